//! The combination of all parts of the error.

use super::pilot::{Errors, Pilot};

/// The margin in standard errors, for a one-sided confidence of 95 %.
const MARGIN: f64 = 1.645;

/// Returns whether enough channels are within the requested error, with a margin for chance.
pub(super) fn will_do(pilot: &Pilot<'_>, others: &[&Errors], counted: Option<&[Errors]>) -> bool {
    let (failing, deviation) = failing(pilot, others, counted);
    failing + MARGIN * deviation <= 1.0 - pilot.accuracy.confidence
}

/// The expected fraction of channels beyond the requested error, and the standard deviation of the
/// difference between it and the fraction of one picture.
///
/// Of N pixels, n were sampled, with k tries each. Let v be the variance of a pixel's fraction
/// between tries, and V the variance of its mean between pixels, which includes v/k. The variance
/// of the difference is `V (1/n - 1/N)` for the pixels outside the sample, plus `(v + v/k)/N` for
/// the picture's own try and the tries that stand for it.
pub(super) fn failing(
    pilot: &Pilot<'_>,
    others: &[&Errors],
    counted: Option<&[Errors]>,
) -> (f64, f64) {
    let error = pilot.accuracy.error;
    let mut sums = vec![[0.0; 2]; pilot.pixels.len()];
    let mut tries = 0_u64;
    each_total(pilot, others, counted, |pixel, total| {
        let fraction = total.iter().filter(|e| e.abs() > error).count() as f64 / 3.0;
        let [sum, squares] = &mut sums[pixel];
        *sum += fraction;
        *squares += fraction * fraction;
        tries += 1;
    });
    let tried = sums.len() as f64;
    let tries = tries as f64 / tried;
    let film = pilot.scene.scene().film;
    let all = f64::from(film.width) * f64::from(film.height);
    let (mut mean, mut between, mut within) = (0.0, 0.0, 0.0);
    for [sum, squares] in sums {
        let fraction: f64 = sum / tries;
        mean += fraction / tried;
        between += fraction * fraction / tried;
        within += (squares / tries - fraction * fraction).max(0.0) / tried;
    }
    let between = (between - mean * mean).max(0.0);
    let variance = between * (1.0 / tried - 1.0 / all) + within * (1.0 + 1.0 / tries) / all;
    (mean, variance.max(0.0).sqrt())
}

/// Calls `take` with the combined error of each pixel, run by run. The first of `others`, the
/// difference of two nets, is added with either sign.
pub(super) fn each_total(
    pilot: &Pilot<'_>,
    others: &[&Errors],
    counted: Option<&[Errors]>,
    mut take: impl FnMut(usize, [f64; 3]),
) {
    let none = [vec![[0.0; 3]; pilot.pixels.len()]];
    for errors in counted.unwrap_or(&none) {
        for (pixel, counted) in errors.iter().enumerate() {
            for sign in [1.0, -1.0] {
                let total = std::array::from_fn(|c| {
                    let mut total = counted[c];
                    for (number, other) in others.iter().enumerate() {
                        total += if number == 0 { sign } else { 1.0 } * other[pixel][c];
                    }
                    total
                });
                take(pixel, total);
            }
        }
    }
}
