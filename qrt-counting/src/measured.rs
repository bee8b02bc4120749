//! The index register after the phase register has been read.
//!
//! Before the inverse Fourier transform the phase register holds j with probability `w_j^2`, and
//! the Grover iterate has acted j times on the index. A measurement of the index gives a good index
//! with probability
//!
//! ```text
//! sum_j w_j^2 sin^2((2j + 1) pi theta) = 1/2 - 1/2 sum_j w_j^2 cos((4j + 2) pi theta),
//! ```
//!
//! for any operation on the phase register. The sum of cosines has a closed form.

use qrt_circuit::quantum::Window;
use std::f64::consts::{PI, TAU};

/// The probability that the index measured after phase estimation is good.
pub(crate) fn good_id(theta: f64, phase_bits: u32, window: Window) -> f64 {
    let size = (1_u64 << phase_bits) as f64;
    let x = PI * theta;
    // sum_j cos(first + j step).
    let cosines = |first: f64, step: f64| {
        let half = 0.5 * step;
        let sine = libm::sin(half);
        let ratio = if sine == 0.0 {
            // 0/0: all terms are equal.
            size
        } else {
            libm::sin(size * half) / sine
        };
        ratio * libm::cos(first + (size - 1.0) * half)
    };
    let plain = cosines(2.0 * x, 4.0 * x);
    let mean = match window {
        Window::Rect => plain / size,
        Window::Sine => {
            let points = size + 1.0;
            let turn = TAU / points;
            let beside =
                cosines(2.0 * x + turn, 4.0 * x + turn) + cosines(2.0 * x - turn, 4.0 * x - turn);
            (plain - 0.5 * beside) / points
        }
    };
    (0.5 - 0.5 * mean).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Small angles, where the terms are nearly equal but their number times their difference is not small. The
    /// mean over a large register is an integral.
    #[test]
    fn small_angles_turn_far_in_large_registers() {
        for bits in [20, 30, 40] {
            for theta in [1e-13, 1e-12, 1e-10, 1e-9] {
                let turns = 2.0 * theta * (1_u64 << bits) as f64;
                if turns > 1e3 {
                    continue;
                }
                for window in [Window::Rect, Window::Sine] {
                    const STEPS: u32 = 200_000;
                    let sum: f64 = (0..STEPS)
                        .map(|step| {
                            let s = (f64::from(step) + 0.5) / f64::from(STEPS);
                            let weight = match window {
                                Window::Rect => 1.0,
                                Window::Sine => 2.0 * libm::sin(PI * s).powi(2),
                            };
                            weight * libm::sin(PI * turns * s).powi(2)
                        })
                        .sum();
                    let mean = sum / f64::from(STEPS);
                    let closed = good_id(theta, bits, window);
                    assert!(
                        (closed - mean).abs() < 1e-5,
                        "{bits} {theta} {window:?}: {closed} {mean}"
                    );
                }
            }
        }
    }

    #[test]
    fn the_sum_over_the_counter_is_the_closed_form() {
        for bits in [1, 2, 3, 6, 10] {
            let size = 1_u32 << bits;
            for step in 0..=200 {
                let theta = f64::from(step) / 400.0;
                for window in [Window::Rect, Window::Sine] {
                    let weight = |j: u32| match window {
                        Window::Rect => 1.0 / f64::from(size),
                        Window::Sine => {
                            let points = f64::from(size) + 1.0;
                            let sine = libm::sin(PI * f64::from(j + 1) / points);
                            2.0 / points * sine * sine
                        }
                    };
                    let sum: f64 = (0..size)
                        .map(|j| {
                            let sine = libm::sin(f64::from(2 * j + 1) * PI * theta);
                            weight(j) * sine * sine
                        })
                        .sum();
                    let found = good_id(theta, bits, window);
                    assert!(
                        (found - sum).abs() < 1e-11,
                        "{bits} {theta} {window:?}: {found} {sum}"
                    );
                }
            }
        }
        assert!((good_id(0.3, 40, Window::Sine) - 0.5).abs() < 1e-9);
    }
}
