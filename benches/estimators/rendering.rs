//! Estimators of quantum rendering: coverage, convergence, and time.
//!
//! Promises, each judged: at a confidence of 95 %, the coverage is 94 % or more, for a
//! uniform in [0, 1] and at its extremes; the 95th-percentile error falls as 1/queries;
//! queries x error is within the bounds below; an estimate of 10^4 queries takes half a millisecond
//! at most.

use crate::common::{Arguments, Promises};
use qrt::drawing::Fit;
use qrt_counting::estimators::{CountingProblem, Device, Noise, Settings, estimator};
use qrt_counting::random::Stream;
use qrt_scene::{Counting, Estimator, Window};
use std::time::Instant;

/// The estimators, each with the largest allowed queries x 95th-percentile error.
const ESTIMATORS: [(Estimator, f64); 3] = [
    (Estimator::Qss, 5.1),
    (Estimator::Qcoin, 11.5),
    (Estimator::AbramsWilliams, 9.5),
];

fn settings(phase_bits: u32) -> Settings {
    let counting = Counting {
        phase_bits,
        repetitions: 1,
        window: Window::Rect,
        estimator: Some(Estimator::Qss),
        strata: None,
        error: None,
    };
    Settings::from_counting(&counting).unwrap()
}

/// Returns absolute errors in ascending order, and the coverage: the fraction of the intervals that contain
/// a.
fn measure(
    name: Estimator,
    settings: &Settings,
    runs: u32,
    total: u64,
    good: impl Fn(&mut Stream) -> u64,
) -> (Vec<f64>, f64) {
    let estimator = estimator(name, settings).unwrap();
    let mut covered = 0.0;
    let mut errors: Vec<f64> = (0..runs)
        .map(|run| {
            let mut stream = Stream::new(17, run, settings.phase_bits, 0);
            let problem = CountingProblem {
                good: good(&mut stream),
                total,
            };
            let mut device = Device::new(problem, Noise::NONE, &mut stream).unwrap();
            let found = estimator.estimate(&mut device).unwrap();
            assert!(found.queries <= settings.queries);
            let truth = problem.good as f64 / total as f64;
            let (low, high) = found.interval;
            covered += f64::from(u8::from(low - 1e-15 <= truth && truth <= high + 1e-15));
            (found.amplitude - truth).abs()
        })
        .collect();
    errors.sort_by(f64::total_cmp);
    (errors, covered / f64::from(runs))
}

fn uniform(total: u64) -> impl Fn(&mut Stream) -> u64 {
    move |stream| (stream.uniform() * (total + 1) as f64) as u64
}

pub(crate) fn run(_: &Arguments, promises: &mut Promises) {
    for (name, most) in ESTIMATORS {
        println!("{name}");
        let mut covered = f64::INFINITY;
        println!("  intervals of 95 %, 10000 runs of 1023 queries, hold S/N in");
        for total in [1_u64 << 40, 16] {
            let (_, coverage) = measure(name, &settings(10), 10_000, total, uniform(total));
            println!("    N = {total:<14} uniform   {:.2} %", 100.0 * coverage);
            covered = covered.min(coverage);
            for amplitude in [0.0, 1e-6, 0.5, 1.0 - 1e-6, 1.0] {
                let good = (amplitude * total as f64).round() as u64;
                let (_, coverage) = measure(name, &settings(10), 10_000, total, |_| good);
                println!(
                    "    N = {total:<14} {amplitude:<9} {:.2} %",
                    100.0 * coverage
                );
                covered = covered.min(coverage);
            }
        }
        println!("  queries   95 % of errors   x queries   mean x queries   RMSE x queries");
        let mut points = Vec::new();
        let mut largest = 0.0;
        for bits in [6, 8, 10, 12, 14, 16] {
            let queries = settings(bits).queries as f64;
            let (errors, _) = measure(name, &settings(bits), 4000, 1 << 40, uniform(1 << 40));
            let quantile = errors[errors.len() * 95 / 100];
            let squares: f64 = errors.iter().map(|error| error * error).sum();
            let rmse = (squares / errors.len() as f64).sqrt();
            let mean = errors.iter().sum::<f64>() / errors.len() as f64;
            println!(
                "  {queries:<9} {quantile:<16.3e} {:<11.2} {:<16.2} {:.2}",
                quantile * queries,
                mean * queries,
                rmse * queries
            );
            points.push((libm::log(queries), libm::log(quantile)));
            largest = f64::max(largest, quantile * queries);
        }
        let slope = Fit::from_points(points).unwrap().slope;

        let settings = Settings {
            queries: 10_000,
            ..settings(13)
        };
        // The quickest of several batches counts: slower ones include other work of the machine.
        let mut microseconds = f64::INFINITY;
        for _ in 0..20 {
            let (start, runs) = (Instant::now(), 100);
            measure(name, &settings, runs, 1 << 40, uniform(1 << 40));
            let each = 1e6 * start.elapsed().as_secs_f64() / f64::from(runs);
            microseconds = microseconds.min(each);
        }
        promises.judge(
            &format!(
                "{name}: least coverage {:.2} %, at least 94 %",
                100.0 * covered
            ),
            covered >= 0.94,
        );
        promises.judge(
            &format!("{name}: slope {slope:.3}, within 0.1 of -1"),
            (slope + 1.0).abs() < 0.1,
        );
        promises.judge(
            &format!("{name}: queries x 95th-percentile error {largest:.2}, below {most}"),
            largest < most,
        );
        promises.judge(
            &format!("{name}: {microseconds:.1} us an estimate of 10^4 queries, below 500"),
            microseconds < 500.0,
        );
        println!();
    }
}
