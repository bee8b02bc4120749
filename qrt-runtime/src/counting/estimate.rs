//! Estimators: from queries of the oracle to the fraction of good ids.
//!
//! One trait, one unit and one result, so that estimators can be compared. The unit is the query:
//! one application of the oracle, and for classical Monte Carlo one path. Phase estimation with T
//! phases applies the Grover iterate, and with it the oracle, T-1 times.

use std::f64::consts::PI;

use qrt_core::scene::{Counting, Estimator, Window};

use super::binomial;
use super::distribution::{PhaseDistribution, check_counts, register};
use super::error::{CountingError, MAX_REPETITIONS};
use super::likelihood::maximum_likelihood;
use crate::random::Stream;

/// The estimators of this version, by their names in scenes.
pub const AVAILABLE: [Estimator; 4] = [
    Estimator::Exact,
    Estimator::MonteCarlo,
    Estimator::Paper,
    Estimator::Sine,
];

/// What is to be estimated. Known to the simulation, not to the estimator, which sees it only
/// through measurements.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Problem {
    /// S, the good ids.
    pub good: u64,
    /// N, all ids.
    pub total: u64,
}

/// An estimated amplitude, and what it took.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// The estimate of S/N, in [0, 1].
    pub amplitude: f64,
    /// The likeliest S, where the estimator finds an integer.
    pub good: Option<u64>,
    /// Holds S/N with at least the probability [`Estimate::confidence`]; how it is obtained is
    /// said with each estimator.
    pub interval: (f64, f64),
    /// The interval's confidence.
    pub confidence: f64,
    /// Applications of the oracle.
    pub queries: u64,
    /// Measurements.
    pub shots: u64,
    /// ln of the probability of what was measured, given the estimate; where the estimator
    /// computes it.
    pub ln_likelihood: Option<f64>,
}

/// An estimator of the fraction of good ids.
pub trait AmplitudeEstimator {
    /// Simulates the measurements of one run, and estimates from them.
    ///
    /// # Errors
    ///
    /// A problem or a setting out of range.
    fn estimate(&self, problem: Problem, stream: &mut Stream) -> Result<Estimate, CountingError>;
}

/// `exact`: S itself. Counts every id, N queries, without error: the picture without counting
/// noise.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Exact;

impl AmplitudeEstimator for Exact {
    fn estimate(&self, problem: Problem, _: &mut Stream) -> Result<Estimate, CountingError> {
        check_counts(problem.good, problem.total)?;
        let amplitude = problem.good as f64 / problem.total as f64;
        Ok(Estimate {
            amplitude,
            good: Some(problem.good),
            interval: (amplitude, amplitude),
            confidence: 1.0,
            queries: problem.total,
            shots: problem.total,
            ln_likelihood: None,
        })
    }
}

/// `monte-carlo`: the fraction of good ids among `queries` drawn at random, with replacement.
///
/// Interval, 95 %: all a whose Kullback-Leibler divergence from the fraction is at most `ln(40)/n`
/// (Chernoff's bound with 2.5 % on either side), which holds for every n and a.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MonteCarlo {
    /// Ids drawn.
    pub queries: u64,
}

impl AmplitudeEstimator for MonteCarlo {
    fn estimate(&self, problem: Problem, stream: &mut Stream) -> Result<Estimate, CountingError> {
        check_counts(problem.good, problem.total)?;
        if self.queries == 0 {
            return Err(CountingError::NoOutcomes);
        }
        let hits = binomial::draw(self.queries, problem.good, problem.total, stream);
        let shots = self.queries as f64;
        let amplitude = hits as f64 / shots;
        let missed = (self.queries - hits) as f64 / shots;
        let reach = libm::log(40.0) / shots;
        let low = (amplitude - chernoff(missed, reach)).max(0.0);
        let high = (amplitude + chernoff(amplitude, reach)).min(1.0);
        Ok(Estimate {
            amplitude,
            good: None,
            interval: (low, high),
            confidence: 0.95,
            queries: self.queries,
            shots: self.queries,
            ln_likelihood: None,
        })
    }
}

/// The distance from `fraction` to the largest a at or above it with `KL(fraction, a) <= reach`.
///
/// By Chernoff's bound a fraction this low or lower has probability at most exp(-n reach) under
/// any larger a.
fn chernoff(fraction: f64, reach: f64) -> f64 {
    let rest = 1.0 - fraction;
    let (mut low, mut high) = (0.0, rest);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        let divergence = binomial::deviance(fraction, -middle) + binomial::deviance(rest, middle);
        if divergence <= reach {
            low = middle;
        } else {
            high = middle;
        }
    }
    high
}

/// Repeated quantum counting, and the likeliest S: `paper` with the rectangular window, `sine`
/// with the sine window.
///
/// Interval: with y' and y'' the lower and the upper median of the B outcomes, theta lies in
/// `[(y' - 1)/T, (y'' + 1)/T]`. A single outcome is within one step of T theta with probability
/// at least 8/pi^2 (Brassard, Hoyer, Mosca & Tapp, *Quantum amplitude amplification and
/// estimation*, 2000, theorem 11; for a single outcome this is
/// `|S~ - S| <= 2 pi sqrt(S(N-S))/T + pi^2 N/T^2`), and for the median to be off, half of the
/// outcomes must be. The sine window exceeds that probability. Where the likeliest S lies outside,
/// the interval is extended to it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct WindowedCounting {
    /// t, of T = 2^t.
    pub phase_bits: u32,
    /// B.
    pub repetitions: u32,
    /// The window of the counting register.
    pub window: Window,
}

/// What a single outcome is within one step of T theta with.
const ONE_STEP: f64 = 8.0 / (PI * PI);

impl WindowedCounting {
    /// The outcomes of one run: B draws, folded onto `0 ..= T/2`.
    ///
    /// # Errors
    ///
    /// A problem or a setting out of range.
    pub fn outcomes(
        &self,
        problem: Problem,
        stream: &mut Stream,
    ) -> Result<Vec<u64>, CountingError> {
        if !(1..=MAX_REPETITIONS).contains(&self.repetitions) {
            return Err(CountingError::RepetitionsOutOfRange(self.repetitions));
        }
        let Problem { good, total } = problem;
        let distribution = PhaseDistribution::new(good, total, self.phase_bits, self.window)?;
        let sampler = distribution.sampler();
        Ok((0..self.repetitions)
            .map(|_| sampler.sample(stream))
            .collect())
    }

    /// What `outcomes` say about the good ids among `total`; [`Self::repetitions`] plays no part.
    ///
    /// # Errors
    ///
    /// As [`maximum_likelihood`].
    pub fn infer(&self, outcomes: &[u64], total: u64) -> Result<Estimate, CountingError> {
        let likeliest = maximum_likelihood(outcomes, total, self.phase_bits, self.window)?;
        let amplitude = likeliest.good as f64 / total as f64;
        let (low, high) = self.medians_interval(outcomes);
        let shots = outcomes.len() as u64;
        Ok(Estimate {
            amplitude,
            good: Some(likeliest.good),
            interval: (low.min(amplitude), high.max(amplitude)),
            confidence: ONE_STEP,
            queries: shots.saturating_mul((1 << self.phase_bits) - 1),
            shots,
            ln_likelihood: Some(likeliest.ln_likelihood),
        })
    }

    fn medians_interval(&self, outcomes: &[u64]) -> (f64, f64) {
        let mut sorted = outcomes.to_vec();
        sorted.sort_unstable();
        let size = (1_u64 << self.phase_bits) as f64;
        let lower = sorted[(sorted.len() - 1) / 2] as f64 - 1.0;
        let upper = sorted[sorted.len() / 2] as f64 + 1.0;
        let amplitude = |steps: f64| {
            let sine = libm::sin(PI * (steps.clamp(0.0, 0.5 * size) / size));
            sine * sine
        };
        (amplitude(lower), amplitude(upper))
    }
}

impl AmplitudeEstimator for WindowedCounting {
    fn estimate(&self, problem: Problem, stream: &mut Stream) -> Result<Estimate, CountingError> {
        self.infer(&self.outcomes(problem, stream)?, problem.total)
    }
}

/// The estimator of that name, under a scene's counting block.
///
/// `paper` and `sine` bring their own window: the block's plays no part in them. `monte-carlo`
/// has as many queries as they would, `(T-1) B`, so that all three can be compared.
///
/// # Errors
///
/// An estimator that this version does not have, or a setting out of range.
pub fn estimator(
    name: Estimator,
    counting: &Counting,
) -> Result<Box<dyn AmplitudeEstimator + Send + Sync>, CountingError> {
    let Counting {
        phase_bits,
        repetitions,
        ..
    } = *counting;
    let windowed = |window| -> Result<WindowedCounting, CountingError> {
        register(phase_bits, window)?;
        if !(1..=MAX_REPETITIONS).contains(&repetitions) {
            return Err(CountingError::RepetitionsOutOfRange(repetitions));
        }
        Ok(WindowedCounting {
            phase_bits,
            repetitions,
            window,
        })
    };
    match name {
        Estimator::Exact => Ok(Box::new(Exact)),
        Estimator::Paper => Ok(Box::new(windowed(Window::Rect)?)),
        Estimator::Sine => Ok(Box::new(windowed(Window::Sine)?)),
        Estimator::MonteCarlo => {
            let WindowedCounting {
                phase_bits,
                repetitions,
                ..
            } = windowed(Window::Rect)?;
            // Below 2^40 * 10^6 < 2^60.
            let queries = ((1_u64 << phase_bits) - 1) * u64::from(repetitions);
            Ok(Box::new(MonteCarlo { queries }))
        }
        _ => Err(CountingError::UnavailableEstimator(name)),
    }
}

/// One run of the estimator of that name: see [`estimator`].
///
/// # Errors
///
/// An estimator that this version does not have, or a problem or a setting out of range.
///
/// ```
/// use qrt_core::scene::{Counting, Estimator, Window};
/// use qrt_runtime::{counting::estimate, random::Stream};
/// let counting = Counting {
///     phase_bits: 8, repetitions: 3, window: Window::Rect, estimator: Estimator::Paper,
/// };
/// let mut stream = Stream::new(1, 0, 0, 0);
/// let found = estimate(Estimator::Paper, &counting, 300, 1000, &mut stream)?;
/// assert_eq!(found.queries, 3 * 255);
/// assert!((found.amplitude - 0.3).abs() < 0.05);
/// # Ok::<(), qrt_runtime::counting::CountingError>(())
/// ```
pub fn estimate(
    name: Estimator,
    counting: &Counting,
    good: u64,
    total: u64,
    stream: &mut Stream,
) -> Result<Estimate, CountingError> {
    estimator(name, counting)?.estimate(Problem { good, total }, stream)
}
