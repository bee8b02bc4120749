//! The fixed machine: a program, operation by operation, on integers.
//!
//! It computes what [`qrt_circuit::Contents`] defines, for a block of states at a time: each
//! operation is a loop over lanes of the narrowest integers that hold its operands and results. The
//! machine undoes nothing: it computes each value once, and reuses the value's lanes after its last
//! use.

mod arith;
mod block;
mod compile;
mod compute;
mod fuse;
mod in_place;
mod lane;
mod ops;
mod product;
mod quotient;
mod reference;
mod seen;
mod slots;
mod steps;
mod table;
#[cfg(test)]
pub(crate) mod tests;

pub use reference::{Extremes, contents_by_definition};

use super::instructions::InstructionSet;
use super::span::PixelLanes;
use block::Block;
use compile::Compiler;
use lane::{Kind, LANES, Slots, Spares};
use pulp::{Simd, WithSimd};
use qrt_circuit::{Program, Word};
use rayon::prelude::*;
use slots::Counts;
use steps::Step;

/// Number of the lowest bits, of a register of `width` bits, that a block's consecutive path
/// indices run through.
fn pattern_bits(width: u32) -> u32 {
    width.min(LANES.ilog2())
}

/// A program, ready to be run on blocks of states.
#[derive(Clone, Debug)]
pub struct FixedMachine {
    steps: Vec<Step>,
    counts: Counts,
    /// By input: its width.
    inputs: Vec<u32>,
    outputs: Vec<(Kind, u32)>,
    /// True if the last of `outputs` is the sign.
    sign: bool,
    instructions: InstructionSet,
}

/// Memory that a thread needs to run a [`FixedMachine`]: the lanes of its values.
#[derive(Clone, Debug)]
pub struct FixedLanes {
    slots: Slots,
    spares: Spares,
}

impl FixedMachine {
    /// Number of lanes of a block: the most states that [`FixedMachine::run`] takes.
    pub const LANES: usize = LANES;

    /// Creates a machine that computes `outputs`, which are numbers read from the program's
    /// registers. It reads them after the last instruction that computes something; it leaves out
    /// later instructions that only undo.
    ///
    /// # Panics
    /// If the program names a register, an operation or a parameter that it doesn't have.
    pub fn new(program: &Program, outputs: &[Word]) -> Self {
        let mut compiler = Compiler::new(program);
        let mut kept = compiler.outputs(outputs);
        let sign = compiler.sign;
        kept.extend(sign.map(|sign| (Kind::Truth, sign)));
        let values = compiler.value();
        let steps = slots::needed(compiler.steps, values, &kept);
        let mut steps = fuse::fused(steps, values, &kept);
        let counts = slots::assign(&mut steps, values, &mut kept);
        let widths = program.inputs.iter().map(|input| program.width(*input));
        Self {
            steps,
            counts,
            inputs: widths.collect(),
            outputs: kept,
            sign: sign.is_some(),
            instructions: InstructionSet::widest(),
        }
    }

    /// Sets the instruction set.
    pub fn with_instructions(mut self, instructions: InstructionSet) -> Self {
        self.instructions = instructions;
        self
    }

    /// Number of steps of a block.
    pub fn steps(&self) -> usize {
        self.steps.len()
    }

    /// Creates the lanes in which a thread runs the machine.
    pub fn lanes(&self) -> FixedLanes {
        FixedLanes {
            slots: self.counts.slots(),
            spares: Spares {
                truth: Default::default(),
                short: Box::default(),
                int: Box::default(),
                long: Box::default(),
            },
        }
    }

    /// Runs the program on a block of states.
    ///
    /// `inputs` are the contents of the program's input registers, one per lane, and `spans` are
    /// the pixels that the lanes belong to. `outputs[k][lane]` becomes the k-th of the machine's
    /// outputs. The machine is fastest for consecutive path indices that start at a multiple of
    /// [`FixedMachine::LANES`], or of their number if this is less.
    ///
    /// # Panics
    /// If there are more than [`FixedMachine::LANES`] lanes, or `lanes` are of another machine.
    pub fn run(
        &self,
        lanes: &mut FixedLanes,
        inputs: &[&[u64]],
        spans: &[PixelLanes<'_>],
        outputs: &mut [&mut [i64]],
    ) {
        self.execute(lanes, inputs, spans);
        for (output, (kind, place)) in outputs.iter_mut().zip(&self.outputs) {
            lanes.read(*kind, *place, output);
        }
    }

    /// Calls `block` for each of `0..blocks`, on all threads, with lanes that no other thread uses.
    /// Results are in the order of blocks.
    pub fn blocks<T: Send>(
        &self,
        blocks: usize,
        block: impl Fn(&mut FixedLanes, usize) -> T + Sync,
    ) -> Vec<T> {
        let numbers = (0..blocks).into_par_iter();
        numbers
            .map_init(|| self.lanes(), |lanes, number| block(lanes, number))
            .collect()
    }

    /// Runs the program as [`FixedMachine::run`] does, and sets `signs` in the lanes whose phase is
    /// flipped.
    ///
    /// # Panics
    /// As [`FixedMachine::run`].
    pub fn signs(
        &self,
        lanes: &mut FixedLanes,
        inputs: &[&[u64]],
        spans: &[PixelLanes<'_>],
        signs: &mut [bool],
    ) {
        let sign = self.outputs.last().filter(|_| self.sign);
        self.execute(lanes, inputs, spans);
        signs.fill(false);
        if let Some((_, place)) = sign {
            let truths = &lanes.slots.truths[*place as usize].0;
            for (sign, truth) in signs.iter_mut().zip(truths) {
                *sign = *truth != 0;
            }
        }
    }

    fn execute(&self, lanes: &mut FixedLanes, inputs: &[&[u64]], spans: &[PixelLanes<'_>]) {
        let runs = self.inputs.iter().zip(inputs);
        let runs = runs.map(|(width, contents)| run_of(contents, *width));
        let block = Block {
            inputs,
            spans,
            runs: runs.collect(),
        };
        self.instructions.dispatch(Run {
            steps: &self.steps,
            lanes,
            block: &block,
        });
    }
}

/// The `first` for which lane l holds `first ^ (l mod 2^k)`, if there is one.
fn run_of(contents: &[u64], width: u32) -> Option<u64> {
    let first = *contents.first()?;
    let mask = (1 << pattern_bits(width)) - 1;
    let lanes = contents.iter().enumerate();
    let differ = lanes.fold(0, |any, (lane, content)| {
        any | (content ^ first ^ (lane as u64 & mask))
    });
    (differ == 0).then_some(first)
}

impl FixedLanes {
    fn read(&self, kind: Kind, place: u32, out: &mut [i64]) {
        let place = place as usize;
        match kind {
            Kind::Truth => widen(&self.slots.truths[place].0, out),
            Kind::Short => widen(&self.slots.shorts[place].0, out),
            Kind::Int => widen(&self.slots.ints[place].0, out),
            Kind::Long => widen(&self.slots.longs[place].0, out),
        }
    }
}

fn widen<K: Copy + Into<i64>>(lanes: &[K; LANES], out: &mut [i64]) {
    let lanes = &lanes[..out.len()];
    for (out, lane) in out.iter_mut().zip(lanes) {
        *out = (*lane).into();
    }
}

struct Run<'a> {
    steps: &'a [Step],
    lanes: &'a mut FixedLanes,
    block: &'a Block<'a>,
}

impl WithSimd for Run<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let FixedLanes { slots, spares } = self.lanes;
        for step in self.steps {
            step.run(slots, spares, self.block);
        }
    }
}
