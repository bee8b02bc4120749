//! Quantization of a colour by comparators.

use super::Figure;
use qrt::counting::Comparators;
use qrt::drawing::{Canvas, Panel, minus, number, polyline, ticks};
use qrt::scene::{Comparator, ComparatorAt};

/// c, for C = 8 comparators.
const BITS: u32 = 3;

/// Draws the error of edges and midpoints over the colour.
pub(super) fn errors() -> Figure {
    let title = "Error of C = 8 comparators, in steps h of the colour scale";
    let mut canvas = Canvas::new(title, 580.0, 450.0);
    let mut means = Vec::new();
    let both = [
        (
            ComparatorAt::Edges,
            "edges, thresholds y h: error in [0, h), h/2 too bright on average",
        ),
        (
            ComparatorAt::Midpoints,
            "midpoints, thresholds (y + ½) h: error within ± h/2",
        ),
    ];
    for (k, (at, name)) in both.into_iter().enumerate() {
        let comparator = Comparator { bits: BITS, at };
        let comparators = Comparators::new(1.0, comparator).expect("comparators");
        let step = comparators.step();
        let error = |x: f64| f64::from(comparators.good(x)) - x / step;
        let top = 66.0 + 185.0 * k as f64;
        let panel = Panel {
            edges: [76.0, top, 560.0, top + 120.0],
            x: [0.0, 8.0],
            y: [-0.75, 1.25],
        };
        canvas.text("", [panel.edges[0], top - 8.0], name);
        let colours = ticks((0..=8).map(f64::from), 0);
        let levels: Vec<_> = [(-0.5, "-½"), (0.0, "0"), (0.5, "½"), (1.0, "1")]
            .map(|(value, label)| (value, minus(label)))
            .into();
        let label = if k == 1 { "colour x, in steps h" } else { "" };
        panel.axes(&mut canvas, [&colours, &levels], [label, "error / h"]);
        canvas.path("axis", &panel.curve([[0.0, 0.0], [8.0, 0.0]]));
        // The error is linear between thresholds: each piece is drawn from its start to its end.
        let first = if at == ComparatorAt::Edges { 0.0 } else { 0.5 };
        let mut breaks = vec![0.0];
        breaks.extend((0..8).map(|y| first + f64::from(y)).filter(|x| *x > 0.0));
        breaks.push(8.0);
        let mut d = String::new();
        for pair in breaks.windows(2) {
            let inner = 1e-9;
            let ends = [pair[0] + inner, pair[1] - inner].map(|x| panel.at([x, error(x * step)]));
            d.push_str(&polyline(&ends));
        }
        canvas.path(&format!("line s{k}"), &d);
        let samples = 8000;
        let mean = (0..samples)
            .map(|j| error((f64::from(j) + 0.5) / f64::from(samples)))
            .sum::<f64>()
            / f64::from(samples);
        means.push(number(mean));
    }
    let says = format!(
        "What eight comparators' count adds to a colour, in steps, over the colour: a sawtooth. \
         At the edges of steps it lies in [0, 1) with mean {}; at midpoints in [-1/2, 1/2] with \
         mean {}.",
        means[0], means[1]
    );
    Figure::drawn(canvas, says)
}
