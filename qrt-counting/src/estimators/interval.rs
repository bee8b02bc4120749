//! Intervals at the requested confidence: from a posterior, or from outcomes of the phase register.
//!
//! For outcomes, let q(w) be the largest probability, over all theta and T, of an outcome more than
//! w steps from T theta. The lower and the upper median of B outcomes are both on one side of T
//! theta and farther than w only if more than half of the outcomes are farther:
//!
//! ```text
//! P(a median off by more than w, both on one side) <= P(Binomial(B, q(w)) > B/2).
//! ```
//!
//! Let w be the distance at which this bound is the requested failure probability. The interval
//! goes from the lower median minus w to the upper median plus w.

use super::clopper_pearson::clopper_pearson;
use qrt_circuit::quantum::Window;
use std::f64::consts::PI;

/// The largest fraction of a step that [`median_steps`] subtracts from a whole number of steps.
const MOST_OFF: f64 = 0.499;
/// Number of steps beyond which theta has no limits: every register has fewer steps.
const ANYWHERE: f64 = 1e13;

/// The fraction of the failure probability that regions of highest density leave out.
///
/// On average over the prior, a region of highest density fails as often as it states, for all
/// outcomes and stopping rules. At a given amplitude its coverage may be lower. Measured at a
/// nominal 5 %: adaptive query depths fail in 9 % of the runs at an amplitude of 1/2, where every
/// query depth gives good and bad indices alike. With 2/5 of the failure probability they fail in 5
/// %, and on average in about 2 %.
const CAUTION: f64 = 0.4;

/// The posterior mass that a region of highest density must have for a coverage of `confidence`
/// even at the amplitude where the coverage is least.
pub(super) fn credible_content(confidence: f64) -> f64 {
    1.0 - CAUTION * (1.0 - confidence)
}

/// w, in steps of the register, for B = `repetitions` and any theta and T.
pub(super) fn median_steps(window: Window, repetitions: u32, confidence: f64) -> f64 {
    let shots = u64::from(repetitions);
    // If a shot is farther than w with probability q, more than half of the shots are farther with
    // the failure probability. This q is a lower limit of Clopper and Pearson's.
    let failure = (1.0 - confidence).min(0.49);
    let (fraction, _) = clopper_pearson(shots / 2 + 1, shots, 2.0 * failure);
    // The margin covers rounding in the limit and in the tails.
    let allowed = fraction * (1.0 - 1e-6);
    let mut whole = 1.0;
    while beyond(window, whole, 0.0) > allowed {
        whole *= 2.0;
        if whole > ANYWHERE {
            return f64::INFINITY;
        }
    }
    let mut low = 0.5 * whole;
    while whole - low > 1.0 {
        let middle = (0.5 * (low + whole)).floor();
        if beyond(window, middle, 0.0) > allowed {
            low = middle;
        } else {
            whole = middle;
        }
    }
    let (mut off, mut too_much) = (0.0, MOST_OFF);
    for _ in 0..20 {
        let middle = 0.5 * (off + too_much);
        if beyond(window, whole, middle) > allowed {
            too_much = middle;
        } else {
            off = middle;
        }
    }
    whole - off
}

/// The largest probability of an outcome more than `whole - off` steps from T theta.
///
/// `whole` is a whole number of at least 1, and `off` is in [0, 1/2).
///
/// Let T theta be f steps above a grid point, f in [0, 1/2]. The outcomes within the distance are
/// those from `1 - whole` to `whole` for f >= off, and to `whole - 1` for f < off. Over either
/// range of f, the probability beyond is largest at an end of the range. With the rectangular
/// window, a finite register has less probability beyond than an infinite one, because its kernel
/// is larger everywhere near. With the sine window it has less than twice as much.
fn beyond(window: Window, whole: f64, off: f64) -> f64 {
    let both = |above: f64, f: f64| tail(window, above - f, f) + tail(window, whole + f, f);
    let few = both(whole, 0.0).max(both(whole, off));
    let many = both(whole + 1.0, off).max(both(whole + 1.0, 0.5));
    let finite = match window {
        Window::Rect => 1.0,
        Window::Sine => 2.0,
    };
    finite * few.max(many)
}

/// The kernel of an infinite register, summed over the distances x = d, d + 1, ... from a phase
/// that is f steps off the grid: `sin^2(pi f)/(pi x)^2` for the rectangular window, and
/// `cos^2(pi f)/2/(pi (x^2 - 1/4))^2` for the sine window.
fn tail(window: Window, distance: f64, f: f64) -> f64 {
    match window {
        Window::Rect => {
            let sine = libm::sin(PI * f) / PI;
            sine * sine * trigamma(distance)
        }
        Window::Sine => {
            let cosine = libm::cos(PI * f) / PI;
            0.5 * cosine * cosine * inverse_squares(distance)
        }
    }
}

/// The sum of `1/((d + j)^2 - 1/4)^2` over j = 0, 1, ...; slightly more if d is above 100.
fn inverse_squares(distance: f64) -> f64 {
    if distance > 100.0 {
        // The summand is convex, so the sum is below the integral from d - 1/2.
        let start = distance - 1.0;
        return 1.0 / (3.0 * start * start * start);
    }
    // 1/(x - 1/2)^2 + 1/(x + 1/2)^2 - 2 (1/(x - 1/2) - 1/(x + 1/2)), whose last part telescopes.
    let before = distance - 0.5;
    2.0 * trigamma(distance + 0.5) + 1.0 / (before * before) - 2.0 / before
}

/// The sum of `1/(x + j)^2` over j = 0, 1, ...: recurrence, and Stirling's series beyond 8.
fn trigamma(x: f64) -> f64 {
    let (mut x, mut sum) = (x, 0.0);
    while x < 8.0 {
        sum += 1.0 / (x * x);
        x += 1.0;
    }
    let y = 1.0 / (x * x);
    sum + 1.0 / x
        + 0.5 * y
        + y / x
            * (1.0 / 6.0 - y * (1.0 / 30.0 - y * (1.0 / 42.0 - y * (1.0 / 30.0 - y * 5.0 / 66.0))))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::PhaseDistribution;

    /// Compares the bound with the distribution, for phases on a fine grid, registers of several
    /// sizes and folded ends.
    #[test]
    fn no_phase_and_no_register_has_more_beyond() {
        for window in [Window::Rect, Window::Sine] {
            for bits in [1, 2, 3, 5, 8] {
                for i in 0..=240 {
                    let theta = f64::from(i) / 480.0;
                    let sine = libm::sin(PI * theta);
                    let found =
                        PhaseDistribution::from_amplitude(sine * sine, bits, window).unwrap();
                    let steps = found.theta() * f64::from(1_u32 << bits);
                    for (whole, off) in [
                        (1.0, 0.0),
                        (1.0, 0.3),
                        (1.0, 0.49),
                        (2.0, 0.2),
                        (3.0, 0.0),
                        (3.0, 0.4),
                        (7.0, 0.1),
                    ] {
                        let within: f64 = (0..=found.largest_outcome())
                            .filter(|&y| (y as f64 - steps).abs() <= whole - off + 1e-9)
                            .map(|y| found.probability(y))
                            .sum();
                        let beyond = beyond(window, whole, off);
                        assert!(
                            1.0 - within <= beyond + 1e-9,
                            "{window:?} {bits} {theta} {whole} {off}: {within}, {beyond}"
                        );
                    }
                }
            }
        }
    }

    /// Checks the 8/pi^2 of Brassard et al. within one step; three quarters of a step hold as much.
    #[test]
    fn single_outcomes_are_within_a_step_as_the_literature_says() {
        let missing = 1.0 - 8.0 / (PI * PI);
        assert!((beyond(Window::Rect, 1.0, 0.0) - missing).abs() < 1e-12);
        assert!((beyond(Window::Rect, 1.0, 0.25) - missing).abs() < 1e-12);
        assert!((trigamma(0.5) - 0.5 * PI * PI).abs() < 1e-12);
        let steps = median_steps(Window::Rect, 1, 0.81);
        assert!((steps - 0.75).abs() < 1e-3, "{steps}");
        // More repetitions give fewer steps, but never less than half a step.
        let mut before = f64::INFINITY;
        for repetitions in [1, 3, 5, 21, 1001, 1_000_000] {
            let steps = median_steps(Window::Rect, repetitions, 0.95);
            assert!(steps < before && steps > 0.5, "{repetitions}: {steps}");
            before = steps;
        }
        assert!(median_steps(Window::Sine, 1, 0.95) < 2.0);
        assert!(median_steps(Window::Rect, 1, 1.0 - 1e-9) > 1e7);
    }
}
