//! The layout: the places of a path's numbers, ray by ray, with their formats as types.

use qrt_circuit::{Bit, Word};
use qrt_core::compile::{NamedPlace, Place};
use qrt_core::oracle::Oracle;
use qrt_core::tracer::Quantity;
use std::fmt::Write as _;

struct Component {
    name: Option<&'static str>,
    ty: String,
    value: String,
}

/// A quantity of a ray, as fields of its struct.
struct Named {
    name: Quantity,
    components: Vec<Component>,
}

/// Writes a struct for each ray, and one for all of them; returns the value of the latter.
pub(super) fn write(
    out: &mut String,
    scene: &str,
    public: &str,
    conditions: &str,
    oracle: &Oracle,
) -> String {
    let depths = oracle.points.depths();
    let mut fields = String::new();
    let mut values = String::new();
    for depth in 0..depths {
        let quantities = quantities(oracle, depth);
        let what = match depth {
            0 => "the primary ray".to_owned(),
            depth => format!("ray {depth}"),
        };
        let _ = writeln!(
            out,
            "{conditions}
            /// Numbers of {what} of [`{scene}`] that are in registers.
            #[derive(Clone, Copy, Debug)]
            #[allow(dead_code, reason = \"an author reads some of them only\")]
            {public} struct {scene}Ray{depth} {{"
        );
        let mut value = String::new();
        for quantity in &quantities {
            field(out, &mut value, scene, quantity);
        }
        out.push_str("}\n");
        let _ = writeln!(fields, "/// Of {what}.\npub ray{depth}: {scene}Ray{depth},");
        let _ = write!(values, "ray{depth}: {scene}Ray{depth} {{ {value} }}, ");
    }
    let _ = writeln!(
        out,
        "{conditions}
        /// Registers of the numbers of a path of [`{scene}`].
        #[derive(Clone, Copy, Debug)]
        #[allow(dead_code, reason = \"an author reads some of them only\")]
        {public} struct {scene}Layout {{ {fields} }}"
    );
    format!("{scene}Layout {{ {values} }}")
}

fn quantities(oracle: &Oracle, depth: usize) -> Vec<Named> {
    let mut quantities: Vec<Named> = Vec::new();
    for (place, named) in oracle.places.iter().enumerate() {
        if named.name.depth != depth {
            continue;
        }
        let name = named.name.quantity;
        if quantities.last().is_none_or(|last| last.name != name) {
            quantities.push(Named {
                name,
                components: Vec::new(),
            });
        }
        if let Some(last) = quantities.last_mut() {
            last.components.push(component(oracle, place, named));
        }
    }
    quantities
}

/// Returns a number's format and its field.
fn component(oracle: &Oracle, place: usize, named: &NamedPlace) -> Component {
    let (word, negated, offset) = match named.place {
        Place::Number {
            word,
            negated,
            offset,
        } => (word, negated, offset),
        Place::Truth(Bit {
            register,
            index,
            inverted,
        }) => (Word::unsigned(register, index, 1), inverted, [0.0; 3]),
        Place::Index(word) => (word, false, [0.0; 3]),
    };
    let fraction = oracle.fraction;
    let above = i64::from(word.bits()) - i64::from(fraction);
    let ty = match (named.place, word.signed) {
        (Place::Truth(_), _) => "Bool".to_owned(),
        (Place::Index(_), _) => format!("UInt<{}>", word.bits()),
        (Place::Number { .. }, true) => format!("Fixed<{above}, {fraction}>"),
        (Place::Number { .. }, false) => format!("UFixed<{above}, {fraction}>"),
    };
    let ty = format!("::qrt::circuit::format::{ty}");
    let sign = if word.signed { "signed" } else { "unsigned" };
    let bits = format!(
        "Word::{sign}({:?}, {}, {})",
        word.register, word.offset, word.width
    );
    let mut value = match word.shift {
        0 => format!("Field::<__Scene, {ty}>::new({place}, {bits})"),
        shift => {
            format!("Field::<__Scene, {ty}>::new({place}, Word {{ shift: {shift}, ..{bits} }})")
        }
    };
    if negated {
        value.push_str(".negated()");
    }
    if offset != [0.0; 3] {
        let _ = write!(value, ".plus({offset:?})");
    }
    Component {
        name: named.component_name(),
        ty,
        value,
    }
}

/// Returns the documentation of a quantity.
fn meaning(quantity: Quantity) -> &'static str {
    match quantity {
        Quantity::Origin => "Where it starts, in the scene's frame as the circuit scales it.",
        Quantity::Direction => "Where it goes; the camera's are of no particular length.",
        Quantity::Throughput => "The fraction of what it finds that reaches the camera.",
        Quantity::Found => "Whether it meets a surface, on a path that has not ended.",
        Quantity::Distance => "How far away that is, in lengths of its direction.",
        Quantity::Face => "The face it meets, by number.",
        Quantity::Lamp => "The cell of the unit square that samples the point on a lamp.",
        Quantity::Sample => "The cell of the unit square that it samples.",
    }
}

fn field(out: &mut String, values: &mut String, scene: &str, quantity: &Named) {
    let meaning = meaning(quantity.name);
    let name = quantity.name.name();
    if let [x, y, z] = quantity.components.as_slice()
        && x.name == Some("x")
    {
        let _ = writeln!(
            out,
            "/// {meaning}\npub {name}: ::qrt::core::oracle::compiled::Vector<{scene}, {}, {}, {}>,",
            x.ty, y.ty, z.ty
        );
        let _ = write!(
            values,
            "{name}: Vector {{ x: {}, y: {}, z: {} }}, ",
            x.value, y.value, z.value
        );
        return;
    }
    for component in &quantity.components {
        let name = match component.name {
            Some(component) => format!("{name}_{component}"),
            None => name.to_owned(),
        };
        let _ = writeln!(
            out,
            "/// {meaning}\npub {name}: ::qrt::core::oracle::compiled::Field<{scene}, {}>,",
            component.ty
        );
        let _ = write!(values, "{name}: {}, ", component.value);
    }
}
