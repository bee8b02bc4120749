//! Estimates a pixel's mean by the mean-phase circuit.
//!
//! Counting good indices has an error of about `2.2 sqrt(a (1 - a))` over the queries: it pays for the
//! *scale* of the colours. The phase of the mean-phase circuit is proportional to the mean itself, in units of
//! the colours' standard deviation sigma ([`Device::mean_phase`]). With the slope
//! `alpha = eta/sigma` it turns by `2 eta/((1 + eta^2) sigma)` a query and unit of the mean, and the
//! error is about `3.4 sigma` over the queries.
//!
//! A run begins with paths drawn at random, which show colours and roughly their mean. Then each
//! shot
//!
//! * takes the mean so far as its reference, where the phase is 0, whatever the colours are;
//! * takes sigma, and with it slope and phase a unit of the mean, from all colours measured so far:
//!   see [`Colours`];
//! * takes the depth and the measured angle that are expected to sharpen the posterior of the mean
//!   most per query: see [`Grid::choose`].
//!
//! Kothari & O'Donnell, *Mean estimation when you have the source code* (2022), showed that an error
//! in proportion to sigma over the queries is possible. The choice of slope and reference before every shot, from the
//! colours of the measured paths, is this crate's own.

mod colours;
mod grid;

use super::{Goal, choice, depth};
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
/// The factor by which the mean of these may be less certain than it seems.
const DOUBT: f64 = 1.3;
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
    check(device).is_ok_and(|bits| deep && read_rightly(goal, device, bits) > READ)
}

/// The probability that the path index and the sign are read rightly.
fn read_rightly(goal: &Goal, device: &Device<'_>, bits: u32) -> f64 {
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

/// Colours of paths that are drawn at random.
pub(super) struct Pilot {
    /// Good indices and others that had been measured before, by level.
    before: Vec<[u64; 2]>,
    bits: u32,
    /// Number of paths drawn.
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

    fn colours(&self, device: &Device<'_>) -> Colours {
        let drawn = device.measured_levels().zip(&self.before);
        let levels = drawn.map(|((level, now), before)| {
            let [good, others] = [0, 1].map(|which| now[which] - before[which]);
            (level, good + others)
        });
        Colours::of_random(levels, self.bits)
    }

    /// True if the mean phase is expected to have less error than counting: less by `margin`.
    ///
    /// If no path was bright, counting has little error, and the spread of the mean phase is not known.
    pub(super) fn favours(&self, device: &Device<'_>, margin: f64) -> bool {
        let colours = self.colours(device);
        let mean = colours.mean();
        let error = margin * ERROR * colours.at(mean).deviation;
        mean > 0.0 && error * error < choice::FAR * choice::FAR * mean * (1.0 - mean)
    }
}

/// Continues a run that began at `start` and has `left` queries left, with the mean-phase circuit,
/// after more paths of the pilot if it has few.
pub(super) fn estimate(
    goal: &Goal,
    device: &mut Device<'_>,
    start: Usage,
    pilot: &Pilot,
    mut left: u64,
) -> Result<Estimate, EstimatorError> {
    let bits = pilot.bits;
    let mut paths = ((PILOT * goal.queries as f64) as u64).max(FEWEST);
    if goal.error.is_some() {
        // A run that stops early may be much shorter than it is allowed to be.
        paths = paths.min(ASKED);
    }
    let more = paths.saturating_sub(pilot.paths).min(left);
    device.paths(more);
    left -= more;
    let read = read_rightly(goal, device, bits);
    let quantile = normal_quantile(0.5 * (1.0 - goal.confidence));
    let mut colours = pilot.colours(device);
    let mean = colours.mean();
    let spread = colours.at(mean);
    let mut grid = Grid::around(mean, DOUBT * spread.deviation / colours.sampled().sqrt());
    let (mut mean, mut deviation) = grid.moments();
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
    }
    let end = |side: f64| (mean + side * quantile * deviation).clamp(0.0, 1.0);
    Ok(device.estimate(start, mean, (end(-1.0), end(1.0)), goal.confidence))
}
