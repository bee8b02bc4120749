//! Reversible code, recorded as a program.

use super::machine::{Declaration, Machine};
use super::{
    Bit, Block, BlockId, Instruction, Op, Operand, Parameter, Program, Register, RegisterId, Style,
    Tag, Type, When, Word, lower,
};
use std::collections::HashMap;
use std::sync::Arc;

/// A machine that records what it is asked to do.
///
/// ```
/// use qrt_circuit::{Declaration, Machine, Recorder, Style, Type, Word, When};
///
/// let mut m = Recorder::new(Style::Lean);
/// let a = m.input(&Declaration::work("a", Type::UInt, 4));
/// let mut b = m.input(&Declaration::work("b", Type::UInt, 4));
/// m.add_into(&mut b, Word::unsigned(&a, 0, 4).into(), false, When::Always);
/// let program = m.finish();
/// assert_eq!(program.instructions.len(), 1);
/// assert_eq!(program.inputs.len(), 2);
/// ```
#[derive(Clone, Debug)]
pub struct Recorder {
    program: Program,
    style: Style,
    /// By register: the operation that computes it.
    computed: HashMap<RegisterId, u32>,
    block: BlockId,
}

/// A register of a [`Recorder`].
#[derive(Debug, PartialEq, Eq)]
pub struct Recorded(RegisterId);

impl Recorded {
    /// Its place in the program's list.
    pub fn id(&self) -> RegisterId {
        self.0
    }
}

impl Recorder {
    /// Records a program of one block, whose operations are lowered in `style`.
    pub fn new(style: Style) -> Self {
        let program = Program {
            blocks: vec![Block::default()],
            ..Program::default()
        };
        Self {
            program,
            style,
            computed: HashMap::new(),
            block: BlockId::ROOT,
        }
    }

    /// Records a program whose registers, blocks and parameters are known: declarations have their
    /// places in the list.
    pub fn of(
        registers: &[Declaration],
        blocks: Vec<Block>,
        parameters: Vec<Parameter>,
        style: Style,
    ) -> Self {
        let mut recorder = Self::new(style);
        let registers = registers.iter().map(register);
        recorder.program.registers = registers.collect();
        recorder.program.blocks = blocks;
        recorder.program.parameters = parameters;
        recorder
    }

    /// A register that holds something before the first instruction.
    pub fn input(&mut self, t: &Declaration) -> Recorded {
        let id = self.declare(t);
        self.program.inputs.push(id);
        Recorded(id)
    }

    /// What has been recorded until now.
    pub fn program(&self) -> &Program {
        &self.program
    }

    /// What was recorded.
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

    /// The register of what an operation leaves behind whose first target is `t`.
    fn scratch(&mut self, t: Option<&Declaration>, op: impl Fn(RegisterId) -> Op) -> RegisterId {
        if let Some(id) = t.and_then(|t| t.scratch) {
            return id;
        }
        let id = RegisterId(self.program.registers.len() as u32);
        let widths = |id: RegisterId| {
            self.program
                .registers
                .get(id.index())
                .map_or(0, |r| r.width)
        };
        let width = lower::scratch_width(&op(id), widths);
        self.program.registers.push(Register {
            name: "scratch".to_owned(),
            ty: Type::Scratch,
            tag: Tag(0),
            width,
            block: self.block,
            range: None,
        });
        id
    }

    fn op(&mut self, op: Op) -> u32 {
        let targets = op.targets();
        let known = targets.first().and_then(|t| self.computed.get(t)).copied();
        let place = known
            .filter(|&place| self.program.ops[place as usize] == op)
            .unwrap_or(self.program.ops.len() as u32);
        if place as usize == self.program.ops.len() {
            self.program.ops.push(op);
        }
        self.step(place, false);
        self.computed
            .extend(targets.into_iter().map(|t| (t, place)));
        place
    }

    fn step(&mut self, op: u32, inverse: bool) {
        let block = self.block;
        let instruction = Instruction { op, inverse, block };
        self.program.instructions.push(instruction);
    }

    /// Records an operation with one target and nothing left behind.
    fn simple(&mut self, t: &Declaration, op: impl FnOnce(RegisterId) -> Op) -> Recorded {
        let target = self.declare(t);
        self.op(op(target));
        Recorded(target)
    }

    /// Records an operation with one target that leaves something behind.
    fn leaving(&mut self, t: &Declaration, op: impl Fn(RegisterId, RegisterId) -> Op) -> Recorded {
        let target = self.declare(t);
        let scratch = self.scratch(Some(t), |scratch| op(target, scratch));
        self.op(op(target, scratch));
        Recorded(target)
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

fn id(register: &Recorded) -> RegisterId {
    register.0
}

fn when(condition: When<&Recorded>) -> When {
    match condition {
        When::Always => When::Always,
        When::If(bit) => When::If(bit.of(id)),
        When::Reversed(bit) => When::Reversed(bit.of(id)),
    }
}

impl Machine for Recorder {
    type Register = Recorded;

    fn zero(&mut self, t: &Declaration) -> Recorded {
        // An operation without gates, so that the register's qubits have an owner.
        self.simple(t, |target| Op::Add {
            a: Operand::Constant(0),
            b: Operand::Constant(0),
            subtract: false,
            target,
        })
    }

    fn free(&mut self, register: Recorded) {
        self.undo([register]);
    }

    fn block(&mut self, block: BlockId) {
        self.block = block;
    }

    fn copy(&mut self, t: &Declaration, a: Word<&Recorded>) -> Recorded {
        let a = a.of(id);
        self.simple(t, |target| Op::Copy { a, target })
    }

    fn load(&mut self, t: &Declaration, parameter: u32) -> Recorded {
        self.simple(t, |target| Op::Load { parameter, target })
    }

    fn parity(
        &mut self,
        t: &Declaration,
        source: &Recorded,
        columns: &[u64],
        parameter: Option<u32>,
    ) -> Recorded {
        self.simple(t, |target| Op::Parity {
            source: source.0,
            columns: columns.into(),
            parameter,
            target,
        })
    }

    fn and(&mut self, t: &Declaration, a: Bit<&Recorded>, b: Bit<&Recorded>) -> Recorded {
        let (a, b) = (a.of(id), b.of(id));
        self.simple(t, |target| Op::And { a, b, target })
    }

    fn xor(&mut self, t: &Declaration, a: Bit<&Recorded>, b: Bit<&Recorded>) -> Recorded {
        let (a, b) = (a.of(id), b.of(id));
        self.simple(t, |target| Op::Xor { a, b, target })
    }

    fn add(&mut self, t: &Declaration, a: Operand<&Recorded>, b: Operand<&Recorded>) -> Recorded {
        let (a, b) = (a.of(id), b.of(id));
        self.simple(t, |target| Op::Add {
            a,
            b,
            subtract: false,
            target,
        })
    }

    fn subtract(
        &mut self,
        t: &Declaration,
        a: Operand<&Recorded>,
        b: Operand<&Recorded>,
    ) -> Recorded {
        let (a, b) = (a.of(id), b.of(id));
        self.simple(t, |target| Op::Add {
            a,
            b,
            subtract: true,
            target,
        })
    }

    fn negate(&mut self, t: &Declaration, a: Word<&Recorded>, when: Bit<&Recorded>) -> Recorded {
        let (a, when) = (a.of(id), when.of(id));
        self.simple(t, |target| Op::Negate { a, when, target })
    }

    fn select(
        &mut self,
        t: &Declaration,
        when: Bit<&Recorded>,
        a: Operand<&Recorded>,
        b: Operand<&Recorded>,
    ) -> Recorded {
        let (when, a, b) = (when.of(id), a.of(id), b.of(id));
        self.simple(t, |target| Op::Select { when, a, b, target })
    }

    fn less(&mut self, t: &Declaration, a: Operand<&Recorded>, b: Operand<&Recorded>) -> Recorded {
        let (a, b) = (a.of(id), b.of(id));
        self.simple(t, |target| Op::Less { a, b, target })
    }

    fn multiply(
        &mut self,
        t: &Declaration,
        a: Word<&Recorded>,
        b: Word<&Recorded>,
        drop: u32,
    ) -> Recorded {
        let (a, b, style) = (a.of(id), b.of(id), self.style);
        self.leaving(t, |target, scratch| Op::Multiply {
            a,
            b,
            drop,
            style,
            target,
            scratch,
        })
    }

    fn square(&mut self, t: &Declaration, a: Word<&Recorded>, drop: u32) -> Recorded {
        let (a, style) = (a.of(id), self.style);
        self.leaving(t, |target, scratch| Op::Square {
            a,
            drop,
            style,
            target,
            scratch,
        })
    }

    fn scale(&mut self, t: &Declaration, a: Word<&Recorded>, factor: i64, drop: u32) -> Recorded {
        let (a, style) = (a.of(id), self.style);
        self.leaving(t, |target, scratch| Op::Scale {
            a,
            factor,
            drop,
            style,
            target,
            scratch,
        })
    }

    fn divide(
        &mut self,
        quotient: &Declaration,
        fits: &Declaration,
        a: Word<&Recorded>,
        b: Word<&Recorded>,
    ) -> [Recorded; 2] {
        let (a, b, style) = (a.of(id), b.of(id), self.style);
        let first = Some(quotient);
        let [quotient, fits] = [quotient, fits].map(|t| self.declare(t));
        let op = |scratch| Op::Divide {
            a,
            b,
            style,
            quotient,
            fits,
            scratch,
        };
        let scratch = self.scratch(first, op);
        self.op(op(scratch));
        [Recorded(quotient), Recorded(fits)]
    }

    fn square_root(&mut self, t: &Declaration, a: Word<&Recorded>) -> Recorded {
        let (a, style) = (a.of(id), self.style);
        self.leaving(t, |target, scratch| Op::SquareRoot {
            a,
            style,
            target,
            scratch,
        })
    }

    fn table<const N: usize>(
        &mut self,
        targets: [&Declaration; N],
        address: &[Bit<&Recorded>],
        columns: [&[i64]; N],
        low: u32,
    ) -> [Recorded; N] {
        let address: Box<[Bit]> = address.iter().map(|bit| bit.of(id)).collect();
        let columns: Arc<[Box<[i64]>]> = columns.iter().map(|&column| column.into()).collect();
        let ids = targets.map(|t| self.declare(t));
        let style = self.style;
        let op = |scratch| Op::Table {
            address: address.clone(),
            columns: columns.clone(),
            low,
            style,
            targets: ids.into(),
            scratch,
        };
        let scratch = self.scratch(targets.first().copied(), op);
        self.op(op(scratch));
        ids.map(Recorded)
    }

    fn undo<const N: usize>(&mut self, computed: [Recorded; N]) {
        let op = computed.first().and_then(|t| self.computed.get(&t.0));
        if let Some(&op) = op {
            self.step(op, true);
        }
    }

    fn xor_into(&mut self, t: &mut Recorded, a: Operand<&Recorded>, when: Option<Bit<&Recorded>>) {
        self.op(Op::XorInto {
            a: a.of(id),
            when: when.map(|bit| bit.of(id)),
            target: t.0,
        });
    }

    fn add_into(
        &mut self,
        t: &mut Recorded,
        a: Operand<&Recorded>,
        subtract: bool,
        condition: When<&Recorded>,
    ) {
        self.op(Op::AddInto {
            a: a.of(id),
            subtract,
            when: when(condition),
            target: t.0,
        });
    }

    fn swap(&mut self, a: &mut Recorded, b: &mut Recorded, when: Option<Bit<&Recorded>>) {
        self.op(Op::Swap {
            a: a.0,
            b: b.0,
            when: when.map(|bit| bit.of(id)),
        });
    }
}
