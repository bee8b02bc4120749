//! The mean phase on the pixels of six scenes, beside counting.
//!
//! `cargo bench --bench estimators -- mean` runs `phase-mean`, `auto`, `adaptive-bayes` and
//! `adaptive-bayes` without strata on some 380 channels of 294 pixels, at 255 to 16,383 queries. It
//! prints, for each scene and number of queries, the geometric mean over channels of queries times
//! the 95th-percentile error, and the same of the root mean square error, both over sigma, the
//! standard deviation of the paths' colours; the worst channel's; and the fraction of intervals of 95 %
//! that hold the mean, on average and on the worst channel.
//!
//! Promised from 1,023 queries on, by the 95th-percentile error: `adaptive-bayes` needs at least 1.8
//! times the queries of `auto` where sigma is below twice the mean, and 0.93 times elsewhere. Intervals
//! of 95 % hold the mean in 94 % of runs, on average over each scene.
//!
//! A number behind `mean` sets the runs of each channel, 100 without it.

use super::common::{Arguments, Promises};
use qrt::core::tracer::{PixelClass, PixelClasses};
use qrt::counting::estimators::{AmplitudeEstimator, Device, Noise, Settings, estimator};
use qrt::counting::random::Stream;
use qrt::counting::{Comparators, Histogram};
use qrt::runtime::path_machines::{PathMachine, Real};
use qrt::scene::front::load;
use qrt::scene::{Counting, Estimator};
use std::fmt::Write;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Scenes, and the settings with which they are measured.
const SCENES: [(&str, &str, &[&str]); 6] = [
    ("box lit", "lit-box", &[]),
    (
        "glass lit",
        "cornell-glass",
        &["sampling.depths=4", "sampling.lights=auto"],
    ),
    (
        "knot lit",
        "knot",
        &["sampling.depths=3", "sampling.lights=auto"],
    ),
    ("sky", "weekend", &[]),
    ("sky with glass", "weekend", &["sampling.depths=6"]),
    ("box without light sampling", "cornell-box", &[]),
];
/// Columns and rows of pixels of each scene.
const SIDE: u32 = 7;
/// One in this many channels of these pixels is measured.
const EVERY: usize = 2;
const PATH_BITS: u32 = 12;
const COMPARATOR_BITS: u32 = 10;
const REGISTERS: [u32; 4] = [8, 10, 12, 14];
/// Sigma of a channel below this has nothing to be estimated: levels are 2^-10 apart.
const FLAT: f64 = 2e-3;

/// The ways to estimate: a name, an estimator and the strata.
const WAYS: [(&str, Estimator, Option<u32>); 4] = [
    ("phase-mean", Estimator::PhaseMean, None),
    ("auto", Estimator::Auto, None),
    ("adaptive-bayes", Estimator::AdaptiveBayes, None),
    ("one register", Estimator::AdaptiveBayes, Some(1)),
];

/// A channel of a pixel.
struct Channel {
    histogram: Histogram,
    mean: f64,
    sigma: f64,
}

/// Errors of an estimator on a channel, times queries over sigma.
#[derive(Clone, Copy)]
struct Errors {
    q95: f64,
    rms: f64,
    covered: f64,
}

fn channels(name: &str, sets: &[&str]) -> Vec<Channel> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes-yaml");
    let mut all: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
    all.push(format!("sampling.path_bits={PATH_BITS}"));
    all.push(format!("comparator.bits={COMPARATOR_BITS}"));
    let scene = load(&folder.join(format!("{name}.yaml")), &all)
        .unwrap()
        .valid;
    let film = scene.scene().film;
    let classes = PixelClasses::new(&scene);
    let place = |n: u32, of: u32| (2 * n + 1) * of / (2 * SIDE);
    let pixels =
        (0..SIDE * SIDE).map(|n| [place(n % SIDE, film.width), place(n / SIDE, film.height)]);
    let pixels: Vec<[u32; 2]> = pixels.collect();
    let mut channels = Vec::new();
    for class in PixelClass::ALL {
        let own = pixels
            .iter()
            .filter(|pixel| classes.class(**pixel) == class);
        let own: Vec<[u32; 2]> = own.copied().collect();
        let real = Real::of_class(&scene, 0, class).unwrap();
        let bounds = PathMachine::bounds(&real);
        let comparators = Comparators::rgb(bounds, scene.scene().comparator).unwrap();
        let none = || [(); 3].map(|()| Histogram::new(COMPARATOR_BITS));
        let mut found: Vec<[Histogram; 3]> = own.iter().map(|_| none()).collect();
        real.trace(&own, |block| {
            for (channel, colours) in block.colours.into_iter().enumerate() {
                let levels = colours
                    .iter()
                    .map(|colour| comparators[channel].good(*colour));
                found[block.pixel][channel].add_all(levels.map(u64::from));
            }
        });
        channels.extend(found.into_iter().flatten());
    }
    let chosen = channels.into_iter().enumerate();
    let chosen = chosen
        .filter(|(n, _)| n % EVERY == 0)
        .map(|(_, histogram)| {
            let all = f64::from(1_u32 << COMPARATOR_BITS);
            let paths = histogram.paths() as f64;
            let mean = histogram.good() as f64 / paths / all;
            let square =
                |(level, paths): (u64, u64)| (level as f64 / all - mean).powi(2) * paths as f64;
            let sigma = (histogram.levels().map(square).sum::<f64>() / paths).sqrt();
            Channel {
                histogram,
                mean,
                sigma,
            }
        });
    chosen.filter(|channel| channel.sigma > FLAT).collect()
}

fn errors(
    channel: &Channel,
    estimator: &dyn AmplitudeEstimator,
    queries: u64,
    runs: u32,
) -> Errors {
    let mut covered = 0;
    let mut errors: Vec<f64> = (0..runs)
        .map(|run| {
            let mut stream = Stream::new(queries, run, 0, 0);
            let histogram = &channel.histogram;
            let mut device = Device::of_histogram(histogram, Noise::NONE, &mut stream).unwrap();
            let found = estimator.estimate(&mut device).unwrap();
            let (low, high) = found.interval;
            covered += u32::from((low..=high).contains(&channel.mean));
            (found.amplitude - channel.mean).abs()
        })
        .collect();
    errors.sort_by(f64::total_cmp);
    let unit = queries as f64 / channel.sigma;
    let squares: f64 = errors.iter().map(|error| error * error).sum();
    Errors {
        q95: unit * errors[(runs as usize * 95 / 100).min(errors.len() - 1)],
        rms: unit * (squares / f64::from(runs)).sqrt(),
        covered: f64::from(covered) / f64::from(runs),
    }
}

/// All channels' errors, measured on all threads.
fn measured(
    channels: &[Channel],
    estimator: &(dyn AmplitudeEstimator + Sync),
    queries: u64,
    runs: u32,
) -> Vec<Errors> {
    let next = AtomicUsize::new(0);
    let threads = std::thread::available_parallelism().map_or(1, std::num::NonZero::get);
    let mut found: Vec<(usize, Errors)> = std::thread::scope(|scope| {
        let work = || {
            let mut own = Vec::new();
            loop {
                let n = next.fetch_add(1, Ordering::Relaxed);
                let Some(channel) = channels.get(n) else {
                    return own;
                };
                own.push((n, errors(channel, estimator, queries, runs)));
            }
        };
        let workers: Vec<_> = (0..threads).map(|_| scope.spawn(work)).collect();
        let joined = workers.into_iter().map(|worker| worker.join().unwrap());
        joined.flatten().collect()
    });
    found.sort_by_key(|(n, _)| *n);
    found.into_iter().map(|(_, errors)| errors).collect()
}

fn geometric(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0), |(sum, count), value: f64| {
        (sum + value.max(1e-9).ln(), count + 1)
    });
    (sum / f64::from(count.max(1))).exp()
}

pub(crate) fn run(arguments: &Arguments, promises: &mut Promises) {
    let runs: u32 = arguments.word().map_or(100, |runs| runs.parse().unwrap());
    let mut csv = String::from(
        "scene,channels,runs,queries,estimator,q95,q95_worst,rmse,rmse_worst,covered,covered_worst\n",
    );
    // By queries: ratios of q95 of `adaptive-bayes` to `auto`, where sigma is small beside the mean, and elsewhere.
    let mut ratios = [const { [const { Vec::new() }; 2] }; REGISTERS.len()];
    let mut worst_coverage = 1.0_f64;
    for (what, name, sets) in SCENES {
        let channels = channels(name, sets);
        println!("\n### {what}: {} channels\n", channels.len());
        println!(
            "| queries | estimator | q95 x Q / sigma | worst | RMSE x Q / sigma | worst | coverage | worst |"
        );
        println!("| --- | --- | --- | --- | --- | --- | --- | --- |");
        for (bits, ratios) in REGISTERS.into_iter().zip(&mut ratios) {
            let mut by_way = Vec::new();
            for (way, estimate, strata) in WAYS {
                let counting = Counting {
                    phase_bits: bits,
                    strata,
                    ..Counting::default()
                };
                let settings = Settings::from_counting(&counting).unwrap();
                let estimator = estimator(estimate, &settings).unwrap();
                let queries = settings.queries;
                let found = measured(&channels, &*estimator, queries, runs);
                let most = |value: fn(&Errors) -> f64| found.iter().map(value).fold(0.0, f64::max);
                let covered: f64 = found.iter().map(|errors| errors.covered).sum();
                let least = found
                    .iter()
                    .map(|errors| errors.covered)
                    .fold(1.0, f64::min);
                let figures = [
                    geometric(found.iter().map(|errors| errors.q95)),
                    most(|errors| errors.q95),
                    geometric(found.iter().map(|errors| errors.rms)),
                    most(|errors| errors.rms),
                    100.0 * covered / found.len() as f64,
                    100.0 * least,
                ];
                let figures = figures.map(|figure| format!("{figure:.1}"));
                let [q95, q95_worst, rms, rms_worst, mean, worst] = &figures;
                println!(
                    "| {queries} | {way} | {q95} | {q95_worst} | {rms} | {rms_worst} | {mean} % | {worst} % |"
                );
                let figures = figures.join(",");
                let channels = channels.len();
                writeln!(csv, "{what},{channels},{runs},{queries},{way},{figures}").unwrap();
                if estimate != Estimator::AdaptiveBayes {
                    worst_coverage = worst_coverage.min(covered / found.len() as f64);
                }
                by_way.push(found);
            }
            for ((channel, auto), counted) in channels.iter().zip(&by_way[1]).zip(&by_way[2]) {
                let wide = usize::from(channel.sigma > 2.0 * channel.mean);
                ratios[wide].push(counted.q95.max(1e-9) / auto.q95.max(1e-9));
            }
        }
    }
    if let (Some(file), true) = (arguments.csv(), arguments.names("mean")) {
        std::fs::write(file, csv).unwrap_or_else(|error| panic!("{file}: {error}"));
    }
    println!(
        "\nqueries of `adaptive-bayes` over those of `auto`, for equal 95th-percentile errors\n"
    );
    println!("| queries | sigma below twice the mean | channels | above | channels |");
    println!("| --- | --- | --- | --- | --- |");
    for (bits, ratios) in REGISTERS.into_iter().zip(&ratios) {
        let [near, wide] = ratios
            .each_ref()
            .map(|ratios| geometric(ratios.iter().copied()));
        let queries = (1_u64 << bits) - 1;
        println!(
            "| {queries} | {near:.2} | {} | {wide:.2} | {} |",
            ratios[0].len(),
            ratios[1].len()
        );
        if bits >= 10 {
            promises.judge(
                &format!("{queries} queries: `auto` needs {near:.2} times fewer, at least 1.8"),
                near >= 1.8,
            );
            promises.judge(
                &format!("{queries} queries, wide colours: {wide:.2} times, at least 0.93"),
                wide >= 0.93,
            );
        }
    }
    let what = format!(
        "intervals of 95 %: {:.1} % on average in the worst case, at least 94 %",
        100.0 * worst_coverage
    );
    promises.judge(&what, worst_coverage >= 0.94);
}
