//! Draws from the counting distribution in constant expected time.
//!
//! Let `T theta = m + f` with m the nearest outcome. Before folding, the register reads `m + k`
//! with probability `K(k - f)`, for k over any T consecutive integers. The central lobe (two to
//! four values of k) is drawn by its exact probabilities. The rest is drawn by rejection. The
//! proposal density times a constant bounds K, and its integral has a closed-form inverse:
//!
//! * rectangular: `csc^2(pi u/T)`, whose integral is a cotangent;
//! * sine: `csc^4(pi u/T)`, whose integral is `c + c^3/3` of the cotangent c.
//!
//! A draw `u` stands for the integer nearest to `u + f`. Both densities are convex, so the integral
//! over the unit cell around an integer is at least the value at the integer (Jensen). Acceptance
//! with the ratio of K to that integral gives exactly K. One trial draws from the lobe and the
//! bound together, so it ends with at least the probability of the lobe, for every f.

use std::f64::consts::PI;

use qrt_circuit::quantum::Window;

use super::kernel::Register;
use super::phase::Phase;
use crate::random::Stream;

/// Draws outcomes of one counting distribution.
#[derive(Clone, Debug)]
pub struct Sampler {
    register: Register,
    cell: u64,
    /// |f|. If f is negative, `mirrored` is true and k counts downwards.
    offset: f64,
    mirrored: bool,
    /// Pairs of k and K(k - f), the likeliest first.
    lobe: [(i64, f64); 4],
    lobe_len: usize,
    /// The tails beyond the lobe: the right one, then the left one.
    tails: [Tail; 2],
    total: f64,
}

/// The cells on one side of the lobe, by their distance `u` from T theta.
#[derive(Clone, Copy, Debug, Default)]
struct Tail {
    /// Values of the integral at the far and the near end of the tail.
    far: f64,
    near: f64,
    /// Integral of the bound over the tail; 0 if the tail has no cells.
    mass: f64,
    /// The range of distances in steps, inclusive.
    first: i64,
    last: i64,
}

impl Sampler {
    pub(crate) fn new(register: Register, phase: Phase) -> Self {
        let mirrored = phase.offset < 0.0;
        let offset = phase.offset.abs();
        let candidates: &[i64] = match (register.window, register.bits) {
            (Window::Rect, _) | (Window::Sine, 1) => &[0, 1],
            (Window::Sine, _) => &[0, 1, -1, 2],
        };
        let mut lobe = [(0, 0.0); 4];
        let mut total = 0.0;
        for (slot, &k) in lobe.iter_mut().zip(candidates) {
            *slot = (k, register.weight(k, offset));
            total += slot.1;
        }
        let reach = candidates.len() as i64 / 2;
        let half = (register.size() / 2) as i64;
        let mut sampler = Self {
            register,
            cell: phase.cell,
            offset,
            mirrored,
            lobe,
            lobe_len: candidates.len(),
            tails: [Tail::default(); 2],
            total,
        };
        // Right of the lobe k = reach+1 ..= T/2, left of it k = -reach ..= -(T/2 - 1).
        sampler.tails = [
            sampler.tail(reach + 1, half, -offset),
            sampler.tail(reach, half - 1, offset),
        ];
        sampler.total += sampler.tails[0].mass + sampler.tails[1].mass;
        sampler
    }

    fn tail(&self, first: i64, last: i64, shift: f64) -> Tail {
        if first > last {
            return Tail::default();
        }
        let size = self.register.size() as f64;
        let near = self.integral(self.cotangent(first as f64 - 0.5 + shift));
        // The last cell may reach past T/2, where the cotangent is a small negative number.
        let beyond = (last as f64 - 0.5 * size) + 0.5 + shift;
        let far = self.integral(-libm::tan(PI * (beyond / size)));
        let mass = self.bound() * (size / PI) * (near - far);
        Tail {
            far,
            near,
            mass,
            first,
            last,
        }
    }

    fn cotangent(&self, u: f64) -> f64 {
        1.0 / libm::tan(PI * (u / self.register.size() as f64))
    }

    /// Minus the integral of the density, in units of T/pi, in terms of the cotangent.
    fn integral(&self, cotangent: f64) -> f64 {
        match self.register.window {
            Window::Rect => cotangent,
            Window::Sine => cotangent * (1.0 + cotangent * cotangent / 3.0),
        }
    }

    /// The cotangent at which [`Self::integral`] is `value`.
    fn inverse(&self, value: f64) -> f64 {
        match self.register.window {
            Window::Rect => value,
            // The real root of c^3 + 3c - 3 value.
            Window::Sine => 2.0 * libm::sinh(libm::asinh(1.5 * value) / 3.0),
        }
    }

    /// The factor with which the density is an upper bound of K over the tails.
    fn bound(&self) -> f64 {
        let size = self.register.size() as f64;
        match self.register.window {
            Window::Rect => {
                let sine = libm::sin(PI * self.offset) / size;
                sine * sine
            }
            Window::Sine => {
                // K <= C / (sin^2 a - sin^2 b)^2, a = pi x/T, b = pi/(2n), |x| >= 2.
                let points = size + 1.0;
                let sine = libm::sin(PI / points);
                let lobe = libm::sin(0.5 * PI / points) / libm::sin(2.0 * PI / size);
                let excess = 1.0 - lobe * lobe;
                sine * sine / (2.0 * size * points * excess * excess)
            }
        }
    }

    /// Integral of the bound over the unit cell centred at distance `u`, without cancellation.
    fn cell_mass(&self, u: f64) -> f64 {
        let size = self.register.size() as f64;
        let (inner, outer) = (PI * ((u - 0.5) / size), PI * ((u + 0.5) / size));
        let (inner_sine, outer_sine) = (libm::sin(inner), libm::sin(outer));
        let difference = libm::sin(PI / size) / (inner_sine * outer_sine);
        let factor = match self.register.window {
            Window::Rect => 1.0,
            Window::Sine => {
                let (a, b) = (libm::cos(inner) / inner_sine, libm::cos(outer) / outer_sine);
                1.0 + (a * a + a * b + b * b) / 3.0
            }
        };
        self.bound() * (size / PI) * difference * factor
    }

    /// Draws one outcome, folded onto `0 ..= T/2`.
    pub fn sample(&self, stream: &mut Stream) -> u64 {
        let k = loop {
            if let Some(k) = self.trial(stream) {
                break k;
            }
        };
        let k = if self.mirrored { -k } else { k };
        let raw = self.cell.wrapping_add_signed(k) & (self.register.size() - 1);
        raw.min(self.register.size() - raw)
    }

    fn trial(&self, stream: &mut Stream) -> Option<i64> {
        let mut position = stream.uniform() * self.total;
        for &(k, weight) in &self.lobe[..self.lobe_len] {
            if position < weight {
                return Some(k);
            }
            position -= weight;
        }
        let right = position < self.tails[0].mass;
        let (tail, shift) = if right {
            (self.tails[0], -self.offset)
        } else {
            (self.tails[1], self.offset)
        };
        if tail.mass <= 0.0 {
            // Rounding took `position` beyond the last weight.
            return None;
        }
        let value = tail.far + stream.fine_uniform() * (tail.near - tail.far);
        let u = self.register.size() as f64 / PI * libm::atan2(1.0, self.inverse(value));
        // Rounding may put `u` slightly outside of the tail's cells.
        let steps = ((u - shift).round() as i64).clamp(tail.first, tail.last);
        let k = if right { steps } else { -steps };
        let accept = self.register.weight(k, self.offset) / self.cell_mass(steps as f64 + shift);
        (stream.uniform() < accept).then_some(k)
    }
}
