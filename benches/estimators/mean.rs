//! The mean phase on the pixels of six scenes, beside counting.
//!
//! `cargo bench --bench estimators -- mean` runs `phase-mean`, `auto`, `adaptive-bayes` and
//! `adaptive-bayes` without strata on some 380 channels of more than 200 pixels, at 255 to 16,383
//! queries. It prints, for each scene and number of queries, the geometric mean over channels of queries
//! times the 95th-percentile error, and the same of the root mean square error, both over sigma, the
//! standard deviation of the paths' colours; the worst channel's; and the fraction of intervals of 95 %
//! that hold the mean, on average and on the worst channel. A second table has the queries that the two
//! ways to count need, over those of `auto`, for equal 95th-percentile errors.
//!
//! Promised by the 95th-percentile error:
//!
//! * from 1,023 queries on, `adaptive-bayes` needs at least 1.8 times the queries of `auto` where sigma
//!   is below twice the mean;
//! * in no scene and at no number of queries fewer than 0.97 times;
//! * from 4,095 queries on, `phase-mean` is within 7 sigma over the queries, in the geometric mean over
//!   all channels.
//!
//! Intervals of 95 % of `phase-mean` and of `auto` hold the mean in at least 94 % of runs, on every channel. The
//! least of some 3,000 fractions is low by chance. So a channel below 94 % is run again, ten times as often and with
//! other outcomes, and the second fraction counts.
//!
//! A number behind `mean` sets the runs of each channel, 100 without it.

use super::common::{Arguments, Promises};
use qrt::counting::estimators::{AmplitudeEstimator, Device, Noise, Settings, estimator};
use qrt::counting::random::Stream;
use qrt::counting::{Comparators, Histogram};
use qrt::runtime::path_machines::{PathMachine, Real};
use qrt::scene::front::load;
use qrt::scene::{Counting, Estimator};
use qrt::tracer::{PixelClass, PixelClasses};
use std::fmt::Write;
use std::ops::Range;
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
    (
        "sky and low sun",
        "terrace",
        &["sun.radiance=[2, 1.8, 1.5]"],
    ),
    ("box without light sampling", "cornell-box", &[]),
];
/// Columns and rows of pixels of each scene.
const SIDE: u32 = 7;
/// One in this many channels of these pixels is measured.
const EVERY: usize = 2;
const PATH_BITS: u32 = 12;
const COMPARATOR_BITS: u32 = 10;
const REGISTERS: [u32; 4] = [8, 10, 12, 14];
/// Least fraction of the intervals of 95 % that hold the mean, on every channel.
const COVERED: f64 = 0.94;
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
    /// The pixel's number.
    pixel: usize,
    histogram: Histogram,
    mean: f64,
    sigma: f64,
}

/// Errors of an estimator on a channel, times queries over sigma.
#[derive(Clone, Copy)]
struct Errors {
    q95: f64,
    rms: f64,
    /// Fraction of intervals that hold the mean.
    covered: f64,
    /// The same; of other runs, ten times the number, if it is below [`COVERED`].
    judged: f64,
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
    let mut numbers = 0..;
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
        let found = found.into_iter().zip(numbers.by_ref());
        channels.extend(found.flat_map(|(rgb, pixel)| rgb.map(|channel| (pixel, channel))));
    }
    let chosen = channels.into_iter().enumerate();
    let chosen = chosen
        .filter(|(n, _)| n % EVERY == 0)
        .map(|(_, (pixel, histogram))| {
            let all = f64::from(1_u32 << COMPARATOR_BITS);
            let paths = histogram.paths() as f64;
            let mean = histogram.good() as f64 / paths / all;
            let square =
                |(level, paths): (u64, u64)| (level as f64 / all - mean).powi(2) * paths as f64;
            let sigma = (histogram.levels().map(square).sum::<f64>() / paths).sqrt();
            Channel {
                pixel,
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
    runs: Range<u32>,
) -> Errors {
    let mut covered = 0;
    let count = runs.len();
    let mut errors: Vec<f64> = runs
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
        q95: unit * errors[(count * 95 / 100).min(count - 1)],
        rms: unit * (squares / count as f64).sqrt(),
        covered: f64::from(covered) / count as f64,
        judged: f64::from(covered) / count as f64,
    }
}

/// The errors of `runs` runs, and the coverage of more if few intervals hold the mean.
fn judged(
    channel: &Channel,
    estimator: &dyn AmplitudeEstimator,
    queries: u64,
    runs: u32,
) -> Errors {
    let mut found = errors(channel, estimator, queries, 0..runs);
    if found.covered < COVERED {
        found.judged = errors(channel, estimator, queries, runs..11 * runs).covered;
    }
    found
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
                own.push((n, judged(channel, estimator, queries, runs)));
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

/// Ratios of the queries of a way to count to those of `auto`, for equal 95th-percentile errors, by channel.
fn ratios(counted: &[Errors], auto: &[Errors]) -> Vec<f64> {
    let pairs = counted.iter().zip(auto);
    pairs
        .map(|(counted, auto)| counted.q95.max(1e-9) / auto.q95.max(1e-9))
        .collect()
}

fn least(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(f64::INFINITY, f64::min)
}

/// Measurements of all scenes at one number of queries.
#[derive(Default)]
struct Measured {
    /// Queries of `adaptive-bayes` over those of `auto`, where sigma is below twice the mean, and elsewhere.
    ratios: [Vec<f64>; 2],
    /// q95 of `phase-mean`.
    of_mean_phase: Vec<f64>,
}

pub(crate) fn run(arguments: &Arguments, promises: &mut Promises) {
    let runs: u32 = arguments.word().map_or(100, |runs| runs.parse().unwrap());
    let mut csv = String::from(
        "scene,channels,runs,queries,estimator,q95,q95_worst,rmse,rmse_worst,covered,covered_worst\n",
    );
    let mut by_queries: [Measured; REGISTERS.len()] = Default::default();
    let mut pixels = 0;
    // Scene, queries: the geometric mean over its channels.
    let mut of_scenes = Vec::new();
    let mut covered_worst = 1.0_f64;
    for (what, name, sets) in SCENES {
        let channels = channels(name, sets);
        let mut numbers: Vec<usize> = channels.iter().map(|channel| channel.pixel).collect();
        numbers.dedup();
        pixels += numbers.len();
        println!(
            "\n### {what}: {} channels of {} pixels\n",
            channels.len(),
            numbers.len()
        );
        println!(
            "| queries | estimator | q95 x Q / sigma | worst | RMSE x Q / sigma | worst | coverage | worst |"
        );
        println!("| --- | --- | --- | --- | --- | --- | --- | --- |");
        let mut comparison = Vec::new();
        for (bits, all) in REGISTERS.into_iter().zip(&mut by_queries) {
            let mut by_way = Vec::new();
            let mut queries = 0;
            for (way, estimate, strata) in WAYS {
                let counting = Counting {
                    phase_bits: bits,
                    strata,
                    ..Counting::default()
                };
                let settings = Settings::from_counting(&counting).unwrap();
                let estimator = estimator(estimate, &settings).unwrap();
                queries = settings.queries;
                let found = measured(&channels, &*estimator, queries, runs);
                let most = |value: fn(&Errors) -> f64| found.iter().map(value).fold(0.0, f64::max);
                let covered: f64 = found.iter().map(|errors| errors.covered).sum();
                let least = least(found.iter().map(|errors| errors.judged));
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
                    covered_worst = covered_worst.min(least);
                }
                by_way.push(found);
            }
            let [mean_phase, auto, strata, whole] = &by_way[..] else {
                unreachable!("four ways are measured");
            };
            let of_mean_phase = mean_phase.iter().map(|errors| errors.q95);
            all.of_mean_phase.extend(of_mean_phase);
            let by_strata = ratios(strata, auto);
            for (channel, ratio) in channels.iter().zip(&by_strata) {
                let wide = usize::from(channel.sigma > 2.0 * channel.mean);
                all.ratios[wide].push(*ratio);
            }
            of_scenes.push((what, queries, geometric(by_strata.iter().copied())));
            let both = [by_strata, ratios(whole, auto)];
            let both = both.map(|ratios| {
                let mean = geometric(ratios.iter().copied());
                format!("{mean:.2} | {:.2}", least(ratios.into_iter()))
            });
            comparison.push(format!("| {queries} | {} |", both.join(" | ")));
        }
        println!("\nqueries over those of `auto`, for equal 95th-percentile errors\n");
        println!("| queries | adaptive-bayes | worst | one register | worst |");
        println!("| --- | --- | --- | --- | --- |");
        println!("{}", comparison.join("\n"));
    }
    if let (Some(file), true) = (arguments.csv(), arguments.names("mean")) {
        std::fs::write(file, csv).unwrap_or_else(|error| panic!("{file}: {error}"));
    }
    println!(
        "\n{pixels} pixels; queries of `adaptive-bayes` over those of `auto`, for equal 95th-percentile errors\n"
    );
    println!("| queries | sigma below twice the mean | channels | above | channels |");
    println!("| --- | --- | --- | --- | --- |");
    for (bits, all) in REGISTERS.into_iter().zip(by_queries) {
        let [near, wide] = (all.ratios.each_ref()).map(|ratios| geometric(ratios.iter().copied()));
        let queries = (1_u64 << bits) - 1;
        println!(
            "| {queries} | {near:.2} | {} | {wide:.2} | {} |",
            all.ratios[0].len(),
            all.ratios[1].len()
        );
        if bits >= 10 {
            promises.judge(
                &format!("{queries} queries: `auto` needs {near:.2} times fewer, at least 1.8"),
                near >= 1.8,
            );
        }
        if bits >= 12 {
            let most = geometric(all.of_mean_phase.into_iter());
            promises.judge(
                &format!(
                    "{queries} queries: 95 % of `phase-mean` within {most:.2} sigma / Q, at most 7"
                ),
                most <= 7.0,
            );
        }
    }
    promises.judge(&format!("{pixels} pixels, at least 200"), pixels >= 200);
    let lowest = of_scenes.iter().min_by(|a, b| a.2.total_cmp(&b.2));
    if let Some((scene, queries, ratio)) = lowest {
        promises.judge(
            &format!("{scene}, {queries} queries: `auto` needs {ratio:.2} times fewer, the least, at least 0.97"),
            *ratio >= 0.97,
        );
    }
    let what = format!(
        "intervals of 95 %: {:.1} % on the worst channel, at least 94 %",
        100.0 * covered_worst
    );
    promises.judge(&what, covered_worst >= COVERED);
}
