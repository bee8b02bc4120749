//! Counts the whole comparator, until the outcomes show a better way.
//!
//! Each shot measures an index, and the colour of its path shows how colours are spread. From the
//! colours follow, roughly, the errors that other ways would have:
//!
//! * the mean phase ([`super::mean`]): considered after the first paths, which are then drawn at
//!   random, and again once enough indices are measured;
//! * strata ([`strata`]): considered at the same times. After the first paths, they only keep the run from the mean
//!   phase where they are clearly better.
//!
//! If a way is expected to be better than counting the whole by a margin ([`choice::Outlook::choose`]), the run takes it. If
//! not, it goes on counting the whole, and no shot is lost.

mod choice;
mod strata;
#[cfg(test)]
mod tests;

use super::Goal;
use super::mean::{self, Pilot, Start};
use super::run::{Depths, Run};
use super::support::Prior;
use crate::estimators::{Device, Estimate, EstimatorError, Settings};
use choice::{Outlook, Way};

/// The ways to count that a run may take beside counting the whole.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Allowed {
    /// Number of strata to count on their own. With `None`, the run chooses the number.
    strata: Option<u32>,
    /// True if the run may go on with the mean-phase circuit.
    pub(super) mean_phase: bool,
}

impl Allowed {
    /// The ways of an estimator that only counts.
    pub(super) fn from_settings(settings: &Settings) -> Self {
        Self {
            strata: settings.strata,
            mean_phase: false,
        }
    }
}

/// Runs once, in the requested way, or in the one that seems best.
pub(super) fn estimate(
    goal: &Goal,
    depths: Depths,
    device: &mut Device<'_>,
) -> Result<Estimate, EstimatorError> {
    let start = device.usage();
    let bits = device.comparator_bits();
    if let (Some(bits), Some(strata @ 2..)) = (bits, goal.allowed.strata) {
        return strata::estimate(goal, depths, device, start, bits, strata);
    }
    let by_strata = goal.allowed.strata.is_none();
    let mut whole = Run::new(goal, depths, device.total(), Prior::Even);
    let mut left = goal.queries;
    let mut pilot = None;
    if goal.allowed.mean_phase && mean::is_open(goal, device) {
        let drawn = pilot.insert(Pilot::new(device)?);
        while let Some(paths) = drawn.next(goal.queries) {
            let paths = paths.min(left);
            left -= whole.sample(device, paths)?;
            drawn.paths += paths;
            if favours_mean_phase(goal, device, drawn, (bits.filter(|_| by_strata), left)) {
                let known = drawn.draw(goal, device, &mut left);
                return mean::estimate(goal, device, start, known, left);
            }
        }
    }
    let mut undecided = bits.filter(|_| by_strata || pilot.is_some());
    while left > 0 && !goal.is_reached(&whole.posterior) {
        left -= whole.step(device, left)?;
        if undecided.is_some() && choice::is_late(goal.queries, left) {
            undecided = None;
        }
        let Some(bits) = undecided.filter(|_| choice::is_due(device, goal.queries, left)) else {
            continue;
        };
        if goal.is_reached(&whole.posterior) {
            break;
        }
        let amplitude = whole.posterior.mean_amplitude();
        let known = pilot
            .as_ref()
            .and_then(|pilot| pilot.after_counting(device, &whole.posterior));
        let by_mean_phase = known.as_ref().map_or(f64::INFINITY, |known| {
            known.variance_after(left as f64, mean::read_rightly(goal, device))
        });
        let queries = (goal.queries, left);
        let outlook = Outlook::new(device, bits, amplitude);
        match outlook.choose(by_strata, queries, by_mean_phase) {
            Way::Whole => undecided = None,
            Way::Strata(strata) => {
                return strata::estimate(goal, depths, device, start, bits, strata);
            }
            Way::MeanPhase => {
                if let Some(known) = known.filter(Start::is_narrow) {
                    return mean::estimate(goal, device, start, known, left);
                }
            }
        }
    }
    Ok(whole.posterior.sharpened().estimate(device, start, goal))
}

/// True if the paths that the run has drawn at random favour the mean phase over the whole comparator, and over
/// strata if the run may choose them: `bits` is then the comparator's.
fn favours_mean_phase(
    goal: &Goal,
    device: &Device<'_>,
    drawn: &Pilot,
    (bits, left): (Option<u32>, u64),
) -> bool {
    let known = drawn.random(device);
    let is_better = |bits| {
        let variance = known.variance_after(left as f64, mean::read_rightly(goal, device));
        Outlook::of_random(&drawn.random_levels(device), bits).allows_mean_phase(left, variance)
    };
    known.favours_mean_phase(choice::WORTH) && bits.is_none_or(is_better)
}
