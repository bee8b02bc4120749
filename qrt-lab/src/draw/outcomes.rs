//! Outcomes of a simulated counting circuit, as bars.

use crate::simulate::Simulation;
use qrt_drawing::{Canvas, Panel, ticks};

/// Draws the simulated probability of each outcome beside the one that theory predicts.
pub fn outcomes(simulation: &Simulation, scene: &str) -> Canvas {
    let [x, y] = simulation.pixel.place;
    let title = format!(
        "{scene}: channel {} of pixel {x},{y}, {} phase bits",
        simulation.name.channel_name(),
        simulation.phase_bits
    );
    let mut canvas = Canvas::new(&title, 640.0, 360.0);
    canvas.describe(&format!(
        "Bars: probability of each outcome y of the phase register, by the amplitudes of the circuit and by \
         theory. They differ by at most {:.1e}.",
        simulation.largest_difference()
    ));
    let last = simulation.outcomes.len() as f64 - 1.0;
    let panel = Panel {
        edges: [80.0, 60.0, 620.0, 300.0],
        x: [-0.5, last + 0.5],
        y: [0.0, 1.0],
    };
    // At most 16 labels fit below the axis.
    let step = (simulation.outcomes.len() / 16).max(1);
    let marked = simulation.outcomes.iter().step_by(step);
    let marked = marked.map(|outcome| outcome.y as f64);
    panel.axes(
        &mut canvas,
        [&ticks(marked, 0), &ticks([0.0, 0.25, 0.5, 0.75, 1.0], 2)],
        ["outcome y", "probability"],
    );
    for outcome in &simulation.outcomes {
        let bars = [(outcome.simulated, "s0", -0.4), (outcome.theory, "s1", 0.0)];
        for (probability, series, from) in bars {
            let left = outcome.y as f64 + from;
            let [x0, top] = panel.at([left, probability]);
            let [x1, bottom] = panel.at([left + 0.4, 0.0]);
            canvas.hinted(
                &format!("{series} pale"),
                [x0, top, x1 - x0, bottom - top],
                &format!("y = {}: {probability:.9}", outcome.y),
            );
        }
    }
    for (series, name, at) in [("s0", "simulated", 440.0), ("s1", "theory", 540.0)] {
        canvas.rectangle(&format!("{series} pale"), [at, 34.0, 12.0, 12.0]);
        canvas.text("soft", [at + 18.0, 45.0], name);
    }
    canvas
}
