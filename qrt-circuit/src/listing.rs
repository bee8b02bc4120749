//! Programs as text.

use super::{Argument, Bit, Instruction, Operand, Program, RegisterId, When, Word};
use std::collections::HashMap;
use std::fmt;

/// The most letters of a constant: tables are shortened.
const MOST: usize = 40;

/// Writes the inputs with their formats, and a line for each instruction: an operation with its
/// targets and operands, or `undo` and the operation that it undoes. A name that several registers
/// have is followed by the register's number.
///
/// ```
/// use qrt_circuit::{Bit, Declaration, Machine, Recorder, Style, Type, When, Word};
///
/// let mut recorder = Recorder::new(Style::InPlace);
/// let a = recorder.input(&Declaration::work("a", Type::UInt, 3));
/// let mut sum = recorder.input(&Declaration::work("sum", Type::UInt, 6));
/// let (low, high) = (Word::unsigned(&a, 0, 2), Bit::at(&a, 2));
/// let square = recorder.multiply(&Declaration::work("square", Type::UInt, 4), low, low, 0);
/// recorder.add_into(&mut sum, Word::unsigned(&square, 0, 4).into(), false, When::If(high));
/// recorder.undo([square]);
/// assert_eq!(
///     recorder.finish().to_string(),
///     "a: UInt<3>, sum: UInt<6>
/// square = multiply(a[0..2], a[0..2], 0)
/// add_into(square, false, if a[2], sum)
/// undo square = multiply(a[0..2], a[0..2], 0)
/// "
/// );
/// ```
impl fmt::Display for Program {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let listing = Listing::new(self);
        let inputs = self.inputs.iter().map(|&input| {
            let register = &self.registers[input.index()];
            let format = register.ty.name(register.width);
            format!("{}: {format}", listing.register(input))
        });
        writeln!(f, "{}", inputs.collect::<Vec<_>>().join(", "))?;
        for instruction in self {
            writeln!(f, "{}", listing.instruction(*instruction))?;
        }
        Ok(())
    }
}

/// A program, and the number of registers with each name.
struct Listing<'a> {
    program: &'a Program,
    named: HashMap<&'a str, usize>,
}

impl<'a> Listing<'a> {
    fn new(program: &'a Program) -> Self {
        let mut named = HashMap::new();
        for register in &program.registers {
            *named.entry(register.name.as_str()).or_default() += 1;
        }
        Self { program, named }
    }

    fn register(&self, id: RegisterId) -> String {
        let name = self.program.registers[id.index()].name.as_str();
        if self.named.get(name) == Some(&1) {
            name.to_owned()
        } else {
            format!("{name}#{}", id.0)
        }
    }

    fn instruction(&self, instruction: Instruction) -> String {
        let op = &self.program.ops[instruction.op as usize];
        let arguments = op.arguments().into_iter();
        let arguments: Vec<String> = arguments.filter_map(|a| self.argument(a)).collect();
        let call = format!("{}({})", op.name(), arguments.join(", "));
        let targets = op.targets().into_iter().map(|target| self.register(target));
        let targets: Vec<String> = targets.collect();
        let undo = if instruction.inverse { "undo " } else { "" };
        if targets.is_empty() {
            format!("{undo}{call}")
        } else {
            format!("{undo}{} = {call}", targets.join(", "))
        }
    }

    /// Returns an argument's text; `None` for the condition of a change that always happens.
    fn argument(&self, argument: Argument<'_>) -> Option<String> {
        Some(match argument {
            Argument::Register(register) => self.register(*register),
            Argument::Word(word) | Argument::Operand(Operand::Word(word)) => self.word(*word),
            Argument::Bit(bit) => self.bit(*bit),
            Argument::Bits(bits) => {
                let bits: Vec<String> = bits.iter().map(|bit| self.bit(*bit)).collect();
                format!("[{}]", bits.join(", "))
            }
            Argument::Operand(Operand::Constant(value)) => value.to_string(),
            Argument::Condition(When::Always) => return None,
            Argument::Condition(When::If(bit)) => {
                format!("if {}", self.bit(bit.map_register(|register| *register)))
            }
            Argument::Condition(When::Reversed(bit)) => {
                format!(
                    "reversed if {}",
                    self.bit(bit.map_register(|register| *register))
                )
            }
            Argument::Constant(constant) => {
                let text = format!("{constant:?}");
                if text.chars().count() <= MOST {
                    text
                } else {
                    let begin: String = text.chars().take(MOST).collect();
                    format!("{begin}..")
                }
            }
        })
    }

    fn word(&self, word: Word) -> String {
        let register = self.register(word.register);
        let all = self.program.width(word.register);
        let read = if (word.offset, word.width) == (0, all) {
            register
        } else {
            format!("{register}[{}..{}]", word.offset, word.offset + word.width)
        };
        match word.shift {
            0 => read,
            shift => format!("{read} << {shift}"),
        }
    }

    fn bit(&self, bit: Bit) -> String {
        let not = if bit.inverted { "!" } else { "" };
        let register = self.register(bit.register);
        if self.program.width(bit.register) == 1 {
            format!("{not}{register}")
        } else {
            format!("{not}{register}[{}]", bit.index)
        }
    }
}
