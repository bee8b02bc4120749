//! The pixel that the book builds step by step: figures of the results of `examples/one_pixel.rs`.

#[path = "../../one_pixel.rs"]
#[allow(dead_code, reason = "the program's own `main`")]
mod program;

use super::Figure;
use qrt::circuit::quantum::Window;
use qrt::counting::PhaseDistribution;
use qrt::drawing::{Canvas, Panel, minus, ticks};
use qrt::lab::draw::Wires;
use std::f64::consts::PI;

/// The cells of the ceiling: left edge of the first, width.
const CELLS: [f64; 2] = [50.0, 60.0];

/// Draws the eight paths.
pub(super) fn paths() -> Figure {
    let colours = program::colours().expect("colours");
    let mut canvas = Canvas::new("Eight paths of one pixel", 580.0, 300.0);
    let (ceiling, floor, point) = (92.0, 252.0, 290.0);
    canvas.line(
        "axis",
        [CELLS[0], ceiling],
        [CELLS[0] + 8.0 * CELLS[1], ceiling],
    );
    canvas.line("axis", [24.0, floor], [556.0, floor]);
    canvas.text("soft", [24.0, floor + 20.0], "floor");
    for (path, colour) in colours.iter().enumerate() {
        let left = CELLS[0] + CELLS[1] * path as f64;
        let middle = left + CELLS[1] / 2.0;
        canvas.line("grid", [left, ceiling - 8.0], [left, ceiling]);
        let class = if *colour > 0 {
            "line s4"
        } else {
            "thin axis dash"
        };
        canvas.line(class, [point, floor], [middle, ceiling]);
        if *colour > 0 {
            canvas.rectangle("pale s4", [left, ceiling - 12.0, CELLS[1], 12.0]);
        }
        canvas.text("mid", [middle, ceiling - 36.0], &format!("path {path}"));
        let label = format!("colour {colour}");
        canvas.text("small soft mid", [middle, ceiling - 20.0], &label);
    }
    canvas.arrow("s0", [60.0, 200.0], [point - 6.0, floor - 3.0]);
    canvas.text("", [30.0, 192.0], "the pixel looks here");
    canvas.circle("solid s0", [point, floor], 4.0);
    let says = format!(
        "A point of the floor, which a pixel sees, and eight rays from it to the eight cells of a \
         ceiling. A lamp fills cells 3 to 6. The colours of the paths 0 to 7 are {colours:?}, by the \
         gates of `trace`; their mean is {}.",
        colours.iter().sum::<u64>() as f64 / 8.0
    );
    Figure::drawn(canvas, says)
}

/// Draws the oracle in boxes.
pub(super) fn oracle() -> Figure {
    let oracle = program::oracle().expect("an oracle");
    let mut wires = Wires::new(&[
        ("path, 3 bits", "id"),
        ("colour, 2 bits", "colour"),
        ("threshold, 2 bits", "comparator"),
        ("good", "flag"),
    ]);
    let z = qrt::circuit::quantum::QuantumGate::Phase {
        turns: qrt::circuit::quantum::Turns::HALF,
        on: &[3],
    };
    wires.part("compute");
    wires.block("trace", [0, 1], None);
    wires.block("compare", [1, 3], None);
    wires.block("trace†", [0, 1], None);
    wires.part("flip");
    wires.gate(z);
    wires.part("uncompute");
    wires.block("trace", [0, 1], None);
    wires.block("compare", [1, 3], None);
    wires.block("trace†", [0, 1], None);
    let says = format!(
        "The oracle of one pixel: trace computes a colour from the path, a comparison with the \
         threshold y flips the bit good, trace is undone; a Z on good; and the same again, which \
         returns good to zero. {} qubits and {} gates, of which one is the Z.",
        oracle.qubits(),
        oracle.gates()
    );
    Figure::drawn(wires.draw("One query of the pixel"), says)
}

/// Draws the good indices, and their signs.
pub(super) fn indices() -> Figure {
    let good = program::good().expect("indices");
    let oracle = program::oracle().expect("an oracle");
    let signs = program::signs(&oracle).expect("amplitudes");
    let mut canvas = Canvas::new("32 indices: a path and a threshold each", 580.0, 190.0);
    let side = 19.0;
    let names = ["superposed", "compared", "signed"];
    for (panel, name) in names.into_iter().enumerate() {
        let left = 58.0 + 178.0 * panel as f64;
        canvas.text("", [left, 50.0], name);
        for (index, good) in good.iter().enumerate() {
            let (path, y) = (index & 7, index >> 3);
            let at = [left + side * path as f64, 60.0 + side * (3 - y) as f64];
            let class = if panel > 0 && *good { "pale s1" } else { "box" };
            canvas.rectangle(class, [at[0], at[1], side - 3.0, side - 3.0]);
            let sign = if signs[index] < 0.0 {
                minus("-")
            } else {
                "+".to_owned()
            };
            if panel == 2 {
                canvas.text("small mid", [at[0] + 8.0, at[1] + 12.5], &sign);
            }
        }
        canvas.text(
            "soft small mid",
            [left + 4.0 * side, 60.0 + 4.0 * side + 14.0],
            "path 0 to 7",
        );
    }
    canvas.upright("soft small", [44.0, 60.0 + 2.0 * side], "threshold y");
    let s = good.iter().filter(|good| **good).count();
    let says = format!(
        "The indices as squares, paths from left to right and thresholds from below: all alike after \
         the Hadamards; {s} of 32 are good, as many in each column as the path's colour; and after \
         the oracle these {s} have the amplitude {:.4}, the others {:.4}.",
        signs
            .iter()
            .fold(f64::INFINITY, |least, sign| least.min(*sign)),
        signs
            .iter()
            .fold(f64::NEG_INFINITY, |most, sign| most.max(*sign))
    );
    Figure::drawn(canvas, says)
}

/// Draws the effect of an iterate on the amplitudes.
pub(super) fn amplified() -> Figure {
    let good = program::good().expect("indices");
    let oracle = program::oracle().expect("an oracle");
    let states = [
        ("at first", program::amplified(&oracle, 0)),
        ("after the sign, O_f", program::signs(&oracle)),
        ("after one iterate, G", program::amplified(&oracle, 1)),
    ]
    .map(|(name, found)| (name, found.expect("amplitudes")));
    let mut canvas = Canvas::new("Amplitudes of the 32 indices", 580.0, 500.0);
    let mut found = Vec::new();
    for (k, (name, amplitudes)) in states.iter().enumerate() {
        let top = 62.0 + 146.0 * k as f64;
        let panel = Panel {
            edges: [70.0, top, 560.0, top + 100.0],
            x: [-0.7, 31.7],
            y: [-0.25, 0.4],
        };
        canvas.text("", [70.0, top - 8.0], name);
        let levels = ticks([-0.2, 0.0, 0.2, 0.4], 1);
        panel.axes(
            &mut canvas,
            [&[], &levels],
            [if k == 2 { "index" } else { "" }, ""],
        );
        for (index, amplitude) in amplitudes.iter().enumerate() {
            let [x, y] = panel.at([index as f64, *amplitude]);
            let zero = panel.at([0.0, 0.0])[1];
            let class = if good[index] { "pale s1" } else { "pale s0" };
            canvas.rectangle(class, [x - 5.0, y.min(zero), 10.0, (y - zero).abs()]);
        }
        let mean = amplitudes.iter().sum::<f64>() / 32.0;
        let [from, to] = [-0.7, 31.7].map(|x| panel.at([x, mean]));
        canvas.line("thin s2 dash", from, to);
        canvas.text("small soft end", [556.0, from[1] - 4.0], "mean");
        let good = amplitudes.iter().zip(&good).filter(|(_, good)| **good);
        found.push(
            good.map(|(amplitude, _)| amplitude * amplitude)
                .sum::<f64>(),
        );
    }
    let says = format!(
        "The amplitudes of all 32 indices, good ones in orange: equal at first; the good ones turned \
         over by the oracle; and reflected about their mean. A good index is measured with {:.1} %, \
         {:.1} % and {:.1} %.",
        100.0 * found[0],
        100.0 * found[1],
        100.0 * found[2]
    );
    Figure::drawn(canvas, says)
}

/// Draws the distribution of the phase register.
pub(super) fn counted() -> Figure {
    let oracle = program::oracle().expect("an oracle");
    let (outcomes, _) = program::count(&oracle, 1).expect("outcomes");
    let good = program::good().expect("indices");
    let s = good.iter().filter(|good| **good).count() as u64;
    let exact = PhaseDistribution::new(s, 32, program::PHASE_BITS, Window::Sine);
    let exact = exact.expect("a distribution");
    for (y, found) in outcomes.iter().enumerate() {
        assert!((found - exact.probability(y as u64)).abs() < 1e-12);
    }
    let mut canvas = Canvas::new(
        "What the phase register says of the pixel, T = 32",
        580.0,
        300.0,
    );
    let panel = Panel {
        edges: [76.0, 40.0, 560.0, 236.0],
        x: [-0.7, 16.7],
        y: [0.0, 0.8],
    };
    let value = |y: f64| 4.0 * libm::pow(libm::sin(PI * y / 32.0), 2.0);
    let places: Vec<_> = (0..=16)
        .step_by(2)
        .map(|y| (f64::from(y), format!("{:.2}", value(f64::from(y)))))
        .collect();
    let levels = ticks([0.0, 0.2, 0.4, 0.6, 0.8], 1);
    panel.axes(
        &mut canvas,
        [&places, &levels],
        [
            "the pixel's value that the outcome y = 0 to 16 means",
            "probability",
        ],
    );
    for (y, probability) in outcomes.iter().enumerate() {
        let [x, top] = panel.at([y as f64, *probability]);
        canvas.rectangle("pale s0", [x - 9.0, top, 18.0, panel.edges[3] - top]);
    }
    let truth = panel.at([32.0 * exact.theta(), 0.0])[0];
    canvas.line("line s1", [truth, 40.0], [truth, panel.edges[3]]);
    canvas.text(
        "",
        [truth + 10.0, 58.0],
        &format!("the mean colour, {}", 4.0 * s as f64 / 32.0),
    );
    let error: f64 = (outcomes.iter().enumerate())
        .map(|(y, p)| p * libm::pow(value(y as f64) - 4.0 * s as f64 / 32.0, 2.0))
        .sum();
    let a = s as f64 / 32.0;
    let says = format!(
        "The distribution of the folded phase register after 31 queries with the sine window, by a \
         state vector of the whole circuit. S = {s} of 32: T theta = {:.2}. The root mean square error \
         of the pixel is {:.3}; 31 random indices have {:.3}.",
        32.0 * exact.theta(),
        error.sqrt(),
        4.0 * (a * (1.0 - a) / 31.0).sqrt()
    );
    Figure::drawn(canvas, says)
}
