//! Oracles as straight-line code: the code that `qrt!` generates, and its use.

use super::{Channel, Oracle};
use crate::compile::{NamedPlace, PixelWord};
use qrt_circuit::format::{Format, Reg};
use qrt_circuit::{
    Block, BlockId, Declaration, Machine, Op, Operand, Program, Recorded, Recorder, RegisterId,
    Style, Tag, Type, Word,
};
use qrt_scene::sampling::{PathPoints, SamplingError};
use qrt_scene::valid::ValidScene;
use std::collections::HashMap;
use std::fmt;
use std::marker::PhantomData;

/// An oracle that was compiled together with the program that uses it.
///
/// The code exists once, generic over the [`Machine`] that runs it: a [`Recorder`] turns it into the program
/// again, and a machine that holds numbers computes with it.
#[diagnostic::on_unimplemented(
    message = "there is no code of the circuit of `{Self}`",
    label = "not compiled to code",
    note = "`qrt!` writes code for circuits of at most 20,000 operations"
)]
pub trait CompiledOracle: Sized + 'static {
    /// The parts of the oracle that are not in the code: its registers, blocks and channels.
    const OUTLINE: &'static Outline;

    /// The scene that the oracle was compiled from.
    fn scene() -> &'static ValidScene;

    /// Computes a path's registers from its index, lets `apply` read them, and uncomputes them.
    ///
    /// Computed registers exist only within `apply`: a caller can neither keep nor forget them.
    fn within<M: Machine, T>(
        machine: &mut M,
        id: &M::Register,
        apply: impl FnOnce(&mut M, Computed<'_, Self, M::Register>) -> T,
    ) -> T;

    /// The paths of a pixel.
    ///
    /// # Errors
    /// The sample sequence cannot be constructed; a checked scene's can.
    fn points() -> Result<PathPoints, SamplingError> {
        PathPoints::new(&Self::scene().scene().sampling)
    }

    /// The program that the code stands for: from a path index to the path's colours.
    fn program() -> Program {
        let outline = Self::OUTLINE;
        let mut recorder = outline.recorder();
        let id = outline.inputs(&mut recorder);
        let program = Self::within(&mut recorder, &id, |recorder, _| recorder.program().clone());
        outline.ordered(program)
    }

    /// The oracle of all three channels, without compiling the scene again.
    ///
    /// # Errors
    /// The sample sequence cannot be constructed; a checked scene's can.
    fn oracle() -> Result<Oracle, SamplingError> {
        let outline = Self::OUTLINE;
        let scene = Self::scene().scene();
        Ok(Oracle {
            program: Self::program(),
            parameters: outline.parameters.to_vec(),
            channels: outline.channels.to_vec(),
            id: outline.id,
            comparator: outline.comparator,
            nearest: None,
            flag: outline.flag,
            fraction: outline.fraction,
            points: Self::points()?,
            film: [scene.film.width, scene.film.height],
            pixel: None,
            places: outline.places.to_vec(),
            sharing: outline.sharing,
        })
    }
}

/// A block as it is declared in code: see [`Block`].
#[derive(Clone, Copy, Debug)]
pub struct BlockDeclaration {
    /// The block around this one; none for the root.
    pub parent: Option<BlockId>,
    /// The block's name.
    pub name: &'static str,
    /// The block's [`crate::compile::Label`], as a tag.
    pub tag: Tag,
}

/// The data of a compiled oracle besides its code.
#[derive(Debug)]
pub struct Outline {
    /// All registers of the program, in its order.
    pub registers: &'static [Declaration],
    /// All blocks of the program, in its order.
    pub blocks: &'static [BlockDeclaration],
    /// The first target of each operation, in the order of [`Program::ops`]; empty if the operations first
    /// run in that order.
    pub order: &'static [RegisterId],
    /// All classical parameters of the program, in its order.
    pub parameters: &'static [PixelWord],
    /// The style in which operations with garbage are lowered.
    pub style: Style,
    /// The channels that the program computes.
    pub channels: &'static [Channel],
    /// The register of the path index.
    pub id: RegisterId,
    /// The register of the comparator.
    pub comparator: RegisterId,
    /// The register of the outcome of the comparison, whose phase is flipped.
    pub flag: RegisterId,
    /// Number of fraction bits of every number.
    pub fraction: u32,
    /// As [`Oracle::sharing`].
    pub sharing: [u64; 2],
    /// As [`Oracle::places`].
    pub places: &'static [NamedPlace],
}

impl Outline {
    /// An empty outline, for a scene that has none because of its errors.
    pub const NONE: Self = Self {
        registers: &[],
        blocks: &[],
        order: &[],
        parameters: &[],
        style: Style::OutOfPlace,
        channels: &[],
        id: RegisterId(0),
        comparator: RegisterId(0),
        flag: RegisterId(0),
        fraction: 0,
        sharing: [0; 2],
        places: &[],
    };

    /// Creates a recorder with the program's registers, blocks and parameters.
    pub fn recorder(&self) -> Recorder {
        let block = |block: &BlockDeclaration| Block {
            parent: block.parent,
            name: block.name.to_owned(),
            tag: block.tag,
        };
        let blocks = self.blocks.iter().map(block).collect();
        let parameters = self.parameters.iter().map(PixelWord::parameter).collect();
        Recorder::with_registers(self.registers, blocks, parameters, self.style)
    }

    /// Sorts the operations of a recorded program into the order of the outline.
    pub fn ordered(&self, mut program: Program) -> Program {
        let places: HashMap<RegisterId, usize> = self
            .order
            .iter()
            .enumerate()
            .map(|(to, t)| (*t, to))
            .collect();
        let place = |op: &Op| op.targets().first().and_then(|t| places.get(t).copied());
        let Some(moved) = program
            .ops
            .iter()
            .map(place)
            .collect::<Option<Vec<usize>>>()
        else {
            return program;
        };
        let mut ops: Vec<_> = moved.iter().copied().zip(program.ops).collect();
        ops.sort_by_key(|(to, _)| *to);
        program.ops = ops.into_iter().map(|(_, op)| op).collect();
        for instruction in &mut program.instructions {
            instruction.op = moved[instruction.op as usize] as u32;
        }
        program
    }

    /// Declares the inputs, and returns the register of the path index.
    pub fn inputs(&self, recorder: &mut Recorder) -> Recorded {
        let id = recorder.input(&self.registers[self.id.index()]);
        recorder.input(&self.registers[self.comparator.index()]);
        id
    }
}

/// The place of a number of a path among the registers of `S`. The number's format is the type `T`.
pub struct Field<S, T> {
    /// Its place in [`Outline::places`].
    place: usize,
    word: Word,
    negated: bool,
    offset: [f64; 3],
    of: PhantomData<fn() -> (S, T)>,
}

impl<S, T> fmt::Debug for Field<S, T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Field").field(&self.word).finish()
    }
}

impl<S, T> Clone for Field<S, T> {
    fn clone(&self) -> Self {
        *self
    }
}
impl<S, T> Copy for Field<S, T> {}

impl<S: CompiledOracle, T: Format> Field<S, T> {
    /// Creates the field that reads `word`, for generated code. `place` is its place in [`Outline::places`].
    #[doc(hidden)]
    pub const fn new(place: usize, word: Word) -> Self {
        Self {
            place,
            word,
            negated: false,
            offset: [0.0; 3],
            of: PhantomData,
        }
    }

    /// The field that reads the negative of the number (of a truth: its negation).
    pub const fn negated(self) -> Self {
        Self {
            negated: true,
            ..self
        }
    }

    /// The field plus the part outside the register: `offset[0] + offset[1] column + offset[2] row`.
    pub const fn plus(self, offset: [f64; 3]) -> Self {
        Self { offset, ..self }
    }

    /// The bits of the register that hold the number. They contain neither its sign nor the part that is the
    /// same on all paths of a pixel: [`Field::value`] includes both.
    pub fn word(&self) -> Word {
        self.word
    }

    /// The number, in pixel (column, row), if `register` is the register's content.
    pub fn value(&self, register: u64, pixel: [u32; 2]) -> f64 {
        let fraction = match T::TYPE {
            Type::Fixed { fraction } | Type::UFixed { fraction } => fraction,
            Type::Bool | Type::UInt | Type::Int | Type::Scratch => 0,
        };
        let number = self.word.read(register) as f64 * 2_f64.powi(-fraction.cast_signed());
        let [constant, column, row] = self.offset;
        let fixed = constant + column * f64::from(pixel[0]) + row * f64::from(pixel[1]);
        match (self.negated, T::TYPE) {
            (true, Type::Bool) => 1.0 - number,
            (true, _) => fixed - number,
            (false, _) => fixed + number,
        }
    }
}

/// A point or a direction among the registers of `S`.
pub struct Vector<S, X, Y, Z> {
    /// Its first component.
    pub x: Field<S, X>,
    /// Its second component.
    pub y: Field<S, Y>,
    /// Its third component.
    pub z: Field<S, Z>,
}

impl<S, X, Y, Z> Clone for Vector<S, X, Y, Z> {
    fn clone(&self) -> Self {
        *self
    }
}
impl<S, X, Y, Z> Copy for Vector<S, X, Y, Z> {}

impl<S, X, Y, Z> fmt::Debug for Vector<S, X, Y, Z> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_list()
            .entries([self.x.word, self.y.word, self.z.word])
            .finish()
    }
}

/// The scene `S` itself: a field belongs to the paths of its own scene alone.
#[diagnostic::on_unimplemented(
    message = "a field of `{Self}` is not on the paths of `{S}`",
    label = "of another scene",
    note = "help: take the field from `{S}::LAYOUT`"
)]
pub trait IsScene<S> {}

impl<S> IsScene<S> for S {}

/// The registers of a path, while they are computed.
pub struct Computed<'a, S, R> {
    fields: &'a [&'a R],
    channels: [[Operand<&'a R>; 2]; 3],
    of: PhantomData<fn() -> S>,
}

impl<'a, S: CompiledOracle, R> Computed<'a, S, R> {
    /// Creates it from the registers of [`Outline::places`], and the count and the colour of each channel.
    #[inline(always)]
    pub fn new(fields: &'a [&'a R], channels: [[Operand<&'a R>; 2]; 3]) -> Self {
        Self {
            fields,
            channels,
            of: PhantomData,
        }
    }

    /// The bits of a field, as operations read them.
    #[inline(always)]
    pub fn word<O: IsScene<S>, T: Format>(&self, field: &Field<O, T>) -> Word<&'a R> {
        field.word.map_register(|_| self.fields[field.place])
    }

    /// Calls `apply` with a field as a register of its format, for reversible functions. The register is a
    /// copy of the field's bits, and is undone when `apply` returns. The bits contain neither the number's
    /// sign nor the part that is the same on all paths of a pixel: [`Field::value`] includes both. A truth
    /// value is complete.
    #[inline(always)]
    pub fn with<M, O, T, A>(
        &self,
        machine: &mut M,
        field: &Field<O, T>,
        apply: impl FnOnce(&mut M, &Reg<R, T>) -> A,
    ) -> A
    where
        M: Machine<Register = R>,
        O: IsScene<S>,
        T: Format,
    {
        let bits = self.word(field);
        let declared = Declaration::work("field", T::TYPE, T::WIDTH);
        let copy = Reg::new(if field.negated && T::TYPE == Type::Bool {
            machine.subtract(&declared, Operand::Constant(1), Operand::Word(bits))
        } else {
            machine.copy(&declared, bits)
        });
        let applied = apply(machine, &copy);
        copy.undo(machine);
        applied
    }

    /// Number of the comparator's thresholds that the colour of each channel exceeds. It is not clamped to
    /// the number of thresholds.
    #[inline(always)]
    pub fn counts(&self) -> [Operand<&'a R>; 3] {
        [0, 1, 2].map(|channel| copied(&self.channels[channel][0]))
    }

    /// The colour of each channel, in units of `2^-fraction` of its bound.
    #[inline(always)]
    pub fn colours(&self) -> [Operand<&'a R>; 3] {
        [0, 1, 2].map(|channel| copied(&self.channels[channel][1]))
    }
}

/// Copies an operand. `derive(Copy)` would require `R: Copy`; references are `Copy` without that.
#[inline(always)]
fn copied<'a, R>(operand: &Operand<&'a R>) -> Operand<&'a R> {
    match operand {
        Operand::Constant(value) => Operand::Constant(*value),
        Operand::Word(word) => Operand::Word(Word {
            register: word.register,
            ..*word
        }),
    }
}
