//! Price of counting: of a draw, of an estimate, and of a whole 64 x 64 picture.
//!
//! Promises: a draw costs the same at T = 2^40 as at 2^8; the counting noise of 64 x 64 pixels and
//! three channels takes well under a second, at any register of 8 to 16 bits and up to eight
//! repetitions.

use std::hint::black_box;

use criterion::{BenchmarkId, Criterion, criterion_group, criterion_main};
use qrt_counting::estimators::{Problem, estimate};
use qrt_counting::random::Stream;
use qrt_counting::{Comparators, PhaseDistribution};
use qrt_scene::{Comparator, ComparatorAt, Counting, Estimator, Window};

const PROBLEM: Problem = Problem {
    good: 1_234_567,
    total: 1 << 22,
};

fn draws(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("draw");
    for window in [Window::Rect, Window::Sine] {
        for bits in [8, 16, 40] {
            let Ok(distribution) = PhaseDistribution::new(1_234_567, 1 << 22, bits, window) else {
                continue;
            };
            let sampler = distribution.sampler();
            let mut stream = Stream::new(1, 0, 0, 0);
            group.bench_function(BenchmarkId::new(format!("{window:?}"), bits), |b| {
                b.iter(|| black_box(sampler.sample(&mut stream)));
            });
        }
    }
    group.finish();
}

fn estimates(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("estimate");
    for name in [Estimator::Paper, Estimator::Sine, Estimator::MonteCarlo] {
        for (phase_bits, repetitions) in [(8, 1), (8, 8), (16, 1), (16, 8)] {
            let counting = Counting {
                phase_bits,
                repetitions,
                window: Window::Sine,
                estimator: name,
                strata: None,
                error: None,
            };
            let mut stream = Stream::new(1, 0, 0, 0);
            let label = format!("t={phase_bits} B={repetitions}");
            group.bench_function(BenchmarkId::new(format!("{name:?}"), label), |b| {
                b.iter(|| black_box(estimate(name, &counting, PROBLEM, &mut stream)));
            });
        }
    }
    group.finish();
}

/// Measures 64 x 64 pixels of three channels, each with another S, on one thread.
fn pictures(criterion: &mut Criterion) {
    let mut group = criterion.benchmark_group("picture 64x64x3");
    group.sample_size(10);
    for (phase_bits, repetitions) in [(8, 1), (16, 8)] {
        for name in [Estimator::Paper, Estimator::Sine] {
            let counting = Counting {
                phase_bits,
                repetitions,
                window: Window::Sine,
                estimator: name,
                strata: None,
                error: None,
            };
            let label = format!("t={phase_bits} B={repetitions}");
            group.bench_function(BenchmarkId::new(format!("{name:?}"), label), |b| {
                b.iter(|| {
                    let mut sum = 0.0;
                    for pixel in 0..64 * 64_u32 {
                        for channel in 0..3 {
                            let mut stream = Stream::new(1, pixel % 64, pixel / 64, channel);
                            let good = u64::from(pixel) * 341 * (1 + u64::from(channel));
                            let problem = Problem {
                                good,
                                total: 1 << 22,
                            };
                            let found = estimate(name, &counting, problem, &mut stream);
                            sum += found.map_or(0.0, |found| found.amplitude);
                        }
                    }
                    black_box(sum)
                });
            });
        }
    }
    group.finish();
}

fn comparators(criterion: &mut Criterion) {
    let comparator = Comparator {
        bits: 10,
        at: ComparatorAt::Midpoints,
    };
    let Ok(comparators) = Comparators::new(17.0, comparator) else {
        return;
    };
    let colours: Vec<f64> = (0..4096)
        .map(|i| f64::from(i * 7 % 4096) * 17.0 / 4096.0)
        .collect();
    criterion.bench_function("comparators, 4096 paths", |b| {
        b.iter(|| black_box(comparators.good_total(black_box(&colours))));
    });
}

criterion_group!(benches, draws, estimates, pictures, comparators);
criterion_main!(benches);
