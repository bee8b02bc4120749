//! Compute and uncompute as straight-line code.

use super::lines::{self, Around, Line};
use super::names::Names;
use qrt_circuit::{Argument, Bit, BlockId, Instruction, Op, Operand, Program, RegisterId, Word};
use qrt_core::oracle::{Channel, Oracle};
use std::fmt::Write as _;

struct Coder<'a> {
    lines: Vec<Line>,
    program: &'a Program,
    names: &'a Names,
    id: RegisterId,
    /// The block that the last instruction was charged to.
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
    let compute = lines::blocks(&std::mem::take(&mut coder.lines), Around::Call, |_, _| true);
    for instruction in &oracle.program.inverse().instructions {
        coder.instruction(*instruction);
    }
    let uncompute = lines::blocks(&coder.lines, Around::Call, |_, _| true);
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
                (Op::Table { .. } | Op::Multiples { .. } | Op::Divide { .. }, all) => {
                    format!("[{}]", all.join(", "))
                }
                (_, all) => all.concat(),
            };
            format!("let {targets} = m.{};", self.call(op))
        };
        self.lines.push(Line { text, bound, taken });
    }

    /// The call that computes an operation out of place: a method of its name takes its targets'
    /// declarations, what it reads, and its constants. Compute has no others: what is left in place
    /// could not be undone by a copy.
    fn call(&self, op: &Op) -> String {
        let declared = |target: &RegisterId| format!("&R[{}]", target.0);
        let targets: Vec<String> = op.targets().iter().map(declared).collect();
        let mut name = op.name();
        let mut arguments = Vec::new();
        if let Op::Table {
            targets: ids,
            low,
            address,
            ..
        } = op
        {
            let address: Vec<String> = address.iter().map(|bit| self.bit(*bit)).collect();
            let columns: Vec<String> = ids.iter().map(|id| format!("T{}", id.0)).collect();
            arguments.push(format!("[{}]", targets.join(", ")));
            arguments.push(format!("&[{}]", address.join(", ")));
            arguments.push(format!("[{}]", columns.join(", ")));
            arguments.push(low.to_string());
        } else if let Op::Multiples { a, .. } = op {
            // By the number of the first target, as the tables are.
            let first = op.targets().first().map_or(0, |target| target.0);
            arguments.push(format!("[{}]", targets.join(", ")));
            arguments.push(self.word(*a));
            arguments.push(format!("&M{first}"));
        } else {
            arguments.extend(targets);
            let read = op.arguments().into_iter().map(|argument| match argument {
                Argument::Register(register) => self.borrowed(*register),
                Argument::Word(word) => self.word(*word),
                Argument::Bit(bit) => self.bit(*bit),
                Argument::Operand(operand) => self.operand(*operand),
                Argument::Constant(constant) => format!("{constant:?}"),
                Argument::Bits(_) | Argument::Condition => String::new(),
            });
            arguments.extend(read);
        }
        match op {
            Op::Add { subtract, .. } => {
                arguments.pop();
                name = if *subtract { "subtract" } else { name };
            }
            Op::Parity { .. } => arguments[2].insert(0, '&'),
            _ => {}
        }
        format!("{name}({})", arguments.join(", "))
    }
}
