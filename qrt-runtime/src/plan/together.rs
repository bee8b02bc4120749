//! All parts of the error together.

use super::pilot::{Errors, Pilot};

/// The margin in standard errors, for a one-sided confidence of 95 %.
const MARGIN: f64 = 1.645;

/// Whether channels are within the asked error as often as was asked, with what may be bad luck.
pub(super) fn will_do(pilot: &Pilot<'_>, others: &[&Errors], counted: Option<&[Errors]>) -> bool {
    let (failing, deviation) = failing(pilot, others, counted);
    let pixels = pilot.pixels.len() as f64;
    failing + MARGIN * deviation / pixels.sqrt() <= 1.0 - pilot.accuracy.confidence
}

/// The fraction of channels beyond the asked error, and how it varies from pixel to pixel.
pub(super) fn failing(
    pilot: &Pilot<'_>,
    others: &[&Errors],
    counted: Option<&[Errors]>,
) -> (f64, f64) {
    let error = pilot.accuracy.error;
    let (mut sum, mut squares, mut count) = (0.0, 0.0, 0.0);
    each_total(pilot, others, counted, |total| {
        let fraction = total.iter().filter(|e| e.abs() > error).count() as f64 / 3.0;
        sum += fraction;
        squares += fraction * fraction;
        count += 1.0;
    });
    let mean: f64 = sum / count;
    (mean, (squares / count - mean * mean).max(0.0).sqrt())
}

/// All errors of a pixel together, run by run. The first of `others`, the difference of two nets,
/// has either sign.
pub(super) fn each_total(
    pilot: &Pilot<'_>,
    others: &[&Errors],
    counted: Option<&[Errors]>,
    mut take: impl FnMut([f64; 3]),
) {
    let none = [vec![[0.0; 3]; pilot.pixels.len()]];
    for errors in counted.unwrap_or(&none) {
        for (pixel, counted) in errors.iter().enumerate() {
            for sign in [1.0, -1.0] {
                take(std::array::from_fn(|c| {
                    let mut total = counted[c];
                    for (number, other) in others.iter().enumerate() {
                        total += if number == 0 { sign } else { 1.0 } * other[pixel][c];
                    }
                    total
                }));
            }
        }
    }
}
