//! Compute and uncompute as straight-line code, with functions for repeated parts.

use super::lines::{self, Line};
use super::names::Names;
use super::repeats::Repeats;
use qrt_circuit::{
    Argument, Bit, BlockId, Instruction, Op, Operand, Program, RegisterId, When, Word,
};
use qrt_core::oracle::{Channel, Oracle};
use std::collections::{HashMap, HashSet};
use std::fmt::Write as _;

/// The fewest statements that become a function if they are repeated. With few qubits, results that
/// are undone early are recomputed many times: of the 30,000 statements of a box within 500 qubits
/// 2,400 differ.
const REPEATED: usize = 16;

/// A statement of the code.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
enum Statement {
    /// Charges the following statements to a block.
    Block(BlockId),
    Compute(u32),
    Undo(u32),
    /// The place between compute and uncompute.
    Apply,
}

/// Returns all statements of compute and of uncompute.
fn statements(compute: &[Instruction], uncompute: &[Instruction]) -> Vec<Statement> {
    let (mut all, mut block) = (Vec::new(), None);
    let mut push_all = |instructions: &[Instruction], last: Option<Statement>| {
        for instruction in instructions {
            if block.replace(instruction.block) != Some(instruction.block) {
                all.push(Statement::Block(instruction.block));
            }
            all.push(if instruction.inverse {
                Statement::Undo(instruction.op)
            } else {
                Statement::Compute(instruction.op)
            });
        }
        all.extend(last);
    };
    push_all(compute, Some(Statement::Apply));
    push_all(uncompute, None);
    all
}

/// The effect of statements on the registers that exist before or after them.
#[derive(Default)]
struct Effect {
    /// Registers that exist before and after.
    read: Vec<RegisterId>,
    /// Registers that exist before, and not after.
    taken: Vec<RegisterId>,
    /// Registers that exist after, and not before.
    made: Vec<RegisterId>,
}

impl Effect {
    /// Returns the effect of `effects`, one after the other.
    fn chain<'a>(effects: impl Iterator<Item = &'a Self>) -> Self {
        let (mut read, mut taken, mut made) = (Vec::new(), Vec::new(), Vec::new());
        for effect in effects {
            for register in &effect.read {
                if !made.contains(register) && !read.contains(register) {
                    read.push(*register);
                }
            }
            for register in &effect.taken {
                let before = made.len();
                made.retain(|own| own != register);
                if made.len() == before {
                    taken.push(*register);
                }
            }
            made.extend(&effect.made);
        }
        read.retain(|register| !taken.contains(register));
        Self { read, taken, made }
    }
}

struct Coder<'a> {
    program: &'a Program,
    names: &'a Names,
    id: RegisterId,
    /// The statement of each symbol.
    statements: Vec<Statement>,
    /// The effect of each symbol; the symbols of functions follow those of statements.
    effects: Vec<Effect>,
    /// The registers that the function being written takes by reference.
    lent: HashSet<RegisterId>,
}

/// Writes the trait's implementation. Names of its variables begin with `__` or end with a
/// register's number, so that no constant around the macro has them.
pub(super) fn write(out: &mut String, oracle: &Oracle, names: &Names) {
    let (mut coder, sequence) = Coder::new(oracle, names);
    let told = Repeats::find(sequence, coder.statements.len(), REPEATED);
    for part in &told.parts {
        coder.function(out, part);
    }
    let is_apply = |symbol: &usize| coder.statements.get(*symbol) == Some(&Statement::Apply);
    let mut halves = told.whole.split(is_apply).map(|half| coder.block(half));
    let [compute, uncompute] = [(); 2].map(|()| halves.next().unwrap_or_default());
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
        "impl CompiledOracle for __Scene {{
            const OUTLINE: &'static Outline = &OUTLINE;

            fn scene() -> &'static ::qrt::scene::valid::ValidScene {{
                __Scene::scene()
            }}

            #[inline(always)]
            fn within<M: Machine, T>(
                __m: &mut M,
                __id: &M::Register,
                __apply: impl FnOnce(&mut M, Computed<'_, Self, M::Register>) -> T,
            ) -> T {{
        {compute}
        let __fields = &[{}];
        let __channels = [{}];
        let __applied = __apply(__m, Computed::new(__fields, __channels));
        {uncompute}
        __applied
        }}
        }}",
        fields.join(", "),
        channels.collect::<Vec<_>>().join(", "),
    );
}

impl<'a> Coder<'a> {
    /// Creates a coder, and returns compute and uncompute as a sequence of its symbols.
    fn new(oracle: &'a Oracle, names: &'a Names) -> (Self, Vec<usize>) {
        let mut coder = Self {
            program: &oracle.program,
            names,
            id: oracle.id,
            statements: Vec::new(),
            effects: Vec::new(),
            lent: HashSet::new(),
        };
        let all = statements(
            &oracle.program.instructions,
            &oracle.program.inverse().instructions,
        );
        let mut symbols = HashMap::new();
        let sequence = all.into_iter().map(|statement| {
            *symbols.entry(statement).or_insert_with(|| {
                coder.effects.push(coder.effect(statement));
                coder.statements.push(statement);
                coder.statements.len() - 1
            })
        });
        let sequence = sequence.collect();
        (coder, sequence)
    }

    fn op(&self, op: u32) -> &'a Op {
        &self.program.ops[op as usize]
    }

    fn effect(&self, statement: Statement) -> Effect {
        let mut effect = Effect::default();
        match statement {
            Statement::Block(_) | Statement::Apply => {}
            Statement::Compute(op) | Statement::Undo(op)
                if let Op::AddInto { target, .. } = self.op(op) =>
            {
                effect.read = self.op(op).reads();
                effect.read.retain(|register| register != target);
                effect.taken = vec![*target];
                effect.made = vec![*target];
            }
            Statement::Compute(op) => {
                effect.read = self.op(op).reads();
                effect.made = self.op(op).targets();
            }
            Statement::Undo(op) => effect.taken = self.op(op).targets(),
        }
        effect.read.retain(|register| *register != self.id);
        effect
    }

    /// Writes the next function.
    fn function(&mut self, out: &mut String, part: &[usize]) {
        let effect = Effect::chain(part.iter().map(|&symbol| &self.effects[symbol]));
        self.lent = effect.read.iter().copied().collect();
        let of = |registers: &[RegisterId], kind: &str| -> String {
            let named = registers
                .iter()
                .map(|&own| format!(", {}: {kind}", self.names.variable(own)));
            named.collect()
        };
        let number = self.effects.len() - self.statements.len();
        let read = of(&effect.read, "&M::Register");
        let taken = of(&effect.taken, "M::Register");
        let made = "M::Register, ".repeat(effect.made.len());
        let code = self.block(part);
        let _ = writeln!(
            out,
            "fn repeated_{number}<M: Machine>(__m: &mut M, __id: &M::Register{read}{taken}) -> ({made}) {{
                {code}
                ({})
            }}",
            self.tuple(&effect.made),
        );
        self.effects.push(effect);
        self.lent.clear();
    }

    fn block(&self, symbols: &[usize]) -> String {
        let lines: Vec<Line> = symbols.iter().map(|&symbol| self.line(symbol)).collect();
        lines::blocks(&lines)
    }

    fn line(&self, symbol: usize) -> Line {
        let effect = &self.effects[symbol];
        let named = |all: &[RegisterId]| {
            all.iter()
                .map(|&own| self.names.variable(own).to_owned())
                .collect()
        };
        let text = match self.statements.get(symbol) {
            None => {
                let number = symbol - self.statements.len();
                let read = effect.read.iter().map(|&own| self.borrowed(own) + ", ");
                let read: String = read.collect();
                let [taken, made] = [&effect.taken, &effect.made].map(|all| self.tuple(all));
                format!("let ({made}) = repeated_{number}(__m, __id, {read}{taken});")
            }
            Some(Statement::Block(block)) => format!("__m.block(BlockId({}));", block.0),
            Some(statement @ (Statement::Compute(op) | Statement::Undo(op)))
                if let &Op::AddInto {
                    a,
                    subtract,
                    when: When::Always,
                    target,
                } = self.op(*op) =>
            {
                let target = self.names.variable(target);
                let subtract = subtract != matches!(statement, Statement::Undo(_));
                let a = self.operand(a);
                format!(
                    "let mut {target} = {target}; \
                     __m.add_into(&mut {target}, {a}, {subtract}, When::Always);"
                )
            }
            Some(Statement::Compute(op)) => {
                let op = self.op(*op);
                let targets = self.targets(op);
                let targets = match (op, targets.as_slice()) {
                    (
                        Op::Table { .. }
                        | Op::Multiples { .. }
                        | Op::Divide { .. }
                        | Op::Encode { .. },
                        all,
                    ) => format!("[{}]", all.join(", ")),
                    (_, all) => all.concat(),
                };
                format!("let {targets} = __m.{};", self.call(op))
            }
            Some(Statement::Undo(op)) => {
                format!("__m.undo([{}]);", self.targets(self.op(*op)).join(", "))
            }
            Some(Statement::Apply) => String::new(),
        };
        Line {
            text,
            bound: named(&effect.made),
            taken: named(&effect.taken),
        }
    }

    /// Returns the variables of `registers`, with a comma after each.
    fn tuple(&self, registers: &[RegisterId]) -> String {
        let named = registers
            .iter()
            .map(|&own| format!("{}, ", self.names.variable(own)));
        named.collect()
    }

    fn borrowed(&self, register: RegisterId) -> String {
        if register == self.id {
            return "__id".to_owned();
        }
        if self.lent.contains(&register) {
            return self.names.variable(register).to_owned();
        }
        format!("&{}", self.names.variable(register))
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
        targets.map(|target| self.names.variable(target)).collect()
    }

    /// Returns the call that computes an out-of-place operation: a method of the operation's name
    /// takes the declarations of its targets, its operands, and its constants.
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
            // The constant has the number of the first target, as tables have.
            let first = op.targets().first().map_or(0, |target| target.0);
            arguments.push(format!("[{}]", targets.join(", ")));
            arguments.push(self.word(*a));
            arguments.push(format!("&M{first}"));
        } else if let Op::Encode { bits, entries, .. } = op {
            let bits: Vec<String> = bits.iter().map(|bit| self.bit(*bit)).collect();
            arguments.push(format!("[{}]", targets.join(", ")));
            arguments.push(format!("&[{}]", bits.join(", ")));
            arguments.push(format!("&{entries:?}"));
        } else {
            arguments.extend(targets);
            let read = op.arguments().into_iter().map(|argument| match argument {
                Argument::Register(register) => self.borrowed(*register),
                Argument::Word(word) => self.word(*word),
                Argument::Bit(bit) => self.bit(*bit),
                Argument::Operand(operand) => self.operand(*operand),
                Argument::Constant(constant) => format!("{constant:?}"),
                Argument::Bits(_) | Argument::Condition(_) => String::new(),
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
