//! Grover's iterate on amplitudes, gate by gate.

use super::Figure;
use qrt::circuit::quantum::{
    CircuitPart, CountingCircuit, GroverIterate, PhaseOracle, QuantumGate,
};
use qrt::drawing::{Canvas, Panel, number, polyline, ticks};
use qrt::machines::statevector::{Dense, StateVector, StateVectorError, fold};
use qrt::scene::Window;
use std::f64::consts::PI;

/// Returns an oracle of `2^bits` indices, the first `good` of them good.
fn oracle(bits: u32, good: u64) -> PhaseOracle {
    PhaseOracle::table(bits, |id| id < good).expect("an oracle")
}

/// Returns the probabilities of a good index after 0, 1, ... iterations.
fn turned(bits: u32, good: usize, iterations: usize) -> Result<Vec<f64>, StateVectorError> {
    let oracle = oracle(bits, good as u64);
    let iterate = GroverIterate::new(&oracle);
    let mut machine = Dense::new(iterate.qubits())?;
    let ids = oracle.superposed();
    for id in ids {
        machine.gate(QuantumGate::H(*id))?;
    }
    let mut found = Vec::new();
    for k in 0..=iterations {
        if k > 0 {
            iterate.apply(None, &mut |gate| machine.gate(gate))?;
        }
        found.push(machine.distribution(ids)?[..good].iter().sum());
    }
    Ok(found)
}

/// Draws the plane of good and bad indices.
pub(super) fn plane() -> Figure {
    const BITS: u32 = 6;
    const GOOD: usize = 3;
    let probabilities = turned(BITS, GOOD, 3).expect("a state");
    let title = "Each iteration G turns the state by 2πθ: S = 3 of N = 64";
    let mut canvas = Canvas::new(title, 580.0, 400.0);
    let (origin, radius) = ([110.0, 350.0], 270.0);
    let at = |angle: f64, r: f64| {
        [
            origin[0] + r * libm::cos(angle),
            origin[1] - r * libm::sin(angle),
        ]
    };
    let arc = |from: f64, to: f64, r: f64| {
        let steps = (0..=16).map(|k| at(from + (to - from) * f64::from(k) / 16.0, r));
        polyline(&steps.collect::<Vec<_>>())
    };
    canvas.path("grid", &arc(0.0, PI / 2.0, radius));
    canvas.arrow("axis", origin, [origin[0] + radius + 40.0, origin[1]]);
    canvas.arrow("axis", origin, [origin[0], origin[1] - radius - 34.0]);
    canvas.text(
        "mid",
        [origin[0] + radius - 6.0, origin[1] + 24.0],
        "bad indices",
    );
    canvas.upright(
        "",
        [origin[0] - 16.0, origin[1] - radius + 30.0],
        "good indices",
    );

    let angles: Vec<f64> = probabilities
        .iter()
        .map(|p: &f64| libm::atan2(p.sqrt(), (1.0 - p).max(0.0).sqrt()))
        .collect();
    for (k, (angle, p)) in angles.iter().zip(&probabilities).enumerate() {
        let class = if k == 0 { "s1" } else { "s0" };
        canvas.arrow(class, origin, at(*angle, radius));
        let name = ["|s⟩", "G|s⟩", "G²|s⟩", "G³|s⟩"][k];
        let [x, y] = at(*angle, radius + 14.0);
        let label = format!("{name}   good with {:.1} %", 100.0 * p);
        canvas.text("", [x, y + 4.0], &label);
    }
    canvas.path("thin s1", &arc(0.0, angles[0], 120.0));
    let [x, y] = at(0.5 * angles[0], 128.0);
    canvas.text("small", [x, y + 4.0], "πθ");
    for (k, pair) in angles.windows(2).enumerate() {
        canvas.path("thin s0", &arc(pair[0], pair[1], 100.0 - 12.0 * k as f64));
        if k == 0 {
            let [x, y] = at(f64::midpoint(pair[0], pair[1]), 106.0);
            canvas.text("small", [x, y + 4.0], "2πθ");
        }
    }
    let degrees: Vec<String> = angles
        .iter()
        .map(|angle| number(angle * 180.0 / PI))
        .collect();
    let good: Vec<String> = probabilities
        .iter()
        .map(|p| format!("{:.1}", 100.0 * p))
        .collect();
    let says = format!(
        "The state in the plane of bad indices (to the right) and good indices (up), as a state vector of \
         6 qubits gives it after 0 to 3 iterations, S = 3, N = 64: at angles of {} degrees; a good \
         index is measured with {} %.",
        degrees.join(", "),
        good.join(", ")
    );
    Figure::drawn(canvas, says)
}

/// Returns the phase register's distribution. Unless `right`, leaves out the Z that corrects O_0's sign
/// under a control.
fn counted(counting: &CountingCircuit<'_>, right: bool) -> Result<Vec<f64>, StateVectorError> {
    let mut machine = Dense::new(counting.qubits())?;
    counting.part(CircuitPart::Counting, &mut |gate| match gate {
        QuantumGate::Phase { on: [qubit], .. }
            if !right && counting.phase_register().contains(qubit) =>
        {
            Ok(())
        }
        _ => machine.gate(gate),
    })?;
    Ok(fold(&machine.distribution(counting.phase_register())?))
}

/// Draws the effect of the sign of O_0.
pub(super) fn sign() -> Figure {
    const BITS: u32 = 6;
    const GOOD: u64 = 13;
    const PHASE_BITS: u32 = 5;
    let oracle = oracle(BITS, GOOD);
    let counting = CountingCircuit::new(&oracle, PHASE_BITS, Window::Rect).expect("a circuit");
    let size = f64::from(1_u32 << PHASE_BITS);
    let ids = f64::from(1_u32 << BITS);
    let read = |y: usize| {
        let sine = libm::sin(PI * y as f64 / size);
        ids * sine * sine
    };
    let title = "The sign of O₀ under a control: S = 13 of N = 64, T = 32";
    let mut canvas = Canvas::new(title, 580.0, 480.0);
    let mut likeliest = Vec::new();
    let both = [
        (true, "O₀ flips all but |0…0⟩: the phase register reads S"),
        (
            false,
            "O₀ flips |0…0⟩ alone: the phase register reads N − S",
        ),
    ];
    for (k, (right, name)) in both.into_iter().enumerate() {
        let found = counted(&counting, right).expect("a state");
        let top = 66.0 + 200.0 * k as f64;
        let panel = Panel {
            edges: [76.0, top, 560.0, top + 130.0],
            x: [-0.7, 16.7],
            y: [0.0, 1.0],
        };
        canvas.text("", [panel.edges[0], top - 10.0], name);
        let outcomes: Vec<_> = (0..=16)
            .step_by(2)
            .map(|y| (y as f64, format!("{:.1}", read(y))))
            .collect();
        let levels = ticks([0.0, 0.5, 1.0], 1);
        let label = if right {
            ""
        } else {
            "what the outcome y = 0, 1, … 16 says: N sin²(πy/T) path indices"
        };
        panel.axes(&mut canvas, [&outcomes, &levels], [label, "probability"]);
        let class = if right { "s2" } else { "s3" };
        for (y, probability) in found.iter().enumerate() {
            let [x, level] = panel.at([y as f64, *probability]);
            let height = panel.edges[3] - level;
            canvas.rectangle(&format!("pale {class}"), [x - 8.0, level, 16.0, height]);
        }
        let mut best = 0;
        for (y, probability) in found.iter().enumerate() {
            if *probability > found[best] {
                best = y;
            }
        }
        likeliest.push((best, found[best], read(best)));
    }
    let [right, wrong] = [likeliest[0], likeliest[1]];
    let says = format!(
        "Probability of a phase register's outcomes by a state vector of 11 qubits, gate by \
         gate. With O_0 right the likeliest outcome is y = {} ({:.3}), which says {:.1} of 64 path indices; \
         S is 13. With the other sign it is y = {} ({:.3}), which says {:.1}; N - S is 51.",
        right.0, right.1, right.2, wrong.0, wrong.1, wrong.2
    );
    Figure::drawn(canvas, says)
}
