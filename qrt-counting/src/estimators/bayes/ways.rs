//! Counts the whole comparator, until the outcomes show a better way.
//!
//! Each shot measures an index, and the colour of its path shows how colours are spread. From the
//! colours follow, roughly, the errors that other ways would have:
//!
//! * the mean phase ([`super::mean`]): considered after the first paths, which are then drawn at
//!   random;
//! * strata ([`super::strata`]): considered once enough indices are measured.
//!
//! If a way is better by [`choice::WORTH`] with the remaining queries, the run takes it. If not, it
//! goes on counting the whole, and no shot is lost.

use super::mean::{self, Pilot};
use super::run::{Depths, Run};
use super::support::Prior;
use super::{Goal, choice, strata};
use crate::estimators::{Device, Estimate, EstimatorError};

/// Runs once, in the requested way, or in the one that seems best.
pub(super) fn estimate(
    goal: &Goal,
    depths: Depths,
    device: &mut Device<'_>,
) -> Result<Estimate, EstimatorError> {
    let start = device.usage();
    let bits = device.comparator_bits();
    if let (Some(bits), Some(strata @ 2..)) = (bits, goal.strata) {
        return strata::estimate(goal, depths, device, start, bits, strata);
    }
    let mut whole = Run::new(goal, depths, device.total(), Prior::Even);
    let mut left = goal.queries;
    if goal.mean_phase && mean::is_open(goal, device) {
        let mut pilot = Pilot::new(device)?;
        while let Some(paths) = pilot.next(goal.queries) {
            let paths = paths.min(left);
            left -= whole.sample(device, paths)?;
            pilot.paths += paths;
            if pilot.favours(device, choice::WORTH) {
                return mean::estimate(goal, device, start, &pilot, left);
            }
        }
    }
    let mut undecided = bits.filter(|_| goal.strata.is_none());
    while left > 0 && !goal.is_reached(&whole.posterior) {
        left -= whole.step(device, left)?;
        let Some(bits) = undecided else {
            continue;
        };
        let amplitude = || whole.posterior.mean_amplitude();
        if let Some(strata) = choice::decided(device, bits, amplitude, goal.queries, left) {
            undecided = None;
            if strata > 1 {
                return strata::estimate(goal, depths, device, start, bits, strata);
            }
        }
    }
    Ok(whole.posterior.sharpened().estimate(device, start, goal))
}
