//! Tests of all estimators.

mod budgets;
mod rendering;

use crate::CountingError;
use crate::estimators::{
    CountingProblem, Device, EstimatorError, Noise, Settings, estimate, estimator,
};
use crate::random::Stream;
use qrt_circuit::quantum::Window;
use qrt_scene::{Counting, Estimator};

fn counting(phase_bits: u32, repetitions: u32) -> Counting {
    Counting {
        phase_bits,
        repetitions,
        window: Window::Sine,
        estimator: Some(Estimator::Paper),
        strata: None,
        error: None,
    }
}

/// Compares with an error measured elsewhere for a uniform in [0, 1]: an RMSE of 0.41/sqrt(n).
#[test]
fn monte_carlo_errors_scale_as_the_literature_says() {
    let total = 1_u64 << 40;
    let (runs, settings) = (4000, counting(8, 1));
    let mut sum = 0.0;
    for run in 0..runs {
        let mut stream = Stream::new(31, run, 0, 0);
        let good = (stream.uniform() * total as f64) as u64;
        let found = estimate(
            Estimator::MonteCarlo,
            &settings,
            CountingProblem { good, total },
            &mut stream,
        )
        .unwrap();
        let error = found.amplitude - good as f64 / total as f64;
        sum += error * error;
    }
    let rmse = (sum / f64::from(runs) * 255.0).sqrt();
    assert!((rmse - 0.41).abs() < 0.02, "{rmse}");
}

#[test]
fn a_million_repetitions_neither_underflow_nor_miss() {
    let total = 1_u64 << 60;
    let good = total / 7 * 2;
    for (name, bits) in [
        (Estimator::Paper, 6),
        (Estimator::Sine, 6),
        (Estimator::Sine, 20),
    ] {
        let mut stream = Stream::new(2, 0, 0, 0);
        let found = estimate(
            name,
            &counting(bits, 1_000_000),
            CountingProblem { good, total },
            &mut stream,
        )
        .unwrap();
        let error = (found.amplitude - 2.0 / 7.0).abs();
        assert!(
            error < 0.02 / f64::from(1_u32 << bits),
            "{name:?} {bits}: {error}"
        );
        assert!(found.ln_likelihood.unwrap().is_finite());
        assert_eq!(found.queries, ((1 << bits) - 1) * 1_000_000);
        assert!(found.interval.0 <= 2.0 / 7.0 && 2.0 / 7.0 <= found.interval.1);
    }
}

#[test]
fn intervals_cover_as_often_as_they_say() {
    let mut choice = Stream::new(77, 0, 0, 0);
    for name in [Estimator::Paper, Estimator::Sine, Estimator::MonteCarlo] {
        for repetitions in [1, 2, 3, 6] {
            let (mut covered, mut confidence) = (0.0, 0.0);
            let runs = 2000;
            for run in 0..runs {
                let total = 1 + choice.next_u64() % (1 << 22);
                let good = (choice.uniform() * choice.uniform() * total as f64) as u64;
                let mut stream = Stream::new(5, run, repetitions, 0);
                let settings = counting(4 + run % 5, repetitions);
                let found = estimate(
                    name,
                    &settings,
                    CountingProblem { good, total },
                    &mut stream,
                )
                .unwrap();
                let truth = good as f64 / total as f64;
                let (low, high) = found.interval;
                assert!(0.0 <= low && low <= found.amplitude);
                assert!(found.amplitude <= high && high <= 1.0);
                covered += f64::from(u8::from(low - 1e-12 <= truth && truth <= high + 1e-12));
                confidence = found.confidence;
            }
            let fraction = covered / f64::from(runs);
            let deviation = (confidence * (1.0 - confidence) / f64::from(runs)).sqrt();
            assert!(
                fraction >= confidence - 4.0 * deviation,
                "{name:?} B={repetitions}: {fraction}"
            );
        }
    }
}

#[test]
fn exact_is_exact_and_extremes_are_never_missed() {
    let mut stream = Stream::new(0, 0, 0, 0);
    let exact = [Estimator::Paper, Estimator::MonteCarlo];
    for total in [1, 2, 1000, 1 << 60] {
        for good in [0, 1, total - 1, total] {
            for &name in Estimator::ALL {
                for (bits, repetitions) in [(1, 1), (2, 3), (10, 2), (40, 1)] {
                    let settings = counting(bits, repetitions);
                    let found = estimate(
                        name,
                        &settings,
                        CountingProblem { good, total },
                        &mut stream,
                    )
                    .unwrap();
                    let truth = good as f64 / total as f64;
                    assert!(found.amplitude.is_finite());
                    let certain = good == 0 || good == total;
                    if name == Estimator::Exact || (certain && exact.contains(&name)) {
                        assert_eq!(found.amplitude, truth, "{name:?} {good}/{total}");
                    }
                }
            }
        }
    }
}

#[test]
fn what_cannot_be_estimated_is_refused_with_what_can() {
    let mut stream = Stream::new(0, 0, 0, 0);
    for &name in Estimator::ALL {
        assert!(!name.name().is_empty());
        assert_eq!(
            estimate(
                name,
                &counting(5, 1),
                CountingProblem { good: 1, total: 0 },
                &mut stream
            ),
            Err(CountingError::NoIds.into())
        );
        let error = estimate(
            name,
            &counting(5, 1),
            CountingProblem { good: 3, total: 2 },
            &mut stream,
        )
        .unwrap_err();
        assert_eq!(
            error,
            CountingError::MoreGoodThanTotal { good: 3, total: 2 }.into()
        );
    }
    for (bits, repetitions) in [(0, 1), (41, 1), (5, 0), (5, 1_000_001)] {
        for name in [Estimator::Paper, Estimator::Sine, Estimator::MonteCarlo] {
            assert!(
                estimate(
                    name,
                    &counting(bits, repetitions),
                    CountingProblem { good: 1, total: 2 },
                    &mut stream
                )
                .is_err()
            );
        }
    }
}

/// Compares the fraction of good indices after k iterations with the closed form.
///
/// With noise, the closed form is mixed with the probability of a random index.
#[test]
fn devices_measure_what_the_iterate_gives() {
    let problem = CountingProblem {
        good: 37,
        total: 1 << 10,
    };
    let theta = libm::asin((37.0_f64 / 1024.0).sqrt());
    for noise in [
        Noise::NONE,
        Noise {
            depolarising: 0.03,
            readout: 0.01,
        },
    ] {
        let mut stream = Stream::new(3, 0, 0, 0);
        let mut device = Device::new(problem, noise, &mut stream).unwrap();
        for k in [0_u64, 1, 2, 3, 5, 17] {
            let shots = 100_000;
            let fraction = device.iterated(k, shots).unwrap() as f64 / shots as f64;
            let ideal = libm::sin((2 * k + 1) as f64 * theta).powi(2);
            // Ten bits are read, and each of k queries may destroy the state.
            let right = (1.0 - noise.depolarising).powi(k as i32) * (1.0 - noise.readout).powi(10);
            let expected = if k == 0 {
                37.0 / 1024.0
            } else {
                right * ideal + (1.0 - right) * 37.0 / 1024.0
            };
            let deviation = (expected * (1.0 - expected) / shots as f64).sqrt();
            assert!(
                (fraction - expected).abs() < 5.0 * deviation,
                "{k}: {fraction}, {expected}"
            );
        }
        assert_eq!(device.usage().queries, 100_000 * (1 + 1 + 2 + 3 + 5 + 17));
        assert_eq!(device.usage().depth, 17);
    }
    let mut stream = Stream::new(3, 0, 0, 0);
    let mut device = Device::new(problem, Noise::NONE, &mut stream).unwrap();
    assert!(device.iterated(1 << 50, 1).is_err());
}

/// Checks that a phase register in the maximally mixed state reads every number equally often.
///
/// After folding, the outcomes between 0 and T/2 are twice as frequent as these two.
#[test]
fn a_destroyed_counter_reads_anything() {
    let problem = CountingProblem { good: 1, total: 64 };
    for noise in [
        Noise {
            depolarising: 1.0,
            readout: 0.0,
        },
        Noise {
            depolarising: 0.0,
            readout: 0.5,
        },
    ] {
        let mut stream = Stream::new(9, 0, 0, 0);
        let mut device = Device::new(problem, noise, &mut stream).unwrap();
        let mut counts = [0_u64; 5];
        for y in device.phases(3, Window::Rect, 80_000).unwrap() {
            counts[y as usize] += 1;
        }
        crate::tests::chi_square_is_plausible(&counts, &[0.125, 0.25, 0.25, 0.25, 0.125]);
        assert_eq!(device.usage().queries, 7 * 80_000);
    }
}

/// Checks misread bits in a register that reads T/4 with certainty.
#[test]
fn wrong_bits_are_those_of_the_counter() {
    let problem = CountingProblem { good: 1, total: 2 };
    let noise = Noise {
        depolarising: 0.0,
        readout: 0.1,
    };
    let mut stream = Stream::new(4, 0, 0, 0);
    let mut device = Device::new(problem, noise, &mut stream).unwrap();
    let mut counts = [0_u64; 5];
    for y in device.phases(3, Window::Rect, 100_000).unwrap() {
        counts[y as usize] += 1;
    }
    // y = 2 or 6: bits 010 and 110. Each bit may flip. 6 folds onto 2, 7 and 1 fold onto 1, ...
    let (w, r) = (0.1_f64, 0.9_f64);
    let mut expected = [0.0; 5];
    for start in [2_usize, 6] {
        for flips in 0..8_usize {
            let read = start ^ flips;
            let wrong = flips.count_ones() as i32;
            expected[read.min(8 - read)] += 0.5 * w.powi(wrong) * r.powi(3 - wrong);
        }
    }
    crate::tests::chi_square_is_plausible(&counts, &expected);
}

#[test]
fn settings_and_noise_out_of_range_are_refused() {
    let settings = Settings::from_counting(&counting(5, 1)).unwrap();
    assert_eq!(settings.queries, 31);
    for wrong in [
        Settings {
            queries: 0,
            ..settings
        },
        Settings {
            error: Some(0.0),
            ..settings
        },
        Settings {
            error: Some(f64::NAN),
            ..settings
        },
        Settings {
            confidence: 1.0,
            ..settings
        },
        Settings {
            known_noise: Noise {
                depolarising: -0.1,
                readout: 0.0,
            },
            ..settings
        },
    ] {
        for &name in Estimator::ALL {
            assert!(estimator(name, &wrong).is_err(), "{name} {wrong:?}");
        }
    }
    let error = "depolarising=2".parse::<Noise>().unwrap_err().to_string();
    assert!(error.contains("2 is not a probability"), "{error}");
    for wrong in ["", "x=1", "readout", "readout=x", "readout=0.1,readout=0.1"] {
        assert!(wrong.parse::<Noise>().is_err(), "{wrong}");
    }
    let noise: Noise = "readout=0.25, depolarising=1e-4".parse().unwrap();
    assert_eq!(noise.to_string().parse(), Ok(noise));
    assert!(matches!(
        Settings::from_counting(&counting(0, 1)),
        Err(EstimatorError::Counting(_))
    ));
}
