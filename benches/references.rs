//! Compares every scene of the independent renderer, at every depth, without light sampling and with it.
//!
//! `cargo bench --bench references` prints the differences of qrt's pictures from the reference, as
//! fractions of the reference's mean, and fails where a promise is broken: without light sampling
//! at 2^18 paths a pixel, with it at 2^16. `-- none`, `-- auto` or `-- mis` selects one of the
//! three. The standard error of a mean is the RMSE over the root of the number of pixels.

// A bench that cannot run has nothing to report.
#![allow(clippy::unwrap_used, clippy::expect_used)]

mod common;
#[path = "../tests/pictures/independent.rs"]
mod independent;

use common::{Arguments, Promises};
use independent::{SIDE, asking, mean, reference, rms_difference, scene, traced};
use std::process::ExitCode;
use std::time::Instant;

/// A scene, the most rays of its paths, and its promised root mean square errors over the mean: without light
/// sampling, and with it.
const SCENES: [(&str, usize, f64, f64); 21] = [
    ("furnace", 4, 0.015, 0.012),
    ("floorlight", 4, 0.015, 0.012),
    ("cornell", 4, 0.015, 0.012),
    ("cornell_mg", 4, 0.015, 0.012),
    ("cornell_mirrorwall", 4, 0.03, 0.012),
    ("cornell_glass", 4, 0.03, 0.012),
    ("cornell_ggx", 4, 0.03, 0.012),
    ("torusknot8k", 4, 0.015, 0.012),
    ("marbles", 4, 0.012, 0.012),
    ("cut_spheres", 4, 0.012, 0.012),
    ("in_glass", 4, 0.012, 0.012),
    ("lensed", 4, 0.012, 0.012),
    ("bottles", 4, 0.012, 0.012),
    ("tiles", 4, 0.012, 0.012),
    ("painted", 4, 0.02, 0.02),
    ("bulbs", 4, 0.015, 0.012),
    ("discs", 4, 0.012, 0.012),
    ("sun", 4, 0.015, 0.012),
    ("terrace", 6, 0.02, 0.012),
    ("metals", 6, 0.012, 0.012),
    ("workshop", 6, 0.012, 0.012),
];

/// A scene whose reference has an error of 1.5 % itself, more than is promised: only the part of
/// the difference beyond that is qrt's.
const NOISY: &str = "cornell_mirrorwall";

/// Promised error of the mean.
const MEAN: f64 = 0.003;

/// Ways of sampling lamps, and path bits.
const SAMPLED: [(&str, u32); 3] = [("none", 18), ("auto", 16), ("mis", 16)];

fn main() -> ExitCode {
    common::run_alone(run)
}

fn run(arguments: &Arguments, promises: &mut Promises) {
    let asked = arguments.word();
    assert!(
        asked.is_none_or(|asked| SAMPLED.iter().any(|(lights, _)| *lights == asked)),
        "none, auto or mis"
    );
    for (lights, path_bits) in SAMPLED {
        if asked.is_none_or(|asked| asked == lights) {
            let kept = measure(lights, path_bits);
            promises.judge(&format!("all differences, lights: {lights}"), kept);
        }
    }
}

/// Returns true if all promises are kept with the way `lights` of sampling lamps.
fn measure(lights: &str, path_bits: u32) -> bool {
    println!(
        "lights: {lights}, 2^{path_bits} paths a pixel, 16 x 16 pixels; all figures in % of the \
         reference's mean"
    );
    println!(
        "scene                D     RMSE (bar)    mean (bar)   in standard errors   reference's own error   seconds"
    );
    let mut kept = true;
    for (name, deepest, without, with) in SCENES {
        let bar = if lights == "none" { without } else { with };
        for depth in 1..=deepest {
            let independent::Reference {
                picture: theirs,
                standard_error,
            } = reference(name, depth);
            let level = mean(&theirs);
            let scene = scene(name, &asking(depth, path_bits, lights));
            let started = Instant::now();
            let ours = traced(&scene, 1);
            let seconds = started.elapsed().as_secs_f64();
            // A black picture has a mean of zero and no error, so the unit does not matter.
            let unit = if level > 0.0 { level } else { 1.0 };
            let rmse = rms_difference(&ours, &theirs) / unit;
            let noise = rms_difference(&standard_error, &vec![[0.0; 3]; theirs.len()]) / unit;
            let shift = (mean(&ours) - level) / unit;
            let own = if name == NOISY {
                (rmse * rmse - noise * noise).max(0.0).sqrt()
            } else {
                rmse
            };
            // Pixels are independent of each other.
            let sigmas = shift * f64::from(SIDE) / rmse.max(f64::MIN_POSITIVE);
            let good = own < bar && shift.abs() < MEAN;
            kept &= good;
            println!(
                "{name:<20} {depth}   {:>6.3} ({:.1})   {:>+7.4} ({:.1})   {sigmas:>+18.1}   {:>21.3}   {seconds:>7.2}{}",
                100.0 * rmse,
                100.0 * bar,
                100.0 * shift,
                100.0 * MEAN,
                100.0 * noise,
                if good { "" } else { "   BROKEN" }
            );
        }
    }
    kept
}
