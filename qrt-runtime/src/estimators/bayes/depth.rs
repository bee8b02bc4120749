//! How deep to measure next.

use super::posterior::Posterior;
use super::support::turned;
use crate::estimators::{MAX_ITERATIONS, Noise};

/// Queries times the standard deviation of `pi theta` at which a shot gains most per query, for a
/// normal posterior: with u = (4 k sigma)^2 and the best phase a shot leaves `1 - u exp(-u)` of
/// the variance, and `((1 - u exp(-u))^(-1/2) - 1)/k` is largest at u = 0.62.
const BEST: f64 = 0.197;
/// Depths tried around the best, as shares of it, where the posterior has one mode.
const AROUND: [f64; 24] = [
    0.60, 0.64, 0.68, 0.72, 0.76, 0.80, 0.83, 0.86, 0.89, 0.92, 0.95, 0.98, 1.0, 1.03, 1.06, 1.09,
    1.12, 1.15, 1.18, 1.21, 1.25, 1.29, 1.34, 1.40,
];
/// Of these, those looked at closely.
const CLOSELY: usize = 4;
/// Up to here every depth is tried.
const SHALLOW: u64 = 6;
/// A share of the variance that a round of several shots at one depth is to take.
const ROUND: f64 = 0.3;

/// What to measure next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Plan {
    pub(super) iterations: u64,
    pub(super) shots: u64,
}

/// The depth whose shot is expected to sharpen the posterior most per query: the largest growth of
/// `1/sigma` over queries, where sigma^2 is the expected variance of `pi theta` over all modes. So
/// a depth that would leave several modes gains little. At most `left` queries, which is at least
/// one.
pub(super) fn choose(posterior: &mut Posterior, noise: &Noise, left: u64) -> Plan {
    let sigma = posterior.variance().sqrt();
    let mode = posterior.mode_deviation();
    let most = left.min(MAX_ITERATIONS).min(posterior.deepest() as u64);
    let mut best = (0.0, 0, 0.0);
    let mut look = |posterior: &mut Posterior, iterations: u64| {
        let rest = posterior.remaining_variance(iterations).max(1e-12);
        let gain = (1.0 / rest.sqrt() - 1.0) / iterations.max(1) as f64;
        if gain > best.0 {
            best = (gain, iterations, 1.0 - rest);
        }
    };
    let decay = -libm::log1p(-noise.depolarising.min(0.999_999));
    let limit = if decay > 0.0 { 0.5 / decay } else { f64::INFINITY };
    if mode < f64::INFINITY && sigma < 1.5 * mode {
        // One mode: the best phase among depths near the best for this width.
        let goal = goal(left as f64 * sigma, sigma).min(limit).min(most as f64);
        let place = posterior.mean_position();
        let mut ranked: Vec<(f64, u64)> = Vec::with_capacity(AROUND.len());
        for share in AROUND {
            let iterations = ((goal * share) as u64).min(most);
            if ranked.last().is_some_and(|&(_, last)| last == iterations) {
                continue;
            }
            let phase = turned(place.wrapping_mul(2 * iterations + 1));
            let quality = phase_quality(phase, iterations as f64 * sigma, iterations);
            ranked.push((quality, iterations));
        }
        ranked.sort_by(|a, b| b.0.total_cmp(&a.0));
        for &(_, iterations) in ranked.iter().take(CLOSELY) {
            look(posterior, iterations);
        }
        if goal < SHALLOW as f64 {
            for iterations in 0..=SHALLOW.min(most) {
                look(posterior, iterations);
            }
        }
    } else {
        for iterations in 0..=SHALLOW.min(most) {
            look(posterior, iterations);
        }
        let deepest = (1.4 * BEST / mode.min(sigma)).min(limit).min(most as f64);
        let mut depth = SHALLOW as f64 * 1.1;
        while depth < deepest {
            look(posterior, depth as u64);
            depth = (depth * 1.15).max(depth + 1.0);
        }
    }
    let (_, iterations, taken) = best;
    let each = iterations.max(1);
    let shots = if taken > 0.0 && taken < 0.5 * ROUND {
        (ROUND / taken) as u64
    } else {
        1
    };
    Plan {
        iterations,
        shots: shots.clamp(1, left / each),
    }
}

/// The depth to aim at: the best per query, or, towards the end, one that leaves no useless rest.
fn goal(room: f64, sigma: f64) -> f64 {
    let share = if room < 0.27 {
        room
    } else if room < 0.55 {
        0.45 * room
    } else if room < 0.85 {
        room / 3.2
    } else {
        BEST
    };
    share / sigma
}

/// The gain per query for a normal posterior.
fn phase_quality((cosine, sine): (f64, f64), width: f64, iterations: u64) -> f64 {
    let u = 16.0 * width * width;
    let visible = libm::exp(-u);
    let taken = u * visible * sine * sine / (1.0 - visible * cosine * cosine).max(1e-300);
    (1.0 / (1.0 - taken.min(0.999_999)).sqrt() - 1.0) / iterations.max(1) as f64
}
