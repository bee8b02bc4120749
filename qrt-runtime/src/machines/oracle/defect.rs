//! What shows that a circuit is not the oracle that it must be.

use crate::machines::gates::{Dirty, InvalidGate};
use qrt_circuit::Qubit;
use std::fmt;

/// A circuit that does not do what an oracle must: a defect of qrt, found while it ran.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Defect {
    /// The list of gates is not a circuit.
    Gate(InvalidGate),
    /// A qubit that was not returned to zero.
    Dirty {
        /// Which, and in which lane.
        dirty: Dirty,
        /// Column and row of the path's pixel.
        pixel: [u32; 2],
        /// The path.
        id: u64,
        /// What the qubit was last used for.
        register: String,
    },
    /// A path whose id was changed, or what else it is given by.
    Id {
        /// Column and row of the path's pixel.
        pixel: [u32; 2],
        /// The path.
        id: u64,
    },
    /// Paths whose first hits are inputs of the oracle, with nothing that finds them.
    FirstHits,
    /// A sign that was turned, or not, against the comparison.
    Flip {
        /// 0 red, 1 green, 2 blue, 3 luminance.
        channel: usize,
        /// The thresholds that the colour exceeds.
        count: i64,
        /// The comparator.
        comparator: u64,
    },
    /// A comparison that changes what it compares.
    Compared {
        /// 0 red, 1 green, 2 blue, 3 luminance.
        channel: usize,
        /// The thresholds that the colour exceeds.
        count: i64,
        /// The comparator.
        comparator: u64,
    },
    /// A comparison that touches a qubit which holds something else.
    Foreign {
        /// 0 red, 1 green, 2 blue, 3 luminance.
        channel: usize,
        /// The qubit.
        qubit: Qubit,
        /// What it holds.
        register: String,
    },
}

impl fmt::Display for Defect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Gate(gate) => gate.fmt(f),
            Self::Dirty {
                dirty,
                pixel: [x, y],
                id,
                register,
            } => write!(
                f,
                "qubit {} (`{register}`) is not returned to zero on path {id} of pixel ({x}, {y})",
                dirty.qubit
            ),
            Self::Id { pixel: [x, y], id } => {
                write!(f, "an input of path {id} of pixel ({x}, {y}) is changed")
            }
            Self::FirstHits => f.write_str(
                "the paths' first hits are inputs of the oracle, and nothing finds them",
            ),
            Self::Flip {
                channel,
                count,
                comparator,
            } => write!(
                f,
                "channel {channel}: the phase of comparator {comparator} is wrong for a colour \
                 above {count} thresholds"
            ),
            Self::Compared {
                channel,
                count,
                comparator,
            } => write!(
                f,
                "channel {channel}: comparing comparator {comparator} with a colour above {count} \
                 thresholds changes one of them"
            ),
            Self::Foreign {
                channel,
                qubit,
                register,
            } => write!(
                f,
                "channel {channel}: the comparison touches qubit {qubit}, which holds `{register}`"
            ),
        }
    }
}

impl std::error::Error for Defect {}

impl From<InvalidGate> for Defect {
    fn from(gate: InvalidGate) -> Self {
        Self::Gate(gate)
    }
}
