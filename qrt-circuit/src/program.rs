//! Programs: operations in the order in which they run.

use super::{Block, BlockId, Op, Register, RegisterId};

/// A classical parameter: a word that whoever runs the program supplies. In a circuit it is built
/// in: it is loaded by Xs.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Parameter {
    /// The parameter's name.
    pub name: String,
    /// How many bits the parameter has: 1 to 64.
    pub width: u32,
}

/// One step of a program: an operation or its inverse.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Instruction {
    /// The operation's index in [`Program::ops`].
    pub op: u32,
    /// Whether the operation is undone.
    pub inverse: bool,
    /// The block that the instruction's cost is charged to.
    pub block: BlockId,
}

/// A reversible program: see [the module](super).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Program {
    /// All registers, by [`RegisterId`].
    pub registers: Vec<Register>,
    /// All blocks, by [`BlockId`]; the first is the whole program.
    pub blocks: Vec<Block>,
    /// All classical parameters.
    pub parameters: Vec<Parameter>,
    /// All operations, each once, whether it runs forwards, backwards or both.
    pub ops: Vec<Op>,
    /// The instructions, in the order in which they run.
    pub instructions: Vec<Instruction>,
    /// Registers that hold something before the first instruction: its
    /// operands. In [`Program::inverse`], also what the program computed.
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

    /// The register's width in qubits.
    pub fn width(&self, register: RegisterId) -> u32 {
        self.registers[register.index()].width
    }
}
