//! The interface of the machines that trace the paths of a scene's pixels.

use super::real::{RUN, UNDIVIDED};
use super::{Defect, Finished, OracleMachine, PathBlock, Real};
use std::ops::Range;
use std::sync::atomic::AtomicBool;

/// The cost of one query of an oracle: compute, compare or mark, flip, uncompute.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct QueryCost {
    /// Toffoli gates.
    pub toffoli: u64,
    /// The largest number of qubits in use at any time.
    pub qubits: u32,
}

/// A machine that traces the paths of a scene's pixels, for the pixels of one class.
///
/// Pictures, counts, plans and tables are computed from any machine in the same way: the options of
/// [`crate::models::MachineOptions`] are decided when the machine is made
/// ([`crate::models::path_machines`]).
pub trait PathMachine: Send + Sync {
    /// R, the number of paths of a pixel.
    fn paths(&self) -> u64;

    /// The proven bound on a path's colour in channel number `channel`, in radiance; 0 for a channel
    /// that the machine does not have.
    fn bound(&self, channel: usize) -> f64;

    /// The largest colour of a path in a channel that rounding can explain, in radiance.
    fn limit(&self, channel: usize) -> f64 {
        self.bound(channel)
    }

    /// Fraction bits of the machine's numbers; `None` for floating point.
    fn fraction(&self) -> Option<u32>;

    /// The cost of a query of the oracle of the machine's first channel; `None` without a circuit.
    fn query_cost(&self) -> Option<QueryCost>;

    /// Number of paths to trace between two checks for cancellation.
    fn run_length(&self) -> u64;

    /// The largest number of paths of a pixel that one thread traces. Of pixels with more paths, each
    /// is divided among all threads.
    fn most_undivided(&self) -> u64;

    /// Traces the paths `ids` of every pixel (column, row), and passes the results to `finished` in
    /// the order of pixels and path indices. Stops when any thread sets `cancel`.
    ///
    /// # Errors
    /// The first defect found; [`Defect::Cancelled`].
    fn trace_paths(
        &self,
        cancel: Option<&AtomicBool>,
        pixels: &[[u32; 2]],
        ids: Range<u64>,
        finished: &mut dyn FnMut(Traced<'_>),
    ) -> Result<(), Defect>;

    /// The proven bounds on a path's red, green and blue.
    fn bounds(&self) -> [f64; 3] {
        [0, 1, 2].map(|channel| self.bound(channel))
    }
}

impl PathMachine for Real {
    fn paths(&self) -> u64 {
        self.points.paths()
    }

    fn bound(&self, channel: usize) -> f64 {
        self.stage.bound().get(channel).copied().unwrap_or(0.0)
    }

    fn limit(&self, channel: usize) -> f64 {
        self.stage.limit().get(channel).copied().unwrap_or(0.0)
    }

    fn fraction(&self) -> Option<u32> {
        None
    }

    fn query_cost(&self) -> Option<QueryCost> {
        None
    }

    fn run_length(&self) -> u64 {
        RUN
    }

    fn most_undivided(&self) -> u64 {
        UNDIVIDED
    }

    /// Ignores `cancel`: a run of paths takes a fraction of a second.
    fn trace_paths(
        &self,
        _cancel: Option<&AtomicBool>,
        pixels: &[[u32; 2]],
        ids: Range<u64>,
        finished: &mut dyn FnMut(Traced<'_>),
    ) -> Result<(), Defect> {
        self.trace_range(pixels, ids, |block| finished(Traced::Colours(block)));
        Ok(())
    }
}

impl PathMachine for OracleMachine {
    fn paths(&self) -> u64 {
        1 << self.oracle.points.path_bits()
    }

    fn bound(&self, channel: usize) -> f64 {
        let mut channels = self.oracle.channels.iter();
        let found = channels.find(|found| found.number == channel);
        found.map_or(0.0, |channel| channel.scale)
    }

    fn fraction(&self) -> Option<u32> {
        Some(self.oracle.fraction)
    }

    fn query_cost(&self) -> Option<QueryCost> {
        let (cost, qubits) = self.oracle.cost(0);
        Some(QueryCost {
            toffoli: cost.toffoli,
            qubits,
        })
    }

    fn run_length(&self) -> u64 {
        self.paths_at_once()
    }

    fn most_undivided(&self) -> u64 {
        self.paths_at_once()
    }

    fn trace_paths(
        &self,
        cancel: Option<&AtomicBool>,
        pixels: &[[u32; 2]],
        ids: Range<u64>,
        finished: &mut dyn FnMut(Traced<'_>),
    ) -> Result<(), Defect> {
        self.trace_until(cancel, pixels, ids, |paths| finished(Traced::Counts(paths)))
    }
}

/// Finished paths of one pixel, as their machine reports them.
#[derive(Clone, Copy)]
pub enum Traced<'a> {
    /// Colours, in radiance: of the tracer in floating point.
    Colours(PathBlock<'a>),
    /// Numbers of thresholds that colours exceed: of an oracle.
    Counts(Finished<'a>),
}

impl Traced<'_> {
    /// Position of the pixel in the caller's list.
    pub fn pixel(&self) -> usize {
        match self {
            Self::Colours(block) => block.pixel,
            Self::Counts(finished) => finished.pixel,
        }
    }

    /// Number of marked paths, of a machine that reports marks; `None` if a number of a path does not
    /// fit into its register.
    pub fn marked(&self) -> Option<u64> {
        match self {
            Self::Colours(block) => {
                let marked = block.colours[0].iter().sum::<f64>();
                (!marked.is_nan()).then_some(marked as u64)
            }
            Self::Counts(finished) => Some(finished.good[0].iter().sum::<i64>().cast_unsigned()),
        }
    }

    /// Calls `path` with the position of each path and its colour in radiance. A circuit's machine
    /// has colours only if it was made with them.
    pub fn each_colour(&self, machine: &dyn PathMachine, mut path: impl FnMut(usize, [f64; 3])) {
        match self {
            Self::Colours(PathBlock { colours, .. }) => {
                let [r, g, b] = colours;
                for (place, ((&r, &g), &b)) in r.iter().zip(*g).zip(*b).enumerate() {
                    path(place, [r, g, b]);
                }
            }
            Self::Counts(Finished { colours, .. }) => {
                let unit = 1.0 / (1_u64 << machine.fraction().unwrap_or(0)) as f64;
                let bounds = machine.bounds();
                let [r, g, b] = colours;
                for (place, ((&r, &g), &b)) in r.iter().zip(*g).zip(*b).enumerate() {
                    let parts = [r, g, b];
                    path(
                        place,
                        [0, 1, 2].map(|c| bounds[c] * (parts[c] as f64 * unit)),
                    );
                }
            }
        }
    }
}
