//! Compares the distribution with independent high-precision arithmetic and with its definition.

use astro_float_num::{BigFloat, Consts, RoundingMode};
use proptest::prelude::*;
use qrt_circuit::quantum::Window;

use crate::PhaseDistribution;
use crate::kernel::Register;
use crate::phase::Phase;

/// Precision in bits. T theta takes 80 bits at T = 2^40; squares cancel twice that near theta = 0.
const P: usize = 384;
const RM: RoundingMode = RoundingMode::ToEven;
const WINDOWS: [Window; 2] = [Window::Rect, Window::Sine];

struct Exact {
    consts: Consts,
    pi: BigFloat,
    /// theta in turns.
    theta: BigFloat,
    size: BigFloat,
    half: u64,
    window: Window,
}

fn int(value: u64) -> BigFloat {
    BigFloat::from_u64(value, P)
}

fn float(value: &BigFloat) -> f64 {
    value.to_string().parse().unwrap()
}

impl Exact {
    fn new(good: u64, total: u64, bits: u32, window: Window) -> Self {
        let mut consts = Consts::new().unwrap();
        let pi = consts.pi(P, RM);
        let theta = int(good)
            .div(&int(total), P, RM)
            .sqrt(P, RM)
            .asin(P, RM, &mut consts)
            .div(&pi, P, RM);
        Self {
            consts,
            pi,
            theta,
            size: int(1 << bits),
            half: 1 << (bits - 1),
            window,
        }
    }

    fn sin(&mut self, x: &BigFloat) -> BigFloat {
        x.sin(P, RM, &mut self.consts)
    }

    fn cos(&mut self, x: &BigFloat) -> BigFloat {
        x.cos(P, RM, &mut self.consts)
    }

    /// The textbook formulas. The precision makes up for their cancellation.
    fn kernel(&mut self, x: &BigFloat) -> BigFloat {
        let size = self.size.clone();
        let one = int(1);
        if x.is_zero() && self.window == Window::Rect {
            return one;
        }
        let turn = self.pi.mul(x, P, RM);
        match self.window {
            Window::Rect => {
                let numerator = self.sin(&turn);
                let denominator = self.sin(&turn.div(&size, P, RM)).mul(&size, P, RM);
                let root = numerator.div(&denominator, P, RM);
                root.mul(&root, P, RM)
            }
            Window::Sine => {
                let points = size.add(&one, P, RM);
                // Half a step off the grid (T = 2, a quarter of the indices) the quotient is 0/0,
                // so the angle is moved slightly.
                let turn = turn.add(&BigFloat::from_f64(1e-50, P), P, RM);
                let omega = turn.mul(&int(2), P, RM).div(&size, P, RM);
                let step = self.pi.div(&points, P, RM);
                let half = omega.mul(&points, P, RM).div(&int(2), P, RM);
                let numerator = self.cos(&half).mul(&self.sin(&step), P, RM);
                let denominator = self.cos(&omega).sub(&self.cos(&step), P, RM);
                let root = numerator.div(&denominator, P, RM);
                root.mul(&root, P, RM)
                    .mul(&int(2), P, RM)
                    .div(&size, P, RM)
                    .div(&points, P, RM)
            }
        }
    }

    fn probability(&mut self, y: u64) -> f64 {
        let steps = self.theta.mul(&self.size, P, RM);
        let near = self.kernel(&int(y).sub(&steps, P, RM));
        if y == 0 || y == self.half {
            return float(&near);
        }
        let far = self.kernel(&int(y).add(&steps, P, RM));
        float(&near.add(&far, P, RM))
    }

    /// Compares the peak, its neighbours, and outcomes up to both ends.
    fn check(good: u64, total: u64, bits: u32, window: Window) {
        let mut exact = Self::new(good, total, bits, window);
        let found = PhaseDistribution::new(good, total, bits, window).unwrap();
        let half = found.largest_outcome();
        let peak = found.nearest_outcome();
        let mut outcomes = vec![0, 1, 2, half / 3, half / 2, half - half / 3, half - 1, half];
        for power in (0..bits).step_by(5) {
            for distance in [(1 << power) - 1, 1 << power, (1 << power) + 1] {
                outcomes.push(peak + distance);
                outcomes.push(peak.saturating_sub(distance));
            }
        }
        for y in outcomes.into_iter().filter(|&y| y <= half) {
            let (p, expected) = (found.probability(y), exact.probability(y));
            assert!(
                (p - expected).abs() < 1e-13,
                "P({y}) = {p}, not {expected}: {good} of {total}, {bits} bits, {window:?}"
            );
            let ln = found.ln_probability(y);
            if expected > 1e-30 {
                // The root of P has an absolute error of a few 2^-53.
                let tolerance = 1e-11 * expected + 1e-15 * expected.sqrt() + 1e-30;
                assert!(
                    (libm::exp(ln) - expected).abs() < tolerance,
                    "{y}: {ln} {expected}"
                );
            } else {
                assert!(ln < -60.0);
            }
        }
    }
}

#[test]
fn extremes_of_good_and_total_hold_at_every_register_size() {
    for bits in [1, 2, 3, 8, 21, 33, 40] {
        for total in [1, 2, 1000, (1 << 22) + 1, 1 << 62, u64::MAX] {
            let mut goods = vec![0, 1, total / 4, total / 2, total - 1, total];
            goods.dedup();
            for good in goods {
                for window in WINDOWS {
                    Exact::check(good, total, bits, window);
                }
            }
        }
    }
}

/// Checks S next to N sin^2(pi j/T), where T theta is within 1e-9 of an integer but not on it.
#[test]
fn phases_a_hair_off_the_grid_hold() {
    for (bits, total) in [
        (8, 1 << 40),
        (20, (1 << 62) - 1),
        (30, 1 << 62),
        (40, 1 << 62),
    ] {
        let register = Register::new(bits, Window::Rect);
        let mut found = 0;
        for i in 1..4000_u64 {
            let grid = register.size() / 8 + i * (register.size() / 16_000).max(1);
            if grid >= register.size() / 2 {
                break;
            }
            let turns = grid as f64 / register.size() as f64;
            let sine = libm::sin(std::f64::consts::PI * turns);
            let mut good = (total as f64 * (sine * sine)) as u64;
            // Walk onto the grid point, by the slope of S in T theta.
            for _ in 0..5 {
                let phase = Phase::from_counts(good, total, &register);
                let error = (phase.cell as f64 - grid as f64) + phase.offset;
                let slope = std::f64::consts::PI * libm::sin(std::f64::consts::TAU * turns);
                let change = error * slope * total as f64 / register.size() as f64;
                good = good.saturating_add_signed(-(change.round() as i64));
            }
            let phase = Phase::from_counts(good, total, &register);
            if phase.offset != 0.0 && phase.offset.abs() < 1e-9 {
                for window in WINDOWS {
                    Exact::check(good, total, bits, window);
                }
                found += 1;
                if found == 6 {
                    break;
                }
            }
        }
        assert!(found >= 3, "{bits}: {found}");
    }
}

/// Checks phases half a step off the grid, where the sine window's closed form is 0/0.
#[test]
fn phases_half_a_step_off_the_grid_hold() {
    for bits in [4_u32, 12, 24, 40] {
        let size = 1_u64 << bits;
        let total = 1_u64 << 62;
        for cell in [0, 1, size / 7, size / 4, size / 2 - 1] {
            let points = size as f64 + 1.0;
            for steps in [0.5, 0.5 * size as f64 / points] {
                let sine = libm::sin(std::f64::consts::PI * (cell as f64 + steps) / size as f64);
                let good = (total as f64 * sine * sine) as u64;
                for good in [good.saturating_sub(1), good, (good + 1).min(total)] {
                    for window in WINDOWS {
                        Exact::check(good, total, bits, window);
                    }
                }
            }
        }
    }
}

/// The probability by its definition, |sum_j w_j exp(2 pi i j (y - T theta)/T)|^2 / T, term by
/// term.
fn by_definition(theta: f64, bits: u32, window: Window, y: u64) -> f64 {
    let size = 1_u64 << bits;
    let kernel = |x: f64| {
        let (mut real, mut imaginary) = (0.0, 0.0);
        for j in 0..size {
            let n = size as f64 + 1.0;
            let weight = match window {
                Window::Rect => (1.0 / size as f64).sqrt(),
                Window::Sine => {
                    (2.0 / n).sqrt() * libm::sin(std::f64::consts::PI * (j as f64 + 1.0) / n)
                }
            };
            let angle = std::f64::consts::TAU * j as f64 * x / size as f64;
            real += weight * libm::cos(angle);
            imaginary += weight * libm::sin(angle);
        }
        (real * real + imaginary * imaginary) / size as f64
    };
    let steps = theta * size as f64;
    let near = 0.5 * (kernel(y as f64 - steps) + kernel(y as f64 + steps));
    // Outcomes y and T - y are folded; 0 and T/2 are their own mirror images.
    if y == 0 || y == size / 2 {
        near
    } else {
        2.0 * near
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn closed_forms_equal_their_definition(good in 0..=1000_u64, bits in 1..9_u32) {
        for window in WINDOWS {
            let found = PhaseDistribution::new(good, 1000, bits, window).unwrap();
            for y in 0..=found.largest_outcome() {
                let expected = by_definition(found.theta(), bits, window, y);
                prop_assert!((found.probability(y) - expected).abs() < 1e-12);
            }
        }
    }

    #[test]
    fn random_counts_hold_at_every_register_size(
        total in 1..=u64::MAX, fraction in 0.0..=1.0_f64, power in 0..64_u32, bits in 1..=40_u32,
    ) {
        let total = (total >> power).max(1);
        let good = ((total as f64 * fraction) as u64).min(total);
        for window in WINDOWS {
            Exact::check(good, total, bits, window);
        }
    }

    #[test]
    fn an_amplitude_and_a_ratio_agree(good in 0..=(1_u64 << 40), bits in 1..=40_u32, y in 0..9_u64) {
        let total = 1_u64 << 40;
        for window in WINDOWS {
            let ratio = PhaseDistribution::new(good, total, bits, window).unwrap();
            let amplitude = good as f64 / total as f64;
            let real = PhaseDistribution::from_amplitude(amplitude, bits, window).unwrap();
            let y = (ratio.nearest_outcome() + y).saturating_sub(4);
            prop_assert!((ratio.probability(y) - real.probability(y)).abs() < 1e-14);
        }
    }
}

#[test]
fn all_outcomes_sum_to_one() {
    for bits in 1..=16 {
        for (good, total) in [
            (0, 9),
            (1, 1 << 30),
            (3, 10),
            (1, 2),
            (999_999, 1 << 20),
            (9, 9),
        ] {
            for window in WINDOWS {
                let found = PhaseDistribution::new(good, total, bits, window).unwrap();
                let sum: f64 = (0..=found.largest_outcome())
                    .map(|y| found.probability(y))
                    .sum();
                assert!(
                    (sum - 1.0).abs() < 1e-12,
                    "{bits} {good}/{total} {window:?}: {sum}"
                );
            }
        }
    }
}

/// Adds 2^15 outcomes on either side of the peak to the integrals of the tails beyond them.
///
/// There are too many outcomes to add all. A sum over unit cells of a function as smooth as
/// `sin(f)^2 csc^2` differs from its integral by its slope over 24, here below 1e-14. The tail of
/// the sine window is below that, too.
#[test]
fn peak_and_tails_of_large_registers_sum_to_one() {
    let reach = 1_u64 << 15;
    for bits in [20, 27, 34, 40] {
        for (good, total) in [(3, 10), (123_456_789, 1 << 30), (1 << 61, (1 << 62) - 1)] {
            for window in WINDOWS {
                let found = PhaseDistribution::new(good, total, bits, window).unwrap();
                let register = Register::new(bits, window);
                let phase = Phase::from_counts(good, total, &register);
                let (cell, f) = (phase.cell, phase.offset);
                // Adds small terms first. The mirrored phase's part is only compared with its
                // bound.
                let mut sum = 0.0;
                for k in (0..=reach).rev() {
                    sum += register.weight(k as i64, f);
                    if k > 0 {
                        sum += register.weight(-(k as i64), f);
                    }
                    let y = cell + k;
                    let folded = found.probability(y) - register.weight(k as i64, f);
                    let size = register.size() as f64;
                    let far = (y + cell).min(register.size() - y - cell) as f64 - 1.0;
                    let bound = 1.0 / (size * libm::sin(std::f64::consts::PI * far / size));
                    assert!(folded >= -1e-15 && folded <= bound * bound);
                }
                if window == Window::Rect {
                    let size = register.size() as f64;
                    let angle = std::f64::consts::PI / size;
                    let sine = libm::sin(std::f64::consts::PI * f);
                    let end = reach as f64 + 0.5;
                    for u in [end - f, end + f] {
                        sum += sine * sine / (std::f64::consts::PI * size) / libm::tan(angle * u);
                    }
                }
                assert!(
                    (sum - 1.0).abs() < 1e-12,
                    "{bits} {good}/{total} {window:?}: {sum}"
                );
            }
        }
    }
}

/// Checks that a rectangular register without its top bit is a smaller register.
///
/// The identity is `K_T(k) + K_T(k + T/2) = K_{T/2}(k)`. It reduces the sum at 2^40 to sizes at
/// which the outcomes are added one by one.
#[test]
fn dropping_the_top_bit_gives_the_smaller_register() {
    for bits in 16..=40_u32 {
        let (large, small) = (
            Register::new(bits, Window::Rect),
            Register::new(bits - 1, Window::Rect),
        );
        let quarter = (large.size() / 4) as i64;
        for f in [-0.5, -1e-9, 0.01, 0.3, 0.5] {
            for k in [0, 1, 2, 1000, quarter / 3, quarter - 1] {
                let both = large.weight(k, f) + large.weight(k - 2 * quarter, f);
                let expected = small.weight(k, f);
                assert!(
                    (both - expected).abs() <= 1e-13 * expected,
                    "{bits} {k} {f}"
                );
            }
        }
    }
}

#[test]
fn impossible_settings_are_refused() {
    for (good, total, bits) in [(0, 0, 5), (2, 1, 5), (1, 2, 0), (1, 2, 41)] {
        assert!(PhaseDistribution::new(good, total, bits, Window::Rect).is_err());
    }
    for amplitude in [-1e-300, 1.0 + 1e-15, f64::NAN, f64::INFINITY] {
        assert!(PhaseDistribution::from_amplitude(amplitude, 5, Window::Sine).is_err());
    }
    for amplitude in [0.0, 5e-324, 1e-300, 1e-17, 1.0 - 1e-16, 1.0] {
        for bits in [1, 2, 17, 40] {
            for window in WINDOWS {
                let found = PhaseDistribution::from_amplitude(amplitude, bits, window).unwrap();
                for y in [0, 1, found.largest_outcome()] {
                    let p = found.probability(y);
                    assert!(
                        (0.0..=1.0 + 1e-14).contains(&p),
                        "{amplitude} {bits} {y}: {p}"
                    );
                    assert!(!found.ln_probability(y).is_nan());
                }
            }
        }
    }
}
