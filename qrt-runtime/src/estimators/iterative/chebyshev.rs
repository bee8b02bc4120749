//! `chebyshev`: Chebyshev amplitude estimation.

use super::{Failures, Goal, Multiples, Rules};
use crate::estimators::{AmplitudeEstimator, Device, Estimate, EstimatorError, Settings};

/// `chebyshev`: Chebyshev amplitude estimation (Rall & Fuller, *Amplitude estimation from quantum
/// signal processing*, Quantum 2023).
///
/// All multiples of theta, each at least twice the one before. Of a state whose amplitude on the
/// good ids is x, a circuit of d reflections shows the square of the Chebyshev polynomial `T_d(x)`:
/// for odd d = 2k+1 as the share of good ids after k iterations, for even d = 2k as the share of
/// states that return when the preparation is undone after k ([`Device::returned`]). Both take k
/// queries. Near the end, when a batch of shots would leave an error of less than [`Self::LATE`]
/// times the one that is asked, shots are taken in small numbers (the authors: one by one; here a
/// tenth of those taken at the depth), so that few are wasted.
///
/// The authors estimate x; here it is S/N = x^2, and errors are errors of that.
///
/// Interval: the last arc. Shots at a depth are looked at after every batch, so that what may fail
/// at it is taken to be 0.6 of what the authors give it; at 95 % asked, 95 to 99 % are held.
///
/// Noise is not reckoned with: shares are taken for those of a perfect device.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Chebyshev {
    goal: Goal,
    rules: Rules,
}

impl Chebyshev {
    /// Shots taken at once. The authors take 100; with a given number of queries, fewer leave more
    /// for the last depth.
    pub const SHOTS: u64 = 20;

    /// The authors' nu.
    pub const LATE: f64 = 8.0;

    /// Queries times the error that is aimed at where only queries are given: about what most runs
    /// take.
    const COST: f64 = 4.0;

    pub(crate) fn new(settings: &Settings) -> Self {
        Self::with_shots(settings, Self::SHOTS)
    }

    /// With another number of shots at once, at least one.
    pub fn with_shots(settings: &Settings, shots: u64) -> Self {
        Self {
            goal: Goal::new(settings, Self::COST),
            rules: Rules {
                multiples: Multiples::All,
                ratio: 2,
                shots: shots.max(1),
                failures: Failures::Equal,
                late: Some(Self::LATE),
            },
        }
    }
}

impl AmplitudeEstimator for Chebyshev {
    fn estimate(&self, device: &mut Device<'_>) -> Result<Estimate, EstimatorError> {
        self.rules.run(&self.goal, device)
    }
}
