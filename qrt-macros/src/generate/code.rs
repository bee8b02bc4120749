//! Compute and uncompute as straight-line code.

use super::lines::{self, Line};
use super::names::Names;
use qrt_circuit::{Bit, BlockId, Instruction, Op, Operand, Program, RegisterId, Word};
use qrt_core::oracle::{Channel, Oracle};
use std::fmt::Write as _;

struct Coder<'a> {
    lines: Vec<Line>,
    program: &'a Program,
    names: &'a Names,
    id: RegisterId,
    /// What the last instruction was charged to.
    block: Option<BlockId>,
}

/// Writes the trait's implementation.
pub(super) fn write(out: &mut String, oracle: &Oracle, names: &Names) {
    let _ = writeln!(
        out,
        "impl CompiledOracle for __Scene {{
            const OUTLINE: &'static Outline = &OUTLINE;

            fn scene() -> &'static ::qrt::core::valid::ValidScene {{
                __Scene::scene()
            }}

            #[inline(always)]
            fn within<M: Machine, T>(
                m: &mut M,
                id: &M::Register,
                apply: impl FnOnce(&mut M, Computed<'_, Self, M::Register>) -> T,
            ) -> T {{"
    );
    let mut coder = Coder {
        lines: Vec::new(),
        program: &oracle.program,
        names,
        id: oracle.id,
        block: None,
    };
    for instruction in &oracle.program.instructions {
        coder.instruction(*instruction);
    }
    let compute = lines::blocks(&std::mem::take(&mut coder.lines), |_, _| true);
    for instruction in &oracle.program.inverse().instructions {
        coder.instruction(*instruction);
    }
    let uncompute = lines::blocks(&coder.lines, |_, _| true);
    let fields = oracle.places.iter();
    let fields: Vec<String> = fields
        .map(|named| coder.borrowed(named.place.register()))
        .collect();
    let channels = (0..3).map(|number| {
        let channel = oracle.channels.iter().find(|c| c.number == number);
        let zero = Operand::Constant(0);
        let pair = channel.map_or([zero; 2], |&Channel { count, colour, .. }| [count, colour]);
        let [count, colour] = pair.map(|operand| coder.operand(operand));
        format!("[{count}, {colour}]")
    });
    let _ = writeln!(
        out,
        "{compute}
        let fields = &[{}];
        let channels = [{}];
        let applied = apply(m, Computed::new(fields, channels));
        {uncompute}
        applied
        }}
        }}",
        fields.join(", "),
        channels.collect::<Vec<_>>().join(", "),
    );
}

impl Coder<'_> {
    fn borrowed(&self, register: RegisterId) -> String {
        if register == self.id {
            return "id".to_owned();
        }
        format!("&{}", self.names.of(register))
    }

    fn word(&self, word: Word) -> String {
        self.bits("Word", word, "")
    }

    fn bits(&self, of: &str, word: Word, end: &str) -> String {
        let sign = if word.signed { "signed" } else { "unsigned" };
        let register = self.borrowed(word.register);
        let (offset, width) = (word.offset, word.width);
        match word.shift {
            0 => format!("{of}::{sign}({register}, {offset}, {width})"),
            shift => format!("Word::{sign}({register}, {offset}, {width}).shifted({shift}){end}"),
        }
    }

    fn operand(&self, operand: Operand) -> String {
        match operand {
            Operand::Constant(value) => format!("Operand::Constant({value})"),
            Operand::Word(word) => self.bits("Operand", word, ".into()"),
        }
    }

    fn bit(&self, bit: Bit) -> String {
        let negated = if bit.inverted { ".inverted()" } else { "" };
        let register = self.borrowed(bit.register);
        format!("Bit::at({register}, {}){negated}", bit.index)
    }

    fn targets(&self, op: &Op) -> Vec<&str> {
        let targets = op.targets().into_iter();
        targets.map(|target| self.names.of(target)).collect()
    }

    fn instruction(&mut self, instruction: Instruction) {
        if self.block.replace(instruction.block) != Some(instruction.block) {
            self.lines.push(Line {
                text: format!("m.block(BlockId({}));", instruction.block.0),
                ..Line::default()
            });
        }
        let op = &self.program.ops[instruction.op as usize];
        let targets = self.targets(op);
        let own = || targets.iter().map(|&name| name.to_owned()).collect();
        let (mut bound, mut taken) = (Vec::new(), Vec::new());
        let text = if instruction.inverse {
            taken = own();
            format!("m.undo([{}]);", targets.join(", "))
        } else {
            bound = own();
            let targets = match (op, targets.as_slice()) {
                (Op::Table { .. } | Op::Divide { .. }, all) => format!("[{}]", all.join(", ")),
                (_, all) => all.concat(),
            };
            format!("let {targets} = m.{};", self.call(op))
        };
        self.lines.push(Line { text, bound, taken });
    }

    /// An operation out of place.
    fn call(&self, op: &Op) -> String {
        let declared = |target: &RegisterId| format!("&R[{}]", target.0);
        match op {
            Op::Copy { a, target } => format!("copy({}, {})", declared(target), self.word(*a)),
            Op::Load { parameter, target } => format!("load({}, {parameter})", declared(target)),
            Op::Parity {
                source,
                columns,
                parameter,
                target,
            } => format!(
                "parity({}, {}, &{columns:?}, {parameter:?})",
                declared(target),
                self.borrowed(*source)
            ),
            Op::And { a, b, target } | Op::Xor { a, b, target } => format!(
                "{}({}, {}, {})",
                op.name(),
                declared(target),
                self.bit(*a),
                self.bit(*b)
            ),
            Op::Add {
                a,
                b,
                subtract,
                target,
            } => format!(
                "{}({}, {}, {})",
                if *subtract { "subtract" } else { "add" },
                declared(target),
                self.operand(*a),
                self.operand(*b)
            ),
            Op::Negate { a, when, target } => format!(
                "negate({}, {}, {})",
                declared(target),
                self.word(*a),
                self.bit(*when)
            ),
            Op::Select { when, a, b, target } => format!(
                "select({}, {}, {}, {})",
                declared(target),
                self.bit(*when),
                self.operand(*a),
                self.operand(*b)
            ),
            Op::Less { a, b, target } => format!(
                "less({}, {}, {})",
                declared(target),
                self.operand(*a),
                self.operand(*b)
            ),
            Op::Multiply {
                a, b, drop, target, ..
            } => format!(
                "multiply({}, {}, {}, {drop})",
                declared(target),
                self.word(*a),
                self.word(*b)
            ),
            Op::Square {
                a, drop, target, ..
            } => format!("square({}, {}, {drop})", declared(target), self.word(*a)),
            Op::Scale {
                a,
                factor,
                drop,
                target,
                ..
            } => format!(
                "scale({}, {}, {factor}, {drop})",
                declared(target),
                self.word(*a)
            ),
            Op::Divide {
                a,
                b,
                quotient,
                fits,
                ..
            } => format!(
                "divide({}, {}, {}, {})",
                declared(quotient),
                declared(fits),
                self.word(*a),
                self.word(*b)
            ),
            Op::SquareRoot { a, target, .. } => {
                format!("square_root({}, {})", declared(target), self.word(*a))
            }
            Op::Table {
                address,
                low,
                targets,
                ..
            } => {
                let list = |items: Vec<String>| items.join(", ");
                let address = list(address.iter().map(|bit| self.bit(*bit)).collect());
                let column = |target: &RegisterId| format!("T{}", target.0);
                format!(
                    "table([{}], &[{address}], [{}], {low})",
                    list(targets.iter().map(declared).collect()),
                    list(targets.iter().map(column).collect()),
                )
            }
            // Compute has none of them: what is left in place could not be undone by a copy.
            Op::XorInto { .. } | Op::AddInto { .. } | Op::Swap { .. } | Op::Phase { .. } => {
                String::new()
            }
        }
    }
}
