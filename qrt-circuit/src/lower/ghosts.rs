//! Ghosts: the instructions that a program needs if registers may be undone by measurement.
//!
//! A register that is measured in the X basis is free at once: its operation does not run
//! backwards. A *ghost* stays. If the measurement gave `m`, each path has the sign `(-1)^(m.v)`,
//! where `v` is the value that the register had. When the same operation has computed `v` again, Zs
//! on its bits remove that sign (Gidney, *Spooky pebble games and irreversible uncomputation*,
//! 2019; Kornerup, Sadun & Soloveichik, *Tight bounds on the spooky pebble game*, Quantum 9, 1636,
//! 2025). Until then nothing is lost: all values are functions of the index, which an oracle does
//! not change, and so is the sign.
//!
//! A program whose scopes are undone early computes their operations several times. Each run of an
//! operation except the last may end in a ghost, which the next run repairs. Gates undo the last
//! run. An operation that was recomputed only to undo a register that is now a ghost need not run
//! at all. Of `k` nested scopes, the innermost is computed `k + 1` times instead of `2^k`.

use super::super::{Instruction, Op, Program, RegisterId};

/// Returns the instructions that remain of a program that returns all its results to zero, if
/// registers may leave ghosts: true for each that remains.
///
/// All qubits keep their places, so the program needs no more qubits. All instructions remain if an
/// operation changes a register in place, if two operations compute the same register, or if a
/// register is not returned to zero.
pub fn with_ghosts(program: &Program) -> Vec<bool> {
    let ops: Vec<&Op> = program.ops.iter().collect();
    steps_with_ghosts(program.registers.len(), &ops, &program.instructions)
}

/// [`with_ghosts`] of a program with this number of registers, these operations and these instructions.
pub fn steps_with_ghosts(registers: usize, ops: &[&Op], steps: &[Instruction]) -> Vec<bool> {
    let Some(runs) = Runs::new(registers, ops, steps) else {
        return vec![true; steps.len()];
    };
    let mut left = vec![false; steps.len()];
    let mut needed = runs.always.clone();
    while let Some(at) = needed.pop() {
        if !std::mem::replace(&mut left[at as usize], true) {
            needed.extend(runs.reads(at as usize));
        }
    }
    left
}

/// The instructions that computed the operands of each instruction.
struct Runs {
    /// The instructions that computed the registers that each instruction reads, in one list.
    reads: Vec<u32>,
    /// By instruction: the end of its part of the list.
    ends: Vec<usize>,
    /// The last run of each operation, and its inverse; operations that compute nothing.
    always: Vec<u32>,
}

impl Runs {
    fn new(registers: usize, ops: &[&Op], steps: &[Instruction]) -> Option<Self> {
        // One more than the instruction that computed the content of each register; 0 if it is empty.
        let mut holder: Vec<u32> = vec![0; registers];
        // The last run of each operation: the instructions at which it begins and ends.
        let mut last: Vec<Option<[u32; 2]>> = vec![None; ops.len()];
        let mut writer: Vec<Option<u32>> = vec![None; registers];
        let mut reads = Vec::new();
        let mut ends = Vec::with_capacity(steps.len());
        let mut always = Vec::new();
        for (at, instruction) in steps.iter().enumerate() {
            let at = at as u32;
            let op = ops[instruction.op as usize];
            op.each_read(&mut |register| reads.extend(holder[register.index()].checked_sub(1)));
            ends.push(reads.len());
            let (mut computes, mut is_only_writer) = (false, true);
            let mut write = |register: RegisterId| {
                computes = true;
                // Two operations that write the same register need not compute the same value.
                let writer = writer[register.index()].get_or_insert(instruction.op);
                is_only_writer &= *writer == instruction.op;
                let holder = &mut holder[register.index()];
                if instruction.inverse
                    && let Some(begin) = holder.checked_sub(1)
                {
                    last[instruction.op as usize] = Some([begin, at]);
                }
                *holder = if instruction.inverse { 0 } else { at + 1 };
            };
            op.each_target(&mut write);
            if let Some(register) = op.scratch() {
                write(register);
            }
            if !is_only_writer {
                return None;
            }
            if !computes {
                if !matches!(op, Op::Phase { .. }) {
                    return None;
                }
                always.push(at);
            }
        }
        // A register that is not returned to zero was never undone.
        if holder.iter().any(|holder| *holder > 0) {
            return None;
        }
        always.extend(last.into_iter().flatten().flatten());
        Some(Self {
            reads,
            ends,
            always,
        })
    }

    fn reads(&self, at: usize) -> &[u32] {
        let start = at.checked_sub(1).map_or(0, |before| self.ends[before]);
        &self.reads[start..self.ends[at]]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Bit, BlockId, Instruction, Register, RegisterId, Type, Word};

    /// Appends the steps of a scope: its operation, the copy of its result, and the inverse of its
    /// operation.
    fn run(scope: u32, depth: u32, out: &mut Vec<(u32, bool)>) {
        let mut inside = Vec::new();
        if scope + 1 < depth {
            run(scope + 1, depth, &mut inside);
        }
        inside.push((2 * scope, false));
        out.extend(&inside);
        out.push((2 * scope + 1, false));
        out.extend(inside.iter().rev().map(|(op, inverse)| (*op, !inverse)));
    }

    /// Returns a program with an AND of two bits for each scope. The AND of scope k reads the copy
    /// of scope k + 1, and is itself copied out before its scope is undone.
    fn nested(depth: u32) -> Program {
        let bit = |register| Bit {
            register: RegisterId(register),
            index: 0,
            inverted: false,
        };
        // Input 0; scope k computes register 2k + 1, and copies it to 2k + 2.
        let mut ops = Vec::new();
        for scope in 0..depth {
            let inner = if scope + 1 < depth { 2 * scope + 4 } else { 0 };
            ops.push(Op::And {
                a: bit(0),
                b: bit(inner),
                target: RegisterId(2 * scope + 1),
            });
            ops.push(Op::Copy {
                a: Word {
                    register: RegisterId(2 * scope + 1),
                    offset: 0,
                    width: 1,
                    signed: false,
                    shift: 0,
                },
                target: RegisterId(2 * scope + 2),
            });
        }
        let mut steps = Vec::new();
        run(0, depth, &mut steps);
        let back: Vec<_> = steps
            .iter()
            .rev()
            .map(|(op, inverse)| (*op, !inverse))
            .collect();
        steps.extend(back);
        let instructions = steps.into_iter().map(|(op, inverse)| Instruction {
            op,
            inverse,
            block: BlockId::ROOT,
        });
        Program {
            registers: (0..=2 * depth)
                .map(|_| Register::new("r", Type::Bool, 1))
                .collect(),
            ops,
            instructions: instructions.collect(),
            inputs: vec![RegisterId(0)],
            ..Program::default()
        }
    }

    #[test]
    fn the_innermost_of_k_scopes_is_computed_k_and_one_times() {
        for depth in 1..7 {
            let program = nested(depth);
            let left = with_ghosts(&program);
            let times = |op: u32, inverse: bool, left: &dyn Fn(usize) -> bool| {
                let steps = program.instructions.iter().enumerate();
                let same = steps
                    .filter(|(at, step)| step.op == op && step.inverse == inverse && left(*at));
                same.count() as u32
            };
            for scope in 0..depth {
                let op = 2 * scope;
                assert_eq!(times(op, false, &|_| true), 2 << scope, "{depth} {scope}");
                assert_eq!(
                    times(op, false, &|at| left[at]),
                    scope + 2,
                    "{depth} {scope}"
                );
                assert_eq!(times(op, true, &|at| left[at]), 1);
            }
        }
    }

    #[test]
    fn what_is_left_reads_what_is_there_and_leaves_no_ghost() {
        let program = nested(5);
        let left = with_ghosts(&program);
        let mut there = vec![false; program.registers.len()];
        let mut ghost = there.clone();
        there[0] = true;
        for (instruction, left) in program.instructions.iter().zip(left) {
            let op = &program.ops[instruction.op as usize];
            for target in op.targets() {
                let at = target.index();
                if left {
                    assert!(op.reads().iter().all(|read| there[read.index()]));
                    assert_eq!(there[at], instruction.inverse);
                    // The register is computed again, which repairs its ghost.
                    (there[at], ghost[at]) = (!instruction.inverse, false);
                } else if instruction.inverse {
                    ghost[at] |= std::mem::take(&mut there[at]);
                }
            }
        }
        assert_eq!(there.iter().filter(|there| **there).count(), 1);
        assert!(!ghost.contains(&true));
    }
}
