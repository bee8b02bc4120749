//! The state of the mean-phase circuit, exactly, from the levels of a pixel's paths.
//!
//! The circuit knows the paths' levels through their phases phi_j alone ([`LevelPhases`]). With
//! `psi` the uniform state of the paths, `R = 2 psi psi^T - 1` and `D = diag(exp(i phi_j))`, its
//! iterate is `U = D^(1/2) R D^(1/2)`. Paths of one phase have one amplitude, so a state is as long
//! as the list of different phases.
//!
//! `U` is unitary and symmetric, and its eigenvectors are real:
//!
//! ```text
//! sum_i p_i cot((lambda - pole_i)/2) = 0,    pole_i = phi_i + pi,
//! v_i ~ sqrt(p_i) / sin((pole_i - lambda)/2),
//! ```
//!
//! with p_i the fraction of paths of phase phi_i. There is one eigenvalue between each two
//! neighbouring poles on the circle. Each is held by its distance from the nearer of the two, which
//! keeps the eigenvectors' small differences.
//!
//! A state after few iterations is the product of the iterates; after many, it follows from the
//! eigenvalues, whose distances from their poles then have 106 bits.

use crate::double::{self, Double};
use crate::elementary::{arctangent, round, sincos};
use crate::vectorized::vectorized;
use qrt_circuit::quantum::LevelPhases;
use std::f64::consts::PI;

/// The most iterations, per different phase, that are multiplied out.
const MULTIPLIED: u64 = 16;
/// The most bits of phases that 53 bits of an arctangent decide, except close to the middle of two.
const DECIDED: u32 = 36;
/// The greatest slope whose square is finite.
const STEEPEST: f64 = 1e150;
/// The most iterations for which 53 bits of an eigenvalue suffice.
const SHALLOW: u64 = 1 << 20;

/// The probabilities of a shot of the mean-phase circuit with `iterations` iterates, measured at
/// `basis` radians: for each of the levels, that the path is of this level and the sign qubit reads 0
/// or 1.
///
/// `levels` are levels in ascending order, each with its number of paths, at least one path in all.
///
/// ```
/// use qrt_circuit::quantum::LevelPhases;
/// use qrt_counting::mean_phase_probabilities;
/// // Two of four paths are white. Half of the scale is the reference: the phases cancel.
/// let phases = LevelPhases::new(1.0, 0.5, 0, 20)?;
/// let [black, white] = mean_phase_probabilities(&[(0, 2), (1, 2)], phases, 6, 0.0)[..] else {
///     unreachable!()
/// };
/// assert!((black[0] + white[0] - 1.0).abs() < 1e-12);
/// # Ok::<(), qrt_circuit::quantum::QuantumError>(())
/// ```
pub fn mean_phase_probabilities(
    levels: &[(u64, u64)],
    phases: LevelPhases,
    iterations: u64,
    basis: f64,
) -> Vec<[f64; 2]> {
    let signal = MeanSignal::new(levels, phases);
    let state = signal.state(iterations);
    let half_basis = libm::sincos(0.5 * basis);
    let mut probabilities = Vec::with_capacity(levels.len());
    for (place, group) in signal.groups.iter().enumerate() {
        let both = state
            .outcomes(place, half_basis)
            .map(|amplitude| amplitude * amplitude);
        for (_, paths) in &levels[group.levels.clone()] {
            let share = *paths as f64 / group.paths;
            probabilities.push(both.map(|probability| probability * share));
        }
    }
    probabilities
}

/// Paths whose levels have the same phase.
#[derive(Clone, Debug)]
struct Group {
    /// The phase, in units of `2^-bits` turns.
    word: i64,
    /// The number of paths.
    paths: f64,
    /// The fraction of all paths.
    weight: f64,
    /// Levels, and their numbers of paths.
    levels: std::ops::Range<usize>,
}

/// A pixel's paths, grouped by the phases of their levels.
#[derive(Clone, Debug)]
pub(crate) struct MeanSignal<'a> {
    levels: &'a [(u64, u64)],
    phases: LevelPhases,
    groups: Vec<Group>,
}

/// The state after some iterations: an amplitude for each group of paths.
#[derive(Clone, Debug, Default)]
pub(crate) struct MeanState {
    pub(crate) re: Vec<f64>,
    pub(crate) im: Vec<f64>,
}

/// Turns of amplitudes, by sine and cosine.
struct Turn {
    cosines: Vec<f64>,
    sines: Vec<f64>,
}

impl Turn {
    fn new(groups: usize) -> Self {
        let [cosines, sines] = [0.0, 0.0].map(|zero| vec![zero; groups]);
        Self { cosines, sines }
    }

    /// Sets the turns to `factor` times these angles, in radians.
    #[inline(always)]
    fn set(&mut self, angles: &[f64], factor: f64) {
        let parts = self.cosines.iter_mut().zip(&mut self.sines);
        for ((cosine, sine), angle) in parts.zip(angles) {
            (*sine, *cosine) = sincos(factor * angle);
        }
    }
}

/// The [`LevelPhases::word`] of each level.
fn phase_words(levels: &[(u64, u64)], phases: &LevelPhases) -> Vec<i64> {
    if phases.bits() > DECIDED || phases.slope() > STEEPEST {
        return levels
            .iter()
            .map(|&(level, _)| phases.word(level))
            .collect();
    }
    let size = (1_u64 << phases.bits()) as f64;
    let most = 1_u64 << phases.level_bits();
    let colours = levels.iter().map(|&(level, _)| level.min(most) as f64);
    let colours: Vec<f64> = colours.collect();
    // Each word, and how far it was rounded.
    let [mut words, mut rounded] = [0.0, 0.0].map(|zero| vec![zero; levels.len()]);
    vectorized(
        #[inline(always)]
        || {
            let each = words.iter_mut().zip(&mut rounded);
            for ((word, rounded), colour) in each.zip(&colours) {
                let distance = colour / most as f64 - phases.reference();
                let exact = size / PI * arctangent(phases.slope() * distance);
                *word = round(exact);
                *rounded = (exact - *word).abs();
            }
        },
    );
    let each = words.into_iter().zip(rounded).zip(levels);
    each.map(|((word, rounded), &(level, _))| {
        // Neither half way between two words, nor near the ends.
        if rounded < 0.499 && word.abs() < 0.5 * size - 2.0 {
            word as i64
        } else {
            phases.word(level)
        }
    })
    .collect()
}

impl<'a> MeanSignal<'a> {
    /// Groups the paths of `levels`, which are in ascending order.
    pub(crate) fn new(levels: &'a [(u64, u64)], phases: LevelPhases) -> Self {
        let total: u64 = levels.iter().map(|(_, paths)| paths).sum();
        let mut groups: Vec<Group> = Vec::with_capacity(levels.len());
        let words = phase_words(levels, &phases);
        for (n, (&(_, paths), word)) in levels.iter().zip(words).enumerate() {
            let weight = paths as f64 / total as f64;
            match groups.last_mut() {
                Some(last) if last.word == word => {
                    last.paths += paths as f64;
                    last.weight += weight;
                    last.levels.end = n + 1;
                }
                _ => groups.push(Group {
                    word,
                    paths: paths as f64,
                    weight,
                    levels: n..n + 1,
                }),
            }
        }
        Self {
            levels,
            phases,
            groups,
        }
    }

    /// The levels of a group, and their numbers of paths.
    pub(crate) fn levels(&self, group: usize) -> &'a [(u64, u64)] {
        &self.levels[self.groups[group].levels.clone()]
    }

    /// The state `U^k psi`.
    pub(crate) fn state(&self, k: u64) -> MeanState {
        if k <= MULTIPLIED * self.groups.len() as u64 {
            self.multiplied(k)
        } else {
            self.by_eigenvalues(k)
        }
    }

    fn multiplied(&self, k: u64) -> MeanState {
        let psi: Vec<f64> = self.groups.iter().map(|g| g.weight.sqrt()).collect();
        let unit = PI / (1_u64 << self.phases.bits()) as f64;
        let angles: Vec<f64> = self.groups.iter().map(|g| g.word as f64 * unit).collect();
        let (mut half, mut whole) = (Turn::new(psi.len()), Turn::new(psi.len()));
        let mut state = MeanState {
            re: psi.clone(),
            im: vec![0.0; psi.len()],
        };
        if k == 0 {
            return state;
        }
        vectorized(
            #[inline(always)]
            || {
                half.set(&angles, 1.0);
                whole.set(&angles, 2.0);
                state.turn(&half);
                for left in (0..k).rev() {
                    state.reflect(&psi);
                    state.turn(if left > 0 { &whole } else { &half });
                }
            },
        );
        state
    }

    fn by_eigenvalues(&self, k: u64) -> MeanState {
        let n = self.groups.len();
        let mut state = MeanState {
            re: vec![0.0; n],
            im: vec![0.0; n],
        };
        for j in 0..n {
            let value = self.eigenvalue(j);
            let offset = value.offset(k > SHALLOW, &self.groups, self.phases.bits());
            let cotangents = value.cotangents();
            let csc = |i: usize| {
                let length = (1.0 + cotangents[i] * cotangents[i]).sqrt();
                // The sign of the pole's distance from the eigenvalue.
                let below = i < value.pole || i == value.pole && offset.hi > 0.0;
                if below { length } else { -length }
            };
            let (mut norm, mut overlap) = (0.0, 0.0);
            for (i, group) in self.groups.iter().enumerate() {
                let x = csc(i);
                norm += group.weight * x * x;
                overlap += group.weight * x;
            }
            let (sine, cosine) = self.turned(k, value.pole, offset);
            let factor = overlap / norm;
            for (i, group) in self.groups.iter().enumerate() {
                let part = factor * group.weight.sqrt() * csc(i);
                state.re[i] += part * cosine;
                state.im[i] += part * sine;
            }
        }
        state
    }

    /// Sine and cosine of k times the eigenvalue at `offset` from a pole.
    fn turned(&self, k: u64, pole: usize, offset: Double) -> (f64, f64) {
        let bits = self.phases.bits();
        // The pole is half a turn from its phase.
        let word = i128::from(self.groups[pole].word) + (1_i128 << (bits - 1));
        let whole = (i128::from(k) * word).rem_euclid(1 << bits);
        let turns = (Double::from(k) * offset).divide(double::PI.scale(2.0));
        let turns = turns - Double::from(turns.hi.round());
        let turns = turns + Double::from(whole as f64 / (1_u64 << bits) as f64);
        libm::sincos(2.0 * PI * (turns.hi - turns.hi.round() + turns.lo))
    }

    /// The eigenvalue between poles j and j + 1.
    fn eigenvalue(&self, j: usize) -> Eigenvalue {
        let n = self.groups.len();
        let size = 1_i64 << self.phases.bits();
        let next = (j + 1) % n;
        let gap = self.groups[next].word - self.groups[j].word + if next <= j { size } else { 0 };
        let unit = PI / size as f64;
        // Cotangents of half the distances from pole i to the nearer pole.
        let cotangents = |pole: usize| -> Vec<f64> {
            let own = self.groups[pole].word;
            let each = self.groups.iter().map(|group| {
                let distance = (own - group.word) as f64 * unit;
                if group.word == own {
                    f64::INFINITY
                } else {
                    1.0 / libm::tan(distance)
                }
            });
            each.collect()
        };
        let mut value = Eigenvalue {
            pole: j,
            cotangents: cotangents(j),
            weights: self.groups.iter().map(|group| group.weight).collect(),
            root: 1.0 / libm::tan(gap as f64 * unit / 2.0),
        };
        if n == 1 {
            // The only pole, half a turn away.
            value.root = 0.0;
            return value;
        }
        let (middle, _) = value.sum(value.root);
        if middle > 0.0 {
            // The sum falls from infinity at pole j: the root lies in the upper half.
            value.pole = next;
            value.cotangents = cotangents(next);
            value.root = -value.root;
        }
        value.solve();
        value
    }
}

/// An eigenvalue by its nearest pole: `root = cot(offset/2)`.
struct Eigenvalue {
    pole: usize,
    /// Cotangents of half the distance of the pole from each pole; infinite for itself.
    cotangents: Vec<f64>,
    weights: Vec<f64>,
    root: f64,
}

impl Eigenvalue {
    /// The sum of all weighted cotangents at `cot(offset/2) = u`, and its derivative.
    fn sum(&self, u: f64) -> (f64, f64) {
        let (mut sum, mut slope) = (0.0, 0.0);
        for (&c, &weight) in self.cotangents.iter().zip(&self.weights) {
            if c == f64::INFINITY {
                sum += weight * u;
                slope += weight;
            } else {
                let inverse = 1.0 / (u + c);
                sum += weight * (u * c - 1.0) * inverse;
                slope += weight * (c * c + 1.0) * inverse * inverse;
            }
        }
        (sum, slope)
    }

    /// Moves `root`, which is half way to the other pole, to the root: towards infinity, with its
    /// sign.
    fn solve(&mut self) {
        let sign = if self.root < 0.0 { -1.0 } else { 1.0 };
        // In terms of |u| the root lies above `low`, and below `high`.
        let (mut low, mut high) = (self.root, sign * f64::INFINITY);
        let mut u = self.root;
        for _ in 0..200 {
            let (sum, slope) = self.sum(u);
            if sum == 0.0 {
                break;
            }
            if (sum > 0.0) == (sign > 0.0) {
                high = u;
            } else {
                low = u;
            }
            let newton = u - sum / slope;
            let inside = (newton - low) * sign > 0.0 && (high - newton) * sign > 0.0;
            let next = if inside {
                newton
            } else if high.is_finite() {
                0.5 * (low + high)
            } else {
                2.0 * u + sign
            };
            let done = (next - u).abs() <= 2.0 * f64::EPSILON * next.abs();
            u = next;
            if done {
                break;
            }
        }
        self.root = u;
    }

    /// Cotangents of half the distance of the eigenvalue from each pole.
    fn cotangents(&self) -> Vec<f64> {
        let u = self.root;
        let each = self.cotangents.iter();
        each.map(|&c| {
            if c == f64::INFINITY {
                u
            } else {
                (u * c - 1.0) / (u + c)
            }
        })
        .collect()
    }

    /// The distance from the pole, in radians, to 106 bits if `fine`.
    fn offset(&self, fine: bool, groups: &[Group], bits: u32) -> Double {
        let offset = 2.0 * libm::atan2(1.0, self.root.abs());
        let mut offset = Double::from(if self.root < 0.0 { -offset } else { offset });
        if !fine {
            return offset;
        }
        let own = groups[self.pole].word;
        let unit = double::PI.scale(1.0 / (1_u64 << bits) as f64);
        for _ in 0..2 {
            let (mut sum, mut slope) = (Double::ZERO, 0.0);
            for group in groups {
                let distance = unit * Double::from((own - group.word) as f64) + offset.scale(0.5);
                let cotangent = cotangent(distance);
                sum = sum + Double::from(group.paths) * cotangent;
                slope -= 0.5 * group.paths * (1.0 + cotangent.hi * cotangent.hi);
            }
            offset = offset - sum.divide(Double::from(slope));
        }
        offset
    }
}

/// The cotangent of an angle in radians.
fn cotangent(angle: Double) -> Double {
    let quarters = (angle.hi / (0.5 * PI)).round();
    let (sine, cosine) = (angle - double::PI.scale(0.5) * Double::from(quarters)).sin_cos();
    if quarters as i64 % 2 == 0 {
        cosine.divide(sine)
    } else {
        -sine.divide(cosine)
    }
}

impl MeanState {
    #[inline(always)]
    fn turn(&mut self, turn: &Turn) {
        let parts = self.re.iter_mut().zip(&mut self.im);
        for ((re, im), (c, s)) in parts.zip(turn.cosines.iter().zip(&turn.sines)) {
            (*re, *im) = (*re * c - *im * s, *re * s + *im * c);
        }
    }

    #[inline(always)]
    fn reflect(&mut self, psi: &[f64]) {
        let mean = |part: &[f64]| 2.0 * dot(part, psi);
        let (re, im) = (mean(&self.re), mean(&self.im));
        for (part, twice) in [(&mut self.re, re), (&mut self.im, im)] {
            for (value, psi) in part.iter_mut().zip(psi) {
                *value = twice * psi - *value;
            }
        }
    }
}

/// A scalar product in eight sums, which a processor adds side by side.
#[inline(always)]
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; 8];
    let (a, b) = (a.as_chunks::<8>(), b.as_chunks::<8>());
    for (a, b) in a.0.iter().zip(b.0) {
        for lane in 0..8 {
            sums[lane] += a[lane] * b[lane];
        }
    }
    let rest: f64 = a.1.iter().zip(b.1).map(|(a, b)| a * b).sum();
    sums.iter().sum::<f64>() + rest
}

impl MeanState {
    /// The ancilla's outcome 0, measured at an angle, has this amplitude at a group, outcome 1 the
    /// second one: the parts of `exp(-i angle/2)` times the group's amplitude. `half_basis` is the sine and
    /// the cosine of half the angle.
    pub(crate) fn outcomes(&self, group: usize, half_basis: (f64, f64)) -> [f64; 2] {
        let (sine, cosine) = half_basis;
        let (re, im) = (self.re[group], self.im[group]);
        [re * cosine + im * sine, im * cosine - re * sine]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Stream;
    use astro_float_num::{BigFloat, Consts, RoundingMode};

    const P: usize = 320;
    const RM: RoundingMode = RoundingMode::ToEven;

    type Complex = [BigFloat; 2];

    /// Levels of `count` kinds, some of them on one phase, some far brighter than the others.
    fn levels(seed: u64, count: u64, bits: u32) -> Vec<(u64, u64)> {
        let mut stream = Stream::new(seed, 0, 0, 0);
        let mut all = std::collections::BTreeMap::new();
        for _ in 0..count {
            let level = stream.below((1 << bits) + 1) >> stream.below(u64::from(bits));
            *all.entry(level).or_insert(0) += 1 + (stream.below(1 << 10) >> stream.below(10));
        }
        all.into_iter().collect()
    }

    fn off(a: &MeanState, b: &MeanState) -> f64 {
        let parts = |state: &MeanState| [state.re.clone(), state.im.clone()].concat();
        let differences = parts(a)
            .into_iter()
            .zip(parts(b))
            .map(|(a, b)| (a - b).abs());
        differences.fold(0.0, f64::max)
    }

    #[test]
    fn words_are_those_of_the_circuit() {
        for (seed, bits, slope, table) in [
            (1, 4, 0.7, 2),
            (2, 8, 3.0, 12),
            (3, 10, 20.0, 24),
            (4, 12, 1.5, DECIDED),
            (5, 12, 1e5, 30),
            (6, 12, 1.5, 51),
            (7, 8, 1e149, 20),
            (8, 8, f64::MAX, 20),
        ] {
            let mut levels = levels(seed, 400, bits);
            // Above the greatest level.
            levels.push((3 << bits, 5));
            for reference in [0.0, 0.03, 0.5, 1.0] {
                let phases = LevelPhases::new(slope, reference, bits, table).unwrap();
                let of_circuit = levels.iter().map(|&(level, _)| phases.word(level));
                let found = phase_words(&levels, &phases);
                assert_eq!(found, of_circuit.collect::<Vec<_>>(), "{seed}, {reference}");
            }
        }
    }

    #[test]
    fn eigenvalues_give_what_products_do() {
        let mut worst = 0.0_f64;
        for (seed, count, bits, slope, table) in [
            (1, 1, 4, 0.7, 8),
            (2, 2, 4, 300.0, 12),
            (3, 5, 8, 3.0, 20),
            (4, 40, 10, 20.0, 14),
            (5, 200, 12, 1.5, 30),
            (6, 200, 12, 1e5, 51),
        ] {
            let levels = levels(seed, count, bits);
            for reference in [0.0, 0.03, 1.0] {
                let phases = LevelPhases::new(slope, reference, bits, table).unwrap();
                let signal = MeanSignal::new(&levels, phases);
                for k in [0, 1, 2, 3, 17, 200, 5000] {
                    let (a, b) = (signal.multiplied(k), signal.by_eigenvalues(k));
                    let norm: f64 = a.re.iter().chain(&a.im).map(|x| x * x).sum();
                    assert!((norm - 1.0).abs() < 1e-11, "{seed}, {k}: {norm}");
                    worst = worst.max(off(&a, &b));
                }
            }
        }
        assert!(worst < 1e-10, "{worst}");
    }

    /// A few levels, and sixteen of them, under slopes and references of several kinds.
    #[test]
    fn a_depth_of_2_to_the_40_is_exact_to_a_billionth() {
        let few = [(0, 1000), (3, 20), (5, 300), (200, 7)];
        let many: Vec<(u64, u64)> = (0..16).map(|n| (n * n, 1 + 40 / (n + 1))).collect();
        for (levels, slope, reference) in
            [(&few[..], 7.3, 0.02), (&many, 3.1, 0.11), (&many, 0.4, 0.9)]
        {
            is_exact(levels, LevelPhases::new(slope, reference, 8, 47).unwrap());
        }
    }

    /// Squares the iterate's matrix 40 times with 320 bits.
    fn is_exact(levels: &[(u64, u64)], phases: LevelPhases) {
        let signal = MeanSignal::new(levels, phases);
        let n = levels.len();
        let big = |value: f64| BigFloat::from_f64(value, P);
        let mut consts = Consts::new().unwrap();
        let paths: u64 = levels.iter().map(|(_, paths)| paths).sum();
        let total = big(paths as f64);
        let psi: Vec<BigFloat> = (levels.iter())
            .map(|(_, paths)| big(*paths as f64).div(&total, P, RM).sqrt(P, RM))
            .collect();
        let unit = consts.pi(P, RM).div(&big(2.0_f64.powi(47)), P, RM);
        let half: Vec<[BigFloat; 2]> = (levels.iter())
            .map(|(level, _)| {
                let angle = unit.mul(&big(phases.word(*level) as f64), P, RM);
                [angle.cos(P, RM, &mut consts), angle.sin(P, RM, &mut consts)]
            })
            .collect();
        let times = |a: &Complex, b: &Complex| -> Complex {
            let product = |x: usize, y: usize| a[x].mul(&b[y], P, RM);
            [
                product(0, 0).sub(&product(1, 1), P, RM),
                product(0, 1).add(&product(1, 0), P, RM),
            ]
        };
        let mut matrix: Vec<Vec<Complex>> = (0..n)
            .map(|i| {
                let entry = |j: usize| {
                    let mut reflection = big(2.0).mul(&psi[i], P, RM).mul(&psi[j], P, RM);
                    if i == j {
                        reflection = reflection.sub(&big(1.0), P, RM);
                    }
                    let [re, im] = times(&half[i], &half[j]);
                    [re.mul(&reflection, P, RM), im.mul(&reflection, P, RM)]
                };
                (0..n).map(entry).collect()
            })
            .collect();
        for power in 1..=40 {
            let before = matrix.clone();
            for i in 0..n {
                for j in 0..n {
                    let zero = [big(0.0), big(0.0)];
                    matrix[i][j] = (0..n).fold(zero, |sum, m| {
                        let [re, im] = times(&before[i][m], &before[m][j]);
                        [sum[0].add(&re, P, RM), sum[1].add(&im, P, RM)]
                    });
                }
            }
            let found = signal.by_eigenvalues(1 << power);
            for i in 0..n {
                for (part, found) in [&found.re, &found.im].into_iter().enumerate() {
                    let expected = (0..n).fold(big(0.0), |sum, j| {
                        sum.add(&matrix[i][j][part].mul(&psi[j], P, RM), P, RM)
                    });
                    let off = expected.sub(&big(found[i]), P, RM).abs();
                    let close = off.cmp(&big(1e-9)).is_some_and(|order| order < 0);
                    assert!(close, "2^{power}, {i}: off by {off}");
                }
            }
        }
    }

    #[test]
    fn probabilities_add_up_to_one_and_to_no_phase_without_iterates() {
        let levels = levels(9, 60, 9);
        let total: u64 = levels.iter().map(|(_, paths)| paths).sum();
        let phases = LevelPhases::new(2.0, 0.1, 9, 6).unwrap();
        for k in [0, 1, 7] {
            for basis in [0.0, 1.0, -2.0] {
                let found = mean_phase_probabilities(&levels, phases, k, basis);
                let sum: f64 = found.iter().flatten().sum();
                assert!((sum - 1.0).abs() < 1e-12);
                if k == 0 {
                    for ((_, paths), [zero, one]) in levels.iter().zip(found) {
                        let share = *paths as f64 / total as f64;
                        assert!((zero + one - share).abs() < 1e-12);
                        assert!((zero - one - share * libm::cos(basis)).abs() < 1e-12);
                    }
                }
            }
        }
    }
}
