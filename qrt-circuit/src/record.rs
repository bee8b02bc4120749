//! A machine that records reversible code as a program.

use super::machine::{Call, Declaration, Machine};
use super::{
    Block, BlockId, Instruction, Op, Parameter, Program, Register, RegisterId, Style, Type, lower,
};
use std::collections::HashMap;
use std::sync::atomic::{AtomicU32, Ordering};

/// A machine that records its calls as a program.
///
/// ```
/// use qrt_circuit::{Declaration, Machine, Recorder, Style, Type, Word, When};
///
/// let mut m = Recorder::new(Style::InPlace);
/// let a = m.input(&Declaration::work("a", Type::UInt, 4));
/// let mut b = m.input(&Declaration::work("b", Type::UInt, 4));
/// m.add_into(&mut b, Word::unsigned(&a, 0, 4).into(), false, When::Always);
/// let program = m.finish();
/// assert_eq!(program.instructions.len(), 1);
/// assert_eq!(program.inputs.len(), 2);
/// ```
///
/// Registers belong to the recorder that made them, and to its clones. Another recorder panics if
/// it receives one of them.
#[derive(Clone, Debug)]
pub struct Recorder {
    /// A number that distinguishes its registers from those of other recorders.
    number: u32,
    program: Program,
    style: Style,
    /// The operation that computes each register.
    computed: HashMap<RegisterId, u32>,
    /// The sums in place, if one that is repeated or undone is found again among the operations.
    sums: Option<HashMap<Op, u32>>,
    block: BlockId,
    /// The most instructions that it records.
    most: usize,
}

/// The most instructions of a routine: a hundred times those that trace a mesh of 1,536 faces.
const MOST: usize = 1 << 24;

/// A register of a [`Recorder`]: a handle on a register of the program that it records.
#[derive(Debug, PartialEq, Eq)]
pub struct Recorded {
    id: RegisterId,
    recorder: u32,
    width: u32,
}

impl Recorded {
    /// Returns the register's index in the program's list.
    pub fn id(&self) -> RegisterId {
        self.id
    }

    /// Number of qubits of the register.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Returns the register's index. Panics if another recorder made it.
    fn on(&self, recorder: u32) -> RegisterId {
        assert!(
            self.recorder == recorder,
            "register {} belongs to another machine: a register is used on the machine that made it",
            self.id.0
        );
        self.id
    }
}

/// Number of recorders created so far.
static RECORDERS: AtomicU32 = AtomicU32::new(0);

impl Recorder {
    /// Creates a recorder of a program of one block, whose operations are lowered in `style`.
    ///
    /// Recording panics at its operation 2^24 + 1. Otherwise loops that call routines with loops
    /// could fill any memory.
    pub fn new(style: Style) -> Self {
        let program = Program {
            blocks: vec![Block::default()],
            ..Program::default()
        };
        Self {
            number: RECORDERS.fetch_add(1, Ordering::Relaxed),
            program,
            style,
            computed: HashMap::new(),
            sums: None,
            block: BlockId::ROOT,
            most: MOST,
        }
    }

    /// Creates a recorder of a program whose registers, blocks and parameters are known:
    /// declarations have their places in the list. An [`Op::AddInto`] that subtracts what an earlier
    /// one adds is recorded as its inverse.
    pub fn with_registers(
        registers: &[Declaration],
        blocks: Vec<Block>,
        parameters: Vec<Parameter>,
        style: Style,
    ) -> Self {
        let mut recorder = Self::new(style);
        recorder.most = usize::MAX;
        recorder.sums = Some(HashMap::new());
        let registers = registers.iter().map(register);
        recorder.program.registers = registers.collect();
        recorder.program.blocks = blocks;
        recorder.program.parameters = parameters;
        recorder
    }

    /// Declares an input: a register that holds a value before the first instruction.
    pub fn input(&mut self, t: &Declaration) -> Recorded {
        let id = self.declare(t);
        self.program.inputs.push(id);
        self.recorded(id)
    }

    fn recorded(&self, id: RegisterId) -> Recorded {
        let register = self.program.registers.get(id.index());
        Recorded {
            id,
            recorder: self.number,
            width: register.map_or(0, |register| register.width),
        }
    }

    /// Returns the register's index in the program's list.
    ///
    /// # Panics
    /// If another recorder made it.
    pub fn own(&self, register: &Recorded) -> RegisterId {
        register.on(self.number)
    }

    /// Returns the program recorded so far.
    pub fn program(&self) -> &Program {
        &self.program
    }

    /// Returns the recorded program.
    pub fn finish(self) -> Program {
        self.program
    }

    fn declare(&mut self, t: &Declaration) -> RegisterId {
        if let Some(id) = t.id {
            return id;
        }
        let registers = &mut self.program.registers;
        let id = RegisterId(registers.len() as u32);
        registers.push(Register {
            block: self.block,
            ..register(t)
        });
        id
    }

    /// Returns the register of the garbage of `op`: the one declared with its first target, or a
    /// new one of the width that its lowering needs.
    fn scratch(&mut self, declared: Option<RegisterId>, op: &Op) -> RegisterId {
        declared.unwrap_or_else(|| {
            let registers = &self.program.registers;
            let width = |id: RegisterId| registers.get(id.index()).map_or(0, |r| r.width);
            let register = Register {
                block: self.block,
                ..Register::new("scratch", Type::Scratch, lower::scratch_width(op, width))
            };
            self.program.registers.push(register);
            RegisterId(self.program.registers.len() as u32 - 1)
        })
    }

    /// Records an operation, and returns its targets.
    fn compute(&mut self, op: Op<&Recorded, &Declaration>) -> Vec<RegisterId> {
        let declared = op.targets().first().and_then(|t| t.scratch);
        let style = op.targets().first().and_then(|t| t.style);
        let (style, number) = (style.unwrap_or(self.style), self.number);
        let unknown = RegisterId(self.program.registers.len() as u32 + op.targets().len() as u32);
        let op = op.map(
            |register| register.on(number),
            |t| match t.ty {
                Type::Scratch => unknown,
                _ => self.declare(t),
            },
        );
        let mut op = op.with_style(style);
        if op.scratch().is_some() {
            let scratch = self.scratch(declared, &op);
            op = op.with_scratch(scratch);
        }
        let targets = op.targets();
        let (place, inverse) = self.place(&op);
        if place as usize == self.program.ops.len() {
            self.program.ops.push(op);
        }
        self.step(place, inverse);
        self.computed.extend(targets.iter().map(|t| (*t, place)));
        targets
    }

    /// Returns the place of `op` among the program's operations, or the place after them, and true if it is the
    /// inverse of the operation at that place.
    fn place(&mut self, op: &Op) -> (u32, bool) {
        let next = self.program.ops.len() as u32;
        if let (Some(sums), Op::AddInto { .. }) = (&mut self.sums, op) {
            let opposite = opposite(op).and_then(|opposite| sums.get(&opposite));
            return match opposite {
                Some(&place) => (place, true),
                None => (*sums.entry(op.clone()).or_insert(next), false),
            };
        }
        let first = op.targets().first().copied();
        let known = first.and_then(|t| self.computed.get(&t)).copied();
        let same = known.filter(|&place| self.program.ops[place as usize] == *op);
        (same.unwrap_or(next), false)
    }

    fn step(&mut self, op: u32, inverse: bool) {
        assert!(
            self.program.instructions.len() < self.most,
            "QRT0811: a program of more than {} operations, each of which becomes gates of its own: \
             write fewer passes of loops and fewer calls within them",
            self.most
        );
        let block = self.block;
        let instruction = Instruction { op, inverse, block };
        self.program.instructions.push(instruction);
    }
}

/// The operation in place that undoes `op`, for a sum.
fn opposite(op: &Op) -> Option<Op> {
    match *op {
        Op::AddInto {
            a,
            subtract,
            when,
            target,
        } => Some(Op::AddInto {
            a,
            subtract: !subtract,
            when,
            target,
        }),
        _ => None,
    }
}

fn register(t: &Declaration) -> Register {
    Register {
        name: t.name.to_owned(),
        ty: t.ty,
        tag: t.tag,
        width: t.width,
        block: t.block,
        range: t.range,
    }
}

impl Machine for Recorder {
    type Register = Recorded;

    fn call(&mut self, call: Call<'_, Recorded>) -> Vec<Recorded> {
        match call {
            Call::Compute(op) => {
                let targets = self.compute(op).into_iter();
                targets.map(|id| self.recorded(id)).collect()
            }
            Call::Undo(computed) => {
                let first = computed.first().map(|register| self.own(register));
                let op = first.and_then(|id| self.computed.get(&id));
                if let Some(&op) = op {
                    self.step(op, true);
                }
                Vec::new()
            }
            Call::Block(block) => {
                self.block = block;
                Vec::new()
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{When, Word};

    /// Recording reports calls in loops of routines with loops, before they fill the memory.
    #[test]
    #[should_panic(expected = "a program of more than 3 operations")]
    fn no_routine_is_endless() {
        let mut m = Recorder::new(Style::InPlace);
        m.most = 3;
        let [a, mut b] = ["a", "b"].map(|name| m.input(&Declaration::work(name, Type::UInt, 4)));
        for _ in 0..4 {
            m.add_into(&mut b, Word::unsigned(&a, 0, 4).into(), false, When::Always);
        }
    }
}
