//! Estimators: from queries of the oracle to the fraction of good indices.
//!
//! All estimators have one trait, one unit of cost and one type of result, and so are comparable.
//!
//! * [`Device`]: makes the measurements. It is an estimator's only source of information about the
//!   good indices. It counts the queries and adds the noise.
//! * [`Settings`]: the requested error and confidence, and the query budget.
//! * [`Estimate`]: the fraction, its interval, and their cost.
//!
//! The unit is the query: one application of the oracle. A shot after k Grover iterations takes k
//! queries, because the index that it measures is evaluated classically. A shot without iterations
//! is a path of classical Monte Carlo, which is one query, too. Phase estimation with T phases
//! takes T-1 queries.

mod abrams_williams;
mod bayes;
mod clopper_pearson;
mod coin;
mod device;
mod error;
mod exact;
mod interval;
mod iterative;
mod mlae;
mod monte_carlo;
mod noise;
mod normal;
mod posterior_mean;
mod qss;
mod quantum_coin;
mod settings;
#[cfg(test)]
mod tests;
mod turns;
mod windowed;

pub use abrams_williams::AbramsWilliams;
pub use bayes::{AdaptiveBayes, PhaseMean, RandomDepth};
pub use device::colours::CountedStratum;
pub use device::{CountingProblem, Device, MeanPhaseShot, Usage};
pub use error::{EstimatorError, MAX_ITERATIONS};
pub use exact::Exact;
pub use iterative::Iterative;
pub use mlae::Mlae;
pub use monte_carlo::MonteCarlo;
pub use noise::{Noise, NoiseError};
pub use posterior_mean::PosteriorMean;
pub use qss::Supersampling;
pub use quantum_coin::QuantumCoin;
pub use settings::{DEFAULT_CONFIDENCE, Settings};
pub use windowed::WindowedCounting;

use crate::random::Stream;
use qrt_scene::{Counting, Estimator};

/// An estimated amplitude and its cost.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// The estimate of S/N, in [0, 1].
    pub amplitude: f64,
    /// The likeliest S, if the estimator finds an integer.
    pub good: Option<u64>,
    /// The interval of S/N, in [0, 1]. Its coverage is at least [`Estimate::confidence`]. Each
    /// estimator documents its method.
    pub interval: (f64, f64),
    /// The requested coverage of the interval, in (0, 1).
    pub confidence: f64,
    /// Applications of the oracle.
    pub queries: u64,
    /// Number of measurements.
    pub shots: u64,
    /// The largest number of queries between preparation and measurement. The device must stay
    /// coherent for that long.
    pub depth: u64,
    /// Number of times that the estimator chose the next measurement.
    pub rounds: u64,
    /// ln of the probability of the outcomes, given the estimate, if the estimator computes it.
    pub ln_likelihood: Option<f64>,
    /// Number of separate ranges of S/N that were still possible at the end, if the estimator keeps
    /// more than one.
    pub candidates: Option<u32>,
    /// Number of strata of the comparator that were counted on their own; 1 if the whole was
    /// counted at once, or the mean was measured as a phase.
    pub strata: u32,
}

impl Estimate {
    /// The estimate 0 of the whole comparator, without a measurement.
    const UNMEASURED: Self = Self {
        amplitude: 0.0,
        good: None,
        interval: (0.0, 1.0),
        confidence: DEFAULT_CONFIDENCE,
        queries: 0,
        shots: 0,
        depth: 0,
        rounds: 0,
        ln_likelihood: None,
        candidates: None,
        strata: 1,
    };
}

/// Number of qubits of an index among `total`, which is at least 1.
fn id_bits(total: u64) -> u32 {
    u64::BITS - (total - 1).leading_zeros()
}

/// An estimator of the fraction of good indices.
pub trait AmplitudeEstimator {
    /// Runs the estimator once: measures on `device`, and estimates from the outcomes.
    ///
    /// The estimate does not include queries that the device made before this run.
    ///
    /// # Errors
    ///
    /// A setting out of range.
    fn estimate(&self, device: &mut Device<'_>) -> Result<Estimate, EstimatorError>;

    /// Probability, in [0, 1], that a run measures no good index although there are some.
    ///
    /// An estimator returns it if the settings alone determine it. The default is 0, for runs that
    /// depend on their outcomes. A pixel that takes its colour from its measured paths has none
    /// after a run that misses.
    fn misses(&self) -> f64 {
        0.0
    }
}

/// Creates the estimator called `name` with `settings`.
///
/// # Errors
///
/// A setting that is out of range, or that the estimator does not support.
pub fn estimator(
    name: Estimator,
    settings: &Settings,
) -> Result<Box<dyn AmplitudeEstimator + Send + Sync>, EstimatorError> {
    settings.check_for(name)?;
    Ok(match name {
        Estimator::Exact => Box::new(Exact),
        Estimator::Paper | Estimator::Sine => Box::new(WindowedCounting::new(name, settings)?),
        Estimator::PosteriorMean => Box::new(PosteriorMean::new(settings)?),
        Estimator::AdaptiveBayes => Box::new(AdaptiveBayes::new(settings)?),
        Estimator::PhaseMean => Box::new(PhaseMean::new(settings)?),
        Estimator::Auto => Box::new(PhaseMean::auto(settings)?),
        Estimator::RandomDepth => Box::new(RandomDepth::new(settings)?),
        Estimator::Mlae => Box::new(Mlae::new(settings)),
        Estimator::Iqae => Box::new(Iterative::iqae(settings)),
        Estimator::Miqae => Box::new(Iterative::miqae(settings)),
        Estimator::Chebyshev => Box::new(Iterative::chebyshev(settings)),
        Estimator::MonteCarlo => Box::new(MonteCarlo::new(settings)),
        Estimator::Qss => Box::new(Supersampling::new(settings)?),
        Estimator::Qcoin => Box::new(QuantumCoin::new(settings)),
        Estimator::AbramsWilliams => Box::new(AbramsWilliams::new(settings)),
    })
}

/// Runs the estimator called `name` once on a device without noise.
///
/// `counting` is a scene's counting block. Its `error` is taken as that of the amplitude, and not in radiance: see
/// [`Settings::of_channel`].
///
/// # Errors
///
/// A problem or a setting out of range.
///
/// ```
/// use qrt_counting::{estimators::{CountingProblem, estimate}, random::Stream};
/// use qrt_scene::{Counting, Estimator};
/// let counting = Counting {
///     phase_bits: 8, repetitions: 3, estimator: Some(Estimator::Paper), ..Counting::default()
/// };
/// let problem = CountingProblem { good: 300, total: 1000 };
/// let found = estimate(Estimator::Paper, &counting, problem, &mut Stream::new(1, 0, 0, 0))?;
/// assert_eq!(found.queries, 3 * 255);
/// assert!((found.amplitude - 0.3).abs() < 0.05);
/// # Ok::<(), qrt_counting::estimators::EstimatorError>(())
/// ```
pub fn estimate(
    name: Estimator,
    counting: &Counting,
    problem: CountingProblem,
    stream: &mut Stream,
) -> Result<Estimate, EstimatorError> {
    let mut device = Device::new(problem, Noise::NONE, stream)?;
    estimator(name, &Settings::of_channel(counting, 1.0)?)?.estimate(&mut device)
}
