//! Seconds that qrt and Mitsuba 3 take for pictures of equal error, and for equally many paths.
//!
//! `cargo bench --bench equal_error -- errors` renders the Cornell box and a mesh, three rays a path, with
//! qrt's real model and with Mitsuba's `path` integrator under each of its samplers, from few paths
//! a pixel to many. Both sample lamps at every surface. The truth is the mean of 65,536 samples a
//! pixel of Mitsuba's, rendered once and kept below `target`. An error is the root mean square over
//! pixels, channels and seeds, as a fraction of the truth's mean. Pixels that see a lamp, or are
//! beside one that does, do not count, since there the lamp's edge would dominate the error.
//! Seconds are the processor's, over all threads, of tracing alone: neither loading a scene nor
//! compiling code counts, for either. `-- --quick` asks for an error of 3 % only, of fewer seeds.
//!
//! It prints the measurements and the seconds to errors of 3 % and 1 %, between the numbers of
//! paths on logarithmic axes, and fails where a promise is broken: qrt's time relative to that of
//! Mitsuba's best sampler, and relative to independent samples.
//!
//! `-- cover` counts the paths of `weekend.yaml` that each traces in a second of the processor: Mitsuba's
//! scalar and LLVM variants, and paths of the same number of rays. `-- meshes` does so for the knot of
//! `knot.yaml` with 1,024, 65,536 and a million triangles, where both sample lamps.
//!
//! `benches/peers/path_tracing.py` installs Mitsuba, where there is a `python3` that can. First the
//! bench compares Mitsuba's pictures of exported scenes with those in `tests/references`. Without
//! Mitsuba the bench fails; with its scalar variant alone it checks no promise, and says so.

// A bench that cannot run has nothing to report.
#![allow(clippy::unwrap_used, clippy::expect_used)]

#[path = "../common/mod.rs"]
mod common;
mod curve;
mod mitsuba;

use common::load::load;
use common::{Arguments, Promises, knot, mesh, processor};
use curve::{Curve, Point};
use mitsuba::{Mitsuba, Truth};
use qrt::runtime::path_machines::Real;
use qrt::scene::front;
use qrt::scene::valid::ValidScene;
use std::path::Path;
use std::process::ExitCode;
use std::sync::atomic::{AtomicUsize, Ordering};

const SCENES: [&str; 2] = ["cornell-box", "knot"];

/// Coordinates of the pixel's square, of directions and of points on lamps.
const DEPTHS: &str = "[{ bits: [10, 10] }, { bits: [10, 10], light: [10, 10] }, \
                      { bits: [10, 10], light: [10, 10] }]";

/// Errors, with the promised bound on qrt's seconds as a fraction of those of Mitsuba's best sampler.
const ERRORS: [(f64, f64); 2] = [(0.03, 1.0), (0.01, 0.6)];

/// Promised bound at both errors, as a fraction of the seconds of independent samples.
const INDEPENDENT: f64 = 0.4;

/// Numbers of paths, as powers of two.
const PATH_BITS: std::ops::RangeInclusive<u32> = 4..=14;

/// Paths of a pixel, over all seeds, that suffice to measure an error.
const ENOUGH: u64 = 8192;

/// Settings of the cover: enough paths for the compilation of Mitsuba's code to take little of the time.
const COVER: [&str; 3] = ["film.width=400", "film.height=225", "sampling.path_bits=6"];

/// Corners of a section of a knot's tube, and sections: 1,024, 65,536 and a million triangles.
const MESHES: [[u32; 2]; 3] = [[16, 32], [128, 256], [500, 1000]];

fn main() -> ExitCode {
    common::run(&[("errors", errors), ("cover", cover), ("meshes", meshes)])
}

fn errors(arguments: &Arguments, promises: &mut Promises) {
    let (errors, seeds) = if arguments.flag("--quick") {
        (&ERRORS[..1], 2)
    } else {
        (&ERRORS[..], 8)
    };
    if let Err(why) = compare(errors, seeds, promises) {
        promises.judge(&format!("Mitsuba is measured: {why}"), false);
    }
}

/// Judges qrt's paths a second on the cover, relative to those of Mitsuba's variants.
fn cover(_: &Arguments, promises: &mut Promises) {
    let scene = load(
        root(),
        "scenes-yaml/weekend.yaml",
        &COVER.map(str::to_owned),
    );
    compare_speeds("the cover", &scene, [1.0, 0.5], promises);
}

/// Judges qrt's paths a second on meshes, relative to those of Mitsuba's variants.
fn meshes(_: &Arguments, promises: &mut Promises) {
    for [around, along] in MESHES {
        let sets = [
            &*format!("sampling.depths={DEPTHS}"),
            "sampling.lights=auto",
            "film.width=256",
            "film.height=256",
            "sampling.path_bits=6",
        ];
        let sets = sets.map(str::to_owned).to_vec();
        let obj = knot::torus_knot(around, along);
        let scene = mesh::with_obj(root(), "scenes-yaml/knot.yaml", &obj, sets);
        let what = format!("{} triangles", 2 * around * along);
        compare_speeds(&what, &scene, [1.2, 0.7], promises);
    }
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// Judges qrt's paths a second on a scene, as multiples of those of Mitsuba's scalar variant and of its LLVM variant.
fn compare_speeds(
    what: &str,
    scene: &ValidScene,
    [scalar, llvm]: [f64; 2],
    promises: &mut Promises,
) {
    let real = Real::new(scene, 1).expect("a valid scene's sequence exists");
    let theirs = match mitsuba::speeds(scene, real.paths()) {
        Ok(speeds) => speeds,
        Err(why) => return promises.judge(&format!("Mitsuba is measured: {why}"), false),
    };
    let film = scene.scene().film;
    let seconds = (0..3).map(|_| {
        let started = processor::seconds();
        picture(&real, film.width, film.height);
        processor::seconds() - started
    });
    let paths = f64::from(film.width * film.height) * real.paths() as f64;
    let ours = paths / seconds.fold(f64::INFINITY, f64::min);
    println!("{what}, qrt: {:.2} million paths a second", ours / 1e6);
    for (variant, speed) in theirs {
        let ratio = ours / speed;
        let least = if variant.starts_with("llvm") {
            llvm
        } else {
            scalar
        };
        println!("{what}, Mitsuba, {variant}: {:.2} million", speed / 1e6);
        let text = format!("{what}: {ratio:.2} of the paths of {variant}, at least {least}");
        promises.judge(&text, ratio >= least);
    }
}

fn compare(errors: &[(f64, f64)], seeds: u64, promises: &mut Promises) -> Result<(), String> {
    for (reference, standard_errors) in mitsuba::references()? {
        println!("Mitsuba, {reference}: {standard_errors:.2} standard errors from the reference");
        assert!(standard_errors < 1.3, "Mitsuba renders something else");
    }
    let least = errors.iter().map(|(error, _)| *error);
    let least = least.fold(f64::INFINITY, f64::min);
    for name in SCENES {
        let theirs = mitsuba::measure(name, errors, seeds)?;
        let ours = curve_of(&scene(name), &theirs.truth, least, seeds);
        print(name, &theirs, &ours, errors);
        if theirs.variant.starts_with("llvm") {
            judge(name, &theirs, &ours, errors, promises);
        } else {
            println!("no promise was checked: Mitsuba's fast variant does not run here");
        }
    }
    Ok(())
}

fn scene(name: &str) -> impl Fn(u32) -> ValidScene {
    let path = root().join(format!("scenes-yaml/{name}.yaml"));
    move |path_bits| {
        let sets = [
            format!("sampling.depths={DEPTHS}"),
            "sampling.lights=auto".to_owned(),
            format!("sampling.path_bits={path_bits}"),
        ];
        let loaded = front::load(&path, &sets).unwrap_or_else(|report| panic!("{report}"));
        loaded.valid
    }
}

/// Measures qrt's errors and seconds, until the error is below `least`.
fn curve_of(scene: &dyn Fn(u32) -> ValidScene, truth: &Truth, least: f64, seeds: u64) -> Curve {
    let mut points: Vec<Point> = Vec::new();
    for path_bits in PATH_BITS {
        let scene = scene(path_bits);
        let paths = 1 << path_bits;
        let runs = seeds.min(ENOUGH / paths).max(2);
        let (mut squares, mut seconds) = (0.0, f64::INFINITY);
        for seed in 1..=runs {
            let real = Real::new(&scene, seed).expect("a valid scene's sequence exists");
            let started = processor::seconds();
            let picture = picture(&real, scene.scene().film.width, scene.scene().film.height);
            seconds = f64::min(seconds, processor::seconds() - started);
            squares += truth.squared_error(&picture);
        }
        points.push(Point {
            samples: paths,
            error: (squares / runs as f64).max(0.0).sqrt() / truth.mean(),
            seconds,
        });
        // A net's error does not fall evenly, so it counts as below only twice in a row.
        if matches!(points[..], [.., a, b] if a.error.max(b.error) < least) {
            break;
        }
    }
    Curve {
        name: "qrt".to_owned(),
        points,
    }
}

/// Renders the film row by row; all cores share the rows.
fn picture(real: &Real, width: u32, height: u32) -> Vec<[f64; 3]> {
    let paths = real.paths() as f64;
    let rows: Vec<Vec<[u32; 2]>> = (0..height)
        .map(|y| (0..width).map(|x| [x, y]).collect())
        .collect();
    let next = AtomicUsize::new(0);
    let work = || {
        let mut done = Vec::new();
        while let Some(row) = rows.get(next.fetch_add(1, Ordering::Relaxed)) {
            done.push((row[0][1], real.sums(row)));
        }
        done
    };
    let cores = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
    let mut done: Vec<_> = std::thread::scope(|scope| {
        let threads: Vec<_> = (0..cores).map(|_| scope.spawn(work)).collect();
        let joined = threads.into_iter().map(std::thread::ScopedJoinHandle::join);
        joined.flat_map(|rows| rows.expect("a thread")).collect()
    });
    done.sort_by_key(|(y, _)| *y);
    let sums = done.into_iter().flat_map(|(_, sums)| sums);
    sums.map(|sum| sum.colour.map(|c| c / paths)).collect()
}

fn print(name: &str, theirs: &Mitsuba, ours: &Curve, errors: &[(f64, f64)]) {
    println!("\n{name}: qrt beside Mitsuba {}", theirs.version);
    println!(
        "(variant {}; the truth's own error, {:.2} %, is subtracted)",
        theirs.variant,
        100.0 * theirs.truth_error
    );
    println!("\n| sampler | samples: error in %, processor's seconds |\n|---|---|");
    let all = theirs.curves.iter().chain([ours]);
    for curve in all.clone() {
        let points = curve.points.iter().map(|point| {
            let percent = 100.0 * point.error;
            format!("{}: {percent:.2}, {:.3}", point.samples, point.seconds)
        });
        let points: Vec<String> = points.collect();
        println!("| {} | {} |", curve.name, points.join("; "));
    }
    let heads = errors.iter().map(|(e, _)| format!(" s to {} % |", 1e2 * e));
    println!("\n| sampler |{} ", heads.collect::<String>());
    println!("|---|{}", "---|".repeat(errors.len()));
    for curve in all {
        let cells = errors.iter().map(|&(error, _)| {
            let seconds = curve.seconds_to(error);
            seconds.map_or(" - |".to_owned(), |s| format!(" {s:.3} |"))
        });
        println!("| {} |{}", curve.name, cells.collect::<String>());
    }
    println!();
}

fn judge(
    name: &str,
    theirs: &Mitsuba,
    ours: &Curve,
    errors: &[(f64, f64)],
    promises: &mut Promises,
) {
    for &(error, most) in errors {
        let qrt = ours.seconds_to(error).unwrap_or(f64::INFINITY);
        let to_error = theirs.curves.iter().filter_map(|curve| {
            let seconds = curve.seconds_to(error)?;
            Some((curve.name.as_str(), seconds))
        });
        let best = to_error.clone().min_by(|a, b| a.1.total_cmp(&b.1));
        let best = best.expect("some sampler comes there");
        let independent = to_error.clone().find(|(name, _)| *name == "independent");
        let independent = independent.expect("independent samples come there");
        for ((sampler, seconds), most) in [(best, most), (independent, INDEPENDENT)] {
            let ratio = qrt / seconds;
            let percent = 100.0 * error;
            let what = format!(
                "{name} at {percent} %: {ratio:.2} of the seconds of {sampler}, at most {most}"
            );
            promises.judge(&what, ratio <= most);
        }
    }
}
