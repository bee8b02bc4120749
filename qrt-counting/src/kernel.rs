//! The outcome distribution of the phase register for one eigenphase.
//!
//! Phase estimation of a phase of `x` grid steps (T steps make a turn) returns outcome `k` with
//! probability `K(k - x)`, where for amplitudes `w_j` on the phase register
//!
//! ```text
//! K(x) = | sum_j w_j exp(2 pi i j x / T) |^2 / T,    j = 0 .. T-1.
//! ```
//!
//! *Rectangular window*, `w_j = 1/sqrt(T)` (the paper's):
//! `K(x) = (sin(pi x) / (T sin(pi x / T)))^2`.
//!
//! *Sine window*, `w_j = sqrt(2/(T+1)) sin(pi (j+1)/(T+1))`. With n = T+1 and z = x n/T - 1/2, the
//! difference of two geometric series is
//!
//! ```text
//! K(x) = (sin(pi/n) / sin(pi (z+1)/n))^2 / (2 T n) * (sin(pi z) / sin(pi z/n))^2,
//! ```
//!
//! whose last factor is a Dirichlet kernel: n^2 if z = 0, that is, half a step off the grid.
//! (Luis & Perina, *Optimum phase-shift estimation and the quantum description of the phase
//! difference*, 1996, introduced this window.)
//!
//! The functions take an offset as an integer and a remainder, `x = k - f` with `|f| <= 1/2`. The
//! numerators depend on f alone, so a large k does not cost precision.

use std::f64::consts::PI;

use qrt_circuit::quantum::Window;

/// A phase register: its size and the window it is prepared in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Register {
    pub(crate) bits: u32,
    pub(crate) window: Window,
    /// sin(pi/n) / sqrt(2 T n); used for the sine window only.
    coefficient: f64,
}

impl Register {
    pub(crate) fn new(bits: u32, window: Window) -> Self {
        let size = (1_u64 << bits) as f64;
        let points = size + 1.0;
        let coefficient = libm::sin(PI / points) / (2.0 * size * points).sqrt();
        Self {
            bits,
            window,
            coefficient,
        }
    }

    /// T, the number of outcomes before folding.
    pub(crate) fn size(&self) -> u64 {
        1 << self.bits
    }

    /// `sqrt(K(k - f))` for `|k| <= T/2`, `|f| <= 1/2`. The result is clamped to at most 1.
    pub(crate) fn root(&self, k: i64, f: f64) -> f64 {
        // K is even: keep x = k - f at or above zero.
        let (k, f) = if k < 0 || (k == 0 && f > 0.0) {
            (-k, -f)
        } else {
            (k, f)
        };
        let size = self.size() as f64;
        let steps = k as f64;
        let x = steps - f;
        let root = match self.window {
            Window::Rect => {
                if x == 0.0 {
                    return 1.0;
                }
                libm::sin(PI * f.abs()) / (size * libm::sin(PI * (x / size)))
            }
            Window::Sine => {
                let points = size + 1.0;
                let shift = x / size - f;
                let z = (steps - 0.5) + shift;
                // sin(pi z) = +- cos(pi shift); 1/2 - |shift| is exact where it is small.
                let dirichlet = if z == 0.0 {
                    points
                } else {
                    libm::sin(PI * (0.5 - shift.abs())).abs() / libm::sin(PI * (z / points)).abs()
                };
                self.coefficient * dirichlet / libm::sin(PI * ((z + 1.0) / points))
            }
        };
        root.min(1.0)
    }

    /// `K(k - f)`.
    pub(crate) fn weight(&self, k: i64, f: f64) -> f64 {
        let root = self.root(k, f);
        root * root
    }

    /// An upper bound of `sqrt(K(x))` that decreases in `x` over [0, T/2] and never exceeds 1.
    ///
    /// The bound is `sqrt(K(x))` with the oscillating numerator set to 1.
    pub(crate) fn envelope(&self, x: f64) -> f64 {
        let size = self.size() as f64;
        let bound = match self.window {
            Window::Rect => 1.0 / (size * libm::sin(PI * (x / size))),
            Window::Sine => {
                let points = size + 1.0;
                let z = x * (points / size) - 0.5;
                if z <= 0.5 {
                    // The main lobe falls from its top. Half a step away, z is 0 and K is n/(2T).
                    return if z >= 0.0 {
                        (0.5 * points / size).sqrt()
                    } else {
                        self.root(0, 0.0)
                    };
                }
                let sines = libm::sin(PI * (z / points)) * libm::sin(PI * ((z + 1.0) / points));
                self.coefficient / sines
            }
        };
        // The factor covers the rounding errors of this function and of `root`.
        (bound * (1.0 + 1e-12)).min(1.0)
    }
}
