//! Extremes of counting: good indices, phase registers, repetitions.

use super::Extreme;
use qrt::counting::PhaseDistribution;
use qrt::counting::estimators::{CountingProblem, Estimate, estimate};
use qrt::counting::random::Stream;
use qrt::scene::{Counting, Estimator, Window};

/// Runs an estimator once; its result must be valid for any problem.
fn run(
    name: Estimator,
    problem: CountingProblem,
    bits: u32,
    repetitions: u32,
    seed: u64,
) -> Estimate {
    let counting = Counting {
        phase_bits: bits,
        repetitions,
        window: Window::Sine,
        estimator: Some(name),
        strata: None,
        error: None,
    };
    let mut stream = Stream::new(seed, bits, repetitions, 0);
    let found = estimate(name, &counting, problem, &mut stream).unwrap();
    let (low, high) = found.interval;
    assert!(
        0.0 <= low && low <= found.amplitude && found.amplitude <= high && high <= 1.0,
        "{name} {problem:?}: {found:?}"
    );
    found
}

fn truth(problem: CountingProblem) -> f64 {
    problem.good as f64 / problem.total as f64
}

/// Measures many estimates: the coverage, which is the fraction whose interval contains the truth, and the
/// largest error of the median run.
fn ends() -> Extreme {
    let (mut runs, mut covered, mut worst) = (0, 0, (0.0_f64, ""));
    for &name in Estimator::ALL {
        for total in [1, 2, 16, 1 << 22, 1 << 60] {
            for good in [0, 1, total - 1, total] {
                let problem = CountingProblem { good, total };
                let mut errors: Vec<f64> = (0..21)
                    .map(|seed| {
                        let found = run(name, problem, 10, 1, seed);
                        let (low, high) = found.interval;
                        runs += 1;
                        let within =
                            low - 1e-12 <= truth(problem) && truth(problem) <= high + 1e-12;
                        covered += u32::from(within);
                        (found.amplitude - truth(problem)).abs()
                    })
                    .collect();
                errors.sort_by(f64::total_cmp);
                if errors[10] > worst.0 {
                    worst = (errors[10], name.name());
                }
            }
        }
    }
    let share = f64::from(covered) / f64::from(runs);
    assert!(share > 0.9, "{share}");
    assert!(worst.0 < 0.06, "{worst:?}");
    Extreme::new(
        "S = 0, 1, N - 1, N; N = 1 to 2^60",
        "every estimate lies in [0, 1] and in its own interval; the intervals contain S/N at least as often as their confidence states",
        format!(
            "{:.1} % of {runs} intervals contain S/N; the largest median error with 1,023 queries is {:.1e} (`{}`)",
            100.0 * share,
            worst.0,
            worst.1
        ),
    )
}

/// Measures the error of the sum of probabilities, for theta on the grid, halfway, and anywhere.
fn grids() -> Extreme {
    let mut off = 0.0_f64;
    for bits in 1..=14 {
        for window in [Window::Rect, Window::Sine] {
            // theta = 0, 1/4, 1/2 are on every grid; 1/6 and 1/3 on none.
            for amplitude in [0.0, 0.5, 1.0, 0.25, 0.75, 1e-12, 0.123_456_789] {
                let found = PhaseDistribution::from_amplitude(amplitude, bits, window).unwrap();
                let sum: f64 = (0..=found.largest_outcome())
                    .map(|y| found.probability(y))
                    .sum();
                off = off.max((sum - 1.0).abs());
                if window == Window::Rect && bits > 1 && [0.0, 0.5, 1.0].contains(&amplitude) {
                    assert!(found.probability(found.nearest_outcome()) > 1.0 - 1e-12);
                }
            }
        }
    }
    assert!(off < 1e-12, "{off}");
    Extreme::new(
        "theta on the grid, halfway and anywhere; T = 2 to 2^14",
        "probabilities add up to 1; on the grid the rectangular window reads theta for certain",
        format!("the sum is off by at most {off:.0e}"),
    )
}

/// Draws from phase registers of all sizes.
fn registers() -> Extreme {
    let mut least = 1.0_f64;
    for bits in [1, 2, 8, 20, 30, 40] {
        for window in [Window::Rect, Window::Sine] {
            for (good, total) in [(1, 3), (0, 7), (7, 7), (1, 1 << 60), (123, 1 << 20)] {
                let found = PhaseDistribution::new(good, total, bits, window).unwrap();
                let sampler = found.sampler();
                let mut stream = Stream::new(1, bits, 0, 0);
                let within = (0..4000).filter(|_| {
                    let y = sampler.sample(&mut stream);
                    assert!(y <= found.largest_outcome());
                    y.abs_diff(found.nearest_outcome()) <= 1
                });
                least = least.min(within.count() as f64 / 4000.0);
            }
        }
    }
    assert!(least > 0.8, "{least}");
    Extreme::new(
        "T = 2 to 2^40",
        "a draw is within one outcome of the likeliest with probability at least 8/pi^2 = 0.81",
        format!("at least {least:.3} of 4,000 draws each"),
    )
}

/// Counts with one repetition to a million.
fn repetitions() -> Extreme {
    let problem = CountingProblem {
        good: (1 << 60) / 7 * 2,
        total: 1 << 60,
    };
    let mut measured = Vec::new();
    for count in [1, 1000, 1_000_000] {
        let found = run(Estimator::Paper, problem, 6, count, 3);
        assert!(found.ln_likelihood.unwrap().is_finite());
        let error = (found.amplitude - truth(problem)).abs();
        assert!(error < 0.1 / f64::from(count).sqrt(), "{count}: {error}");
        measured.push(format!("{error:.0e}"));
    }
    Extreme::new(
        "B = 1, 1,000, 1,000,000 at T = 64, N = 2^60",
        "likelihoods neither underflow nor miss their peak; the error falls at least as 1/sqrt(B)",
        format!("errors of `paper` {}", measured.join(", ")),
    )
}

/// Counts with the smallest and the largest budgets.
fn budgets() -> Extreme {
    let problem = CountingProblem {
        good: (1 << 60) / 5,
        total: 1 << 60,
    };
    let mut worst = (0.0_f64, "");
    for &name in Estimator::ALL {
        if name == Estimator::Exact {
            continue;
        }
        // One query gives no sensible estimate, but a valid result.
        run(name, problem, 1, 1, 0);
        let found = run(name, problem, 30, 1, 0);
        assert!(found.queries < 1 << 30, "{name}");
        let error = (found.amplitude - 0.2).abs();
        if name != Estimator::MonteCarlo && error > worst.0 {
            worst = (error, name.name());
        }
    }
    assert!(worst.0 < 1e-4, "{worst:?}");
    Extreme::new(
        "1 query, and 2^30 - 1",
        "no estimator spends more; with 2^30 - 1 queries every estimator but `monte-carlo` is within 1e-4 of S/N",
        format!(
            "the largest error with 2^30 - 1 queries is {:.0e} (`{}`)",
            worst.0, worst.1
        ),
    )
}

pub(super) fn all() -> Vec<Extreme> {
    let all: [fn() -> Extreme; 5] = [ends, grids, registers, repetitions, budgets];
    all.map(|extreme| extreme()).into()
}
