//! Checks that the planner keeps a requested accuracy, and measures its price.
//!
//! `cargo bench --bench accuracy -- plans` requests three errors for each of four scenes, renders
//! each plan on the circuit's numbers, and compares with 2^23 paths of another seed. It fails
//! unless the requested fraction of channels is within the requested error, at no more than twice
//! the queries of the best parameters that a sweep by hand finds: every register and number of
//! repetitions, over any number of paths. Then it requests an error of 1 % for the Cornell box with
//! its lamp sampled, and fails unless the best parameters by hand, which count the comparator
//! whole, take 2.5 times fewer queries than without, and a plan, which counts it by strata and
//! stops by itself, 6 times fewer. Last, it plans and renders four scenes with sampled lamps by the default
//! estimator, `auto`, and by `adaptive-bayes`. It fails unless both keep the accuracy, and `auto` takes
//! fewer queries and at most twice the processor time, in the geometric mean. A word behind the name selects the scenes
//! whose names contain it; `lamps` selects the sampled lamp, `estimators` the two estimators.

use crate::common::{Arguments, Promises, processor};
use qrt_counting::estimators::{CountingProblem, Device, Noise, Settings, estimator};
use qrt_counting::random::Stream;
use qrt_runtime::Prepared;
use qrt_runtime::memory::Memory;
use qrt_runtime::path_machines::Real;
use qrt_runtime::plan::{self, Plan};
use qrt_runtime::render::{Model, RenderOptions};
use qrt_runtime::sample::{Means, prefix_means, radiance, spread};
use qrt_runtime::workers::Workers;
use qrt_scene::meshes::Meshes;
use qrt_scene::valid::{ValidScene, validate};
use qrt_scene::{Accuracy, Comparator, Counting, Estimator, Film, Precision, Sampling, Scene};
use qrt_tracer::{PixelClass, PixelClasses};
use std::path::Path;
use std::time::Instant;

const SCENES: [&str; 4] = [
    "floor-and-light",
    "cornell-box",
    "cornell-mirror",
    "cornell-ggx",
];
const ERRORS: [f64; 3] = [0.1, 0.03, 0.01];
const CONFIDENCE: f64 = 0.95;
const SIDE: u32 = 20;
/// Path bits of the reference means, at least four times the paths of any picture, and their seed.
const TRUTH: (u32, u64) = (23, 77);
/// Seed of the sweep's paths.
const SEED: u64 = 1;
/// Seeds of the pictures.
const SEEDS: [u64; 3] = [1, 2, 3];
/// Path bits of the sweep.
const PATHS: [u32; 5] = [12, 14, 16, 18, 20];
/// Number of pictures over which the sweep's fractions are averaged.
const DRAWS: u64 = 4;
/// Largest shortfall of the first picture's fraction with which the sweep tries the others: more than
/// three standard deviations of the fraction.
const LACK: f64 = 0.02;

/// Loads the scene `name` with the overrides `sets`, and requests `error`.
fn scene(name: &str, sets: &[&str], error: f64) -> ValidScene {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes-yaml");
    let sets: Vec<String> = sets.iter().map(|&set| set.into()).collect();
    let loaded = qrt_scene::front::load(&root.join(format!("{name}.yaml")), &sets);
    let scene: Scene = loaded.unwrap().valid.scene().clone();
    let scene = Scene {
        film: Film {
            width: SIDE,
            height: SIDE,
        },
        sampling: Sampling {
            path_bits: Sampling::default().path_bits,
            ..scene.sampling
        },
        precision: Precision::default(),
        comparator: Comparator::default(),
        counting: Counting::default(),
        accuracy: Some(Accuracy {
            error,
            confidence: CONFIDENCE,
        }),
        ..scene
    };
    validate(scene, &Meshes::default()).unwrap()
}

/// Returns the fraction of `values` within `error` of `truth`.
fn share(values: &[[f64; 3]], truth: &[[f64; 3]], error: f64) -> f64 {
    let pairs = values.iter().flatten().zip(truth.iter().flatten());
    let within = pairs.filter(|(a, b)| (*a - *b).abs() <= error).count();
    within as f64 / (3 * truth.len()) as f64
}

/// Returns the fewest queries a pixel with which counting over one of `means` keeps the error, and the
/// parameters; `bounds` are the scales of the pixels.
fn by_hand(
    means: &[Means],
    truth: &Means,
    bounds: &[[f64; 3]],
    error: f64,
    name: Estimator,
) -> Option<(f64, [u32; 3])> {
    let pixels = spread([SIDE; 2], u64::MAX);
    let total = 1_u64 << 40;
    let mut registers: Vec<[u32; 2]> = (3..=18)
        .flat_map(|phase_bits| [1, 2, 3, 5, 7].map(|repetitions| [phase_bits, repetitions]))
        .collect();
    registers.sort_by_key(|[phase_bits, repetitions]| ((1 << phase_bits) - 1) * repetitions);
    // Counting cannot repair the error of too few paths, so those are left out.
    let enough = |means: &Means| share(means, truth, error) >= CONFIDENCE - LACK;
    let means: Vec<(&Means, u32)> = means.iter().zip(PATHS).filter(|m| enough(m.0)).collect();
    for [phase_bits, repetitions] in registers {
        let counting = Counting {
            phase_bits,
            repetitions,
            ..Counting::default()
        };
        let made = estimator(name, &Settings::from_counting(&counting).unwrap()).unwrap();
        for &(means, bits) in &means {
            let (mut kept, mut spent) = (0.0, 0);
            for draw in 0..DRAWS {
                // The first draw is too far off for the other draws to make up.
                if draw == 1 && kept * (DRAWS as f64) < CONFIDENCE - LACK {
                    break;
                }
                let pixel = |((&[x, y], mean), bound): ((&[u32; 2], &[f64; 3]), &[f64; 3])| {
                    let channel = |c: usize| {
                        if bound[c] == 0.0 {
                            return 0.0;
                        }
                        let good = (mean[c] / bound[c] * total as f64) as u64;
                        let mut stream = Stream::new(1000 + draw, x, y, c as u8);
                        let problem = CountingProblem { good, total };
                        let mut device = Device::new(problem, Noise::NONE, &mut stream).unwrap();
                        let estimate = made.estimate(&mut device).unwrap();
                        spent += estimate.queries;
                        bound[c] * estimate.amplitude
                    };
                    [0, 1, 2].map(channel)
                };
                let pixels = pixels.iter().zip(means).zip(bounds);
                let values: Means = pixels.map(pixel).collect();
                kept += share(&values, truth, error) / DRAWS as f64;
            }
            if kept >= CONFIDENCE {
                let spent = spent as f64 / (DRAWS * bounds.len() as u64) as f64;
                return Some((spent, [bits, phase_bits, repetitions]));
            }
        }
    }
    None
}

pub(crate) fn run(arguments: &Arguments, promises: &mut Promises) {
    let mut fine = true;
    println!(
        "{:<16}{:>6} {:>4} {:>4} {:>4} {:>3} {:>2} {:>9} {:>8} {:>8} {:>9}  by hand",
        "scene",
        "error",
        "2^R",
        "frac",
        "2^C",
        "t",
        "B",
        "queries",
        "expected",
        "measured",
        "plan, s"
    );
    let asked = arguments.word();
    for name in SCENES {
        if asked.is_some_and(|asked| !name.contains(asked)) {
            continue;
        }
        let any = scene(name, &[], ERRORS[0]);
        let wide = wide(&any, TRUTH.0);
        let truth = truth(&wide);
        let (means, bounds) = paths(&wide);
        let mean = radiance(&truth);
        for error in ERRORS {
            let asked = scene(name, &[], error);
            let start = Instant::now();
            let planned: Plan = match plan::plan(&asked, &plan::PlanOptions::default()) {
                Ok(planned) => planned.unwrap(),
                Err(failed) => {
                    println!("{name:<16}{error:>6} {failed}");
                    fine = false;
                    continue;
                }
            };
            let seconds = start.elapsed().as_secs_f64();
            let (queries, measured) = counted(&asked, &planned, &truth);
            let figures = planned.figures;
            let hand = by_hand(&means, &truth, &bounds, error * mean, figures.estimator);
            let hand_text = hand.map_or("none".to_owned(), |(queries, [r, t, b])| {
                format!("{queries:.0} (2^{r}, t={t}, B={b})")
            });
            println!(
                "{name:<16}{error:>6} {:>4} {:>4} {:>4} {:>3} {:>2} {queries:>9.0} {:>8.4} \
                 {measured:>8.4} {seconds:>9.1}  {hand_text}",
                figures.path_bits,
                figures
                    .fraction
                    .map_or("-".to_owned(), |bits| bits.to_string()),
                figures.comparator_bits,
                figures.phase_bits,
                figures.repetitions,
                figures.within,
            );
            if measured < CONFIDENCE {
                println!("  the promise is broken");
                fine = false;
            }
            if hand.is_some_and(|(best, _)| queries > 2.0 * best) {
                println!("  more than twice the queries of the best parameters");
                fine = false;
            }
        }
    }
    if asked.is_none_or(|asked| "lamps".contains(asked)) {
        fine &= lamps_pay();
    }
    promises.judge("all plans keep their accuracy at their price", fine);
    if asked.is_none_or(|asked| "estimators".contains(asked)) {
        by_estimators(promises);
    }
}

/// Scenes with sampled lamps, and their settings.
const LIT: [(&str, &[&str]); 4] = [
    (
        "floor-and-light",
        &["sampling.depths=3", "sampling.lights=auto"],
    ),
    (
        "cornell-mirror",
        &["sampling.depths=3", "sampling.lights=auto"],
    ),
    (
        "cornell-ggx",
        &["sampling.depths=3", "sampling.lights=auto"],
    ),
    ("terrace", &["sun.radiance=[2, 1.8, 1.5]"]),
];
/// Path bits of these scenes' reference means.
const LIT_TRUTH: u32 = 18;

fn by_estimators(promises: &mut Promises) {
    println!("| scene | error | estimator | queries | within | processor time |");
    println!("| --- | --- | --- | --- | --- | --- |");
    let (mut queries, mut seconds) = (1.0, 1.0);
    let mut kept = true;
    let errors = &ERRORS[..2];
    for (name, sets) in LIT {
        let wide = wide(&scene(name, sets, ERRORS[0]), LIT_TRUTH);
        let truth = truth(&wide);
        for &error in errors {
            let asked = scene(name, sets, error);
            let [auto, counting] = [Estimator::Auto, Estimator::AdaptiveBayes].map(|estimator| {
                let begun = processor::seconds();
                let options = plan::PlanOptions {
                    estimator: Some(estimator),
                    ..plan::PlanOptions::default()
                };
                let planned: Plan = plan::plan(&asked, &options).unwrap().unwrap();
                let (queries, measured) = counted(&asked, &planned, &truth);
                let seconds = processor::seconds() - begun;
                println!("| {name} | {error} | {estimator} | {queries:.0} | {measured:.4} | {seconds:.1} s |");
                kept &= measured >= CONFIDENCE;
                [queries, seconds]
            });
            queries *= counting[0] / auto[0];
            seconds *= auto[1] / counting[1];
        }
    }
    let cases = (LIT.len() * errors.len()) as f64;
    let (queries, seconds) = (queries.powf(1.0 / cases), seconds.powf(1.0 / cases));
    promises.judge(
        "plans by `auto` and `adaptive-bayes` keep their accuracy",
        kept,
    );
    promises.judge(
        &format!("plans by `auto` take {queries:.2} times fewer queries, more than 1"),
        queries > 1.0,
    );
    promises.judge(
        &format!("plans by `auto` take {seconds:.2} times the processor time, at most 2"),
        seconds <= 2.0,
    );
}

/// Returns the scene with 2^`bits` paths, for the reference means.
fn wide(scene: &ValidScene, bits: u32) -> ValidScene {
    let mut parameters = scene.parameters();
    parameters.sampling.path_bits = bits;
    scene.with_parameters(parameters).unwrap()
}

fn truth(wide: &ValidScene) -> Means {
    let pixels = spread([SIDE; 2], u64::MAX);
    let real = Real::new(wide, TRUTH.1).unwrap();
    let bits = wide.scene().sampling.path_bits;
    prefix_means(&real, &pixels, &[bits], &Workers::default())
        .unwrap()
        .remove(0)
}

/// Returns the means over each number of paths of the sweep, and the scales of the pixels.
fn paths(wide: &ValidScene) -> (Vec<Means>, Vec<[f64; 3]>) {
    let pixels = spread([SIDE; 2], u64::MAX);
    let classes = PixelClasses::new(wide);
    let of = |class| Real::of_class(wide, SEED, class).unwrap();
    let [all, dim] = PixelClass::ALL.map(of);
    let scale = |&pixel: &[u32; 2]| match classes.class(pixel) {
        PixelClass::MayMeetLamp => all.stage().bound(),
        PixelClass::MeetsNoLamp => dim.stage().bound(),
    };
    let means = prefix_means(&all, &pixels, &PATHS, &Workers::default()).unwrap();
    (means, pixels.iter().map(scale).collect())
}

/// Renders by a plan; returns queries a pixel, and the fraction of channels within the requested error.
fn counted(asked: &ValidScene, planned: &Plan, truth: &Means) -> (f64, f64) {
    let error = planned.figures.accuracy.error * radiance(truth);
    let (mut queries, mut within) = (0.0, 0.0);
    let prepared = Prepared::with_plan(asked, Some(planned.clone()), Memory::default());
    for seed in SEEDS {
        let options = RenderOptions {
            seed,
            model: Some(Model::Fixed),
            ..RenderOptions::default()
        };
        let picture = prepared.render(&options).unwrap().0;
        queries += picture.total_queries() as f64 / truth.len() as f64;
        within += share(&picture.image.pixels, truth, error);
    }
    let pictures = SEEDS.len() as f64;
    (queries / pictures, within / pictures)
}

/// Least ratios of the queries for the Cornell box by hand without a sampled lamp to those with one: by
/// hand, with the comparator counted whole and all channels alike, and by a plan.
const LAMPS_PAY: [f64; 2] = [2.5, 6.0];

fn lamps_pay() -> bool {
    const LIT: &str = "sampling.depths=[{ bits: [8, 8] }, { bits: [8, 8], light: [8, 8] }, \
                       { bits: [8, 8], light: [8, 8] }]";
    const ERROR: f64 = 0.01;
    let mut fine = true;
    let mut spent = Vec::new();
    for (about, sets) in [
        ("not sampled", &[][..]),
        ("sampled", &[LIT, "sampling.lights=auto"]),
    ] {
        let asked = scene("cornell-box", sets, ERROR);
        let wide = wide(&asked, TRUTH.0);
        let truth = truth(&wide);
        let planned: Plan = plan::plan(&asked, &plan::PlanOptions::default())
            .unwrap()
            .unwrap();
        let (queries, measured) = counted(&asked, &planned, &truth);
        let (means, bounds) = paths(&wide);
        let error = ERROR * radiance(&truth);
        let hand = by_hand(&means, &truth, &bounds, error, planned.figures.estimator);
        let (hand, [r, t, b]) = hand.unwrap();
        println!(
            "cornell-box, error {ERROR}, lamp {about}: {queries:.0} queries a pixel, 2^{} paths, \
             {measured:.4} within; by hand {hand:.0} (2^{r}, t={t}, B={b})",
            planned.figures.path_bits
        );
        if measured < CONFIDENCE {
            println!("  the promise is broken");
            fine = false;
        }
        spent.push([hand, queries]);
    }
    let [[unlit, _], lit] = spent[..] else {
        unreachable!("both were asked")
    };
    for (lit, promise) in lit.into_iter().zip(LAMPS_PAY) {
        println!("  {:.2} times fewer, at least {promise}", unlit / lit);
        fine &= unlit >= promise * lit;
    }
    fine
}
