//! Defects, which show that a circuit is not the oracle that it must be.

use qrt_circuit::Qubit;
use qrt_machines::{Dirty, InvalidGate};

/// Reason for which a run of an oracle ended early. Except for [`Defect::Cancelled`] and
/// [`Defect::PrimaryHits`], it is a circuit that does not do what it must, which is a defect of
/// qrt.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum Defect {
    /// The list of gates is not a circuit.
    #[error(transparent)]
    Gate(#[from] InvalidGate),
    /// A qubit that was not returned to zero.
    #[error(
        "qubit {} (`{register}`) is not returned to zero on path {id} of pixel ({}, {})",
        .dirty.qubit, .pixel[0], .pixel[1]
    )]
    Dirty {
        /// The qubit, and the lane in which it is not zero.
        dirty: Dirty,
        /// Column and row of the path's pixel.
        pixel: [u32; 2],
        /// The path's index.
        id: u64,
        /// The register that the qubit belongs to after compute, or `an ancilla`.
        register: String,
    },
    /// A path whose index, or another input of the oracle, was changed.
    #[error("an input of path {id} of pixel ({}, {}) is changed", .pixel[0], .pixel[1])]
    Id {
        /// Column and row of the path's pixel.
        pixel: [u32; 2],
        /// The path's index.
        id: u64,
    },
    /// A path whose colour exceeds its bound by more than rounding. Counting would cut the colour
    /// to the bound, and the picture would be too dark.
    #[error(
        "path {id} of pixel ({}, {}) exceeds {count} thresholds in {}, of {most} that its bound has",
        .pixel[0], .pixel[1], channel_name(*.channel)
    )]
    OutOfBounds {
        /// Column and row of the path's pixel.
        pixel: [u32; 2],
        /// The path's index.
        id: u64,
        /// 0 red, 1 green, 2 blue, 3 luminance, 4 a predicate.
        channel: usize,
        /// The thresholds that the colour exceeds; below 0 for a negative colour.
        count: i64,
        /// The number of thresholds up to the bound: `2^c`.
        most: i64,
    },
    /// The caller cancelled the run.
    #[error("the run was cancelled")]
    Cancelled,
    /// The oracle has primary hits as inputs, and the machine has no search for them.
    #[error("the paths' primary hits are inputs of the oracle, and nothing finds them")]
    PrimaryHits,
    /// A phase that is flipped, or not flipped, contrary to the comparison.
    #[error(
        "channel {channel}: the phase of comparator {comparator} is wrong for a colour above \
         {count} thresholds"
    )]
    Flip {
        /// 0 red, 1 green, 2 blue, 3 luminance.
        channel: usize,
        /// The thresholds that the colour exceeds.
        count: i64,
        /// The comparator y, in `0..2^c`.
        comparator: u64,
    },
    /// A comparison that changes its colour or its comparator.
    #[error(
        "channel {channel}: comparing comparator {comparator} with a colour above {count} \
         thresholds changes one of them"
    )]
    Compared {
        /// 0 red, 1 green, 2 blue, 3 luminance.
        channel: usize,
        /// The thresholds that the colour exceeds.
        count: i64,
        /// The comparator y, in `0..2^c`.
        comparator: u64,
    },
    /// A comparison that touches a qubit which holds something else.
    #[error("channel {channel}: the comparison touches qubit {qubit}, which holds `{register}`")]
    Foreign {
        /// 0 red, 1 green, 2 blue, 3 luminance.
        channel: usize,
        /// The number of the qubit that is touched.
        qubit: Qubit,
        /// The name of the register that the qubit belongs to.
        register: String,
    },
}

/// The name of a channel of an oracle.
fn channel_name(channel: usize) -> &'static str {
    let names = ["red", "green", "blue", "luminance", "the predicate"];
    names.get(channel).copied().unwrap_or("?")
}
