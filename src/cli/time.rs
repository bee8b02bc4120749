//! Estimates the time of work before it begins, and prints it if it is long; the user may still have meant it.

use super::terminal;
use qrt_runtime::Prepared;
use qrt_runtime::memory::CircuitSize;
use qrt_runtime::render::Model;

/// Paths per second of a thread by `real`: a round figure, for an estimate of hours or days.
const PATHS: f64 = 1e6;
/// Gates per second of a thread by `gates`, and operations per second by `fixed`: round figures, too.
const GATES: f64 = 2e11;
const OPERATIONS: f64 = 2e8;
/// Most qubits of a circuit that runs at the rate `GATES`. Gates of larger circuits are generated again for
/// each small batch of paths that fits in memory; `GATES_ANEW` is their rate.
const MANY_QUBITS: f64 = 4e6;
const GATES_ANEW: f64 = 5e9;
/// Most paths for which the time of the circuit is not estimated.
const FEW_PATHS: f64 = 65_536.0;
/// Minutes below which nothing is printed.
const MINUTES: f64 = 10.0;

/// Returns the seconds that a thread takes per path; 0 if the scene has no circuit.
fn seconds(size: Option<CircuitSize>, model: Model) -> f64 {
    match model {
        Model::Real => 1.0 / PATHS,
        Model::Fixed => size.map_or(0.0, |size| size.operations / OPERATIONS),
        Model::Gates => size.map_or(0.0, |size| {
            let many = size.qubits <= MANY_QUBITS;
            size.gates / if many { GATES } else { GATES_ANEW }
        }),
    }
}

/// Prints the time to trace all paths of `pixels` pixels on each of `models`, each `times` times, if it is
/// long. Only the models of a circuit need a scene that has one.
pub(crate) fn tell_of_paths(
    prepared: &Prepared<'_>,
    pixels: f64,
    times: f64,
    models: &[Model],
    threads: usize,
) {
    let bits = prepared.scene().scene().sampling.path_bits;
    let paths = times * pixels * libm::exp2(f64::from(bits));
    // Fewer paths run quickly on any circuit, and a search for primary hits needs no other circuit's size.
    let of_circuit = paths > FEW_PATHS && models.iter().any(|model| *model != Model::Real);
    let size = of_circuit
        .then(|| prepared.circuit_size([0, 0]).ok())
        .flatten();
    let of_path = models.iter().map(|model| seconds(size, *model));
    let seconds = paths * of_path.sum::<f64>() / threads as f64;
    let plural = if pixels == 1.0 { "" } else { "s" };
    let what = format!("{pixels} pixel{plural} of 2^{bits} paths each");
    tell(&what, seconds, &less(bits, seconds));
}

/// Suggests settings that take less than `seconds`, for paths of `bits` bits.
fn less(bits: u32, seconds: f64) -> String {
    // Each bit halves the time.
    let fewer = libm::ceil(libm::log2(seconds / (60.0 * MINUTES)));
    let enough = f64::from(bits) - fewer;
    if enough >= 1.0 {
        format!(
            "lower `sampling.path_bits` takes less, such as `--set sampling.path_bits={enough}`"
        )
    } else {
        "fewer pixels of fewer paths take less".to_owned()
    }
}

/// Prints that `what` takes `seconds`, if that is long, and `less`, the advice.
pub(crate) fn tell(what: &str, seconds: f64, less: &str) {
    if let Some(long) = long(seconds) {
        terminal::note(&format!("{what} take about {long} on this machine; {less}"));
    }
}

/// Returns a long time in words; `None` below 10 minutes.
fn long(seconds: f64) -> Option<String> {
    let minutes = seconds / 60.0;
    let (value, unit) = match minutes {
        minutes if minutes < MINUTES => return None,
        minutes if minutes < 120.0 => (minutes, "minutes"),
        minutes if minutes < 48.0 * 60.0 => (minutes / 60.0, "hours"),
        minutes if minutes < 2.0 * 365.0 * 1440.0 => (minutes / 1440.0, "days"),
        minutes => (minutes / 1440.0 / 365.0, "years"),
    };
    Some(format!("{} {unit}", number(value)))
}

/// Formats with two significant digits or as a whole number; large numbers as powers of ten.
fn number(value: f64) -> String {
    if value < 10.0 {
        format!("{value:.1}")
    } else if value < 1e6 {
        format!("{value:.0}")
    } else {
        format!("{value:.1e}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fewer_bits_take_less_than_is_told_of() {
        for (bits, seconds, fewer) in [(12, 601.0, 11), (52, 600.0 * 1024.5, 41), (2, 1000.0, 1)] {
            let less = less(bits, seconds);
            assert!(less.contains(&format!("path_bits={fewer}`")), "{less}");
        }
        for (bits, seconds) in [(1, 601.0), (8, 600.0 * 300.0), (8, f64::INFINITY)] {
            assert!(!less(bits, seconds).contains("--set"));
        }
    }

    #[test]
    fn long_times_are_told_in_words() {
        assert_eq!(long(599.0), None);
        for (seconds, words) in [
            (600.0, "10 minutes"),
            (7199.0, "120 minutes"),
            (7201.0, "2.0 hours"),
            (3600.0 * 47.0, "47 hours"),
            (86_400.0 * 2.5, "2.5 days"),
            (86_400.0 * 365.0 * 1e6, "1.0e6 years"),
        ] {
            assert_eq!(long(seconds).as_deref(), Some(words));
        }
        assert!(long(f64::INFINITY).is_some());
    }
}
