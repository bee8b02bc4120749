//! User-defined predicates: reversible code over a path's registers decides if the path is good.
//!
//! The oracle of a predicate computes the numbers of a path that the predicate reads, and no
//! others. Then it computes the predicate, flips one phase, and undoes all of it:
//!
//! ```text
//! compute        id -> the rays, as far as they are read; the numbers in their formats
//! predicate      good ^= predicate(numbers)
//! flip           Z on `good`                          of paths
//!                Z where y < (good ? colour' : 0)     of light
//! undo predicate, undo compute
//! ```
//!
//! For [`Marks::Paths`] the good indices are the good paths, S of R. For [`Marks::Light`] they are
//! pairs of a good path and a comparator that its colour exceeds: the count measures the light that
//! arrives on good paths.

mod traced;

use super::paths::{PathFormats, PathInputs, PathNumber, PathScene};
use super::{Channel, Oracle, OracleError, OracleOptions, PREDICATE_CHANNEL};
use crate::compile::{Label, StageName};
use qrt_circuit::format::{Bool, Reg};
use qrt_circuit::lower::{self, Cost};
use qrt_circuit::{
    Bit, BlockId, Instruction, Op, Operand, Program, Recorded, Recorder, Register, RegisterId,
    Style, Type, Word,
};
use qrt_scene::valid::ValidScene;
use std::collections::HashMap;
use traced::traced;

/// The quantity that is counted where a predicate holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Marks {
    /// Paths: S of the R paths of a pixel are good.
    Paths,
    /// Light: as for a picture in which all paths are black that are not good.
    Light,
}

/// The reason why code is not a predicate of a scene's paths.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum PredicateError {
    /// The predicate leaves a value in a register.
    Kept {
        /// The register's name.
        register: String,
    },
    /// The predicate flips phases itself.
    Flips,
    /// The scene is too large for registers.
    TooLarge,
}

impl std::fmt::Display for PredicateError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Kept { register } => write!(
                f,
                "the predicate leaves something in `{register}`: undo what was computed into it, \
                 or let a `#[reversible]` function do so"
            ),
            Self::Flips => f.write_str(
                "the predicate flips a phase: write its result into the register that says whether \
                 the path is good, whose phase the oracle flips",
            ),
            Self::TooLarge => f.write_str(
                "the scene is larger than a register of 62 bits can tell: scale it down",
            ),
        }
    }
}

impl std::error::Error for PredicateError {}

/// A predicate of a scene's paths: a program from the numbers of a path to one bit.
///
/// `qrt!` generates the types of the registers; the crate `qrt` has examples of predicates.
#[derive(Clone, Debug)]
pub struct Predicate {
    scene: &'static ValidScene,
    formats: PathFormats,
    /// The program from the numbers that it reads, its inputs, to the bit.
    program: Program,
    numbers: Vec<PathNumber>,
    good: RegisterId,
}

impl Predicate {
    /// Records a predicate: code that flips the given bit if the path is good, and leaves
    /// everything else unchanged. The bit is 0 before. The code has the path by reference, so it
    /// cannot change the numbers that it reads. Reversible functions leave nothing in registers of
    /// their own. If code written by hand leaves a value in a register that it frees, the gates
    /// machine finds it.
    ///
    /// # Errors
    /// The code leaves a value behind or flips phases, or the scene is too large for registers.
    ///
    /// # Panics
    /// If the code puts another recorder in the place of its own.
    pub fn record<S: PathScene>(
        predicate: impl FnOnce(&mut Recorder, &S::Path, &mut Reg<Recorded, Bool>),
    ) -> Result<Self, PredicateError> {
        let scene = S::scene();
        let formats = PathFormats::new(scene).ok_or(PredicateError::TooLarge)?;
        let mut recorder = Recorder::new(Style::OutOfPlace);
        let mut inputs = PathInputs {
            recorder: &mut recorder,
            formats: &formats,
            made: Vec::new(),
        };
        let path = S::path(&mut inputs);
        let made = inputs.made;
        let mut good: Reg<_, Bool> = Reg::zero(&mut recorder, "good");
        predicate(&mut recorder, &path, &mut good);
        let good = recorder.own(good.register());
        let mut program = recorder.finish();
        for (number, register) in &made {
            program.registers[register.index()].name = number.to_string();
        }
        let mut read = vec![false; program.registers.len()];
        for op in &program.ops {
            if matches!(op, Op::Phase { .. }) {
                return Err(PredicateError::Flips);
            }
            for register in op.reads() {
                read[register.index()] = true;
            }
        }
        let (numbers, inputs): (Vec<_>, Vec<_>) = made
            .into_iter()
            .filter(|(_, register)| read[register.index()])
            .unzip();
        program.inputs = inputs;
        let kept = |register: &RegisterId| *register != good && !program.inputs.contains(register);
        if let Some(kept) = program.outputs().into_iter().find(kept) {
            let register = program.registers[kept.index()].name.clone();
            return Err(PredicateError::Kept { register });
        }
        Ok(Self {
            scene,
            formats,
            program,
            numbers,
            good,
        })
    }

    /// The scene of the predicate's paths.
    pub fn scene(&self) -> &'static ValidScene {
        self.scene
    }

    /// The formats of the scene's paths.
    pub fn formats(&self) -> &PathFormats {
        &self.formats
    }

    /// The predicate as a program: its inputs are [`Predicate::numbers`], in their order.
    pub fn program(&self) -> &Program {
        &self.program
    }

    /// The numbers of a path that the predicate reads.
    pub fn numbers(&self) -> &[PathNumber] {
        &self.numbers
    }

    /// The bit at the program's end that is 1 if the path is good.
    pub fn good(&self) -> Word {
        Word::unsigned(self.good, 0, 1)
    }

    /// The oracle of the predicate.
    ///
    /// For [`Marks::Paths`] it has one channel, and no comparator: it flips the phase of good
    /// paths. For [`Marks::Light`] it has the three channels of a picture.
    ///
    /// # Errors
    /// As [`Oracle::new`].
    pub fn oracle(&self, marks: Marks, options: OracleOptions) -> Result<Oracle, OracleError> {
        let (mut oracle, registers) =
            traced(self.scene, &self.formats, &self.numbers, marks, options)?;
        let good = self.append(&mut oracle.program, &registers);
        match marks {
            Marks::Paths => {
                let word = Operand::Word(Word::unsigned(good, 0, 1));
                oracle.channels = vec![Channel {
                    number: PREDICATE_CHANNEL,
                    colour: word,
                    count: word,
                    scale: 1.0,
                }];
            }
            Marks::Light => {
                let block = last_block(&oracle.program);
                for channel in &mut oracle.channels {
                    channel.count = masked(&mut oracle.program, channel.count, good, block);
                }
            }
        }
        Ok(oracle)
    }

    /// Appends the predicate to `program`, whose `registers` are its inputs. Returns the register
    /// of its bit.
    fn append(&self, program: &mut Program, registers: &[RegisterId]) -> RegisterId {
        let block = last_block(program);
        let given = self
            .program
            .inputs
            .iter()
            .copied()
            .zip(registers.iter().copied());
        let mut places: HashMap<RegisterId, RegisterId> = given.collect();
        for (own, register) in self.program.registers.iter().enumerate() {
            places.entry(RegisterId(own as u32)).or_insert_with(|| {
                program.registers.push(Register {
                    block,
                    ..register.clone()
                });
                RegisterId(program.registers.len() as u32 - 1)
            });
        }
        let place = |register: RegisterId| places[&register];
        let first = program.ops.len() as u32;
        let ops = self.program.ops.iter().cloned();
        program.ops.extend(ops.map(|op| op.map(place, place)));
        let instructions = self.program.instructions.iter();
        program
            .instructions
            .extend(instructions.map(|step| Instruction {
                op: step.op + first,
                inverse: step.inverse,
                block,
            }));
        place(self.good)
    }
}

impl Oracle {
    /// The oracle of a scene's paths without a predicate: its program computes the `numbers` of a
    /// path and marks nothing. Also returns the registers that hold the numbers, in their order.
    ///
    /// # Errors
    /// As [`Oracle::new`].
    pub fn of_numbers(
        scene: &ValidScene,
        formats: &PathFormats,
        numbers: &[PathNumber],
    ) -> Result<(Self, Vec<RegisterId>), OracleError> {
        traced(
            scene,
            formats,
            numbers,
            Marks::Paths,
            OracleOptions::default(),
        )
    }

    /// The cost of one query in gates, and the most qubits in use at any time. The query is for
    /// channel number `channel` of [`Oracle::channels`].
    pub fn cost(&self, channel: usize) -> (Cost, u32) {
        let whole = self.whole(channel);
        let costs = lower::tally(&whole);
        (costs.into_iter().sum(), lower::most_qubits(&whole))
    }
}

/// The block of the predicate: the last one of the program.
fn last_block(program: &Program) -> BlockId {
    let blocks = program
        .blocks
        .iter()
        .rposition(|block| Label::from_block(block).stage == StageName::Predicate);
    BlockId(blocks.unwrap_or(0) as u32)
}

/// `if good { count } else { 0 }`
fn masked(program: &mut Program, count: Operand, good: RegisterId, block: BlockId) -> Operand {
    let (ty, width, signed) = match count {
        Operand::Constant(0) => return count,
        Operand::Constant(value) => (Type::UInt, 64 - value.leading_zeros(), false),
        Operand::Word(word) if word.signed => (Type::Int, word.bits(), true),
        Operand::Word(word) => (Type::UInt, word.bits(), false),
    };
    let target = RegisterId(program.registers.len() as u32);
    program.registers.push(Register {
        block,
        ..Register::new("count", ty, width)
    });
    program.instructions.push(Instruction {
        op: program.ops.len() as u32,
        inverse: false,
        block,
    });
    program.ops.push(Op::Select {
        when: Bit::at(good, 0),
        a: count,
        b: Operand::Constant(0),
        target,
    });
    Operand::Word(Word {
        signed,
        ..Word::unsigned(target, 0, width)
    })
}
