//! Registers, blocks, tables and classical parameters as constants.

use qrt_circuit::{Bit, Op, Operand, Style, Type, Word};
use qrt_core::compile::ValuePlace;
use qrt_core::oracle::Oracle;
use std::collections::HashMap;
use std::fmt::Write as _;

/// Writes the constants of an oracle.
pub(super) fn write(out: &mut String, oracle: &Oracle) {
    registers(out, oracle);
    blocks(out, oracle);
    tables(out, oracle);
    outline(out, oracle);
}

fn ty(ty: Type) -> String {
    match ty {
        Type::Bool => "Type::Bool".to_owned(),
        Type::UInt => "Type::UInt".to_owned(),
        Type::Int => "Type::Int".to_owned(),
        Type::UFixed { fraction } => format!("Type::UFixed {{ fraction: {fraction} }}"),
        Type::Fixed { fraction } => format!("Type::Fixed {{ fraction: {fraction} }}"),
        Type::Scratch => "Type::Scratch".to_owned(),
    }
}

/// Writes the registers by number, with the garbage of their operations.
fn registers(out: &mut String, oracle: &Oracle) {
    let program = &oracle.program;
    let mut scratch: HashMap<u32, u32> = HashMap::new();
    // The styles that differ from the outline's.
    let mut styles: HashMap<u32, Style> = HashMap::new();
    let style_of_most = program.ops.iter().find_map(Op::style);
    for op in &program.ops {
        let targets = op.targets();
        let Some(target) = targets.first() else {
            continue;
        };
        if let Some(left) = op.scratch() {
            scratch.insert(target.0, left.0);
        }
        if let Some(style) = op.style().filter(|_| op.style() != style_of_most) {
            styles.insert(target.0, style);
        }
    }
    let _ = writeln!(
        out,
        "/// Registers by number.\nstatic R: [Declaration; {}] = [",
        program.registers.len()
    );
    for (id, register) in program.registers.iter().enumerate() {
        let _ = write!(
            out,
            "Declaration::at({id}, {:?}, {}, {:?}, {})",
            register.name,
            ty(register.ty),
            register.tag,
            register.width
        );
        if register.block.0 != 0 {
            let _ = write!(out, ".block({})", register.block.0);
        }
        if let Some([low, high]) = register.range {
            let _ = write!(out, ".range({low}, {high})");
        }
        if let Some(left) = scratch.get(&(id as u32)) {
            let _ = write!(out, ".scratch({left})");
        }
        if let Some(style) = styles.get(&(id as u32)) {
            let _ = write!(out, ".style(Style::{style:?})");
        }
        out.push_str(",\n");
    }
    out.push_str("];\n");
}

fn blocks(out: &mut String, oracle: &Oracle) {
    out.push_str("const BLOCKS: &[BlockDeclaration] = &[\n");
    for block in &oracle.program.blocks {
        let _ = writeln!(
            out,
            "BlockDeclaration {{ parent: {:?}, name: {:?}, tag: {:?} }},",
            block.parent, block.name, block.tag
        );
    }
    out.push_str("];\n");
}

/// Writes the columns of tables and the products of one number, each named by its target's number.
fn tables(out: &mut String, oracle: &Oracle) {
    for op in &oracle.program.ops {
        if let Op::Table {
            columns, targets, ..
        } = op
        {
            for (column, target) in columns.iter().zip(targets) {
                let _ = writeln!(out, "static T{}: &[i64] = &{column:?};", target.0);
            }
        }
        if let Op::Multiples {
            products, targets, ..
        } = op
        {
            let _ = writeln!(
                out,
                "static M{}: ::qrt::__std::sync::LazyLock<::qrt::__std::sync::Arc<Multiples>> = \
                 ::qrt::__std::sync::LazyLock::new(|| Multiples::new(&{:?})\
                 .expect(\"the constants were in bounds\").into());",
                targets[0].0,
                products.products(),
            );
        }
    }
}

fn word(word: Word) -> String {
    let sign = if word.signed { "signed" } else { "unsigned" };
    let text = format!(
        "Word::{sign}(RegisterId({}), {}, {})",
        word.register.0, word.offset, word.width
    );
    match word.shift {
        0 => text,
        shift => format!("Word {{ shift: {shift}, ..{text} }}"),
    }
}

fn operand(operand: Operand) -> String {
    match operand {
        Operand::Constant(value) => format!("Operand::Constant({value})"),
        Operand::Word(bits) => format!("Operand::Word({})", word(bits)),
    }
}

fn place(place: ValuePlace) -> String {
    match place {
        ValuePlace::Number {
            word: bits,
            negated,
            offset,
        } => format!(
            "ValuePlace::Number {{ word: {}, negated: {negated}, offset: {offset:?} }}",
            word(bits)
        ),
        ValuePlace::Truth(Bit {
            register,
            index,
            inverted,
        }) => format!(
            "ValuePlace::Truth(Bit {{ register: {register:?}, index: {index}, \
             inverted: {inverted} }})"
        ),
        ValuePlace::Index(bits) => format!("ValuePlace::Index({})", word(bits)),
    }
}

fn outline(out: &mut String, oracle: &Oracle) {
    let style = oracle.program.ops.iter().find_map(Op::style);
    let program = &oracle.program;
    let mut seen = vec![false; program.ops.len()];
    let mut first_runs = Vec::new();
    for instruction in &program.instructions {
        if !std::mem::replace(&mut seen[instruction.op as usize], true) {
            first_runs.push(instruction.op as usize);
        }
    }
    let in_order = first_runs.iter().copied().eq(0..program.ops.len());
    let order: Vec<_> = program
        .ops
        .iter()
        .filter_map(|op| op.targets().first().copied())
        .filter(|_| !in_order)
        .collect();
    out.push_str("const PARAMETERS: &[PixelWord] = &[\n");
    for word in &oracle.parameters {
        // The word's debug form is Rust code.
        let _ = writeln!(out, "PixelWord::{word:?},");
    }
    out.push_str("];\nconst CHANNELS: &[Channel] = &[\n");
    for channel in &oracle.channels {
        let _ = writeln!(
            out,
            "Channel {{ number: {}, colour: {}, count: {}, scale: {:?} }},",
            channel.number,
            operand(channel.colour),
            operand(channel.count),
            channel.scale
        );
    }
    out.push_str("];\nconst PLACES: &[NamedPlace] = &[\n");
    for named in &oracle.places {
        let _ = writeln!(
            out,
            "NamedPlace {{ name: Named {{ depth: {}, quantity: Quantity::{:?} }}, component: {}, \
             place: {} }},",
            named.name.depth,
            named.name.quantity,
            named.component,
            place(named.place)
        );
    }
    let _ = writeln!(
        out,
        "];
        static OUTLINE: Outline = Outline {{
            registers: &R,
            blocks: BLOCKS,
            order: &{order:?},
            parameters: PARAMETERS,
            style: Style::{:?},
            channels: CHANNELS,
            id: {:?},
            comparator: {:?},
            flag: {:?},
            fraction: {},
            sharing: {:?},
            places: PLACES,
        }};",
        style.unwrap_or(Style::OutOfPlace),
        oracle.id,
        oracle.comparator,
        oracle.flag,
        oracle.fraction,
        oracle.sharing,
    );
}
