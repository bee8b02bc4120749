//! Compares every scene of the independent renderer, at every depth, without light sampling and with it.
//!
//! `cargo bench --bench references` prints the differences of qrt's pictures from the reference, as
//! fractions of the reference's mean, and fails where a promise is broken: without light sampling
//! at 2^18 paths a pixel, with it at 2^16. `-- none`, `-- auto` or `-- mis` selects one of the
//! three, and names behind it scenes: `-- auto sun metals`. Coordinates of directions and lamps have 16 bits.
//!
//! A picture's mean is that of two seeds. Its standard error follows from the difference of the two, pixel by pixel,
//! and from the reference's own error of each pixel, whose channels are taken to err together. Of all means, 95 % are
//! expected within two standard errors. Where lamps are met by chance alone, few pixels have most of the error, and two
//! seeds do not show it: there, nothing is promised of standard errors, and so if scenes are named. RMSEs are those of the
//! first seed, and seconds those of both.

// A bench that cannot run has nothing to report.
#![allow(clippy::unwrap_used, clippy::expect_used)]

mod common;
#[path = "../tests/pictures/independent.rs"]
mod independent;

use common::{Arguments, Promises};
use independent::{Picture, Reference, asking, mean, reference, rms_difference, scene, traced};
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

/// Least share of the means that are within two standard errors, and the most standard errors of any.
const WITHIN_TWO: f64 = 0.9;
const MOST_ERRORS: f64 = 3.5;

/// Relative rounding of the references, whose numbers are of single precision.
const ROUNDING: f64 = 1e-7;

/// Bits of a coordinate of directions and lamps.
const BITS: u32 = 16;

/// Ways of sampling lamps, and path bits.
const SAMPLED: [(&str, u32); 3] = [("none", 18), ("auto", 16), ("mis", 16)];

fn main() -> ExitCode {
    common::run_alone(run)
}

fn run(arguments: &Arguments, promises: &mut Promises) {
    let (asked, names) = match arguments.words() {
        [] => (None, &[][..]),
        [asked, names @ ..] => (Some(asked.as_str()), names),
    };
    assert!(
        asked.is_none_or(|asked| SAMPLED.iter().any(|(lights, _)| *lights == asked)),
        "none, auto or mis"
    );
    for name in names {
        assert!(
            SCENES.iter().any(|scene| scene.0 == name),
            "no scene is called `{name}`"
        );
    }
    for (lights, path_bits) in SAMPLED {
        if asked.is_none_or(|asked| asked == lights) {
            let (kept, shifts) = measure(lights, path_bits, names);
            promises.judge(&format!("all differences, lights: {lights}"), kept);
            let within = shifts.iter().filter(|shift| shift.abs() <= 2.0).count();
            let most = shifts
                .iter()
                .fold(0.0, |most: f64, shift| most.max(shift.abs()));
            let text = format!(
                "{within} of {} means within two standard errors, the most at {most:.1}",
                shifts.len()
            );
            let share = within as f64 / shifts.len() as f64;
            if lights == "none" || !names.is_empty() {
                println!("       {text}");
            } else {
                promises.judge(&text, share >= WITHIN_TWO && most <= MOST_ERRORS);
            }
        }
    }
}

/// The error of the mean of two pictures of different seeds, and its standard error.
fn shift([one, other]: [&Picture; 2], theirs: &Reference) -> (f64, f64) {
    let pixels = one.len() as f64;
    let grey = |picture: &Picture, pixel: usize| picture[pixel].iter().sum::<f64>() / 3.0;
    let variance = |pixel: usize| {
        let apart = grey(one, pixel) - grey(other, pixel);
        let reference = grey(&theirs.standard_error, pixel);
        apart * apart / 4.0 + reference * reference
    };
    let variance: f64 = (0..one.len()).map(variance).sum();
    let shift = f64::midpoint(mean(one), mean(other)) - mean(&theirs.picture);
    (shift, variance.sqrt() / pixels)
}

/// Returns true if all promised differences are kept with the way `lights` of sampling lamps, and the errors of all
/// means in standard errors. `names` are the scenes, or nothing for all.
fn measure(lights: &str, path_bits: u32, names: &[String]) -> (bool, Vec<f64>) {
    println!(
        "lights: {lights}, 2^{path_bits} paths a pixel, 16 x 16 pixels; all figures in % of the \
         reference's mean"
    );
    println!(
        "scene                D     RMSE (bar)    mean (bar)   in standard errors   reference's own error   seconds"
    );
    let mut kept = true;
    let mut shifts = Vec::new();
    let is_asked = |name: &str| names.is_empty() || names.iter().any(|asked| asked == name);
    for (name, deepest, without, with) in SCENES.into_iter().filter(|scene| is_asked(scene.0)) {
        let bar = if lights == "none" { without } else { with };
        for depth in 1..=deepest {
            let theirs = reference(name, depth);
            let level = mean(&theirs.picture);
            let scene = scene(name, &asking(BITS, depth, path_bits, lights));
            let started = Instant::now();
            let ours = [1, 2].map(|seed| traced(&scene, seed));
            let seconds = started.elapsed().as_secs_f64();
            // A black picture has a mean of zero and no error, so the unit does not matter.
            let unit = if level > 0.0 { level } else { 1.0 };
            let rmse = rms_difference(&ours[0], &theirs.picture) / unit;
            let dark = vec![[0.0; 3]; ours[0].len()];
            let noise = rms_difference(&theirs.standard_error, &dark) / unit;
            let (shift, error) = shift(ours.each_ref(), &theirs);
            let sigmas = shift / error.max(ROUNDING * unit);
            let shift = shift / unit;
            let own = if name == NOISY {
                (rmse * rmse - noise * noise).max(0.0).sqrt()
            } else {
                rmse
            };
            let good = own < bar && shift.abs() < MEAN;
            kept &= good;
            shifts.push(sigmas);
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
    (kept, shifts)
}
