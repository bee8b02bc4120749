//! The posterior of a mean, on a grid that narrows around it.

use std::f64::consts::{FRAC_PI_2, PI};

/// Number of points.
const POINTS: usize = 256;
/// Half the width of the first grid, in standard deviations.
const FIRST: f64 = 14.0;
/// The probability that is cut off at either end when the grid narrows.
const TAIL: f64 = 1e-5;
/// The grid narrows if its points between the tails are at most this fraction of all.
const NARROW: f64 = 0.75;
/// The smallest depth that is considered, in standard deviations of the phase.
const REACH: f64 = 0.25;
/// Number of multiples of that depth that are considered.
const MULTIPLES: u64 = 5;
/// The largest phase between two points, in radians.
const COARSEST: f64 = 0.7;
/// Number of angles of measurement that are considered, over half a turn.
const ANGLES: u32 = 16;
/// The arctangent of a smaller number is its series of three terms, to 2e-8.
const NEAR: f64 = 0.1;

/// A shot: its depth, and the angle at which it is measured.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plan {
    pub(super) iterations: u64,
    pub(super) basis: f64,
}

/// Probabilities of a mean at equidistant points in [0, 1].
#[derive(Clone, Debug)]
pub(super) struct Grid {
    low: f64,
    step: f64,
    /// They add up to 1 after [`Grid::moments`].
    probabilities: Vec<f64>,
    /// Eigenphases at the points, in radians.
    phases: Vec<f64>,
}

impl Grid {
    /// A posterior with heavy tails around a mean.
    pub(super) fn around(mean: f64, deviation: f64) -> Self {
        let low = (mean - FIRST * deviation).max(0.0);
        let high = (mean + FIRST * deviation).min(1.0);
        let mut grid = Self {
            low,
            step: (high - low) / (POINTS - 1) as f64,
            probabilities: Vec::new(),
            phases: vec![0.0; POINTS],
        };
        // Student's distribution of four degrees of freedom.
        grid.probabilities = (0..POINTS)
            .map(|point| {
                let z = (grid.position(point) - mean) / deviation;
                libm::pow(1.0 + 0.25 * z * z, -2.5)
            })
            .collect();
        grid
    }

    fn position(&self, point: usize) -> f64 {
        self.low + self.step * point as f64
    }

    /// Mean and standard deviation. Makes the probabilities add up to 1.
    pub(super) fn moments(&mut self) -> (f64, f64) {
        let (mut sum, mut first, mut second) = (0.0, 0.0, 0.0);
        for (point, probability) in self.probabilities.iter().enumerate() {
            let x = point as f64;
            sum += probability;
            first += probability * x;
            second += probability * x * x;
        }
        for probability in &mut self.probabilities {
            *probability /= sum;
        }
        let mean = first / sum;
        let variance = (second / sum - mean * mean).max(0.0);
        let mean = (self.low + self.step * mean).clamp(0.0, 1.0);
        (mean, self.step * variance.sqrt())
    }

    /// Cuts the tails off, if a good part of the points is in them, and interpolates between the
    /// others.
    pub(super) fn narrow(&mut self) {
        fn tail<'a>(probabilities: impl Iterator<Item = &'a f64>) -> usize {
            let sums = probabilities.scan(0.0, |sum, probability| {
                *sum += probability;
                Some(*sum)
            });
            sums.take_while(|sum| *sum < TAIL).count()
        }
        let first = tail(self.probabilities.iter()).saturating_sub(1);
        let last = POINTS - tail(self.probabilities.iter().rev()).max(1);
        if (last - first) as f64 > NARROW * POINTS as f64 {
            return;
        }
        let at = |point: usize| self.probabilities[point.min(POINTS - 1)];
        let step = (last - first) as f64 / (POINTS - 1) as f64;
        let between = |point: usize| {
            let place = first as f64 + step * point as f64;
            let n = (place as usize).min(POINTS - 2);
            let t = place - n as f64;
            let [before, from, to, after] = [at(n.saturating_sub(1)), at(n), at(n + 1), at(n + 2)];
            // Catmull and Rom's cubic, which may fall below zero beside a steep slope.
            let cubic = 3.0 * (from - to) + after - before;
            let square = 2.0 * before - 5.0 * from + 4.0 * to - after;
            let value = from + 0.5 * t * (to - before + t * (square + t * cubic));
            value.max(0.5 * from.min(to))
        };
        self.probabilities = (0..POINTS).map(between).collect();
        self.low += first as f64 * self.step;
        self.step *= step;
    }

    /// Sets the eigenphases at the points for a circuit with this gain and reference.
    pub(super) fn aim(&mut self, gain: f64, reference: f64) {
        let tangent = |point: usize| 0.5 * gain * (self.position(point) - reference);
        let near = tangent(0).abs().max(tangent(POINTS - 1).abs()) < NEAR;
        let phase = |tangent: f64| {
            let square = tangent * tangent;
            2.0 * if near {
                tangent * (1.0 - square * (1.0 / 3.0 - square * 0.2))
            } else {
                libm::atan(tangent)
            }
        };
        self.phases = (0..POINTS).map(|point| phase(tangent(point))).collect();
    }

    /// The depth and the angle that are expected to sharpen the posterior most per query.
    ///
    /// The posterior's standard deviation is `deviation`. A shot takes one query more than iterates,
    /// of which there are at most `most`; noise leaves about `coherent` of them intact.
    pub(super) fn choose(
        &self,
        (gain, deviation): (f64, f64),
        (most, coherent): (u64, f64),
        visibility: impl Fn(u64) -> f64,
    ) -> Plan {
        let mut plan = Plan {
            iterations: 1,
            basis: FRAC_PI_2,
        };
        let coarsest = 0.5 * COARSEST / (gain * self.step);
        let unit = (0.5 * REACH / (gain * deviation)).min(coarsest);
        let unit = unit.min(coherent / MULTIPLES as f64).round();
        let unit = (unit as u64).clamp(1, most);
        let turns = self.phases.iter();
        let turns: Vec<_> = turns
            .map(|phase| libm::sincos(2.0 * unit as f64 * phase))
            .collect();
        let mut multiples = vec![(0.0, 1.0); POINTS];
        let mut best = 0.0;
        for multiple in 1..=MULTIPLES {
            let k = multiple * unit;
            if k > most || multiple > 1 && k as f64 > coarsest {
                break;
            }
            for ((sine, cosine), turn) in multiples.iter_mut().zip(&turns) {
                (*sine, *cosine) = (
                    *sine * turn.1 + *cosine * turn.0,
                    *cosine * turn.1 - *sine * turn.0,
                );
            }
            let (rest, basis) = self.rest(&multiples, visibility(k));
            let worth = (1.0 / rest.max(1e-9).sqrt() - 1.0) / (k + 1) as f64;
            if worth > best {
                best = worth;
                plan = Plan {
                    iterations: k,
                    basis,
                };
            }
        }
        plan
    }

    /// The smallest part of the variance that a shot is expected to leave, over all angles, and the
    /// angle. `turns` are sine and cosine of the shot's phase at every point.
    fn rest(&self, turns: &[(f64, f64)], visibility: f64) -> (f64, f64) {
        // Sums of the probabilities times 1, x and x^2, alone and times the cosine and the sine.
        let mut sums = [[0.0; 3]; 3];
        for (point, (probability, (sine, cosine))) in
            self.probabilities.iter().zip(turns).enumerate()
        {
            let x = point as f64 - 0.5 * POINTS as f64;
            for (sums, factor) in sums.iter_mut().zip([1.0, x, x * x]) {
                let p = probability * factor;
                sums[0] += p;
                sums[1] += p * cosine;
                sums[2] += p * sine;
            }
        }
        let variance = sums[2][0] - sums[1][0] * sums[1][0];
        let at = |angle: u32| {
            let basis = f64::from(angle) * PI / f64::from(ANGLES);
            let (sine, cosine) = libm::sincos(basis);
            let after = |sign: f64| {
                let [weight, first, second] =
                    sums.map(|[sum, c, s]| sum + sign * visibility * (c * cosine + s * sine));
                0.5 * (second - first * first / weight)
            };
            ((after(1.0) + after(-1.0)) / variance, basis)
        };
        let all = (0..ANGLES).map(at);
        all.min_by(|a, b| a.0.total_cmp(&b.0))
            .unwrap_or((1.0, FRAC_PI_2))
    }

    /// Takes the outcome of a shot into account.
    pub(super) fn observe(&mut self, plan: &Plan, visibility: f64, one: bool) {
        let signed = if one { -visibility } else { visibility };
        for (probability, phase) in self.probabilities.iter_mut().zip(&self.phases) {
            let angle = 2.0 * plan.iterations as f64 * phase - plan.basis;
            *probability *= 1.0 + signed * libm::cos(angle);
        }
    }
}
