//! A scene's oracle: the paper's Path Tracing frame as a reversible program.
//!
//! The oracle of a channel flips the phase of every basis state (path index, comparator) whose
//! path's colour exceeds the comparator's threshold, and leaves all other qubits as they were:
//!
//! ```text
//! compute        id -> colour_id            generate_ray, find_intersection, shade; per depth
//! compare        flag = y < colour'         colour' = #thresholds that the colour exceeds
//! flip           Z on the flag
//! undo compare, undo compute
//! ```
//!
//! The colour is in units of the channel's proven bound, so it is a number in [0, 1] for all radiances.
//! `colour'` is the colour rounded to a step `2^-c` (to the nearest under `midpoints`, up under
//! `edges`), so that the comparison is one of integers: `#{y < 2^c : y < colour'} = min(colour', 2^c)`
//! of a path's basis states are good.
//!
//! One program serves all pixels of a film. The differences between pixels are classical parameters
//! ([`crate::compile::PixelWord`]), which X gates load.

mod bound;
mod budget;
mod call_cost;
pub mod compiled;
mod nearest;
mod oracles;
pub mod paths;
mod phase;
mod predicate;
mod recording;
mod strategy_costs;
mod target;

pub use bound::BoundProgram;
pub use budget::check_budget;
pub use call_cost::{CallCost, call_cost};
pub use nearest::{MOST_FACES, NearestOracle};
pub(crate) use oracles::LARGE;
pub use oracles::{OracleCost, OracleName, Oracles, PARTS_OF_A_CALL};
pub use phase::MOST_BITS;
pub use predicate::{Marks, Predicate, PredicateError};
pub use strategy_costs::{StrategyCost, StrategyCosts};

use crate::compile::{
    BuildError, Builder, Label, NamedPlace, Passes, PixelWord, RealValue, StageName, Strategy,
};
use qrt_circuit::{
    Bit, Block, BlockId, Instruction, Op, Operand, Program, RegisterId, Word, lower,
};
use qrt_scene::ComparatorAt;
use qrt_scene::sampling::{PathPoints, SamplingError};
use qrt_scene::valid::ValidScene;
use qrt_tracer::{Arith, PixelClass, PixelClasses, Stage};
use recording::{PrimaryHit, Recording};
use std::fmt;

pub use qrt_scene::DEFAULT_FRACTION;

/// The number of the channel that holds the luminance.
pub const LUMINANCE_CHANNEL: usize = 3;

/// The number of the channel that counts paths on which a predicate holds.
pub const PREDICATE_CHANNEL: usize = 4;

/// Names of channels, by number.
const CHANNELS: [&str; 5] = ["r", "g", "b", "luminance", "predicate"];

/// Weights of red, green and blue in the luminance, of the primaries of sRGB (ITU-R BT.709).
pub(crate) const LUMINANCE: [f64; 3] = [0.2126, 0.7152, 0.0722];

/// The luminance of a linear colour.
pub fn luminance(colour: &[f64; 3]) -> f64 {
    let [r, g, b] = *colour;
    LUMINANCE[0] * r + LUMINANCE[1] * g + LUMINANCE[2] * b
}

/// Options of compilation, which may differ from the scene's.
#[derive(Clone, Copy, Debug)]
pub struct OracleOptions {
    /// The uncomputation strategy; the scene's `circuit.uncompute` unless set.
    pub strategy: Option<Strategy>,
    /// The passes that make the program cheaper.
    pub passes: Passes,
    /// The class of the pixels that the oracle is for. The default serves all pixels; the oracle of a
    /// class has the class's scale.
    pub class: PixelClass,
    /// The pixel (column, row) whose oracle is compiled alone: its position is a constant, and costs no
    /// qubits. Without a pixel, one program serves all pixels of the class, and a pixel's position is a
    /// parameter in registers.
    pub pixel: Option<[u32; 2]>,
}

impl OracleOptions {
    /// The uncomputation strategy of circuits of `scene`.
    ///
    /// # Errors
    /// As [`Oracle::new`]: `uncompute: auto` tries several.
    pub fn strategy(&self, scene: &ValidScene) -> Result<Strategy, OracleError> {
        match (self.strategy, self.pixel) {
            (Some(strategy), _) => Ok(strategy),
            (None, None) => Oracles::new(scene).strategy(),
            (None, Some(pixel)) => Oracles::new(scene).of_pixel(pixel).strategy(),
        }
    }

    /// The defaults, for pixels of this class.
    pub fn of_class(class: PixelClass) -> Self {
        Self {
            class,
            ..Self::default()
        }
    }

    /// The defaults, for the pixel (column, row) alone.
    pub fn of_pixel(scene: &ValidScene, pixel: [u32; 2]) -> Self {
        Self {
            class: PixelClasses::new(scene).class(pixel),
            pixel: Some(pixel),
            ..Self::default()
        }
    }
}

impl Default for OracleOptions {
    fn default() -> Self {
        Self {
            strategy: None,
            passes: Passes::ALL,
            class: PixelClass::default(),
            pixel: None,
        }
    }
}

/// The reason why a scene has no oracle.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum OracleError {
    /// The program cannot be built.
    Build(BuildError),
    /// The scene's sample sequence cannot be constructed.
    Sampling(SamplingError),
    /// The scene has more faces than a table holds whose address is a face's number.
    TooManyFaces {
        /// Number of faces of the scene.
        faces: usize,
    },
    /// A table of faces has no spheres.
    SphereInTable {
        /// The number of the sphere in the scene's list of primitives.
        primitive: usize,
    },
    /// A sphere's radius has too few bits.
    SmallSphere {
        /// The number of the sphere in the scene's list of primitives.
        primitive: usize,
        /// Number of fraction bits of the circuit's numbers.
        fraction: u32,
        /// Least number of fraction bits that the sphere needs.
        needed: u32,
    },
    /// The normal of a smooth face of a mesh changes over a width that has too few bits.
    ThinSmoothFace {
        /// The number of the mesh in the scene's list of primitives.
        primitive: usize,
        /// Number of fraction bits of the circuit's numbers.
        fraction: u32,
        /// Least number of fraction bits that the face needs.
        needed: u32,
    },
    /// The colours of a face of a mesh change over a width that has too few bits.
    ThinColouredFace {
        /// The number of the mesh in the scene's list of primitives.
        primitive: usize,
        /// Number of fraction bits of the circuit's numbers.
        fraction: u32,
        /// Least number of fraction bits that the face needs.
        needed: u32,
    },
    /// The cells of a checker have too few bits.
    SmallCell {
        /// The name of the material.
        material: String,
        /// The kind of the material, such as `lambertian`.
        kind: &'static str,
        /// The key of the colour in the material, such as `albedo`.
        key: &'static str,
        /// Number of fraction bits of the circuit's numbers.
        fraction: u32,
        /// Least number of fraction bits that the cells need.
        needed: u32,
    },
}

impl fmt::Display for OracleError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.problem().what.fmt(f)
    }
}

impl std::error::Error for OracleError {}

impl From<BuildError> for OracleError {
    fn from(error: BuildError) -> Self {
        Self::Build(error)
    }
}

impl From<SamplingError> for OracleError {
    fn from(error: SamplingError) -> Self {
        Self::Sampling(error)
    }
}

/// A channel's part of an oracle.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// 0 red, 1 green, 2 blue, [`LUMINANCE_CHANNEL`] their luminance, [`PREDICATE_CHANNEL`] paths
    /// on which a predicate holds.
    pub number: usize,
    /// The colour, in units of `scale 2^-fraction`.
    pub colour: Operand,
    /// Number of the comparator's thresholds that the colour exceeds, before it is clamped to `2^c`.
    pub count: Operand,
    /// The proven bound on a path's colour, in radiance.
    pub scale: f64,
}

/// A scene's oracle: see [the module](self).
#[derive(Clone, Debug)]
pub struct Oracle {
    /// The program that computes the colours.
    pub program: Program,
    /// The values of the program's parameters, as functions of the pixel.
    pub parameters: Vec<PixelWord>,
    /// The channels whose colours the program computes.
    pub channels: Vec<Channel>,
    /// The register of the path index.
    pub id: RegisterId,
    /// The register of the comparator.
    pub comparator: RegisterId,
    /// The register of the first ray's hit, if the hit is an input: see [`Oracle::given_primary_hit`].
    pub nearest: Option<RegisterId>,
    /// The register of the outcome of the comparison, whose phase is flipped.
    pub flag: RegisterId,
    /// Number of fraction bits of every number.
    pub fraction: u32,
    /// The paths of a pixel.
    pub points: PathPoints,
    /// Columns and rows of the film.
    pub film: [u32; 2],
    /// The only pixel (column, row) that the oracle is for; none if it is for all pixels of a class.
    pub pixel: Option<[u32; 2]>,
    /// The named values that are in registers after compute, by name and ray.
    pub places: Vec<NamedPlace>,
    /// Number of operations that the tracer requested, and number of these that reused an earlier one.
    pub sharing: [u64; 2],
}

impl Oracle {
    /// The oracle of one channel: 0 red, 1 green, 2 blue.
    ///
    /// # Errors
    /// The scene has numbers that no register can hold.
    pub fn new(
        scene: &ValidScene,
        channel: usize,
        options: OracleOptions,
    ) -> Result<Self, OracleError> {
        Self::compile(scene, [channel], options)
    }

    /// One program for all three channels, which share their paths. Machines run it for a picture; a
    /// channel's own oracle is a part of it.
    ///
    /// # Errors
    /// As [`Oracle::new`].
    pub fn rgb(scene: &ValidScene, options: OracleOptions) -> Result<Self, OracleError> {
        Self::compile(scene, [0, 1, 2], options)
    }

    /// The program of [`Oracle::rgb`] for paths whose primary hits are known. An input holds the number
    /// of the primary hit's face in the scene's [`NearestOracle`], or the number of faces for none. The
    /// rest of the path is traced as usual. A scene without faces has no such input.
    ///
    /// # Errors
    /// As [`Oracle::new`], and if there are more than [`MOST_FACES`] faces.
    pub fn given_primary_hit(scene: &ValidScene, class: PixelClass) -> Result<Self, OracleError> {
        let options = OracleOptions::of_class(class);
        let recording = Recording::new(scene, [0, 1, 2], options, PrimaryHit::Given)?;
        Ok(recording.oracle(&[0, 1, 2]))
    }

    /// The oracles of the three channels, and the oracle of all three together, from one recording. The
    /// oracle of a channel is as [`Oracle::new`] makes it, except for the numbers of its registers and
    /// [`Oracle::sharing`], which is that of all channels.
    ///
    /// # Errors
    /// As [`Oracle::new`].
    pub fn all(scene: &ValidScene) -> Result<([Self; 3], Self), OracleError> {
        let options = OracleOptions::default();
        let recording = Recording::new(scene, [0, 1, 2], options, PrimaryHit::Traced)?;
        let channels = [0, 1, 2].map(|channel| recording.oracle(&[channel]));
        Ok((channels, recording.oracle(&[0, 1, 2])))
    }

    /// The oracle of the luminance alone: see [`luminance`].
    ///
    /// # Errors
    /// As [`Oracle::new`].
    pub fn luminance(scene: &ValidScene, options: OracleOptions) -> Result<Self, OracleError> {
        Ok(Recording::with_luminance(scene, options)?.oracle(&[3]))
    }

    /// One program for all three channels and, after them, their luminance. A machine that runs it
    /// counts the luminance and reads the colours of the paths that it measures.
    ///
    /// # Errors
    /// As [`Oracle::new`].
    pub fn rgb_and_luminance(
        scene: &ValidScene,
        options: OracleOptions,
    ) -> Result<Self, OracleError> {
        Ok(Recording::with_luminance(scene, options)?.oracle(&[0, 1, 2, 3]))
    }

    fn compile<const C: usize>(
        scene: &ValidScene,
        channels: [usize; C],
        options: OracleOptions,
    ) -> Result<Self, OracleError> {
        let recording = Recording::new(scene, channels, options, PrimaryHit::Traced)?;
        Ok(recording.oracle(&std::array::from_fn::<_, C, _>(|place| place)))
    }

    /// The parameters of pixel (column, row).
    ///
    /// # Panics
    /// If the oracle is for another pixel alone.
    pub fn parameter_words(&self, seed: u64, pixel: [u32; 2]) -> Vec<u64> {
        assert!(
            self.pixel.is_none_or(|own| own == pixel),
            "an oracle of pixel {:?} alone cannot serve pixel {pixel:?}",
            self.pixel.unwrap_or_default()
        );
        let words = self.parameters.iter();
        words
            .map(|word| word.value(&self.points, seed, pixel))
            .collect()
    }

    /// Number of qubits that a call needs: the maximum in use at any time, for channel number 0.
    pub fn qubits(&self) -> u32 {
        lower::most_qubits(&self.upto_flip())
    }

    /// Compute, and then the comparison and the flip of channel number 0. Uncompute needs the same
    /// qubits as compute at each instruction, so it is not included.
    fn upto_flip(&self) -> Program {
        let (mut upto, flip) = self.with_flip(0);
        let compute = self.program.instructions.iter().copied();
        upto.instructions = compute.chain(flip).collect();
        upto
    }

    /// Number of qubits of the comparator.
    pub fn comparator_bits(&self) -> u32 {
        self.program.width(self.comparator)
    }

    /// The parts of the index, from its bit 0 upwards, by name and number of bits: the path's index and
    /// the comparator, as [`Export::new`](qrt_circuit::export::Export::new) takes them.
    pub fn index_parts(&self) -> [(&'static str, u32); 2] {
        [
            ("path", self.points.path_bits()),
            ("comparator", self.comparator_bits()),
        ]
    }

    /// Number of good basis states of a path whose register `count` reads as `count`. These are the
    /// comparators, of its `2^c`, that the colour exceeds.
    pub fn good(&self, count: i64) -> u64 {
        count.clamp(0, 1 << self.comparator_bits()).cast_unsigned()
    }

    /// Compares with the comparator, flips the phase, and undoes the comparison: the part between
    /// compute and uncompute of channel number `channel` of [`Oracle::channels`].
    pub fn flip(&self, channel: usize) -> Program {
        let (mut program, steps) = self.with_flip(channel);
        program.instructions = steps;
        program.inputs = self.program.outputs();
        program
    }

    /// The program without instructions, with the operations of the flip of channel number `channel`, and the
    /// instructions of the flip.
    fn with_flip(&self, channel: usize) -> (Program, Vec<Instruction>) {
        let own = &self.program;
        let steps = self.flip_steps(channel);
        let (block, flip) = steps.placed(own.ops.len(), own.blocks.len());
        let mut ops = Vec::with_capacity(own.ops.len() + steps.ops.len());
        ops.extend_from_slice(&own.ops);
        ops.extend(steps.ops);
        let mut blocks = own.blocks.clone();
        blocks.push(block);
        let program = Program {
            registers: own.registers.clone(),
            blocks,
            parameters: own.parameters.clone(),
            ops,
            instructions: Vec::new(),
            inputs: own.inputs.clone(),
        };
        (program, flip)
    }

    /// The operations of [`Oracle::flip`], and their order.
    fn flip_steps(&self, channel: usize) -> FlipSteps {
        self.flip_of(&self.channels[channel], self.comparator_bits())
    }

    /// The same for a channel that the program need not have, and a comparator of `bits` bits.
    fn flip_of(&self, channel: &Channel, bits: u32) -> FlipSteps {
        let count = channel.count;
        if let (0, Operand::Word(word)) = (bits, count)
            && word.bits() == 1
        {
            // Without a comparator, and with a count of one bit: flip the phase of that bit.
            let bit = Bit::at(word.register, word.offset);
            return FlipSteps {
                ops: vec![Op::Phase { bit }],
                order: &[(0, false)],
            };
        }
        let comparator = match bits {
            0 => Operand::Constant(0),
            bits => Operand::Word(Word::unsigned(self.comparator, 0, bits)),
        };
        let less = Op::Less {
            a: comparator,
            b: count,
            target: self.flag,
        };
        let bit = Bit::at(self.flag, 0);
        FlipSteps {
            ops: vec![less, Op::Phase { bit }],
            order: &[(0, false), (1, false), (0, true)],
        }
    }

    /// The whole oracle of channel number `channel` of [`Oracle::channels`]: compute, compare,
    /// flip, uncompute.
    pub fn whole(&self, channel: usize) -> Program {
        let (mut whole, flip) = self.with_flip(channel);
        whole.instructions.clone_from(&self.program.instructions);
        append_flip(&mut whole.instructions, &flip);
        whole
    }

    /// Calls `each` with [`Oracle::whole`] of channel number 0, and returns both. The registers and the operations
    /// of a large program take a gigabyte; until `each` returns there is one copy of them.
    pub(crate) fn with_whole<T>(&mut self, each: impl FnOnce(&Program) -> T) -> (Program, T) {
        let steps = self.flip_steps(0);
        let mut whole = std::mem::take(&mut self.program);
        let [ops, blocks, compute] = [
            whole.ops.len(),
            whole.blocks.len(),
            whole.instructions.len(),
        ];
        let (block, flip) = steps.placed(ops, blocks);
        whole.ops.reserve_exact(steps.ops.len());
        whole.ops.extend(steps.ops);
        whole.blocks.push(block);
        append_flip(&mut whole.instructions, &flip);
        let result = each(&whole);
        self.program = Program {
            registers: whole.registers.clone(),
            blocks: whole.blocks[..blocks].to_vec(),
            parameters: whole.parameters.clone(),
            ops: whole.ops[..ops].to_vec(),
            instructions: whole.instructions[..compute].to_vec(),
            inputs: whole.inputs.clone(),
        };
        (whole, result)
    }
}

/// Appends the flip and the inverse of compute to compute.
fn append_flip(compute: &mut Vec<Instruction>, flip: &[Instruction]) {
    let own = compute.len();
    compute.reserve_exact(own + flip.len());
    compute.extend_from_slice(flip);
    for place in (0..own).rev() {
        let instruction = compute[place];
        compute.push(Instruction {
            inverse: !instruction.inverse,
            ..instruction
        });
    }
}

struct FlipSteps {
    ops: Vec<Op>,
    /// Indices of the operations to run, in order, each with true if it is inverted.
    order: &'static [(u32, bool)],
}

impl FlipSteps {
    /// The block of the flip, and its instructions, after a program of `ops` operations and `blocks` blocks.
    fn placed(&self, ops: usize, blocks: usize) -> (Block, Vec<Instruction>) {
        let label = Label {
            stage: StageName::CompareAndFlip,
            depth: None,
        };
        let instruction = |&(step, inverse): &(u32, bool)| Instruction {
            op: ops as u32 + step,
            inverse,
            block: BlockId(blocks as u32),
        };
        let flip = self.order.iter().map(instruction).collect();
        (label.block(Some(BlockId::ROOT)), flip)
    }
}

/// One more than the greatest label of a face that a ray can meet.
fn faces<const C: usize>(stage: &Stage<C>) -> u32 {
    let geometry = stage.geometry();
    let labels = geometry.faces.iter().map(|face| face.label);
    let labels = labels.chain(geometry.balls.iter().map(|ball| ball.label));
    labels.max().map_or(0, |label| label + 1)
}

fn register_of(operand: Operand) -> Option<RegisterId> {
    match operand {
        Operand::Word(word) => Some(word.register),
        Operand::Constant(_) => None,
    }
}

impl Builder<'_> {
    /// The register of a colour, and the number of the `2^bits` thresholds that the colour exceeds.
    fn counted(&mut self, colour: RealValue, bits: u32, at: ComparatorAt) -> (Operand, Operand) {
        self.enter_count();
        let fraction = self.fraction_bits();
        let (operand, _) = self.operand_of(colour);
        // x > (y + s) 2^k is equivalent to floor((x + r) / 2^k) > y, with r = 2^k - 1 - s 2^k.
        let step = fraction.saturating_sub(bits);
        let rise = match at {
            ComparatorAt::Midpoints if step > 0 => (1_i64 << (step - 1)) - 1,
            ComparatorAt::Midpoints => 0,
            ComparatorAt::Edges => (1 << step) - 1,
        };
        if let Operand::Constant(value) = operand {
            // Scaling does not round a constant down, as it does a register.
            let count = (value + rise) >> step << bits.saturating_sub(fraction);
            self.leave();
            return (operand, Operand::Constant(count));
        }
        let rise = self.real(rise as f64 / (1_u64 << fraction) as f64);
        let raised = self.add(colour, rise);
        let raised = self.held(raised);
        let exponent = f64::from(bits) - f64::from(fraction);
        let count = self.scale(raised, exponent.exp2());
        let (count, _) = self.operand_of(count);
        self.leave();
        (operand, count)
    }
}
