//! The machine that traces the paths of pixels.

use crate::path_machines::{OracleMachine, Real};

/// Number of paths that are traced in floating point between two checks for cancellation.
pub(super) const RUN: u64 = 1 << 16;

/// The machine that traces the paths.
pub(super) enum Source {
    /// A machine that returns colours, in radiance.
    Real(Box<Real>),
    /// A machine that returns counts of thresholds that colours exceed.
    Oracle(OracleMachine),
}

impl Source {
    /// Returns the proven bound on a path's colour in each channel, in radiance.
    pub(super) fn bound(&self) -> [f64; 3] {
        match self {
            Self::Real(real) => real.stage().bound(),
            Self::Oracle(machine) => {
                let channels = &machine.oracle().channels;
                let scale = |c: usize| channels.get(c).map_or(0.0, |channel| channel.scale);
                [scale(0), scale(1), scale(2)]
            }
        }
    }

    /// Number of paths between two checks for cancellation.
    pub(super) fn run_length(&self) -> u64 {
        match self {
            Self::Real(_) => RUN,
            Self::Oracle(machine) => machine.paths_at_once(),
        }
    }
}
