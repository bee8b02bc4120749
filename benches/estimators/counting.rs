//! Price of counting: of a draw, of an estimate, and of a whole 64 x 64 picture, on one core.
//!
//! `cargo bench --bench estimators -- counting` prints processor time, the least of several
//! measurements. It fails where a promise is broken: a draw at T = 2^40 takes at most twice as long as
//! at 2^8, and the counting noise of 64 x 64 pixels and three channels takes less than a second, at
//! any register of 8 to 16 bits and up to eight repetitions.

use crate::common::{Arguments, Promises, processor};
use qrt_counting::estimators::{CountingProblem, estimate};
use qrt_counting::random::Stream;
use qrt_counting::{Comparators, PhaseDistribution};
use qrt_scene::{Comparator, ComparatorAt, Counting, Estimator, Window};
use std::hint::black_box;

const PROBLEM: CountingProblem = CountingProblem {
    good: 1_234_567,
    total: 1 << 22,
};

/// Number of measurements of which the least counts.
const RUNS: usize = 5;

/// Promised ratio of the time of a draw at T = 2^40 to that at 2^8.
const GROWTH: f64 = 2.0;

pub(crate) fn run(_: &Arguments, promises: &mut Promises) {
    draws(promises);
    estimates();
    pictures(promises);
    comparators();
}

fn draws(promises: &mut Promises) {
    println!("nanoseconds a draw, by T");
    for window in [Window::Rect, Window::Sine] {
        let times = [8, 16, 40].map(|bits| {
            let counted = PhaseDistribution::new(PROBLEM.good, PROBLEM.total, bits, window);
            let counted = counted.expect("a register of few bits");
            let (sampler, mut stream) = (counted.sampler(), Stream::new(1, 0, 0, 0));
            let time = processor::least(RUNS, || {
                black_box(sampler.sample(&mut stream));
            });
            println!(
                "  {:5} 2^{bits:<2} {:8.1}",
                format!("{window:?}"),
                1e9 * time
            );
            time
        });
        let growth = times[2] / times[0];
        promises.judge(
            &format!(
                "{window:?}: a draw at 2^40 takes {growth:.2} times that at 2^8, at most {GROWTH}"
            ),
            growth <= GROWTH,
        );
    }
}

fn settings(estimator: Estimator, phase_bits: u32, repetitions: u32) -> Counting {
    Counting {
        phase_bits,
        repetitions,
        window: Window::Sine,
        estimator: Some(estimator),
        strata: None,
        error: None,
    }
}

fn estimates() {
    println!("\nmicroseconds an estimate, by t and B");
    for name in [Estimator::Paper, Estimator::Sine, Estimator::MonteCarlo] {
        for (phase_bits, repetitions) in [(8, 1), (8, 8), (16, 1), (16, 8)] {
            let counting = settings(name, phase_bits, repetitions);
            let mut stream = Stream::new(1, 0, 0, 0);
            let time = processor::least(RUNS, || {
                let found = estimate(name, &counting, PROBLEM, &mut stream);
                black_box(found.expect("valid settings"));
            });
            println!(
                "  {:12} {phase_bits:2} {repetitions} {:9.2}",
                name.name(),
                1e6 * time
            );
        }
    }
}

/// Measures 64 x 64 pixels of three channels, each with another S.
fn pictures(promises: &mut Promises) {
    println!("\nseconds of 64 x 64 pixels, three channels each");
    for (phase_bits, repetitions) in [(8, 1), (16, 8)] {
        for name in [Estimator::Paper, Estimator::Sine] {
            let counting = settings(name, phase_bits, repetitions);
            let time = processor::least(RUNS, || {
                for pixel in 0..64 * 64_u32 {
                    for channel in 0..3 {
                        let mut stream = Stream::new(1, pixel % 64, pixel / 64, channel);
                        let good = u64::from(pixel) * 341 * (1 + u64::from(channel));
                        let problem = CountingProblem {
                            good,
                            total: 1 << 22,
                        };
                        let found = estimate(name, &counting, problem, &mut stream);
                        black_box(found.expect("valid settings"));
                    }
                }
            });
            let what =
                format!("{name}, t = {phase_bits}, B = {repetitions}: {time:.3} s, less than 1");
            promises.judge(&what, time < 1.0);
        }
    }
}

fn comparators() {
    let comparator = Comparator {
        bits: 10,
        at: ComparatorAt::Midpoints,
    };
    let comparators = Comparators::new(17.0, comparator).expect("a positive bound");
    let colours: Vec<f64> = (0..4096)
        .map(|i| f64::from(i * 7 % 4096) * 17.0 / 4096.0)
        .collect();
    let time = processor::least(RUNS, || {
        black_box(comparators.good_total(black_box(&colours)));
    });
    println!("\n{:.1} us for the comparators of 4,096 paths", 1e6 * time);
}
