//! Compute as code for vectors of lanes, which the native machine runs.
//!
//! Each operation becomes the instructions that its numbers need. The known properties of the
//! numbers (widths, ranges, constants) are used here, where the code is written, so that the
//! compiler has nothing to decide.

mod divide;
mod number;
mod range;
mod table;
#[cfg(test)]
mod tests;

use super::lines::{self, Around, Line};
use super::names::Names;
use number::Number;
use qrt_circuit::{Bit, Op, Operand, Program, Register, RegisterId, Type, Word};
use qrt_core::oracle::Oracle;
use range::Range;
use std::collections::HashMap;
use std::fmt::Write as _;

/// A register as a variable of the code.
#[derive(Clone, Debug)]
enum Variable {
    Truths(String),
    Number(Number),
}

/// The `cfg` of native code. Without optimisation the code takes seconds to compile, and runs no
/// faster than the fixed machine. A crate's tests have it, so that they run the code that its users
/// run.
const WRITTEN: &str = "#[cfg(any(not(debug_assertions), test))]";
const LEFT_OUT: &str = "#[cfg(not(any(not(debug_assertions), test)))]";

/// Writes the trait's implementation.
pub(super) fn write(out: &mut String, oracle: &Oracle, names: &Names) {
    let _ = writeln!(
        out,
        "{WRITTEN}
        const _: () = {{
        {}
        }};
        {LEFT_OUT}
        impl NativeOracle for __Scene {{
            const WRITTEN: bool = false;
            fn native<V: Vectors>(_: V, _: &[u64], _: V::Longs) -> [[V::Longs; 3]; 2] {{
                ::core::unreachable!(\"no native code without optimisation\")
            }}
        }}",
        code(oracle, names),
    );
}

/// Returns the tables, and the implementation that looks them up.
fn code(oracle: &Oracle, names: &Names) -> String {
    let mut coder = Coder {
        program: &oracle.program,
        names,
        bindings: Vec::new(),
        statics: String::new(),
        variables: HashMap::new(),
        temporaries: 0,
    };
    let id = coder.of_longs(Range::of_width(63, false), "ids".to_owned());
    let paths = Range::of_width(oracle.points.path_bits().max(1), false);
    let id = if paths.narrow() {
        Number {
            text: coder.ints(&id),
            range: paths,
        }
    } else {
        Number { range: paths, ..id }
    };
    coder.variables.insert(oracle.id, Variable::Number(id));
    for instruction in &oracle.program.instructions {
        let op = &oracle.program.ops[instruction.op as usize];
        let targets = op.targets();
        // A register that is undone and computed again holds the same value.
        let known = |target| coder.variables.contains_key(target);
        if !instruction.inverse && !targets.iter().all(known) {
            coder.op(op);
        }
    }
    let mut outputs = [const { String::new() }; 2];
    for number in 0..3 {
        let channel = oracle.channels.iter().find(|c| c.number == number);
        let zero = Operand::Constant(0);
        let both = channel.map_or([zero; 2], |channel| [channel.count, channel.colour]);
        for (output, operand) in outputs.iter_mut().zip(both) {
            let number = coder.operand(operand);
            let longs = coder.longs(&number);
            let _ = write!(output, "{longs}, ");
        }
    }
    let [counts, colours] = outputs;
    let lines = coder.bindings.into_iter().map(Binding::line);
    let mut lines: Vec<Line> = lines.collect();
    let body = lines.len();
    // The outputs are used last of all.
    lines.push(Line {
        text: format!("{counts} {colours}"),
        ..Line::default()
    });
    let uses = lines::last_uses(&lines);
    let needed = |name: &str, after: usize| uses.get(name).is_some_and(|&last| last > after);
    let code = lines::blocks(&lines[..body], Around::Inlined, needed);
    format!(
        "{}
        impl NativeOracle for __Scene {{
            #[inline(always)]
            fn native<V: Vectors>(v: V, words: &[u64], ids: V::Longs) -> [[V::Longs; 3]; 2] {{
                {code}
                [[{counts}], [{colours}]]
            }}
        }}",
        coder.statics,
    )
}

/// `let name = value;`
struct Binding {
    name: String,
    value: String,
    /// True if a register gave it its name.
    is_named: bool,
}

impl Binding {
    fn line(self) -> Line {
        Line {
            text: format!("let {} = {};", self.name, self.value),
            bound: vec![self.name],
            taken: Vec::new(),
        }
    }
}

struct Coder<'a> {
    program: &'a Program,
    names: &'a Names,
    bindings: Vec<Binding>,
    /// The tables that the code looks up, as text of Rust.
    statics: String,
    variables: HashMap<RegisterId, Variable>,
    temporaries: usize,
}

impl Coder<'_> {
    /// Binds a new variable to `value`, and returns its name.
    fn bind(&mut self, value: &str) -> String {
        self.temporaries += 1;
        let name = format!("t{}", self.temporaries);
        self.bindings.push(Binding {
            name: name.clone(),
            value: value.to_owned(),
            is_named: false,
        });
        name
    }

    fn register(&self, id: RegisterId) -> &Register {
        &self.program.registers[id.index()]
    }

    /// Renames the variable that was bound last to the register's name, unless it has a name
    /// already.
    fn rename(&mut self, id: RegisterId, variable: &mut String) {
        if let Some(last) = self.bindings.last_mut()
            && !last.is_named
            && last.name == *variable
        {
            self.names.variable(id).clone_into(variable);
            last.name.clone_from(variable);
            last.is_named = true;
        }
    }

    /// Sets the register to the number's lowest bits.
    fn set(&mut self, id: RegisterId, number: Number) {
        let register = self.register(id);
        let (width, signed) = (register.width, signed(register.ty));
        let proven = register.range;
        if width == 1 && !signed {
            let truths = self.number_bit(&number, 0);
            return self.set_truths(id, truths);
        }
        let mut number = self.cut(number, width, signed);
        if let Some([low, high]) = proven {
            let narrow = number.range.narrow();
            let proven = number.range.intersection(Range::new(low, high));
            // The register's variable keeps its kind of lanes, even if its proven range is
            // narrower.
            if proven.low <= proven.high && proven.narrow() == narrow {
                number.range = proven;
            }
        }
        self.rename(id, &mut number.text);
        self.variables.insert(id, Variable::Number(number));
    }

    /// Sets the register to 1 where the truth holds, and to 0 elsewhere.
    fn set_truths(&mut self, id: RegisterId, mut truths: String) {
        let register = self.register(id);
        if register.width == 1 && !signed(register.ty) {
            self.rename(id, &mut truths);
            self.variables.insert(id, Variable::Truths(truths));
            return;
        }
        let digit = self.digit(&truths);
        self.set(id, digit);
    }

    /// Returns 1 where the truth holds, 0 elsewhere.
    fn digit(&mut self, truths: &str) -> Number {
        let text = self.bind(&format!("v.ints(1).choose({truths}, v.ints(0))"));
        let range = Range::new(0, 1);
        Number { text, range }
    }

    /// Returns the content of a register. A register that nothing computed is zero.
    fn content(&mut self, id: RegisterId) -> Number {
        match self.variables.get(&id).cloned() {
            Some(Variable::Number(number)) => number,
            Some(Variable::Truths(truths)) => self.digit(&truths),
            None => Self::constant(0),
        }
    }

    /// Returns a word's number, without the zeros below it.
    fn bits(&mut self, word: Word) -> Number {
        let all = self.content(word.register);
        let all = self.right(all, word.offset);
        self.cut(all, word.width, word.signed)
    }

    fn word(&mut self, word: Word) -> Number {
        let bits = self.bits(word);
        self.left(bits, word.shift)
    }

    fn operand(&mut self, operand: Operand) -> Number {
        match operand {
            Operand::Word(word) => self.word(word),
            Operand::Constant(value) => Self::constant(value),
        }
    }

    fn bit(&mut self, bit: Bit) -> String {
        let truths = match self.variables.get(&bit.register).cloned() {
            Some(Variable::Truths(truths)) => truths,
            Some(Variable::Number(number)) => self.number_bit(&number, bit.index),
            None => "v.truths(false)".to_owned(),
        };
        if bit.inverted {
            self.bind(&format!("{truths}.not()"))
        } else {
            truths
        }
    }

    fn op(&mut self, op: &Op) {
        let width = |coder: &Self, id: RegisterId| coder.register(id).width;
        match op {
            Op::Copy { a, target } => {
                let a = self.word(*a);
                self.set(*target, a);
            }
            Op::Load { parameter, target } => {
                let number = self.classical(*parameter, *target);
                self.set(*target, number);
            }
            Op::Parity {
                source,
                columns,
                parameter,
                target,
            } => self.parity(*source, columns, *parameter, *target),
            Op::And { a, b, target } | Op::Xor { a, b, target } => {
                let (a, b) = (self.bit(*a), self.bit(*b));
                let truths = self.bind(&format!("{a}.{}({b})", op.name()));
                self.set_truths(*target, truths);
            }
            Op::Add {
                a,
                b,
                subtract,
                target,
            } => {
                let (a, b) = (self.operand(*a), self.operand(*b));
                let width = width(self, *target);
                let sum = self.added(&a, &b, *subtract, width);
                self.set(*target, sum);
            }
            Op::Negate { a, when, target } => {
                let (a, when) = (self.word(*a), self.bit(*when));
                let width = width(self, *target);
                let minus = self.added(&Self::constant(0), &a, true, width);
                let chosen = self.choose(&minus, &when, &a);
                self.set(*target, chosen);
            }
            Op::Select { when, a, b, target } => {
                let (a, b) = (self.operand(*a), self.operand(*b));
                let when = self.bit(*when);
                let chosen = self.choose(&a, &when, &b);
                self.set(*target, chosen);
            }
            Op::Less { a, b, target } => {
                let (a, b) = (self.operand(*a), self.operand(*b));
                let less = self.less(&a, &b);
                self.set_truths(*target, less);
            }
            Op::Multiply {
                a, b, drop, target, ..
            } => {
                let (a, b) = (self.word(*a), self.word(*b));
                let width = width(self, *target);
                let product = self.product(&a, &b, *drop, width);
                self.set(*target, product);
            }
            Op::Square {
                a, drop, target, ..
            } => {
                let a = self.word(*a);
                let width = width(self, *target);
                let product = self.product(&a, &a, *drop, width);
                self.set(*target, product);
            }
            Op::Scale {
                a,
                factor,
                drop,
                target,
                ..
            } => {
                let a = self.word(*a);
                let width = width(self, *target);
                let product = self.product(&a, &Self::constant(*factor), *drop, width);
                self.set(*target, product);
            }
            Op::Multiples {
                a,
                products,
                targets,
                ..
            } => {
                let a = self.word(*a);
                for (&(factor, drop), target) in products.products().iter().zip(targets) {
                    let width = width(self, *target);
                    let product = self.product(&a, &Self::constant(factor), drop, width);
                    self.set(*target, product);
                }
            }
            Op::Divide {
                a,
                b,
                quotient,
                fits,
                ..
            } => {
                let (a, b) = ((self.bits(*a), a.shift), (self.bits(*b), b.shift));
                let width = width(self, *quotient);
                let (value, holds) = self.divided(a, b, width);
                self.set_truths(*fits, holds);
                self.set(*quotient, value);
            }
            Op::SquareRoot { a, target, .. } => {
                let a = self.word(*a);
                let root = self.root(&a);
                self.set(*target, root);
            }
            Op::Table {
                address,
                columns,
                targets,
                ..
            } => self.table(address, columns, targets),
            // Compute has no operations in place.
            Op::XorInto { .. } | Op::AddInto { .. } | Op::Swap { .. } | Op::Phase { .. } => {}
        }
    }
}

fn signed(ty: Type) -> bool {
    matches!(ty, Type::Int | Type::Fixed { .. })
}
