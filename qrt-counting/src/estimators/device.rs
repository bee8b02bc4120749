//! The device on which estimators measure.
//!
//! The Grover iterate rotates the uniform state of the indices by twice the angle `pi theta`, where
//! `sin^2(pi theta) = S/N`, in the plane of the good and the bad indices. Every circuit of the
//! estimators therefore has outcomes with a closed-form probability, from which the device draws
//! them. `theta` is known to 104 bits: a shot after 2^40 iterations has the right probability to
//! better than 1e-15.

pub(super) mod colours;
mod mean_phase;
mod shifted;

pub use mean_phase::MeanPhaseShot;

use super::{Estimate, EstimatorError, MAX_ITERATIONS, Noise, id_bits};
use crate::random::Stream;
use crate::{Angle, PhaseDistribution, binomial, good_id};
use qrt_circuit::quantum::Window;

/// The quantity to estimate. The device knows it, the estimator does not.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct CountingProblem {
    /// S, the number of good indices, in `0..=N`.
    pub good: u64,
    /// N, the number of all indices, at least 1.
    pub total: u64,
}

/// Numbers of queries and shots of a device since its creation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Usage {
    /// Applications of the oracle.
    pub queries: u64,
    /// Number of measurements.
    pub shots: u64,
    /// The query depth: the largest number of queries in one shot.
    pub depth: u64,
    /// Number of times that the estimator requested measurements.
    pub rounds: u64,
    /// Number of measured indices that were good. Each of them is one of the good indices, all
    /// equally likely.
    pub good_ids: u64,
}

/// A device that runs circuits with the oracle of one problem, and counts queries and shots.
#[derive(Debug)]
pub struct Device<'a> {
    problem: CountingProblem,
    theta: Angle,
    noise: Noise,
    stream: &'a mut Stream,
    usage: Usage,
    known: Option<Box<colours::Known>>,
}

impl<'a> Device<'a> {
    /// Creates a device for `problem` that draws its measurements from `stream`.
    ///
    /// # Errors
    /// No indices, more good indices than indices, or noise out of range.
    pub fn new(
        problem: CountingProblem,
        noise: Noise,
        stream: &'a mut Stream,
    ) -> Result<Self, EstimatorError> {
        let CountingProblem { good, total } = problem;
        noise.check()?;
        Ok(Self {
            problem,
            theta: Angle::from_counts(good, total)?,
            noise,
            stream,
            usage: Usage::default(),
            known: None,
        })
    }

    /// N, the number of indices.
    pub fn total(&self) -> u64 {
        self.problem.total
    }

    /// The usage since the device was created.
    pub fn usage(&self) -> Usage {
        self.usage
    }

    /// Random numbers for an estimator's own choices.
    pub fn stream(&mut self) -> &mut Stream {
        self.stream
    }

    /// Creates the estimate of a run that began at `start`, with the counts of this device.
    pub fn estimate(
        &self,
        start: Usage,
        amplitude: f64,
        interval: (f64, f64),
        confidence: f64,
    ) -> Estimate {
        Estimate {
            amplitude,
            interval,
            confidence,
            queries: self.usage.queries - start.queries,
            shots: self.usage.shots - start.shots,
            depth: self.usage.depth,
            rounds: self.usage.rounds - start.rounds,
            ..Estimate::UNMEASURED
        }
    }

    /// Counts `shots` measurements of `queries` queries each.
    fn spend(&mut self, shots: u64, queries: u64) {
        self.usage.queries = (self.usage.queries).saturating_add(shots.saturating_mul(queries));
        self.usage.shots = self.usage.shots.saturating_add(shots);
        self.usage.depth = self.usage.depth.max(queries);
        self.usage.rounds += 1;
    }

    /// Counts S by evaluating all indices, with N queries.
    pub fn every_id(&mut self) -> u64 {
        self.spend(self.problem.total, 1);
        self.usage.good_ids += self.problem.good;
        self.problem.good
    }

    /// Number of good indices among `shots` random ones, drawn with replacement; one query each.
    pub fn paths(&mut self, shots: u64) -> u64 {
        self.spend(shots, 1);
        let CountingProblem { good, total } = self.problem;
        let found = binomial::draw(shots, good, total, self.stream);
        self.usage.good_ids += found;
        self.read_paths([found, shots - found]);
        found
    }

    /// Number of good indices among `shots` measurements after `iterations` Grover iterations.
    ///
    /// A shot takes `iterations` queries. Without iterations it takes one query, as in
    /// [`Device::paths`].
    ///
    /// An index is good with probability `sin^2((2k + 1) pi theta)`.
    ///
    /// # Errors
    /// More iterations than [`MAX_ITERATIONS`].
    pub fn iterated(&mut self, iterations: u64, shots: u64) -> Result<u64, EstimatorError> {
        if iterations > MAX_ITERATIONS {
            return Err(EstimatorError::TooManyIterations(iterations));
        }
        if iterations == 0 {
            return Ok(self.paths(shots));
        }
        self.spend(shots, iterations);
        let good = self.theta.sine_squared(2 * iterations + 1);
        Ok(self.measured_ids(iterations, good, shots))
    }

    /// Number of `shots` states that return to the initial state after `iterations` Grover
    /// iterations.
    ///
    /// The circuit then undoes the preparation, and all qubits of the index read zero. A shot takes
    /// `iterations` queries, because the preparation of all indices takes none.
    ///
    /// A state returns with probability `cos^2(2k pi theta)`, k = `iterations`: the iterations
    /// between the preparation and its inverse rotate it by `2k pi theta`. A state that noise has
    /// destroyed, or that is misread, reads zero as often as any other index, once in N.
    ///
    /// # Errors
    /// More iterations than [`MAX_ITERATIONS`].
    pub fn returned(&mut self, iterations: u64, shots: u64) -> Result<u64, EstimatorError> {
        if iterations > MAX_ITERATIONS {
            return Err(EstimatorError::TooManyIterations(iterations));
        }
        self.spend(shots, iterations);
        let (sine, cosine) = self.theta.sine_squared(2 * iterations);
        let any = 1.0 / self.problem.total as f64;
        let right = self.intact(iterations);
        let mixed = |ideal: f64, any: f64| right * ideal + (1.0 - right) * any;
        let (p, q) = (mixed(cosine, any), mixed(sine, 1.0 - any));
        Ok(binomial::draw_with(shots, p, q, self.stream))
    }

    /// The probability that a state survives `queries` queries and all bits of its index are read
    /// correctly.
    fn intact(&self, queries: u64) -> f64 {
        let bits = id_bits(self.problem.total);
        self.noise.intact(queries) * self.noise.read_rightly(bits)
    }

    /// Number of good indices among `shots` measured ones, after `queries` queries each.
    ///
    /// `good` is (p, 1 - p), where p is the probability of a good index without noise.
    fn measured_ids(&mut self, queries: u64, good: (f64, f64), shots: u64) -> u64 {
        let (p, q) = if self.noise == Noise::NONE {
            good
        } else {
            let right = self.intact(queries);
            let any = self.theta.sine_squared(1);
            let mixed = |ideal: f64, any: f64| right * ideal + (1.0 - right) * any;
            (mixed(good.0, any.0), mixed(good.1, any.1))
        };
        let found = binomial::draw_with(shots, p, q, self.stream);
        self.usage.good_ids += found;
        self.read_paths([found, shots - found]);
        found
    }

    /// Outcomes of `repetitions` runs of the counting circuit with T = 2^`phase_bits`.
    ///
    /// The outcomes are folded onto `0 ..= T/2`. Each run takes T-1 queries.
    ///
    /// # Errors
    /// A register out of range.
    pub fn phases(
        &mut self,
        phase_bits: u32,
        window: Window,
        repetitions: u32,
    ) -> Result<Vec<u64>, EstimatorError> {
        let CountingProblem { good, total } = self.problem;
        let distribution = PhaseDistribution::new(good, total, phase_bits, window)?;
        let sampler = distribution.sampler();
        let size = 1_u64 << phase_bits;
        self.spend(u64::from(repetitions), size - 1);
        let intact = self.noise.intact(size - 1);
        let noise = self.noise;
        let stream = &mut *self.stream;
        let mut outcome = || {
            if noise == Noise::NONE {
                return sampler.sample(stream);
            }
            // The value is not folded yet, because flipped bits change y and T - y differently.
            let mut raw = if stream.uniform() < intact {
                let folded = sampler.sample(stream);
                let mirrored = stream.next_u64() >> 63 == 1;
                if mirrored {
                    (size - folded) & (size - 1)
                } else {
                    folded
                }
            } else {
                stream.next_u64() & (size - 1)
            };
            for bit in 0..phase_bits {
                raw ^= u64::from(stream.uniform() < noise.readout) << bit;
            }
            raw.min(size - raw)
        };
        let outcomes = (0..repetitions).map(|_| outcome()).collect();
        // The circuit measures the index, too.
        let theta = distribution.theta();
        let p = good_id(theta, phase_bits, window);
        self.measured_ids(size - 1, (p, 1.0 - p), u64::from(repetitions));
        Ok(outcomes)
    }
}
