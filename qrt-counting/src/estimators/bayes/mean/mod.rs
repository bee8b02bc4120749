//! Estimates a pixel's mean by the mean-phase circuit.
//!
//! Counting good indices has an error of about `2.2 sqrt(a (1 - a))` over the queries: it pays for the
//! *scale* of the colours. The phase of the mean-phase circuit is proportional to the mean itself, in units of
//! the colours' standard deviation sigma ([`Device::mean_phase`]). With the slope
//! `alpha = eta/sigma` it turns by `2 eta/((1 + eta^2) sigma)` a query and unit of the mean, and the
//! error is about `3.4 sigma` over the queries.
//!
//! A run begins with paths drawn at random, or with those of a run that has counted: they show
//! colours and roughly their mean. Then each shot
//!
//! * takes the mean so far as its reference, where the phase is 0, whatever the colours are;
//! * takes sigma, and with it slope and phase a unit of the mean, from all colours measured so far:
//!   see [`Colours`];
//! * takes the depth and the measured angle that are expected to sharpen the posterior of the mean
//!   most per query: see [`Grid::choose`].
//!
//! The colours have a mean of their own. If the posterior's is far from it, the posterior may be at a
//! wrong mode, and begins anew.
//!
//! Kothari & O'Donnell, *Mean estimation when you have the source code* (2022), showed that an error
//! in proportion to sigma over the queries is possible. The choice of slope and reference before every shot, from the
//! colours of the measured paths, is this crate's own.

mod colours;
mod grid;

use super::posterior::Posterior;
use super::{FAR, Goal, depth};
use crate::estimators::device::Usage;
use crate::estimators::normal::normal_quantile;
use crate::estimators::{Device, Estimate, EstimatorError, id_bits};
use colours::Colours;
use grid::Grid;
use qrt_circuit::quantum::{LevelPhases, MAX_LEVEL_BITS};

/// Queries times the standard deviation of a mean, over sigma; measured.
const ERROR: f64 = 3.4;
/// The smallest number of measured paths from whose colours their spread is taken.
const FEWEST: u64 = 12;
/// The smallest numbers of queries of a run that decides once, and of one that decides twice.
const ONCE: u64 = 60;
const TWICE: u64 = 240;
/// The most queries of a shot.
const DEEPEST: u64 = (1 << 40) - 1;
/// Bits of a phase beyond those of the depth: the phases of a shot are off by at most
/// `2 pi 2^-FINER` in all.
const FINER: u32 = 12;
/// The fraction of queries that draw paths at random.
const PILOT: f64 = 0.02;
/// The most such paths of a run that is asked for an error.
const ASKED: u64 = 48;
/// The most queries of a run, over the depth that noise leaves intact: the likelihood has one eigenphase,
/// and what it leaves out would outweigh the outcomes of more shots of one depth.
const SHOTS: f64 = 64.0;
/// Distance of the posterior's mean from that of the measured colours, in standard errors, at which the posterior is
/// at a wrong mode.
const ELSEWHERE: f64 = 6.0;
/// The factor by which the mean of these may be less certain than it seems.
const DOUBT: f64 = 1.3;
/// The largest standard deviation of a mean that counting has found, over the colours' standard deviation.
const NEAR: f64 = 0.4;
/// The smallest standard deviation at which a run goes on.
const KNOWN: f64 = 1e-13;
/// The smallest probability of a right reading with which the circuit is run.
const READ: f64 = 0.1;
/// A shot whose signal is smaller tells nothing.
const BLIND: f64 = 1e-6;
/// The part of a signal that the model explains.
const EXPLAINED: f64 = 0.95;

/// True if the device runs the mean-phase circuit, and its noise leaves shots that are deep enough for
/// these queries and often read rightly.
///
/// Otherwise the number of shots would grow with the queries. Counting makes such shots together.
pub(super) fn is_open(goal: &Goal, device: &Device<'_>) -> bool {
    let deep = goal.queries as f64 <= SHOTS * depth::useful(&goal.noise);
    check(device).is_ok() && deep && read_rightly(goal, device) > READ
}

/// The probability that the path index and the sign are read rightly.
pub(super) fn read_rightly(goal: &Goal, device: &Device<'_>) -> f64 {
    let bits = device.level_bits().unwrap_or_default();
    goal.noise.read_rightly(id_bits(device.total() >> bits) + 1)
}

/// Checks that the device runs the mean-phase circuit.
pub(super) fn check(device: &Device<'_>) -> Result<u32, EstimatorError> {
    let bits = device.level_bits().ok_or(EstimatorError::NoLevels)?;
    if bits > MAX_LEVEL_BITS {
        return Err(EstimatorError::LevelBits(bits));
    }
    Ok(bits)
}

/// The paths that a run has measured, first random ones and then those of counting circuits.
pub(super) struct Pilot {
    /// Good indices and others that had been measured before, by level.
    before: Vec<[u64; 2]>,
    bits: u32,
    /// Number of paths drawn at random.
    pub(super) paths: u64,
}

impl Pilot {
    /// A pilot without paths.
    pub(super) fn new(device: &Device<'_>) -> Result<Self, EstimatorError> {
        Ok(Self {
            bits: check(device)?,
            before: device.measured_levels().map(|(_, found)| found).collect(),
            paths: 0,
        })
    }

    /// Number of paths to draw next in a run of `queries` queries; none if there are enough to decide
    /// against the mean phase.
    ///
    /// A run decides on [`FEWEST`] paths, and again on twice that number. One of few queries decides once,
    /// or counts at once.
    pub(super) fn next(&self, queries: u64) -> Option<u64> {
        let most = if queries < ONCE {
            0
        } else if queries < TWICE {
            FEWEST
        } else {
            2 * FEWEST
        };
        (self.paths < most).then_some(FEWEST)
    }

    /// The levels of the paths measured since, and their numbers of good indices and of others.
    fn levels(&self, device: &Device<'_>) -> impl Iterator<Item = (u64, [u64; 2])> + Clone {
        let levels = device.measured_levels().zip(&self.before);
        levels.map(|((level, now), before)| (level, [0, 1].map(|which| now[which] - before[which])))
    }

    /// The levels of paths drawn at random, and how often each was drawn: the run has not counted yet.
    pub(super) fn random_levels(
        &self,
        device: &Device<'_>,
    ) -> impl Iterator<Item = (u64, u64)> + Clone {
        let levels = self.levels(device);
        levels.map(|(level, [good, others])| (level, good + others))
    }

    /// The colours of all paths that were measured, and the mean that counting has found for them; `None` if no good
    /// index was measured, or no other.
    ///
    /// In `posterior`, each shot counts half, so that other modes have weight: no shot of the mean-phase circuit could
    /// find them again.
    pub(super) fn after_counting(
        &self,
        device: &Device<'_>,
        posterior: &Posterior,
    ) -> Option<Start> {
        let (mean, deviation) = posterior.tempered_amplitude();
        let amplitude = posterior.mean_amplitude();
        let any = |which: usize| self.levels(device).any(|(_, found)| found[which] > 0);
        let is_mixed = any(0) && any(1) && amplitude > 0.0 && amplitude < 1.0;
        is_mixed.then(|| Start {
            colours: Colours::of_counted(self.levels(device), self.bits, amplitude),
            mean,
            deviation,
        })
    }

    /// Draws more paths at random, if they are few beside the run's queries, of which `left` are left.
    pub(super) fn draw(&self, goal: &Goal, device: &mut Device<'_>, left: &mut u64) -> Start {
        let mut paths = ((PILOT * goal.queries as f64) as u64).max(FEWEST);
        if goal.error.is_some() {
            // A run that stops early may be much shorter than it is allowed to be.
            paths = paths.min(ASKED);
        }
        let more = paths.saturating_sub(self.paths).min(*left);
        device.paths(more);
        *left -= more;
        self.random(device)
    }

    /// The colours of the paths drawn at random, and their mean.
    pub(super) fn random(&self, device: &Device<'_>) -> Start {
        let colours = Colours::of_random(self.random_levels(device), self.bits);
        let mean = colours.mean();
        let spread = colours.at(mean);
        Start {
            mean,
            deviation: DOUBT * spread.deviation / colours.times().sqrt(),
            colours,
        }
    }
}

/// The knowledge with which a run goes on with the mean-phase circuit.
pub(super) struct Start {
    colours: Colours,
    mean: f64,
    /// The mean's standard deviation.
    deviation: f64,
}

impl Start {
    /// True if the mean phase is expected to have less error than counting the whole: less by `margin`.
    ///
    /// If no path was bright, counting has little error, and the spread of the mean phase is not known.
    pub(super) fn favours_mean_phase(&self, margin: f64) -> bool {
        let mean = self.mean;
        let error = margin * ERROR * self.colours.at(mean).deviation;
        mean > 0.0 && error * error < FAR * FAR * mean * (1.0 - mean)
    }

    /// True if the mean is known well enough for one eigenphase to explain the shots.
    pub(super) fn is_narrow(&self) -> bool {
        self.deviation <= NEAR * self.colours.at(self.mean).deviation
    }

    /// The expected variance of the mean after `queries` queries, if no colour has been missed, and shots are read
    /// rightly with probability `read`.
    ///
    /// The run finds those that matter: its shots measure paths far from the reference first.
    pub(super) fn variance_after(&self, queries: f64, read: f64) -> f64 {
        self.colours.at(self.mean).seen * (ERROR / (queries * read)).powi(2)
    }
}

/// Continues a run that began at `begun` and has `left` queries left, with the mean-phase circuit.
pub(super) fn estimate(
    goal: &Goal,
    device: &mut Device<'_>,
    begun: Usage,
    start: Start,
    mut left: u64,
) -> Result<Estimate, EstimatorError> {
    let bits = check(device)?;
    let read = read_rightly(goal, device);
    let quantile = normal_quantile(0.5 * (1.0 - goal.confidence));
    let mut colours = start.colours;
    let mut grid = Grid::around(start.mean, start.deviation);
    let (mut mean, mut deviation) = grid.moments();
    // A posterior at a wrong mode begins anew, once: the colours' mean may be wrong, too, and a second posterior at the
    // same place is right. Late in a run, too few queries are left.
    let mut half = left / 2;
    while left >= 2 && deviation > KNOWN {
        let half_width = quantile * deviation;
        if goal.error.is_some_and(|error| half_width <= error) {
            break;
        }
        grid.narrow();
        let spread = colours.at(mean);
        grid.aim(spread.gain, mean);
        let intact = |k: u64| goal.noise.intact(k + 1) * read;
        let visibility = |k: u64| spread.visibility * EXPLAINED * intact(k);
        if visibility(1) < BLIND {
            break;
        }
        let most = (left - 1).min(DEEPEST);
        let coherent = depth::useful(&goal.noise);
        let plan = grid.choose((spread.gain, deviation), (most, coherent), visibility);
        let k = plan.iterations;
        let phase_bits = k.ilog2() + FINER;
        let phases = LevelPhases::new(spread.slope, mean, bits, phase_bits);
        let phases = phases.map_err(|_| EstimatorError::MeanPhase {
            slope: spread.slope,
            reference: mean,
        })?;
        let shot = device.mean_phase(phases, k, plan.basis)?;
        grid.observe(&plan, visibility(k), shot.one);
        colours.add(shot.level, &phases, k, intact(k));
        left -= k + 1;
        (mean, deviation) = grid.moments();
        if left >= half
            && let Some(anew) = elsewhere(&colours, mean, deviation)
        {
            half = u64::MAX;
            grid = anew;
            (mean, deviation) = grid.moments();
        }
    }
    let end = |side: f64| (mean + side * quantile * deviation).clamp(0.0, 1.0);
    Ok(device.estimate(begun, mean, (end(-1.0), end(1.0)), goal.confidence))
}

/// The posterior that the colours alone suggest, if that of the shots is far from their mean.
fn elsewhere(colours: &Colours, mean: f64, deviation: f64) -> Option<Grid> {
    let expected = colours.mean();
    let error = colours.error_of_mean(expected);
    let distance = (mean - expected).abs();
    let is_far = distance > ELSEWHERE * error.hypot(deviation);
    // The new posterior reaches the place of the old one.
    is_far.then(|| Grid::around(expected, (DOUBT * error).max(distance / Grid::REACH)))
}
