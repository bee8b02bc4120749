//! Reasons why the work on pixels ends early.

use super::RenderError;
use crate::path_machines::{Defect, PathMachine};
use crate::workers::Workers;

/// The reason why the work on a pixel or a tile ended early.
pub(super) enum Stop {
    Cancelled,
    Failed(RenderError),
}

impl<E: Into<RenderError>> From<E> for Stop {
    fn from(error: E) -> Self {
        Self::Failed(error.into())
    }
}

/// Checks that the work is not cancelled.
pub(super) fn go_on(workers: &Workers<'_>) -> Result<(), Stop> {
    if workers.cancelled() {
        return Err(Stop::Cancelled);
    }
    Ok(())
}

/// Converts a defect into the reason why a run of paths of this machine ended early.
pub(super) fn ended(machine: &dyn PathMachine, defect: Defect) -> Stop {
    match defect {
        Defect::Cancelled => Stop::Cancelled,
        Defect::OutOfBounds {
            pixel,
            id,
            channel,
            count,
            most,
        } => {
            let bound = machine.bound(channel);
            Stop::Failed(RenderError::OutOfBounds {
                pixel,
                id,
                channel,
                colour: bound * (count as f64 / most as f64),
                bound,
                fraction: machine.fraction(),
            })
        }
        defect => defect.into(),
    }
}
