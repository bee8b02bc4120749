//! The coverage of the estimators' intervals.

use super::expected::{Expected, Verdicts};
use super::runs::Run;
use qrt::counting::estimators::CountingProblem;
use qrt::scene::Estimator;
use std::fmt::Write as _;

/// Amplitudes that are hard for one estimator or another; `None` stands for amplitudes spread evenly.
const AMPLITUDES: [Option<f64>; 6] = [
    None,
    Some(0.0),
    Some(1e-6),
    Some(0.5),
    Some(1.0 - 1e-6),
    Some(1.0),
];

/// Bits of the indices, and of the phase registers whose queries may be used.
const SIZES: [(u32, u32); 4] = [(4, 5), (40, 5), (40, 8), (40, 12)];

/// Prints the least coverage of each estimator's intervals, over all sizes.
pub(crate) fn table(names: &[Estimator], quick: bool, verdicts: &mut Verdicts) {
    let runs = if quick { 500 } else { 10_000 };
    println!("| estimator | asked | even | 0 | 1e-6 | 0.5 | 1 - 1e-6 | 1 |");
    println!("| --- | --- | --- | --- | --- | --- | --- | --- |");
    for &name in names {
        let mut asked = 0.0;
        let mut cells = String::new();
        for amplitude in AMPLITUDES {
            let mut least = 1.0_f64;
            for (ids, bits) in SIZES {
                let total = 1_u64 << ids;
                let problem = |run: u32| {
                    let even = (f64::from(run) + 0.5) / f64::from(runs);
                    let fraction = amplitude.unwrap_or(even);
                    let good = (fraction * total as f64).round() as u64;
                    CountingProblem { good, total }
                };
                let run = Run {
                    name,
                    bits,
                    repetitions: Expected::of(name).repetitions,
                };
                let outcomes = run.outcomes(runs, problem);
                asked = outcomes[0].confidence;
                let held = outcomes.iter().filter(|outcome| outcome.held).count();
                least = least.min(held as f64 / f64::from(runs));
            }
            write!(cells, " {:.1} % |", 100.0 * least).unwrap();
            // Allowance for chance, larger with few runs.
            let slack = if quick { 0.04 } else { 0.01 };
            let about = amplitude.map_or("spread evenly".to_owned(), |a| format!("a = {a}"));
            verdicts.keep(
                least >= asked - slack,
                format!("{name}, {about}: holds {least:.4} of {asked:.4}"),
            );
        }
        println!("| {name} | {:.1} % |{cells}", 100.0 * asked);
    }
}
