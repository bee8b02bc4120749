//! The posterior of theta after shots at several query depths.

use super::Goal;
use super::support::{self, Prior, Support};
use super::unbiased::{self, Evidence};
use crate::estimators::id_bits;
use crate::estimators::interval::credible_content;
use crate::estimators::{Device, Estimate, Noise, Usage};
use crate::vectorized::vectorized;
use std::f64::consts::PI;

/// Points with less than this mass are negligible. A cell is dropped if all its points are.
const NEGLIGIBLE: f64 = 1e-8;
/// Densities below this fraction of the greatest are rarely part of an interval.
const FAR_BELOW: f64 = 1e-4;
/// The largest grid step, in units of the standard deviation that the shots may have left. Sums
/// over points of a smooth density then agree with its integral to better than
/// `exp(-2 (pi/0.7)^2) = 3e-18`.
const COARSEST: f64 = 0.7;
/// The largest number of points of a grid.
const MOST_POINTS: f64 = 4096.0;
/// The smallest likelihood of an outcome, so that rounding cannot make data impossible.
const UNLIKELIEST: f64 = 1e-30;
/// Number of factors between two rescalings of a product.
const FACTORS: usize = 8;

/// Shots at one query depth.
#[derive(Clone, Copy, Debug)]
struct Shots {
    /// 2k + 1.
    multiple: u64,
    good: u64,
    bad: u64,
    /// The fraction of shots that noise leaves intact.
    intact: f64,
}

/// The posterior of theta = asin(sqrt(S/N))/pi, with a prior that is uniform over S in `0 ..= N`.
///
/// It is held at points ([`Support`]), which are coarse at first. If the shots require finer
/// points, it is recomputed from all shots, around every mode that still has mass. If few S are
/// left, these are the points.
#[derive(Clone, Debug)]
pub(super) struct Posterior {
    total: u64,
    noise: Noise,
    before: Prior,
    /// Number of bits of an index.
    bits: u32,
    support: Support,
    shots: Vec<Shots>,
    /// Fisher information of the shots about `pi theta`.
    information: f64,
    /// Mass of each point; they sum to 1.
    mass: Vec<f64>,
    prior: Vec<f64>,
    /// `pi theta` of each point, less the mean.
    deviations: Vec<f64>,
    /// The posterior with the square root of the likelihood.
    tempered: Tempered,
    /// `cos 2 pi theta` of each point.
    plain: Vec<f64>,
    mean: f64,
    variance: f64,
    /// The likelihood of a shot, as [`Posterior::look_at`] left it.
    cosines: Vec<f64>,
    /// The likelihood of the shot chosen so far, and its `2k + 1`; 0 if there is none.
    chosen: (u64, Vec<f64>),
}

/// The posterior in which every shot counts half, for the choice of query depths.
///
/// Outcomes of single shots at the best phase are as likely under one mode as under another, so a
/// wrong mode may come to seem certain. At an amplitude of 1/2, where every query depth gives good
/// and bad indices alike, no later outcome would contradict it. With half the certainty, the choice
/// keeps testing other modes: errors of many standard deviations become rare, at the price of a
/// tenth of the queries. (Bayesian amplitude estimation's annealing, Ramôa & Santos 2024, has the
/// same aim.)
#[derive(Clone, Debug, Default)]
struct Tempered {
    mass: Vec<f64>,
    deviations: Vec<f64>,
    variance: f64,
}

impl Tempered {
    #[inline(always)]
    fn update(&mut self, mass: &[f64], prior: &[f64], deviations: &[f64]) {
        self.mass.clear();
        self.mass.extend(
            mass.iter()
                .zip(prior)
                .map(|(mass, prior)| (mass * prior).sqrt()),
        );
        let scale = 1.0 / sum(&self.mass, &self.mass, |mass, _| mass);
        for mass in &mut self.mass {
            *mass *= scale;
        }
        let mean = sum(&self.mass, deviations, |mass, deviation| mass * deviation);
        self.deviations.clear();
        self.deviations
            .extend(deviations.iter().map(|deviation| deviation - mean));
        self.variance = sum(&self.mass, &self.deviations, |mass, deviation| {
            mass * deviation * deviation
        });
    }
}

impl Posterior {
    /// Creates the posterior before the first shot.
    pub(super) fn new(total: u64, noise: Noise, before: Prior) -> Self {
        let mut posterior = Self {
            total,
            noise,
            before,
            bits: id_bits(total),
            support: Support::whole(total),
            shots: Vec::new(),
            information: 0.0,
            mass: Vec::new(),
            prior: Vec::new(),
            deviations: Vec::new(),
            tempered: Tempered::default(),
            plain: Vec::new(),
            mean: 0.0,
            variance: 0.0,
            cosines: Vec::new(),
            chosen: (0, Vec::new()),
        };
        posterior.recompute();
        posterior
    }

    /// The variance of `pi theta`.
    pub(super) fn variance(&self) -> f64 {
        self.variance
    }

    /// The mean of `pi theta`, in units of 2^-64 turns.
    pub(super) fn mean_position(&self) -> u64 {
        let turns = self.mean * (18_446_744_073_709_551_616.0 / PI);
        self.support.position(0).wrapping_add_signed(turns as i64)
    }

    /// The mean distance of `pi theta` from its mean, scaled to the deviation of a normal
    /// posterior.
    ///
    /// Far modes with little mass count less here than in the standard deviation.
    pub(super) fn width(&self) -> f64 {
        let distance = |mass: f64, deviation: f64| mass * deviation.abs();
        sum(&self.mass, &self.deviations, distance) * (0.5 * PI).sqrt()
    }

    /// True if an interval of half-width `error` could hold most of the mass.
    ///
    /// For a wider posterior, the interval need not be computed.
    pub(super) fn could_reach(&self, error: f64) -> bool {
        let place = support::radians(self.mean_position());
        let slope = libm::sin(2.0 * place).abs();
        slope * self.width() < 4.0 * error
    }

    /// The fraction of shots after `iterations` iterations that noise leaves intact.
    pub(super) fn intact(&self, iterations: u64) -> f64 {
        if self.noise == Noise::NONE || iterations == 0 {
            1.0
        } else {
            self.noise.intact(iterations) * self.noise.read_rightly(self.bits)
        }
    }

    /// The largest number of iterations that is useful.
    ///
    /// On a grid, the posterior can still be held after it: many modes need many points. On
    /// integers, it distinguishes neighbouring ones.
    pub(super) fn deepest(&self) -> f64 {
        let Some(step) = self.support.step() else {
            // Neighbours at a distance d differ most if `2 (2k + 1) d` is half a turn.
            return 0.25 * PI / self.support.least_distance();
        };
        let length = step * self.support.len() as f64;
        let most = MOST_POINTS * COARSEST / length;
        0.25 * (most * most - self.information).max(0.0).sqrt()
    }

    /// The expected variance after one more shot, as a fraction of the present variance.
    ///
    /// The variances are those of the posterior in which shots count half.
    ///
    /// With `C = E[c]` and `D = E[(x - mean) c]` of `c = 1 - 2 P(good)`, a shot leaves
    /// `V - D^2/(1 - C^2)` on average.
    pub(super) fn remaining_variance(&mut self, iterations: u64) -> f64 {
        if self.tempered.variance <= 0.0 {
            return 1.0;
        }
        self.look_at(2 * iterations + 1, self.intact(iterations));
        let Tempered {
            mass, deviations, ..
        } = &self.tempered;
        let [even, odd] = vectorized(
            #[inline(always)]
            || products(mass, deviations, &self.cosines),
        );
        let spread = (1.0 - even * even).max(f64::MIN_POSITIVE);
        (1.0 - odd * odd / (spread * self.tempered.variance)).clamp(0.0, 1.0)
    }

    /// Adds shots after `iterations` iterations: `good` good ones and `bad` others.
    pub(super) fn observe(&mut self, iterations: u64, good: u64, bad: u64) {
        let intact = self.intact(iterations);
        let shots = Shots {
            multiple: 2 * iterations + 1,
            good,
            bad,
            intact,
        };
        self.shots.push(shots);
        let slope = 2.0 * shots.multiple as f64 * intact;
        self.information += slope * slope * (good + bad) as f64;
        if let Some(step) = self.support.step()
            && step * self.information.sqrt() > COARSEST
        {
            self.refine(step);
            return;
        }
        let mut mass = std::mem::take(&mut self.mass);
        self.multiply(shots, &mut mass);
        self.mass = mass;
        self.summarise();
        self.prune();
    }

    /// Drops cells without mass, if they hold at least a quarter of the points.
    fn prune(&mut self) {
        let held = |mass: &[f64]| mass.iter().any(|&mass| mass > NEGLIGIBLE);
        let width = self.support.width();
        let empty = self.mass.chunks(width).filter(|chunk| !held(chunk)).count();
        if 4 * empty * width < self.mass.len() {
            return;
        }
        let kept: Vec<bool> = self.mass.chunks(width).map(held).collect();
        self.support.retain(&kept);
        self.chosen.0 = 0;
        for values in [&mut self.mass, &mut self.prior, &mut self.plain] {
            let mut chunk = 0..values.len();
            values.retain(|_| chunk.next().is_some_and(|index| kept[index / width]));
        }
        self.summarise();
    }

    /// Moves to a grid two to four times finer than the shots require.
    ///
    /// The next few shots then need no other grid. Cells that had no mass before the last shots are
    /// dropped.
    fn refine(&mut self, step: f64) {
        let mut finer = 1;
        while step * self.information.sqrt() > COARSEST * f64::from(1_u32 << (finer - 1)) {
            finer += 1;
        }
        self.refine_by(finer);
    }

    fn refine_by(&mut self, finer: u32) {
        let mass = std::mem::take(&mut self.mass);
        self.support = (self.support).refined(|index| mass[index] > NEGLIGIBLE, finer, self.total);
        self.recompute();
    }

    /// Returns the posterior on a grid fine enough to read off an interval's ends.
    pub(super) fn sharpened(mut self) -> Self {
        let fine = (self.support.step()).is_none_or(|step| step * self.information.sqrt() < 0.1);
        if !fine {
            self.refine_by(2);
        }
        self
    }

    fn recompute(&mut self) {
        self.prior = self.support.prior(self.before, self.total);
        let mut mass = self.prior.clone();
        self.support.cosines(1, &mut self.plain);
        self.chosen.0 = 0;
        for index in 0..self.shots.len() {
            self.multiply(self.shots[index], &mut mass);
            if index % FACTORS == FACTORS - 1 {
                rescale(&mut mass);
            }
        }
        self.mass = mass;
        self.summarise();
    }

    /// Multiplies `mass` by the likelihood of `shots`, up to a common factor.
    fn multiply(&mut self, shots: Shots, mass: &mut [f64]) {
        if self.chosen.0 == shots.multiple {
            std::mem::swap(&mut self.cosines, &mut self.chosen.1);
        } else {
            self.look_at(shots.multiple, shots.intact);
        }
        self.chosen.0 = 0;
        if shots.good + shots.bad == 1 {
            let sign = if shots.good == 1 { -0.5 } else { 0.5 };
            let cosines = &self.cosines;
            vectorized(
                #[inline(always)]
                || {
                    for (mass, cosine) in mass.iter_mut().zip(cosines) {
                        *mass *= (0.5 + sign * cosine).max(UNLIKELIEST);
                    }
                },
            );
            return;
        }
        multiply_many(shots, &self.cosines, mass);
    }

    /// Keeps the likelihood of the shot that was last looked at, for when it is made.
    pub(super) fn keep_likelihood(&mut self, iterations: u64) {
        self.chosen.0 = 2 * iterations + 1;
        std::mem::swap(&mut self.cosines, &mut self.chosen.1);
    }

    /// Sets the cosines to `1 - 2 P(good)` of a shot.
    ///
    /// Noise mixes them with those of a destroyed state, which is good with probability S/N.
    fn look_at(&mut self, multiple: u64, intact: f64) {
        self.support.cosines(multiple, &mut self.cosines);
        if intact < 1.0 {
            for (cosine, plain) in self.cosines.iter_mut().zip(&self.plain) {
                *cosine = intact * *cosine + (1.0 - intact) * plain;
            }
        }
    }

    fn summarise(&mut self) {
        self.support.places(&mut self.deviations);
        vectorized(
            #[inline(always)]
            || self.set_moments(),
        );
    }

    /// Makes the masses add up to 1, and sets moments and [`Tempered`] from them and the places of
    /// points.
    #[inline(always)]
    fn set_moments(&mut self) {
        let scale = 1.0 / sum(&self.mass, &self.mass, |mass, _| mass);
        for mass in &mut self.mass {
            *mass *= scale;
        }
        let mean = sum(&self.mass, &self.deviations, |mass, place| mass * place);
        for deviation in &mut self.deviations {
            *deviation -= mean;
        }
        self.mean = mean;
        self.variance = sum(&self.mass, &self.deviations, |mass, deviation| {
            mass * deviation * deviation
        });
        self.tempered
            .update(&self.mass, &self.prior, &self.deviations);
    }

    /// The variance of the fraction of good indices, `(1 - cos 2 pi theta)/2`.
    pub(super) fn amplitude_variance(&self) -> f64 {
        let mean = sum(&self.mass, &self.plain, |mass, cosine| mass * cosine);
        let square = |mass: f64, cosine: f64| mass * (cosine - mean) * (cosine - mean);
        0.25 * sum(&self.mass, &self.plain, square)
    }

    /// Mean and standard deviation of the fraction of good indices, if each shot counted half: see [`Tempered`].
    pub(super) fn tempered_amplitude(&self) -> (f64, f64) {
        let points = || {
            let masses = self.tempered.mass.iter().enumerate();
            masses.map(|(index, mass)| (*mass, self.support.amplitude(index, self.total)))
        };
        let mean: f64 = points().map(|(mass, amplitude)| mass * amplitude).sum();
        let square = |(mass, amplitude): (f64, f64)| mass * (amplitude - mean) * (amplitude - mean);
        (
            mean.clamp(0.0, 1.0),
            points().map(square).sum::<f64>().sqrt(),
        )
    }

    /// The mean fraction of good indices.
    pub(super) fn mean_amplitude(&self) -> f64 {
        let mean: f64 = (self.mass.iter().enumerate())
            .map(|(index, mass)| mass * self.support.amplitude(index, self.total))
            .sum();
        mean.clamp(0.0, 1.0)
    }

    /// The fraction of good indices under [`Prior::Even`], nearly without bias: see [`unbiased`].
    pub(super) fn unbiased_amplitude(&self) -> f64 {
        let mut evidence = Evidence::default();
        for shots in &self.shots {
            evidence.note(shots.multiple, [shots.good, shots.bad], shots.intact);
        }
        let point = |(index, &mass)| (mass, self.support.amplitude(index, self.total));
        let points = self.mass.iter().enumerate().map(point);
        unbiased::amplitude(points, evidence).unwrap_or_else(|| self.mean_amplitude())
    }

    /// The estimate of a run under [`Prior::Even`], with the interval of likeliest points.
    ///
    /// See [`Self::unbiased_amplitude`] and [`Self::interval`]. If `goal` has an error, the
    /// estimate is the posterior mean, which lies nearer the middle of the interval: the requested
    /// error bounds the error of each pixel, not that of the picture.
    pub(super) fn estimate(&self, device: &Device<'_>, start: Usage, goal: &Goal) -> Estimate {
        let confidence = goal.confidence;
        let (low, high) = self.interval(confidence);
        let amplitude = match goal.error {
            Some(_) => self.mean_amplitude(),
            None => self.unbiased_amplitude(),
        };
        let interval = (low.min(amplitude), high.max(amplitude));
        Estimate {
            good: self.likeliest().map(|(good, _)| good),
            candidates: Some(self.candidates()),
            ..device.estimate(start, amplitude, interval, confidence)
        }
    }

    /// The likeliest S and its probability, if the points are integers.
    pub(super) fn likeliest(&self) -> Option<(u64, f64)> {
        let Support::Integers(integers) = &self.support else {
            return None;
        };
        (integers.iter().zip(&self.mass))
            .map(|(&(good, _), &mass)| (good, mass))
            .max_by(|a, b| a.1.total_cmp(&b.1))
    }

    /// Number of ranges without a gap that hold mass.
    pub(super) fn candidates(&self) -> u32 {
        let runs = self.support.runs();
        let held = |&&(first, last): &&(usize, usize)| {
            self.mass[first..=last].iter().sum::<f64>() > NEGLIGIBLE
        };
        runs.iter().filter(held).count() as u32
    }

    /// The range of the posterior's region of highest density.
    ///
    /// The region is the points of highest likelihood that hold [`credible_content`] of the mass.
    pub(super) fn interval(&self, confidence: f64) -> (f64, f64) {
        let content = credible_content(confidence);
        let density = |index: usize| self.mass[index] / self.prior[index];
        // The coverage is that of an even prior, whatever the prior of the posterior.
        let mass = match self.before {
            Prior::Even => None,
            Prior::Ends => {
                let mut mass = self.support.prior(Prior::Even, self.total);
                for (index, mass) in mass.iter_mut().enumerate() {
                    *mass *= density(index);
                }
                let scale = 1.0 / mass.iter().sum::<f64>();
                for mass in &mut *mass {
                    *mass *= scale;
                }
                Some(mass)
            }
        };
        let mass = mass.as_ref().unwrap_or(&self.mass);
        // Most points are far below the likeliest and hardly ever needed, so they are sorted
        // separately.
        let greatest = (0..mass.len()).map(density).fold(0.0, f64::max);
        let (mut held, mut first, mut last) = (0.0, usize::MAX, 0);
        for far in [false, true] {
            let asked = |index: &usize| (density(*index) < FAR_BELOW * greatest) == far;
            let count = (0..mass.len()).filter(asked).count();
            let mut points = Vec::with_capacity(count);
            points.extend(
                (0..mass.len())
                    .filter(asked)
                    .map(|index| (density(index), index)),
            );
            points.sort_by(|a, b| b.0.total_cmp(&a.0));
            for (_, index) in points {
                if held >= content {
                    break;
                }
                held += mass[index];
                (first, last) = (first.min(index), last.max(index));
            }
            if held >= content {
                break;
            }
        }
        let low = self.support.ends(first, self.total).0;
        let high = self.support.ends(last, self.total).1;
        (low, high)
    }
}

/// The sums of `mass cosine` and of `mass deviation cosine`, in parallel sums, one per lane.
#[inline(always)]
fn products(mass: &[f64], deviations: &[f64], cosines: &[f64]) -> [f64; 2] {
    let (mut even, mut odd) = ([0.0; support::LANES], [0.0; support::LANES]);
    let (masses, rest_of_masses) = mass.as_chunks::<{ support::LANES }>();
    let (deviations, rest_of_deviations) = deviations.as_chunks::<{ support::LANES }>();
    let (cosines, rest_of_cosines) = cosines.as_chunks::<{ support::LANES }>();
    for ((mass, deviation), cosine) in masses.iter().zip(deviations).zip(cosines) {
        let terms: [f64; support::LANES] = std::array::from_fn(|lane| mass[lane] * cosine[lane]);
        for lane in 0..support::LANES {
            even[lane] += terms[lane];
        }
        for lane in 0..support::LANES {
            odd[lane] += terms[lane] * deviation[lane];
        }
    }
    let rest = rest_of_masses.iter().zip(rest_of_deviations);
    for (lane, ((mass, deviation), cosine)) in rest.zip(rest_of_cosines).enumerate() {
        even[lane] += mass * cosine;
        odd[lane] += mass * cosine * deviation;
    }
    [even, odd].map(|sums| sums.iter().sum())
}

/// Sums `term` over pairs of numbers, in parallel sums, one per lane.
#[inline(always)]
fn sum(a: &[f64], b: &[f64], term: impl Fn(f64, f64) -> f64) -> f64 {
    let mut sums = [0.0; support::LANES];
    let (a, rest_a) = a.as_chunks::<{ support::LANES }>();
    let (b, rest_b) = b.as_chunks::<{ support::LANES }>();
    for (a, b) in a.iter().zip(b) {
        for ((sum, a), b) in sums.iter_mut().zip(a).zip(b) {
            *sum += term(*a, *b);
        }
    }
    for ((sum, a), b) in sums.iter_mut().zip(rest_a).zip(rest_b) {
        *sum += term(*a, *b);
    }
    let [a, b, c, d, e, f, g, h] = sums;
    ((a + e) + (c + g)) + ((b + f) + (d + h))
}

fn rescale(mass: &mut [f64]) {
    let largest = mass.iter().copied().fold(0.0, f64::max);
    for mass in mass {
        *mass /= largest;
    }
}

/// Multiplies `mass` by the likelihood of many shots at one query depth.
///
/// The factors come from logarithms relative to the likeliest point, so that large counts multiply
/// small numbers.
fn multiply_many(shots: Shots, cosines: &[f64], mass: &mut [f64]) {
    let (good, bad) = (shots.good as f64, shots.bad as f64);
    // P(good) = (1 - c)/2, so the likelihood is largest at this c.
    let best = (bad - good) / (good + bad);
    let nearest = (cosines.iter().copied())
        .min_by(|a, b| (a - best).abs().total_cmp(&(b - best).abs()))
        .unwrap_or(best)
        .clamp(1e-15 - 1.0, 1.0 - 1e-15);
    let ln = |count: f64, ratio: f64| {
        if count == 0.0 {
            0.0
        } else {
            count * libm::log1p(ratio.max(UNLIKELIEST - 1.0))
        }
    };
    let terms = |c: f64| {
        let change = c - nearest;
        ln(good, -change / (1.0 - nearest)) + ln(bad, change / (1.0 + nearest))
    };
    let logarithms: Vec<f64> = cosines.iter().map(|&c| terms(c)).collect();
    let largest = logarithms.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    for (mass, logarithm) in mass.iter_mut().zip(logarithms) {
        *mass *= libm::exp(logarithm - largest).max(UNLIKELIEST);
    }
}
