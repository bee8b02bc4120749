//! Quantum counting on amplitudes, beside other people's simulators.
//!
//! `cargo bench --bench machines -- statevector` counts the good indices of n bits with a register
//! of t bits, n + t = 8 + 8 to 10 + 10, from one list of gates (Hadamards, controlled powers of the
//! Grover iterate, inverse Fourier transform): on the dense machine, the sparse one, and by the
//! reduced and the subspace models. It prints seconds, and the distance of each from the closed
//! form. Beside them it prints figures of other simulators: measured on the same circuit in the
//! same run by `benches/peers/counting.py`, where there is a `python3` that can install them, and
//! those of another machine (2 cores of a Zen 5), measured on a similar circuit.
//!
//! It fails where a promise is broken, at 10 + 10, against the fastest of the others: the dense
//! machine is faster, the reduced model at least 100 times as fast, the subspace at least 10,000
//! times. Against others of the same run if there are any, else against the figures kept here.

use crate::common::{Arguments, Promises};
use qrt::circuit::quantum::{CountingCircuit, PhaseOracle, QuantumGate};
use qrt::counting::PhaseDistribution;
use qrt::counting::amplitudes::{reduced, subspace};
use qrt::machines::statevector::{Checks, Dense, Sparse, StateVector, count, fold};
use qrt::scene::Window;
use serde_json::{Value, json};
use std::convert::Infallible;
use std::io::Write;
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Instant;

const SIZES: [u32; 3] = [8, 9, 10];

/// Seconds at these sizes on 2 cores of a Zen 5.
const PUBLISHED: [(&str, [Option<f64>; 3]); 6] = [
    (
        "qsim (single precision)",
        [Some(0.20), Some(0.83), Some(3.7)],
    ),
    (
        "PennyLane lightning.qubit",
        [Some(0.13), Some(0.71), Some(5.9)],
    ),
    (
        "Aer, oracle as diagonal",
        [Some(0.92), Some(6.8), Some(53.0)],
    ),
    ("mqt.ddsim", [Some(0.19), Some(20.0), Some(173.0)]),
    ("cirq", [Some(1.7), None, None]),
    ("Q# sparse", [Some(20.0), None, None]),
];

/// Simulators measured in this run: name in the script, name in the table, and allowed error.
const MEASURED: [(&str, &str, f64); 2] = [
    ("lightning", "lightning.qubit, this run", 1e-10),
    ("qsim", "qsim, this run", 1e-2),
];

/// Monomials of an index's bits: an index is good if an odd number of them are 1.
const MONOMIALS: [&[u32]; 4] = [&[0, 1], &[2, 3, 4], &[0, 3, 6, 7], &[1, 2, 5, 7]];

struct Problem {
    oracle: PhaseOracle,
    table: Vec<bool>,
    good: u64,
    bits: u32,
}

impl Problem {
    fn new(bits: u32) -> Self {
        let monomials = MONOMIALS.iter().map(|on| on.to_vec()).collect();
        let holds = |id: u64, on: &[u32]| on.iter().all(|bit| id >> bit & 1 == 1);
        let odd = |id| MONOMIALS.iter().filter(|on| holds(id, on)).count() % 2 == 1;
        let table: Vec<bool> = (0..1 << bits).map(odd).collect();
        Self {
            oracle: PhaseOracle::polynomial(bits, monomials).expect("bits of the id"),
            good: table.iter().filter(|good| **good).count() as u64,
            table,
            bits,
        }
    }

    fn counting(&self) -> CountingCircuit<'_> {
        CountingCircuit::new(&self.oracle, self.bits, Window::Rect).expect("a small register")
    }

    /// Returns the largest error of a distribution.
    fn off(&self, distribution: &[f64]) -> f64 {
        let exact = PhaseDistribution::new(self.good, 1 << self.bits, self.bits, Window::Rect);
        let exact = exact.expect("counts");
        let outcomes = distribution.iter().enumerate();
        outcomes
            .map(|(y, p)| (p - exact.probability(y as u64)).abs())
            .fold(0.0, f64::max)
    }
}

pub(crate) fn run(_: &Arguments, promises: &mut Promises) {
    let problems = SIZES.map(Problem::new);
    println!("seconds of quantum counting, and how far from the closed form");
    println!(
        "{:28} {:>19} {:>19} {:>19}",
        "n + t", "8 + 8", "9 + 9", "10 + 10"
    );
    let ours = [
        row("dense", &problems, |problem| {
            let counting = problem.counting();
            let qubits = counting.qubits();
            Some(best(3, || {
                let mut machine = Dense::new(qubits).expect("few qubits");
                distribution(&mut machine, &counting, Checks::AtTheEnd)
            }))
        }),
        row("sparse", &problems, |problem| {
            let counting = problem.counting();
            let qubits = counting.qubits();
            (problem.bits < 10).then(|| {
                best(1, || {
                    distribution(&mut Sparse::new(qubits), &counting, Checks::EveryQuery)
                })
            })
        }),
        row("reduced", &problems, |problem| {
            Some(best(9, || {
                reduced(&problem.table, problem.bits, Window::Rect).expect("a table")
            }))
        }),
        row("subspace", &problems, |problem| {
            let total = 1 << problem.bits;
            Some(best(99, || {
                subspace(problem.good, total, problem.bits, Window::Rect).expect("counts")
            }))
        }),
    ];
    let measured = MEASURED.map(|(tool, name, allowed)| {
        row(name, &problems, |problem| match peer(tool, problem) {
            Ok((seconds, outcomes)) => {
                let folded = fold(&outcomes);
                assert!(
                    problem.off(&folded) < allowed,
                    "{name} measures something else"
                );
                Some((seconds, folded))
            }
            Err(why) => {
                println!("  {name}: not measured: {why}");
                None
            }
        })
    });
    for (name, seconds) in PUBLISHED {
        let cells = seconds.map(|s| s.map_or(String::new(), |s| format!("{s:.2}")));
        let [a, b, c] = cells.map(|cell| format!("{cell:19}"));
        println!("{name:28} {a} {b} {c}");
    }

    let fastest =
        |all: &mut dyn Iterator<Item = Option<f64>>| all.flatten().fold(f64::INFINITY, f64::min);
    let here = fastest(&mut measured.iter().map(|row| row[2]));
    let there = fastest(&mut PUBLISHED.iter().map(|(_, row)| row[2]));
    let (bar, whose) = if here.is_finite() {
        (here, "the fastest other of this run")
    } else {
        (there, "the fastest published figure")
    };
    println!("\nat 10 + 10, against {whose}, {bar:.2} s:");
    for (name, seconds, least) in [
        ("dense", ours[0][2], 1.0),
        ("reduced", ours[2][2], 100.0),
        ("subspace", ours[3][2], 10_000.0),
    ] {
        let ratio = bar / seconds.expect("measured");
        let what = format!("{name}: {ratio:.1} times as fast, more than {least}");
        promises.judge(&what, ratio > least);
    }
}

fn distribution<M: StateVector>(
    machine: &mut M,
    counting: &CountingCircuit<'_>,
    checks: Checks,
) -> Vec<f64> {
    let counted = count(machine, counting, checks).expect("a circuit that fits");
    counted.distribution
}

/// Returns the least seconds of `runs` runs, and their result.
fn best(runs: usize, mut run: impl FnMut() -> Vec<f64>) -> (f64, Vec<f64>) {
    let mut least = (f64::INFINITY, Vec::new());
    for _ in 0..runs {
        let started = Instant::now();
        let found = run();
        let seconds = started.elapsed().as_secs_f64();
        if seconds < least.0 {
            least = (seconds, found);
        }
    }
    least
}

/// Measures and prints a row.
fn row(
    name: &str,
    problems: &[Problem; 3],
    measure: impl Fn(&Problem) -> Option<(f64, Vec<f64>)>,
) -> [Option<f64>; 3] {
    let mut seconds = [None; 3];
    let mut cells = Vec::new();
    for (problem, slot) in problems.iter().zip(&mut seconds) {
        let found = measure(problem);
        cells.push(
            found
                .as_ref()
                .map_or(String::new(), |(seconds, distribution)| {
                    format!("{seconds:.3e}  {:.1e}", problem.off(distribution))
                }),
        );
        *slot = found.map(|(seconds, _)| seconds);
    }
    println!("{name:28} {:19} {:19} {:19}", cells[0], cells[1], cells[2]);
    seconds
}

/// Returns the seconds that another simulator takes for a problem's gates, and the phase register's outcomes.
fn peer(tool: &str, problem: &Problem) -> Result<(f64, Vec<f64>), String> {
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("benches/peers/counting.py");
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("peers");
    let mut python = Command::new("python3")
        .arg(script)
        .args(["--tool", tool, "--venv"])
        .arg(folder)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .map_err(|error| format!("no python3: {error}"))?;
    let circuit = circuit(&problem.counting()).to_string();
    let mut input = python.stdin.take().ok_or("no standard input")?;
    // The script's own error says more than a closed pipe, so `written` is checked last.
    let written = input.write_all(circuit.as_bytes());
    drop(input);
    let output = python
        .wait_with_output()
        .map_err(|error| error.to_string())?;
    if !output.status.success() {
        let said = String::from_utf8_lossy(&output.stderr);
        let last = said.lines().last().unwrap_or("it failed");
        return Err(last.to_owned());
    }
    written.map_err(|error| error.to_string())?;
    let found: Value = serde_json::from_slice(&output.stdout).map_err(|error| error.to_string())?;
    let seconds = found["seconds"].as_f64().ok_or("no seconds")?;
    let outcomes = found["outcomes"].as_array().ok_or("no outcomes")?;
    Ok((seconds, outcomes.iter().filter_map(Value::as_f64).collect()))
}

/// Returns the circuit in the script's format.
fn circuit(counting: &CountingCircuit<'_>) -> Value {
    type Sink<'a> = Box<dyn FnMut(QuantumGate<'_>) -> Result<(), Infallible> + 'a>;
    let list = |emit: &dyn Fn(&mut Sink<'_>) -> Result<(), Infallible>| {
        let mut gates = Vec::new();
        let mut push: Sink<'_> = Box::new(|gate: QuantumGate<'_>| {
            gates.push(match gate {
                QuantumGate::X(t) => json!(["x", t]),
                QuantumGate::Cx(a, t) => json!(["cx", a, t]),
                QuantumGate::Ccx(a, b, t) => json!(["ccx", a, b, t]),
                QuantumGate::H(t) => json!(["h", t]),
                QuantumGate::Ry { angle, target } => json!(["ry", angle, target]),
                QuantumGate::Phase { turns, on } => json!(["p", turns.as_f64(), on]),
            });
            Ok(())
        });
        let Ok(()) = emit(&mut push);
        drop(push);
        Value::Array(gates)
    };
    let bits = counting.phase_register().len() as u32;
    let queries = (0..bits).map(|bit| list(&|sink| counting.query(bit, sink)));
    json!({
        "qubits": counting.qubits(),
        "counter": counting.phase_register(),
        "prepare": list(&|sink| counting.prepare(sink)),
        "queries": queries.collect::<Vec<_>>(),
        "fourier": list(&|sink| counting.inverse_fourier(sink)),
    })
}
