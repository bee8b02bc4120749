//! Every scene of the independent renderer, at every depth, with 2^18 paths a pixel.
//!
//! `cargo bench --bench references [-- PATH_BITS]` prints how far qrt's pictures are from the
//! reference, as fractions of the reference's mean, and fails where a promise is broken.

// A bench that cannot run has nothing to report.
#![allow(clippy::unwrap_used, clippy::expect_used)]

#[path = "../tests/pictures/independent.rs"]
mod independent;

use independent::{asking, mean, reference, rms_difference, scene, traced};
use std::process::ExitCode;
use std::time::Instant;

/// Scene, and its promise: the root mean square error over the mean.
const SCENES: [(&str, f64); 8] = [
    ("furnace", 0.015),
    ("floorlight", 0.015),
    ("cornell", 0.015),
    ("cornell_mg", 0.015),
    ("cornell_mirrorwall", 0.03),
    ("cornell_glass", 0.03),
    ("cornell_ggx", 0.03),
    ("torusknot8k", 0.015),
];

/// The promise for the mean.
const MEAN: f64 = 0.003;

fn main() -> ExitCode {
    let path_bits = std::env::args()
        .find_map(|argument| argument.parse().ok())
        .unwrap_or(18);
    println!(
        "2^{path_bits} paths a pixel, 16 x 16 pixels; all figures in % of the reference's mean"
    );
    println!(
        "scene                D     RMSE (bar)    mean (bar)   reference's own error   seconds"
    );
    let mut kept = true;
    for (name, bar) in SCENES {
        for depth in 1..=4 {
            let independent::Reference {
                picture: theirs,
                standard_error,
            } = reference(name, depth);
            let level = mean(&theirs);
            let started = Instant::now();
            let ours = traced(&scene(name, &asking(depth, path_bits)), 1);
            let seconds = started.elapsed().as_secs_f64();
            // A black picture has no mean to measure by, and no error to make.
            let unit = if level > 0.0 { level } else { 1.0 };
            let rmse = rms_difference(&ours, &theirs) / unit;
            let noise = rms_difference(&standard_error, &vec![[0.0; 3]; theirs.len()]) / unit;
            let shift = (mean(&ours) - level) / unit;
            let good = rmse < bar && shift.abs() < MEAN;
            kept &= good;
            println!(
                "{name:<20} {depth}   {:>6.3} ({:.1})   {:>+7.4} ({:.1})   {:>21.3}   {seconds:>7.2}{}",
                100.0 * rmse,
                100.0 * bar,
                100.0 * shift,
                100.0 * MEAN,
                100.0 * noise,
                if good { "" } else { "   BROKEN" }
            );
        }
    }
    ExitCode::from(u8::from(!kept))
}
