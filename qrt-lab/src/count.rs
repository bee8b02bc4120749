//! The distribution of the phase register's outcomes for S of N good indices, and draws from it.
//!
//! ```
//! use qrt_lab::count::{CountFigures, CountOptions};
//! use qrt_scene::Window;
//!
//! let count = CountFigures::new(CountOptions {
//!     good: 300,
//!     total: 1000,
//!     phase_bits: 6,
//!     window: Window::Rect,
//!     outcomes: Vec::new(),
//!     shots: Some(5),
//!     seed: 1,
//! })?;
//! assert_eq!(count.outcomes.len(), 33);
//! assert!((count.listed_probability() - 1.0).abs() < 1e-12);
//! # Ok::<(), qrt_counting::estimators::EstimatorError>(())
//! ```

use qrt_counting::estimators::{
    CountingProblem, DEFAULT_CONFIDENCE, Device, Estimate, EstimatorError, Noise, WindowedCounting,
};
use qrt_counting::random::Stream;
use qrt_counting::{CountingError, PhaseDistribution, posterior};
use qrt_scene::Window;
use std::collections::BTreeMap;

/// Largest number of phase bits for which all outcomes are listed; above it, those near the peak.
const MAX_LISTED_BITS: u32 = 16;
/// Number of outcomes listed on either side of the peak.
const PEAK_REACH: u64 = 16;
/// Largest number of indices for which the posterior is summed index by index.
const MAX_POSTERIOR_IDS: u64 = 1 << 16;
/// Number of the most likely values of S that a posterior lists.
const LIKELIEST: usize = 10;

/// A counting problem, the phase register, and the outcomes and draws that are asked for.
#[derive(Clone, Debug)]
pub struct CountOptions {
    /// S, the number of good indices: at most `total`.
    pub good: u64,
    /// N, the number of indices: at least 1.
    pub total: u64,
    /// t, the number of qubits of the phase register: 1 to 40.
    pub phase_bits: u32,
    /// The window on the phase register.
    pub window: Window,
    /// The outcomes that are listed, each at most `2^(t-1)`. If there are none: all of them, or with more
    /// than 16 phase bits those about the peak.
    pub outcomes: Vec<u64>,
    /// Number of outcomes that are drawn.
    pub shots: Option<u32>,
    /// The same seed draws the same outcomes.
    pub seed: u64,
}

/// The selection of outcomes that are listed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Listed {
    /// All outcomes.
    All,
    /// Those of [`CountOptions::outcomes`].
    Asked,
    /// Those about the peak.
    Peak,
}

impl Listed {
    /// The name in JSON.
    pub fn name(self) -> &'static str {
        match self {
            Self::All => "all",
            Self::Asked => "asked",
            Self::Peak => "peak",
        }
    }
}

/// The distribution of outcomes, and draws from it.
#[derive(Clone, Debug)]
pub struct CountFigures {
    /// The problem, and the outcomes and draws that were asked for.
    pub options: CountOptions,
    /// The distribution.
    pub distribution: PhaseDistribution,
    /// Which outcomes are listed.
    pub listed: Listed,
    /// The listed outcomes.
    pub outcomes: Vec<u64>,
    /// The draws, if they were asked for.
    pub drawn: Option<DrawnOutcomes>,
}

/// Outcomes that were drawn, and the estimate from them.
#[derive(Clone, Debug)]
pub struct DrawnOutcomes {
    /// The number of times that each outcome was drawn; only those that were.
    pub counts: BTreeMap<u64, u64>,
    /// The estimate.
    pub estimate: Estimate,
    /// The posterior of S, up to N = 65536.
    pub posterior: Option<GoodPosterior>,
}

/// P(S | outcomes) for a prior that is uniform over 0..=N.
#[derive(Clone, Debug)]
pub struct GoodPosterior {
    /// The mean of S.
    pub mean: f64,
    /// The standard deviation of S.
    pub deviation: f64,
    /// The ten most likely values of S with their probabilities, the most likely first.
    pub likeliest: Vec<(u64, f64)>,
}

impl CountFigures {
    /// Computes the distribution, and draws from it.
    ///
    /// # Errors
    /// S is more than N, or an outcome or the number of phase bits is out of range.
    pub fn new(options: CountOptions) -> Result<Self, EstimatorError> {
        let CountOptions {
            good,
            total,
            phase_bits,
            window,
            ..
        } = options;
        let distribution = PhaseDistribution::new(good, total, phase_bits, window)?;
        let largest = distribution.largest_outcome();
        if let Some(&outcome) = options.outcomes.iter().find(|&&y| y > largest) {
            return Err(CountingError::OutcomeOutOfRange { outcome, largest }.into());
        }
        let (listed, outcomes) = if !options.outcomes.is_empty() {
            (Listed::Asked, options.outcomes.clone())
        } else if phase_bits <= MAX_LISTED_BITS {
            (Listed::All, (0..=largest).collect())
        } else {
            let peak = distribution.nearest_outcome();
            let first = peak.saturating_sub(PEAK_REACH);
            let last = (peak + PEAK_REACH).min(largest);
            (Listed::Peak, (first..=last).collect())
        };
        let drawn = options
            .shots
            .map(|shots| DrawnOutcomes::new(&options, shots));
        Ok(Self {
            distribution,
            listed,
            outcomes,
            drawn: drawn.transpose()?,
            options,
        })
    }

    /// The phase y/T of the outcome `y`.
    pub fn phase(&self, y: u64) -> f64 {
        y as f64 / (1_u64 << self.options.phase_bits) as f64
    }

    /// The probability of all listed outcomes together.
    pub fn listed_probability(&self) -> f64 {
        let probabilities = self.outcomes.iter();
        probabilities
            .map(|&y| self.distribution.probability(y))
            .sum()
    }
}

impl DrawnOutcomes {
    fn new(options: &CountOptions, shots: u32) -> Result<Self, EstimatorError> {
        let window = options.window;
        let run = WindowedCounting {
            phase_bits: options.phase_bits,
            repetitions: shots,
            window,
            confidence: DEFAULT_CONFIDENCE,
        };
        let mut stream = Stream::new(options.seed, 0, 0, 0);
        let problem = CountingProblem {
            good: options.good,
            total: options.total,
        };
        let mut device = Device::new(problem, Noise::NONE, &mut stream)?;
        let outcomes = device.phases(options.phase_bits, window, shots)?;
        let mut counts = BTreeMap::new();
        for &y in &outcomes {
            *counts.entry(y).or_insert(0) += 1;
        }
        let posterior = if options.total <= MAX_POSTERIOR_IDS {
            Some(GoodPosterior::new(&posterior(
                &outcomes,
                options.total,
                options.phase_bits,
                window,
            )?))
        } else {
            None
        };
        Ok(Self {
            counts,
            estimate: run.infer(&outcomes, options.total)?,
            posterior,
        })
    }
}

impl GoodPosterior {
    fn new(probabilities: &[f64]) -> Self {
        let values = || (0_u64..).zip(probabilities.iter().copied());
        let mean: f64 = values().map(|(good, p)| good as f64 * p).sum();
        let variance: f64 = values()
            .map(|(good, p)| {
                let distance = good as f64 - mean;
                p * distance * distance
            })
            .sum();
        let mut likeliest: Vec<_> = values().filter(|&(_, p)| p > 0.0).collect();
        likeliest.sort_by(|a, b| b.1.total_cmp(&a.1));
        likeliest.truncate(LIKELIEST);
        Self {
            mean,
            deviation: variance.sqrt(),
            likeliest,
        }
    }
}
