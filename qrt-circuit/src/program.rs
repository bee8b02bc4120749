//! Programs: operations in the order in which they run.

use super::{Block, BlockId, Op, Operand, Register, RegisterId};
use std::fmt;

/// A classical parameter: a word that the caller supplies for each run of the program. It is built
/// into a circuit: Xs load it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Parameter {
    /// The parameter's name.
    pub name: String,
    /// Number of bits of the parameter: 1 to 64.
    pub width: u32,
}

/// One step of a program: an operation or its inverse.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Instruction {
    /// The operation's index in [`Program::ops`].
    pub op: u32,
    /// True if the operation is undone.
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
    /// Registers that hold a value before the first instruction: the program's operands. In
    /// [`Program::inverse`], they also include its results.
    pub inputs: Vec<RegisterId>,
}

impl Program {
    /// Returns the program that undoes this one: the inverses in reverse order.
    pub fn inverse(&self) -> Self {
        let mut inverse = self.clone();
        inverse.instructions.reverse();
        for instruction in &mut inverse.instructions {
            instruction.inverse = !instruction.inverse;
        }
        inverse.inputs = self.outputs();
        inverse
    }

    /// Returns the registers that hold a value after the last instruction, the inputs included.
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

    /// Returns the program with its classical parameters built in: `words` are their contents, and
    /// the result has no parameters.
    ///
    /// Constants take the places of the parameters. So the result computes the same with the same
    /// registers, and every machine runs it without words, inverse and export included.
    ///
    /// ```
    /// use qrt_circuit::{BlockId, Instruction, Op, Parameter, Program, Register, RegisterId, Type};
    ///
    /// let load = Program {
    ///     registers: vec![Register::new("loaded", Type::UInt, 4)],
    ///     blocks: vec![Default::default()],
    ///     parameters: vec![Parameter { name: "pixel".into(), width: 4 }],
    ///     ops: vec![Op::Load { parameter: 0, target: RegisterId(0) }],
    ///     instructions: vec![Instruction { op: 0, inverse: false, block: BlockId::ROOT }],
    ///     ..Program::default()
    /// };
    /// let bound = load.bound(&[9])?;
    /// assert!(bound.parameters.is_empty());
    /// // 9 is 1001: two Xs.
    /// assert_eq!(bound.circuit().gates.len(), 2);
    /// assert!(load.bound(&[16]).is_err());
    /// # Ok::<(), qrt_circuit::WordError>(())
    /// ```
    ///
    /// # Errors
    /// The number of words is not the number of parameters, or a word has more bits than its
    /// parameter.
    pub fn bound(&self, words: &[u64]) -> Result<Self, WordError> {
        if words.len() != self.parameters.len() {
            return Err(WordError::Number {
                given: words.len(),
                expected: self.parameters.len(),
            });
        }
        for (parameter, &word) in self.parameters.iter().zip(words) {
            if word.checked_shr(parameter.width).unwrap_or(0) != 0 {
                let parameter = parameter.name.clone();
                return Err(WordError::TooWide { parameter, word });
            }
        }
        let constant = |parameter: u32| {
            let unused = 64 - self.parameters[parameter as usize].width.min(64);
            // Only the lowest bits are needed.
            Operand::Constant((words[parameter as usize] << unused).cast_signed() >> unused)
        };
        let mut bound = self.clone();
        bound.parameters.clear();
        // By operation: the in-place operation that follows it.
        let mut shifts = vec![None; self.ops.len()];
        for (place, op) in self.ops.iter().enumerate() {
            match *op {
                Op::Load { parameter, target } => {
                    bound.ops[place] = Op::Add {
                        a: constant(parameter),
                        b: Operand::Constant(0),
                        subtract: false,
                        target,
                    };
                }
                Op::Parity {
                    parameter: Some(parameter),
                    target,
                    ..
                } => {
                    if let Op::Parity { parameter, .. } = &mut bound.ops[place] {
                        *parameter = None;
                    }
                    shifts[place] = Some(bound.ops.len() as u32);
                    bound.ops.push(Op::XorInto {
                        a: constant(parameter),
                        when: None,
                        target,
                    });
                }
                _ => {}
            }
        }
        bound.instructions.clear();
        for &instruction in &self.instructions {
            let shift = shifts[instruction.op as usize].map(|op| Instruction { op, ..instruction });
            // The last operation is undone first.
            bound
                .instructions
                .extend(shift.filter(|_| instruction.inverse));
            bound.instructions.push(instruction);
            bound
                .instructions
                .extend(shift.filter(|_| !instruction.inverse));
        }
        Ok(bound)
    }

    /// Iterates over the instructions, in the order in which they run.
    pub fn iter(&self) -> std::slice::Iter<'_, Instruction> {
        self.instructions.iter()
    }
}

/// Iterates over the instructions.
///
/// ```
/// use qrt_circuit::{Declaration, Machine, Operand, Recorder, Style, Type, When};
///
/// let mut recorder = Recorder::new(Style::InPlace);
/// let mut sum = recorder.input(&Declaration::work("sum", Type::UInt, 2));
/// recorder.add_into(&mut sum, Operand::Constant(3), false, When::Always);
/// let program = recorder.finish();
/// for instruction in &program {
///     assert_eq!(program.ops[instruction.op as usize].name(), "add_into");
/// }
/// assert!(program.inverse().into_iter().all(|instruction| instruction.inverse));
/// ```
impl<'a> IntoIterator for &'a Program {
    type Item = &'a Instruction;
    type IntoIter = std::slice::Iter<'a, Instruction>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter()
    }
}

/// Iterates over the instructions.
impl IntoIterator for Program {
    type Item = Instruction;
    type IntoIter = std::vec::IntoIter<Instruction>;

    fn into_iter(self) -> Self::IntoIter {
        self.instructions.into_iter()
    }
}

/// An error: words that are not those of a program's classical parameters.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum WordError {
    /// The number of words is not the number of parameters.
    Number {
        /// Number of words given.
        given: usize,
        /// Number of parameters of the program.
        expected: usize,
    },
    /// A word has more bits than its parameter.
    TooWide {
        /// The parameter's name.
        parameter: String,
        /// The word.
        word: u64,
    },
}

impl fmt::Display for WordError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number { given, expected } => write!(
                f,
                "{given} words were given for {expected} classical parameters: give one for each"
            ),
            Self::TooWide { parameter, word } => {
                write!(
                    f,
                    "the word {word} does not fit into the parameter `{parameter}`"
                )
            }
        }
    }
}

impl std::error::Error for WordError {}
