//! Measures every estimator on noisy devices: whether its error still falls with more queries.
//!
//! For each estimator, kind of noise and amplitude: the mean absolute error at growing numbers of
//! queries, once with a likelihood that knows the noise, once without. An estimator *survives* if
//! sixteen times the queries still halve its error. Estimators that run phase estimation are shown
//! with one register as long as the queries allow, and with the most repetitions of a register of
//! five bits that the queries allow.
//!
//! At the end the bench tests the claim of the quantum coin's authors, that it is more robust than
//! quantum supersampling. It judges these findings, with margins:
//!
//! * one long register does not survive a depolarising noise of 1e-3: more queries make it worse;
//!   repetitions of a short one survive if their likelihoods are joined;
//! * the mean phase and `auto`, whose colours are spread from half of the amplitude to one and a half
//!   of it, survive a depolarising noise of 1e-3 that they know, alone and with a readout error of 1e-3;
//! * the coins survive a depolarising noise of 1e-2 and a readout error of 1e-2, and knowing the
//!   noise is worth a factor of 1.5 at the least;
//! * under depolarising noise the claim holds, against one register and against short ones; under
//!   readout errors it does not hold against short registers, whose few bits are read correctly more
//!   often than the coin's, which must all be 0.

use crate::common::{Arguments, Promises};
use qrt_counting::Histogram;
use qrt_counting::estimators::{CountingProblem, Device, Noise, Settings, estimator};
use qrt_counting::random::Stream;
use qrt_scene::{Counting, Estimator, Window};

const TOTAL: u64 = 1 << 20;
const RUNS: u32 = 300;
/// Bits t of 2^t - 1 queries; the short register runs as often as fits into that number.
const BITS: [u32; 4] = [6, 8, 10, 12];
const SHORT: u32 = 5;

/// The settings of a row of the tables.
#[derive(Clone, Copy)]
struct Case {
    name: Estimator,
    short: bool,
    noise: Noise,
    known: bool,
    /// a, or uniform in [0, 1].
    amplitude: Option<f64>,
}

impl Case {
    fn settings(&self, bits: u32) -> Settings {
        let most = (1_u32 << bits) - 1;
        let (phase_bits, repetitions) = if self.short {
            (SHORT, most / ((1 << SHORT) - 1))
        } else {
            (bits, 1)
        };
        let counting = Counting {
            phase_bits,
            repetitions,
            window: Window::Sine,
            estimator: Some(self.name),
            strata: None,
            error: None,
        };
        let known_noise = if self.known { self.noise } else { Noise::NONE };
        Settings {
            known_noise,
            ..Settings::from_counting(&counting).unwrap()
        }
    }

    /// Returns the mean absolute error.
    fn error(&self, bits: u32) -> f64 {
        let estimator = estimator(self.name, &self.settings(bits)).unwrap();
        let mut sum = 0.0;
        for run in 0..RUNS {
            let mut stream = Stream::new(23, run, bits, 0);
            let amplitude = self.amplitude.unwrap_or_else(|| stream.uniform());
            let good = (amplitude * TOTAL as f64) as u64;
            let problem = CountingProblem { good, total: TOTAL };
            let histogram = self.name.reads_levels().then(|| colours(amplitude));
            let truth = histogram.as_ref().map_or(good, Histogram::good) as f64 / TOTAL as f64;
            let device = match &histogram {
                Some(histogram) => Device::of_histogram(histogram, self.noise, &mut stream),
                None => Device::new(problem, self.noise, &mut stream),
            };
            let found = estimator.estimate(&mut device.unwrap()).unwrap();
            assert!((0.0..=1.0).contains(&found.amplitude), "{}", self.name);
            sum += (found.amplitude - truth).abs();
        }
        sum / f64::from(RUNS)
    }

    fn errors(&self) -> [f64; 4] {
        BITS.map(|bits| self.error(bits))
    }
}

/// The levels of 2^10 paths, spread evenly from half of the amplitude to one and a half of it, under 2^10 thresholds.
fn colours(amplitude: f64) -> Histogram {
    let mut histogram = Histogram::new(10);
    let level = |path: u32| amplitude * (512.0 + f64::from(path));
    histogram.add_all((0..1024).map(|path| (level(path) as u64).min(1024)));
    histogram
}

fn survives(errors: &[f64; 4]) -> bool {
    errors[3] < 0.5 * errors[1]
}

fn tables() {
    let estimators = Estimator::ALL
        .iter()
        .filter(|&&name| name != Estimator::Exact);
    for &name in estimators {
        for amplitude in [None, Some(0.02)] {
            let what = amplitude.map_or("uniform".into(), |a| format!("{a}"));
            println!("\n{name}, a = {what}: mean |error| at 63, 255, 1023, 4095 queries");
            println!("depolarising  readout  register  noise     errors");
            for depolarising in [0.0, 1e-4, 1e-3, 1e-2] {
                for readout in [0.0, 1e-3, 1e-2] {
                    let noise = Noise {
                        depolarising,
                        readout,
                    };
                    for short in [false, true] {
                        if short && !name.has_register() {
                            continue;
                        }
                        for known in [false, true] {
                            if known && noise == Noise::NONE {
                                continue;
                            }
                            let case = Case {
                                name,
                                short,
                                noise,
                                known,
                                amplitude,
                            };
                            let errors = case.errors();
                            print!(
                                "{depolarising:<13} {readout:<8} {:<9} {:<8}",
                                if short { "short" } else { "long" },
                                if known { "known" } else { "unknown" }
                            );
                            for error in errors {
                                print!("  {error:.2e}");
                            }
                            println!("{}", if survives(&errors) { "  survives" } else { "" });
                        }
                    }
                }
            }
        }
    }
}

/// Prints the errors of the quantum coin and of supersampling at 255 queries, as in the authors' comparison
/// (240 and 255): alone, and relative to a perfect device.
fn claim() {
    println!("\nThe claim: mean |error| at 255 queries, a uniform, and its growth by the noise");
    println!("depolarising  readout  qcoin             qss, one register  qss, short registers");
    for depolarising in [0.0, 1e-3, 1e-2, 3e-2] {
        for readout in [0.0, 1e-2] {
            let noise = Noise {
                depolarising,
                readout,
            };
            let error = |name, short, noise| {
                let case = Case {
                    name,
                    short,
                    noise,
                    known: false,
                    amplitude: None,
                };
                case.error(8)
            };
            print!("{depolarising:<13} {readout:<8}");
            for (name, short) in [
                (Estimator::Qcoin, false),
                (Estimator::Qss, false),
                (Estimator::Qss, true),
            ] {
                let found = error(name, short, noise);
                let growth = found / error(name, short, Noise::NONE);
                print!(" {found:.4} ({growth:5.2} x) ");
            }
            println!();
        }
    }
}

fn bars(promises: &mut Promises) {
    let noise = |depolarising, readout| Noise {
        depolarising,
        readout,
    };
    let case = |name, short, noise, known| Case {
        name,
        short,
        noise,
        known,
        amplitude: None,
    };
    for &name in Estimator::ALL
        .iter()
        .filter(|&&name| name != Estimator::Exact)
    {
        let errors = case(name, false, Noise::NONE, false).errors();
        let what = format!("{name} survives without noise: {}", listed(&errors));
        promises.judge(&what, survives(&errors));
    }
    for name in [Estimator::Paper, Estimator::Sine, Estimator::Qss] {
        let errors = case(name, false, noise(1e-3, 0.0), false).errors();
        let what = format!(
            "{name}, long, depolarising 1e-3: worse with more queries: {}",
            listed(&errors)
        );
        promises.judge(&what, errors[3] > 2.0 * errors[1]);
    }
    for name in [Estimator::Paper, Estimator::Sine] {
        let errors = case(name, true, noise(1e-3, 0.0), false).errors();
        let what = format!(
            "{name}, short, survives depolarising 1e-3: {}",
            listed(&errors)
        );
        promises.judge(&what, survives(&errors));
    }
    for name in [Estimator::PhaseMean, Estimator::Auto] {
        for noise in [noise(1e-3, 0.0), noise(1e-3, 1e-3)] {
            let errors = case(name, false, noise, true).errors();
            let what = format!("{name} survives {noise} that it knows: {}", listed(&errors));
            promises.judge(&what, survives(&errors));
        }
    }
    for name in [Estimator::Qcoin, Estimator::AbramsWilliams] {
        for noise in [noise(1e-2, 0.0), noise(0.0, 1e-2)] {
            let unknown = case(name, false, noise, false).errors();
            let known = case(name, false, noise, true).errors();
            let what = format!(
                "{name} survives {noise}, unknown and known: {}; {}",
                listed(&unknown),
                listed(&known)
            );
            promises.judge(&what, survives(&unknown) && survives(&known));
            let worth = unknown[3] / known[3];
            let what = format!("{name}, {noise}: knowing it is worth {worth:.2}, more than 1.5");
            promises.judge(&what, worth > 1.5);
        }
    }
    let growth = |name, short, noise| {
        case(name, short, noise, false).error(8) / case(name, short, Noise::NONE, false).error(8)
    };
    let (qcoin, qss) = (Estimator::Qcoin, Estimator::Qss);
    let mut judge = |what: &str, figure: f64, [low, high]: [f64; 2]| {
        let what = format!("{what}: {figure:.2} times, in {low}..{high}");
        promises.judge(&what, low < figure && figure < high);
    };
    let destroying = noise(1e-2, 0.0);
    let any = f64::INFINITY;
    judge(
        "depolarising 1e-2, qcoin",
        growth(qcoin, false, destroying),
        [0.0, 1.3],
    );
    judge(
        "depolarising 1e-2, qss, short",
        growth(qss, true, destroying),
        [1.4, any],
    );
    judge(
        "depolarising 1e-2, qss, long",
        growth(qss, false, destroying),
        [20.0, any],
    );
    let misreading = noise(0.0, 1e-2);
    judge(
        "readout 1e-2, qcoin",
        growth(qcoin, false, misreading),
        [1.8, any],
    );
    judge(
        "readout 1e-2, qss, short",
        growth(qss, true, misreading),
        [0.0, 1.2],
    );
    let error = |name, short| case(name, short, misreading, false).error(8);
    let ratio = error(qcoin, false) / error(qss, true);
    judge("readout 1e-2, qcoin by qss, short", ratio, [1.2, any]);
}

fn listed(errors: &[f64; 4]) -> String {
    errors.map(|error| format!("{error:.2e}")).join(", ")
}

pub(crate) fn run(_: &Arguments, promises: &mut Promises) {
    tables();
    claim();
    bars(promises);
}
