//! Programs: operations in the order in which they run.

use super::{Block, BlockId, Op, Register, RegisterId};
use crate::sampling::PathPoints;

/// A classical word that depends on the pixel alone. The circuit of a pixel has it built in: it is
/// loaded by Xs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Parameter {
    /// The XOR shift of a sample coordinate, its top `bits` bits.
    Shift {
        /// Depth of the ray.
        depth: usize,
        /// 0: u, 1: v.
        axis: usize,
        /// Bits of the coordinate.
        bits: u32,
    },
    /// `round((constant + along[0] column + along[1] row) 2^fraction) mod 2^width`
    Affine {
        /// At the film's upper left corner.
        constant: f64,
        /// Its change per column and per row.
        along: [f64; 2],
        /// Bits after the point.
        fraction: u32,
        /// Bits in all.
        width: u32,
    },
}

impl Parameter {
    /// Bits.
    pub fn width(&self) -> u32 {
        match *self {
            Self::Shift { bits, .. } => bits,
            Self::Affine { width, .. } => width,
        }
    }

    /// Its bits in pixel (column, row).
    pub fn value(&self, points: &PathPoints, seed: u64, pixel: [u32; 2]) -> u64 {
        match *self {
            Self::Shift { depth, axis, bits } => {
                let dimension = PathPoints::dimension(depth, axis);
                let shift = points.shift(seed, pixel[0], pixel[1], dimension);
                shift.checked_shr(64 - bits).unwrap_or(0)
            }
            Self::Affine {
                constant,
                along,
                fraction,
                width,
            } => {
                let value =
                    constant + along[0] * f64::from(pixel[0]) + along[1] * f64::from(pixel[1]);
                let scaled = (value * (1_u64 << fraction) as f64).round_ties_even() as i64;
                scaled.cast_unsigned() & (u64::MAX >> (64 - width))
            }
        }
    }
}

/// One step of a program: an operation or its inverse.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Instruction {
    /// Its place in [`Program::ops`].
    pub op: u32,
    /// Is it undone?
    pub inverse: bool,
    /// The block that it is charged to.
    pub block: BlockId,
}

/// A reversible program: see [the module](super).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Program {
    /// All registers.
    pub registers: Vec<Register>,
    /// All blocks; the first is the whole program.
    pub blocks: Vec<Block>,
    /// All classical words.
    pub parameters: Vec<Parameter>,
    /// All operations.
    pub ops: Vec<Op>,
    /// What runs, in order.
    pub instructions: Vec<Instruction>,
    /// Registers that hold something before the first instruction: the id, the comparator. In
    /// [`Program::inverse`], also what the program computed.
    pub inputs: Vec<RegisterId>,
}

impl Program {
    /// The program that undoes this one: the inverses in reverse order.
    pub fn inverse(&self) -> Self {
        let mut inverse = self.clone();
        inverse.instructions.reverse();
        for instruction in &mut inverse.instructions {
            instruction.inverse = !instruction.inverse;
        }
        inverse.inputs = self.outputs();
        inverse
    }

    /// Registers that hold something after the last instruction, the inputs included.
    pub fn outputs(&self) -> Vec<RegisterId> {
        let mut held = vec![false; self.registers.len()];
        for input in &self.inputs {
            held[input.index()] = true;
        }
        for instruction in &self.instructions {
            for target in self.ops[instruction.op as usize].fresh() {
                held[target.index()] = !instruction.inverse;
            }
        }
        let ids = (0..self.registers.len() as u32).map(RegisterId);
        ids.filter(|id| held[id.index()]).collect()
    }

    /// The register's width.
    pub fn width(&self, register: RegisterId) -> u32 {
        self.registers[register.index()].width
    }
}
