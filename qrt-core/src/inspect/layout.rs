//! The register map: the qubits of each register over time.
//!
//! Registers are laid out contiguously in the order in which they are computed, each on the lowest
//! run of free qubits that is wide enough. Under `keep`, no register is freed before all are
//! computed, so each lies above the one before. Under `scoped`, the qubits of finished scopes are
//! allocated again. A lowering to gates may scatter a register over single free qubits, and then
//! needs no more qubits than are in use. The map keeps registers whole, and can be a little higher.

use qrt_circuit::{Program, RegisterId};
use std::collections::BTreeMap;
use std::ops::Range;

/// A register from its computation to its uncomputation. Under `scoped` a register may have several
/// lifetimes: a scope's values are computed again when the scope is undone.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Lifetime {
    /// The register that is computed and uncomputed.
    pub register: RegisterId,
    /// The register's first qubit in the layout.
    pub offset: u32,
    /// From the instruction that computes it to the one that uncomputes it.
    pub instructions: Range<usize>,
}

/// The lifetimes of a program's registers, laid out contiguously in the order of their computation.
/// Each is on the lowest run of free qubits that is wide enough.
///
/// Under `keep`, each register lies above the one before. Under `scoped`, the qubits of finished
/// scopes are used again, so that registers of different times can have one offset. Registers stay
/// whole here, so the layout can be a little higher than the number of qubits in use, which the
/// placement of single qubits reaches.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct RegisterLayout {
    /// The lifetimes, in the order in which they begin.
    pub lifetimes: Vec<Lifetime>,
    /// Number of qubits of the layout.
    pub height: u32,
    /// The first qubit of each register when it is first computed; none for a register that the
    /// program does not compute.
    offsets: Vec<Option<u32>>,
}

impl RegisterLayout {
    /// Lays out a program. Inputs come first and stay.
    pub fn new(program: &Program) -> Self {
        let end = program.instructions.len();
        let mut layout = Self {
            offsets: vec![None; program.registers.len()],
            ..Self::default()
        };
        let mut free = Free::default();
        // By register: its lifetime while it is alive.
        let mut alive: Vec<Option<usize>> = vec![None; program.registers.len()];
        for &input in &program.inputs {
            layout.begin(program, &mut free, &mut alive, input, 0..end);
        }
        for (at, instruction) in program.instructions.iter().enumerate() {
            let mut fresh = program.ops[instruction.op as usize].fresh();
            if instruction.inverse {
                // Free them in the reverse order, from the top.
                fresh.reverse();
            }
            for register in fresh {
                if !instruction.inverse {
                    layout.begin(program, &mut free, &mut alive, register, at..end);
                } else if let Some(lifetime) = alive[register.index()].take() {
                    let lifetime = &mut layout.lifetimes[lifetime];
                    lifetime.instructions.end = at + 1;
                    free.give(lifetime.offset, program.width(register));
                }
            }
        }
        layout.height = free.top;
        layout
    }

    /// The register's first qubit when it is first computed; none if the program doesn't compute
    /// it.
    pub fn offset(&self, register: RegisterId) -> Option<u32> {
        self.offsets.get(register.index()).copied().flatten()
    }

    /// Number of registers that the layout places.
    pub fn registers(&self) -> u64 {
        self.offsets.iter().flatten().count() as u64
    }

    fn begin(
        &mut self,
        program: &Program,
        free: &mut Free,
        alive: &mut [Option<usize>],
        register: RegisterId,
        instructions: Range<usize>,
    ) {
        let offset = free.allocate(program.width(register));
        self.offsets[register.index()].get_or_insert(offset);
        alive[register.index()] = Some(self.lifetimes.len());
        self.lifetimes.push(Lifetime {
            register,
            offset,
            instructions,
        });
    }
}

/// Free qubits: runs below `top`, and all from `top` on.
#[derive(Debug, Default)]
struct Free {
    runs: BTreeMap<u32, u32>,
    top: u32,
}

impl Free {
    /// Allocates the lowest free run of `width` qubits.
    fn allocate(&mut self, width: u32) -> u32 {
        let found = self.runs.iter().find(|&(_, &length)| length >= width);
        if let Some((&start, &length)) = found {
            self.runs.remove(&start);
            if length > width {
                self.runs.insert(start + width, length - width);
            }
            return start;
        }
        // If the last run reaches the top, the new run begins in it.
        let start = match self.runs.last_key_value() {
            Some((&start, &length)) if start + length == self.top => {
                self.runs.remove(&start);
                start
            }
            _ => self.top,
        };
        self.top = start + width;
        start
    }

    fn give(&mut self, mut start: u32, mut width: u32) {
        if width == 0 {
            return;
        }
        if let Some((&before, &length)) = self.runs.range(..start).next_back()
            && before + length == start
        {
            self.runs.remove(&before);
            start = before;
            width += length;
        }
        if let Some(length) = self.runs.remove(&(start + width)) {
            width += length;
        }
        self.runs.insert(start, width);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use qrt_circuit::{Block, BlockId, Instruction, Op, Operand, Register, Type, Word};

    #[test]
    fn what_was_given_back_is_taken_again_from_below() {
        let mut free = Free::default();
        assert_eq!([4, 3, 2].map(|width| free.allocate(width)), [0, 4, 7]);
        free.give(4, 3);
        assert_eq!(free.allocate(4), 9);
        assert_eq!(free.allocate(2), 4);
        free.give(0, 4);
        free.give(4, 2);
        assert_eq!(free.allocate(7), 0);
        assert_eq!(free.top, 13);
        free.give(9, 4);
        assert_eq!(
            free.allocate(6),
            9,
            "what is free at the top is a part of what comes above"
        );
    }

    /// A program that computes registers of `widths` in turn, and undoes them in the order `undo`.
    fn program(widths: &[u32], undo: &[usize]) -> Program {
        let step = |op: usize, inverse| Instruction {
            op: op as u32,
            inverse,
            block: BlockId::ROOT,
        };
        let load = |n: usize| Op::Add {
            a: Operand::Constant(1),
            b: Operand::Word(Word {
                register: RegisterId(0),
                offset: 0,
                width: 1,
                signed: false,
                shift: 0,
            }),
            subtract: false,
            target: RegisterId(n as u32),
        };
        let computed = (1..widths.len()).map(|n| step(n - 1, false));
        let undone = undo.iter().map(|&n| step(n, true));
        Program {
            registers: widths
                .iter()
                .map(|&width| Register::new("", Type::UInt, width))
                .collect(),
            blocks: vec![Block::default()],
            ops: (1..widths.len()).map(load).collect(),
            instructions: computed.chain(undone).collect(),
            inputs: vec![RegisterId(0)],
            ..Program::default()
        }
    }

    proptest! {
        #[test]
        fn no_two_registers_have_a_qubit_at_one_time(
            widths in proptest::collection::vec(0_u32..9, 2..24),
            seed in any::<u64>(),
        ) {
            let mut undo: Vec<usize> = (0..widths.len() - 1).collect();
            let length = undo.len();
            for n in 0..length {
                undo.swap(n, (seed.rotate_left(n as u32) % length as u64) as usize);
            }
            undo.truncate((seed % (length as u64 + 1)) as usize);
            let program = program(&widths, &undo);
            let layout = RegisterLayout::new(&program);
            prop_assert_eq!(layout.lifetimes.len(), widths.len());
            for (n, a) in layout.lifetimes.iter().enumerate() {
                let top = a.offset + program.width(a.register);
                prop_assert!(top <= layout.height);
                for b in &layout.lifetimes[..n] {
                    let together = a.instructions.start < b.instructions.end
                        && b.instructions.start < a.instructions.end;
                    let apart = top <= b.offset || b.offset + program.width(b.register) <= a.offset;
                    prop_assert!(!together || apart, "{:?} {:?}", a, b);
                }
            }
            // All were computed before the first was undone.
            prop_assert_eq!(layout.height, widths.iter().sum::<u32>());
        }
    }
}
