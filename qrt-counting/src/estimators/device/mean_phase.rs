//! The mean-phase circuit, whose phase is a pixel's mean itself minus a reference.
//!
//! The circuit looks the phase `phi = 2 arctan(slope (x - reference))` of a path's colour x up and
//! has no comparator. With `R = 2 psi psi^T - 1` on the paths' uniform state `psi` and
//! `D = diag(exp(i phi))`, its iterate `U = D^(1/2) R D^(1/2)` turns by
//!
//! ```text
//! tan(lambda/2) = slope (mean - reference) / (1 + E[y^2]),    y = slope (x - reference),
//! ```
//!
//! to first order in the right side. One more qubit, in superposition, chooses the sign of all
//! phases, so that its branches are `U^k` and `U^-k`. Measured in the basis at angle b, it reads 0
//! with probability
//!
//! ```text
//! P(0) = (1 + Re(exp(-i b) <psi| U^(2k) |psi>)) / 2.
//! ```
//!
//! The path index is measured, too: a sample of the colours that prefers those far from the reference.

use super::Device;
use super::colours::Known;
use crate::estimators::{EstimatorError, MAX_ITERATIONS, Noise, id_bits};
use crate::mean_signal::{MeanSignal, MeanState};
use crate::random::Stream;
use crate::{Histogram, LevelCounts, Octaves};
use qrt_circuit::quantum::LevelPhases;

/// The outcome of a shot of the mean-phase circuit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MeanPhaseShot {
    /// The bit that the sign qubit reads.
    pub one: bool,
    /// The level of the measured path: the number of thresholds that its colour exceeds.
    pub level: u64,
}

impl<'a> Device<'a> {
    /// Creates a device that knows the levels of its paths one by one, and therefore runs the
    /// mean-phase circuit. It also does what a device of [`Device::of_octaves`] does.
    ///
    /// # Errors
    /// No paths, or noise out of range.
    pub fn of_histogram(
        histogram: &Histogram,
        noise: Noise,
        stream: &'a mut Stream,
    ) -> Result<Self, EstimatorError> {
        let mut device = Self::of_octaves(&Octaves::from(histogram), noise, stream)?;
        if let Some(known) = &mut device.known {
            known.levels = histogram.levels().collect();
            known.measured_levels = vec![[0; 2]; known.levels.len()];
        }
        Ok(device)
    }

    /// Creates a device that knows the levels of its paths as exactly as `levels` does: see
    /// [`Device::of_octaves`] and [`Device::of_histogram`].
    ///
    /// # Errors
    /// No paths, or noise out of range.
    pub fn of_levels(
        levels: &LevelCounts,
        noise: Noise,
        stream: &'a mut Stream,
    ) -> Result<Self, EstimatorError> {
        match levels {
            LevelCounts::Octaves(octaves) => Self::of_octaves(octaves, noise, stream),
            LevelCounts::Histogram(histogram) => Self::of_histogram(histogram, noise, stream),
        }
    }

    /// Number of the comparator's bits, if the levels of paths are known one by one.
    pub fn level_bits(&self) -> Option<u32> {
        let known = levels(self.known.as_deref()).is_ok();
        self.comparator_bits().filter(|_| known)
    }

    /// Levels of the paths, and the numbers of good indices and of others that counting circuits
    /// over the whole comparator have measured.
    pub(crate) fn measured_levels(&self) -> impl Iterator<Item = (u64, [u64; 2])> + Clone {
        let known = self.known.iter();
        known.flat_map(|known| {
            let levels = known.levels.iter().map(|&(level, _)| level);
            levels.zip(known.measured_levels.iter().copied())
        })
    }

    /// Runs the mean-phase circuit once, with `iterations` iterates, and measures the sign qubit at
    /// `basis` radians and the path. It takes one query more than iterations.
    ///
    /// A state that noise has destroyed, or that is misread, reads any path and either bit.
    ///
    /// # Errors
    /// The device does not know the levels of its paths, or has others than the phases; more
    /// iterations than [`MAX_ITERATIONS`].
    ///
    /// ```
    /// use qrt_circuit::quantum::LevelPhases;
    /// use qrt_counting::{Histogram, random::Stream};
    /// use qrt_counting::estimators::{Device, Noise};
    /// // All paths have one colour, 3/8 of the scale, which is the reference: no phase ever.
    /// let mut histogram = Histogram::new(3);
    /// histogram.add_all([3; 64]);
    /// let mut stream = Stream::new(1, 0, 0, 0);
    /// let mut device = Device::of_histogram(&histogram, Noise::NONE, &mut stream)?;
    /// let phases = LevelPhases::new(1.0, 0.375, 3, 12)?;
    /// let shot = device.mean_phase(phases, 1000, 0.0)?;
    /// assert!(!shot.one && shot.level == 3);
    /// assert_eq!(device.usage().queries, 1001);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn mean_phase(
        &mut self,
        phases: LevelPhases,
        iterations: u64,
        basis: f64,
    ) -> Result<MeanPhaseShot, EstimatorError> {
        if iterations > MAX_ITERATIONS {
            return Err(EstimatorError::TooManyIterations(iterations));
        }
        let bits = self.comparator_bits().unwrap_or_default();
        let levels = levels(self.known.as_deref())?;
        if bits != phases.level_bits() {
            return Err(EstimatorError::OtherLevels {
                device: bits,
                phases: phases.level_bits(),
            });
        }
        let signal = MeanSignal::new(levels, phases);
        let paths: u64 = levels.iter().map(|(_, paths)| paths).sum();
        let bits = id_bits(paths) + 1;
        let intact = self.noise.intact(iterations + 1) * self.noise.read_rightly(bits);
        let state = signal.state(iterations);
        let choice = self.stream.uniform();
        let shot = if self.noise != Noise::NONE && self.stream.uniform() >= intact {
            let path = self.stream.below(paths);
            let one = self.stream.next_u64() >> 63 == 1;
            MeanPhaseShot {
                one,
                level: nth_path(levels, path),
            }
        } else {
            let (one, group) = drawn(&state, basis, choice);
            let levels = signal.levels(group);
            let paths: u64 = levels.iter().map(|(_, paths)| paths).sum();
            let path = if levels.len() > 1 {
                self.stream.below(paths)
            } else {
                0
            };
            MeanPhaseShot {
                one,
                level: nth_path(levels, path),
            }
        };
        self.spend(1, iterations + 1);
        Ok(shot)
    }
}

/// Levels of the paths, each with its number of paths.
fn levels(known: Option<&Known>) -> Result<&[(u64, u64)], EstimatorError> {
    let levels = known.map_or(&[][..], |known| &known.levels);
    if levels.is_empty() {
        return Err(EstimatorError::NoLevels);
    }
    Ok(levels)
}

/// The level of path number `path`.
fn nth_path(levels: &[(u64, u64)], mut path: u64) -> u64 {
    for &(level, paths) in levels {
        if path < paths {
            return level;
        }
        path -= paths;
    }
    levels.last().map_or(0, |&(level, _)| level)
}

/// Draws the sign qubit's bit and a group of paths, at `choice` of all probability.
fn drawn(state: &MeanState, basis: f64, choice: f64) -> (bool, usize) {
    let mut left = choice;
    let mut last = (false, 0);
    let half_basis = libm::sincos(0.5 * basis);
    for group in 0..state.re.len() {
        for (one, amplitude) in [false, true]
            .into_iter()
            .zip(state.outcomes(group, half_basis))
        {
            let probability = amplitude * amplitude;
            if probability > 0.0 {
                last = (one, group);
            }
            if left < probability {
                return last;
            }
            left -= probability;
        }
    }
    last
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mean_phase_probabilities;

    /// Compares how often each outcome is drawn with its probability, with noise and without.
    #[test]
    fn shots_are_drawn_with_and_without_noise() {
        let mut histogram = Histogram::new(4);
        histogram.add_all([0, 0, 0, 1, 1, 2, 5, 16]);
        let levels: Vec<(u64, u64)> = histogram.levels().collect();
        let noisy = Noise {
            depolarising: 0.02,
            readout: 0.01,
        };
        let phases = LevelPhases::new(1.7, 0.2, 4, 5).unwrap();
        let shots = 40_000;
        for noise in [Noise::NONE, noisy] {
            for (k, basis) in [(0, 0.4), (1, -1.0), (6, 2.0)] {
                let mut stream = Stream::new(3, k as u32, 0, 0);
                let mut device = Device::of_histogram(&histogram, noise, &mut stream).unwrap();
                let mut found = vec![[0.0; 2]; levels.len()];
                for _ in 0..shots {
                    let shot = device.mean_phase(phases, k, basis).unwrap();
                    let place = levels.iter().position(|(level, _)| *level == shot.level);
                    found[place.unwrap()][usize::from(shot.one)] += 1.0 / f64::from(shots);
                }
                let predicted = mean_phase_probabilities(&levels, phases, k, basis);
                // The path index has three bits.
                let intact =
                    (1.0 - noise.depolarising).powi(k as i32 + 1) * (1.0 - noise.readout).powi(4);
                for ((place, found), predicted) in found.iter().enumerate().zip(predicted) {
                    for (found, predicted) in found.iter().zip(predicted) {
                        let any = levels[place].1 as f64 / 16.0;
                        let expected = intact * predicted + (1.0 - intact) * any;
                        let deviation = (expected * (1.0 - expected) / f64::from(shots)).sqrt();
                        assert!((found - expected).abs() < 5.0 * deviation + 1e-12);
                    }
                }
                let usage = device.usage();
                assert_eq!(usage.queries, u64::from(shots as u32) * (k + 1));
                assert_eq!((usage.depth, usage.good_ids), (k + 1, 0));
            }
        }
    }

    #[test]
    fn a_device_without_levels_has_no_mean_phase() {
        let mut octaves = Octaves::new(2);
        octaves.add(3);
        let mut stream = Stream::new(1, 0, 0, 0);
        let mut device = Device::of_octaves(&octaves, Noise::NONE, &mut stream).unwrap();
        let phases = LevelPhases::new(1.0, 0.5, 2, 8).unwrap();
        assert_eq!(device.level_bits(), None);
        assert_eq!(
            device.mean_phase(phases, 1, 0.0),
            Err(EstimatorError::NoLevels)
        );
        let mut histogram = Histogram::new(2);
        histogram.add_all([3]);
        let mut stream = Stream::new(1, 0, 0, 0);
        let mut device = Device::of_histogram(&histogram, Noise::NONE, &mut stream).unwrap();
        let deep = MAX_ITERATIONS + 1;
        let refused = Err(EstimatorError::TooManyIterations(deep));
        assert_eq!(device.mean_phase(phases, deep, 0.0), refused);
        assert_eq!(device.usage().shots, 0);
    }
}
