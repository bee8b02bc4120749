//! Colours of measured paths, and what the mean-phase circuit takes from them.

use crate::elementary::{arctangent, sincos};
use crate::vectorized::vectorized;
use qrt_circuit::quantum::LevelPhases;
use std::f64::consts::FRAC_PI_2;

/// sigma times the slope: the colours' standard deviation in units of the phases. The signal turns
/// fastest at 1, and is seen best at less.
const ETA: f64 = 0.6;
/// Number of paths that may have been missed at any colour.
const UNSEEN: f64 = 1.5;
/// Number of octaves of colours that may have been missed.
const OCTAVES: u32 = 8;

/// A colour in [0, 1], how often it was measured, and the density of measurements.
#[derive(Clone, Copy, Debug)]
struct Seen {
    colour: f64,
    times: f64,
    /// The expected number of measurements of a path of this colour, in units of that of a path
    /// drawn at random once.
    density: f64,
}

/// A shot of the mean-phase circuit, and the density of the paths that it measures.
#[derive(Clone, Copy, Debug)]
struct Shot {
    slope: f64,
    reference: f64,
    iterations: f64,
    /// The inverse of the mean density of all colours.
    norm: f64,
    /// The probability that noise leaves the shot intact. Otherwise it measures any path.
    intact: f64,
}

impl Shot {
    /// The probability to measure a path of this colour, over its fraction of all paths.
    #[inline(always)]
    fn density(&self, colour: f64) -> f64 {
        self.with_noise(self.ideal(colour))
    }

    #[inline(always)]
    fn with_noise(&self, ideal: f64) -> f64 {
        1.0 + self.intact * (ideal * self.norm - 1.0)
    }

    /// The density without noise, up to [`Self::norm`].
    ///
    /// Let the other paths keep their amplitude. Each iterate then takes a path's amplitude a to
    /// `exp(i phi) (2 - a)`. It turns around `sqrt(1 + y^2)`, y = tan(phi/2), by `phi + pi` an
    /// iterate: a path far from the reference takes many iterates to be seen.
    #[inline(always)]
    fn ideal(&self, colour: f64) -> f64 {
        let y = self.slope * (colour - self.reference);
        let centre = (1.0 + y * y).sqrt();
        // The arctangent of 1/|y|, which is small where |y| is large.
        let steep = arctangent(1.0 / y.abs().max(1.0));
        let flat = FRAC_PI_2 - arctangent(y.abs().min(1.0));
        let half = if y.abs() > 1.0 { steep } else { flat };
        let (sine, _) = sincos(self.iterations * half);
        1.0 + 4.0 * centre * (centre - 1.0) * sine * sine
    }
}

/// Colours of measured paths, each with the weight that undoes the circuits' preference.
///
/// All shots together are one sample, whose density is the sum of theirs (the *balance heuristic*
/// of Veach & Guibas 1995). So a colour that one kind of shot would show rarely, and another often,
/// has the weight of the latter.
#[derive(Clone, Debug)]
pub(super) struct Colours {
    all: f64,
    /// The density of the first measurements at the colours 0 and 1, between which it is linear.
    first: [f64; 2],
    /// Number of measurements.
    times: f64,
    /// In ascending order.
    seen: Vec<Seen>,
    /// Colours that no path may have: they bound the variance that has been missed.
    unseen: Vec<Seen>,
    shots: Vec<Shot>,
}

/// Properties of the circuit at a reference, as the colours show them.
#[derive(Clone, Copy, Debug)]
pub(super) struct Spread {
    /// The standard deviation of colours, with that of colours that may have been missed.
    pub(super) deviation: f64,
    /// The variance of the measured colours alone.
    pub(super) seen: f64,
    /// The factor of a colour's distance from the reference.
    pub(super) slope: f64,
    /// The eigenphase over the mean's distance from the reference.
    pub(super) gain: f64,
    /// The fraction of the signal that has this eigenphase.
    pub(super) visibility: f64,
}

/// The value at `x` of the line through these values at 0 and 1.
fn between([zero, one]: [f64; 2], x: f64) -> f64 {
    zero + (one - zero) * x
}

/// The variance that paths may add which `times` measurements have missed.
///
/// Their mean colour is at most that of all paths, so they are fewer the brighter they are.
pub(super) fn missed(mean: f64, times: f64) -> f64 {
    let rare = 0.5 / (times + 1.0);
    let mean = mean.clamp(rare, 1.0 - rare);
    UNSEEN * mean * (1.0 - mean) / times
}

impl Colours {
    /// The colours of paths drawn at random: levels over `2^bits`, and how often they were drawn.
    pub(super) fn of_random(levels: impl Iterator<Item = (u64, u64)>, bits: u32) -> Self {
        let levels: Vec<(u64, u64)> = levels.collect();
        let drawn: u64 = levels.iter().map(|(_, times)| times).sum();
        Self::new(levels.into_iter(), bits, [drawn as f64; 2])
    }

    /// The colours of paths that counting circuits measured: levels over `2^bits`, each with its numbers of good
    /// indices and of others.
    ///
    /// A good index has a path of colour x with a probability in proportion to x, and any other index in
    /// proportion to 1 - x. `amplitude` is the fraction of good indices, neither 0 nor 1.
    pub(super) fn of_counted(
        levels: impl Iterator<Item = (u64, [u64; 2])> + Clone,
        bits: u32,
        amplitude: f64,
    ) -> Self {
        let [good, others] = [0, 1].map(|which| {
            let sum: u64 = levels.clone().map(|(_, found)| found[which]).sum();
            sum as f64
        });
        let levels = levels.map(|(level, [good, others])| (level, good + others));
        Self::new(levels, bits, [others / (1.0 - amplitude), good / amplitude])
    }

    /// Levels over `2^bits`, how often they were measured, and the density of the measurements at the colours 0
    /// and 1.
    fn new(levels: impl Iterator<Item = (u64, u64)>, bits: u32, first: [f64; 2]) -> Self {
        let all = (1_u64 << bits) as f64;
        let entry = |(colour, times)| Seen {
            colour,
            times,
            density: between(first, colour),
        };
        let measured = levels.filter(|&(_, times)| times > 0);
        let measured = measured.map(|(level, times)| entry((level as f64 / all, times as f64)));
        let seen: Vec<Seen> = measured.collect();
        let bright = (0..=2 * OCTAVES).map(|n| libm::exp2(-0.5 * f64::from(n)));
        let unseen = bright.chain([0.0]).map(|colour| entry((colour, 0.0)));
        Self {
            all,
            first,
            times: seen.iter().map(|seen| seen.times).sum(),
            unseen: unseen.collect(),
            seen,
            shots: Vec::new(),
        }
    }

    /// The mean of the colours.
    pub(super) fn mean(&self) -> f64 {
        let (mut weights, mut sum) = (0.0, 0.0);
        for seen in &self.seen {
            let weight = seen.times / seen.density;
            weights += weight;
            sum += weight * seen.colour;
        }
        if weights > 0.0 { sum / weights } else { 0.0 }
    }

    /// The standard error of the mean of the colours, with what colours may add that have been missed.
    pub(super) fn error_of_mean(&self, mean: f64) -> f64 {
        let (mut weights, mut squares) = (0.0, 0.0);
        for seen in &self.seen {
            let off = (seen.colour - mean) / seen.density;
            weights += seen.times / seen.density;
            squares += seen.times * off * off;
        }
        let missed = self
            .unseen
            .iter()
            .map(|seen| (seen.colour - mean).abs() / seen.density);
        let missed = UNSEEN * missed.fold(0.0, f64::max);
        (squares.sqrt() / weights).hypot(missed)
    }

    /// Number of measurements.
    pub(super) fn times(&self) -> f64 {
        self.times
    }

    /// Adds the level that a shot of the mean-phase circuit measured after k iterates.
    ///
    /// Noise has left the shot intact with probability `intact`.
    pub(super) fn add(&mut self, level: u64, phases: &LevelPhases, k: u64, intact: f64) {
        let mut shot = Shot {
            slope: phases.slope(),
            reference: phases.reference(),
            iterations: k as f64,
            norm: 1.0,
            intact,
        };
        let colours = self.seen.iter().chain(&self.unseen);
        let mut densities: Vec<f64> = colours.map(|seen| seen.colour).collect();
        vectorized(
            #[inline(always)]
            || {
                for density in &mut densities {
                    *density = shot.ideal(*density);
                }
            },
        );
        let (mut weights, mut sum) = (0.0, 0.0);
        for (seen, density) in self.seen.iter().zip(&densities) {
            let weight = seen.times / seen.density;
            weights += weight;
            sum += weight * density;
        }
        if sum > 0.0 {
            shot.norm = weights / sum;
        }
        for (seen, density) in self.seen.iter_mut().chain(&mut self.unseen).zip(densities) {
            seen.density += shot.with_noise(density);
        }
        self.shots.push(shot);
        self.times += 1.0;
        let colour = level as f64 / self.all;
        match (self.seen).binary_search_by(|seen| seen.colour.total_cmp(&colour)) {
            Ok(place) => self.seen[place].times += 1.0,
            Err(place) => {
                let mut densities = vec![0.0; self.shots.len()];
                vectorized(
                    #[inline(always)]
                    || {
                        for (density, shot) in densities.iter_mut().zip(&self.shots) {
                            *density = shot.density(colour);
                        }
                    },
                );
                let new = Seen {
                    colour,
                    times: 1.0,
                    density: between(self.first, colour) + densities.iter().sum::<f64>(),
                };
                self.seen.insert(place, new);
            }
        }
    }

    /// The circuit's properties at this reference.
    pub(super) fn at(&self, reference: f64) -> Spread {
        let square = |seen: &Seen| {
            let distance = seen.colour - reference;
            distance * distance
        };
        let (mut weights, mut sum) = (0.0, 0.0);
        for seen in &self.seen {
            let weight = seen.times / seen.density;
            weights += weight;
            sum += weight * square(seen);
        }
        let known = if weights > 0.0 { sum / weights } else { 0.0 };
        let unseen = self.unseen.iter().map(|seen| square(seen) / seen.density);
        let unseen = UNSEEN * unseen.fold(0.0, f64::max);
        let unseen = unseen.min(missed(reference, self.times));
        let deviation = (known + unseen).sqrt();
        let slope = ETA / deviation;
        // E[y^2], with colours that have been missed.
        let square_of_y = ETA * ETA;
        let mut lengths = 0.0;
        for seen in &self.seen {
            lengths += seen.times / seen.density * (1.0 + slope * slope * square(seen)).sqrt();
        }
        let length = if weights > 0.0 {
            lengths / weights
        } else {
            1.0
        };
        Spread {
            deviation,
            seen: known,
            slope,
            gain: 2.0 * slope / (1.0 + square_of_y),
            visibility: (length * length / (1.0 + square_of_y)).min(1.0),
        }
    }
}
