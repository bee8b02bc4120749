//! The layout: the places of a path's numbers, ray by ray, with their formats as types.

use super::names::beside;
use qrt_circuit::{Bit, Word};
use qrt_core::compile::{NamedPlace, ValuePlace};
use qrt_core::oracle::Oracle;
use qrt_tracer::Quantity;
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
pub(super) fn write(out: &mut String, scene: &str, public: &str, oracle: &Oracle) -> String {
    let depths = oracle.points.depths();
    let mut fields = String::new();
    let mut values = String::new();
    for depth in 0..depths {
        let quantities = quantities(oracle, depth);
        let ray = beside(scene, &format!("Ray{depth}"));
        let what = match depth {
            0 => "the primary ray".to_owned(),
            depth => format!("ray {depth}"),
        };
        let _ = writeln!(
            out,
            "/// Numbers of {what} of [`{scene}`] that are in registers.
            #[::core::prelude::v1::derive(
                ::core::clone::Clone, ::core::marker::Copy, ::core::fmt::Debug,
            )]
            #[allow(dead_code, reason = \"an author reads some of them only\")]
            {public} struct {ray} {{"
        );
        let mut value = String::new();
        for quantity in &quantities {
            field(out, &mut value, scene, quantity);
        }
        out.push_str("}\n");
        let _ = writeln!(fields, "/// Of {what}.\npub ray{depth}: {ray},");
        let _ = write!(values, "ray{depth}: {ray} {{ {value} }}, ");
    }
    let layout = beside(scene, "LAYOUT");
    let _ = writeln!(
        out,
        "/// Registers of the numbers of a path of [`{scene}`].
        #[::core::prelude::v1::derive(
            ::core::clone::Clone, ::core::marker::Copy, ::core::fmt::Debug,
        )]
        #[allow(non_camel_case_types, reason = \"messages show the name that an author writes\")]
        #[allow(dead_code, reason = \"an author reads some of them only\")]
        {public} struct {layout} {{ {fields} }}"
    );
    format!("{layout} {{ {values} }}")
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
        ValuePlace::Number {
            word,
            negated,
            offset,
        } => (word, negated, offset),
        ValuePlace::Truth(Bit {
            register,
            index,
            inverted,
        }) => (Word::unsigned(register, index, 1), inverted, [0.0; 3]),
        ValuePlace::Index(word) => (word, false, [0.0; 3]),
    };
    let fraction = oracle.fraction;
    let above = i64::from(word.bits()) - i64::from(fraction);
    let ty = match (named.place, word.signed) {
        (ValuePlace::Truth(_), _) => "Bool".to_owned(),
        (ValuePlace::Index(_), _) => format!("UInt<{}>", word.bits()),
        (ValuePlace::Number { .. }, true) => format!("Fixed<{above}, {fraction}>"),
        (ValuePlace::Number { .. }, false) => format!("UFixed<{above}, {fraction}>"),
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
        Quantity::Origin => "Start of the ray, in the scene's frame as the circuit scales it.",
        Quantity::Direction => "Direction of the ray; the camera's rays have no particular length.",
        Quantity::Throughput => "Fraction of the light at the ray's end that reaches the camera.",
        Quantity::Found => "True if the ray meets a surface, on a path that has not ended.",
        Quantity::Distance => "Distance to the surface, in lengths of the direction.",
        Quantity::Face => "Number of the face that the ray meets.",
        Quantity::Lens => "Cell of the unit square that samples the point on the lens.",
        Quantity::Lamp => "Cell of the unit square that samples the point on a lamp.",
        Quantity::Sample => "Cell of the unit square that samples the direction.",
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
