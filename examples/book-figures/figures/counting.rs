//! Measurements of counting, and the inference from them.

use super::Figure;
use qrt::counting::random::Stream;
use qrt::counting::{PhaseDistribution, posterior};
use qrt::drawing::{Canvas, Panel, number, ticks};
use qrt::scene::Window;
use std::f64::consts::PI;

/// theta = 1/3: three of four indices are good.
const GOOD: [u64; 2] = [3, 4];
/// T = 1024.
const PHASE_BITS: u32 = 10;

fn third(window: Window) -> PhaseDistribution {
    PhaseDistribution::new(GOOD[0], GOOD[1], PHASE_BITS, window).expect("a distribution")
}

/// Draws the distribution around theta.
pub(super) fn distribution() -> Figure {
    let title = "What a phase register of T = 1024 reads at θ = 1/3";
    let mut canvas = Canvas::new(title, 580.0, 360.0);
    let panel = Panel {
        edges: [76.0, 40.0, 560.0, 290.0],
        x: [329.5, 353.5],
        y: [0.0, 0.75],
    };
    let size = f64::from(1 << PHASE_BITS);
    let outcomes = ticks((66..=70).map(|k| f64::from(5 * k)), 0);
    let levels = ticks((0..=7).map(|k| f64::from(k) / 10.0), 1);
    panel.axes(
        &mut canvas,
        [&outcomes, &levels],
        ["outcome y, which says θ̃ = y/1024", "probability P(θ̃ | θ)"],
    );
    let known = third(Window::Rect);
    let bottom = panel.edges[3];
    for y in 330..=353 {
        let [x, top] = panel.at([y as f64, known.probability(y)]);
        canvas.rectangle("pale s0", [x - 6.0, top, 12.0, bottom - top]);
    }
    let truth = panel.at([known.theta() * size, 0.0])[0];
    canvas.line("line s1", [truth, panel.edges[1]], [truth, bottom]);
    canvas.text(
        "",
        [truth + 34.0, panel.edges[1] + 20.0],
        "θ = 1/3, T θ = 341⅓",
    );
    let near = known.nearest_outcome();
    for (y, side, class) in [(near, -12.0, "soft end"), (near + 1, 12.0, "soft")] {
        let probability = known.probability(y);
        let [x, top] = panel.at([y as f64, probability]);
        let label = format!("{probability:.3}");
        canvas.text(class, [x + side, top + 5.0], &label);
    }
    let within = |steps: u64| -> f64 {
        let near = near - steps..=near + 1 + steps;
        near.map(|y| known.probability(y)).sum()
    };
    let says = format!(
        "Bars of probability over outcomes y: {:.4} at 341 and {:.4} at 342, the neighbours of \
         T theta = 341.33, together {:.4} (at least 8/pi^2 = 0.8106 for every theta); {:.4} within \
         336..347, so that {:.2} % are in the tails beyond.",
        known.probability(near),
        known.probability(near + 1),
        within(0),
        within(5),
        100.0 * (1.0 - within(5)),
    );
    Figure::drawn(canvas, says)
}

/// Largest distance from T theta, in steps, over which the windows are shown.
const REACH: i64 = 20;

/// Draws both windows, with the tails.
pub(super) fn windows() -> Figure {
    let title = "Rectangular and sine window: T = 1024, θ = 1/3";
    let mut canvas = Canvas::new(title, 580.0, 400.0);
    let panel = Panel {
        edges: [76.0, 40.0, 560.0, 330.0],
        x: [-21.0, 21.0],
        y: [-8.0, 0.0],
    };
    let steps = ticks((-4..=4).map(|k| f64::from(5 * k)), 0);
    let powers = ["1", "10⁻²", "10⁻⁴", "10⁻⁶", "10⁻⁸"];
    let powers: Vec<_> = (powers.iter().enumerate())
        .map(|(k, label)| (-2.0 * k as f64, (*label).to_owned()))
        .collect();
    panel.axes(
        &mut canvas,
        [&steps, &powers],
        ["y − T θ, steps of the register", "probability P(y)"],
    );
    let mut beyond = [0.0; 2];
    let all = [
        (Window::Rect, "rectangular: falls as 1/d²", [4.2, -1.7]),
        (Window::Sine, "sine: falls as 1/d⁴", [6.0, -4.35]),
    ];
    for (k, (window, name, label)) in all.into_iter().enumerate() {
        let known = third(window);
        let near = known.nearest_outcome();
        let off = known.theta() * f64::from(1 << PHASE_BITS) - near as f64;
        let point = |step: i64| {
            let probability = known.probability(near.saturating_add_signed(step));
            [step as f64 - off, libm::log10(probability)]
        };
        let points: Vec<[f64; 2]> = (-REACH..=REACH).map(point).collect();
        canvas.path(&format!("thin s{k}"), &panel.curve(points.iter().copied()));
        let places = points.iter().map(|point| panel.at(*point));
        canvas.dots(&format!("s{k}"), places);
        let at = panel.at(label);
        canvas.text(&format!("solid s{k}"), at, name);
        let inside = near.saturating_add_signed(-10)..=near + 10;
        beyond[k] = 1.0 - inside.map(|y| known.probability(y)).sum::<f64>();
    }
    let says = format!(
        "Probability of an outcome, on a logarithmic scale, over its distance d from T theta. The \
         rectangular window's tails fall as 1/d^2, the sine window's as 1/d^4. More than 10 steps \
         from the nearest outcome: {:.2} % of the rectangular window's outcomes, {:.4} % of the \
         sine window's. Its peak is wider: the most probable outcome has {:.3} against {:.3}.",
        100.0 * beyond[0],
        100.0 * beyond[1],
        third(Window::Sine).probability(341),
        third(Window::Rect).probability(341),
    );
    Figure::drawn(canvas, says)
}

/// T = 2^5 and N = 2^11 for posteriors, of S/N = 0.345.
const SMALL: u32 = 5;
const IDS: u64 = 1 << 11;
const TRUE: u64 = 707;

/// Draws posteriors after B runs of the paper's counting.
pub(super) fn posteriors() -> Figure {
    let known = PhaseDistribution::new(TRUE, IDS, SMALL, Window::Rect).expect("a distribution");
    let sampler = known.sampler();
    let mut stream = Stream::new(11, 0, 0, 0);
    let outcomes: Vec<u64> = (0..7).map(|_| sampler.sample(&mut stream)).collect();

    let listed: Vec<String> = outcomes.iter().map(ToString::to_string).collect();
    let title = format!(
        "Posterior of S/N after B runs: T = 32, read {}",
        listed.join(", ")
    );
    let mut canvas = Canvas::new(&title, 580.0, 400.0);
    let panel = Panel {
        edges: [76.0, 40.0, 560.0, 330.0],
        x: [0.0, 1.0],
        y: [0.0, 48.0],
    };
    let tenths = ticks((0..=5).map(|k| f64::from(k) / 5.0), 1);
    let levels = ticks((0..=4).map(|k| f64::from(12 * k)), 0);
    panel.axes(
        &mut canvas,
        [&tenths, &levels],
        ["fraction of good indices S/N", "posterior density"],
    );
    let truth = panel.at([TRUE as f64 / IDS as f64, 0.0])[0];
    canvas.line(
        "axis dash",
        [truth, panel.edges[1]],
        [truth, panel.edges[3]],
    );
    canvas.text("", [truth + 30.0, panel.edges[1] + 16.0], "truth: 0.345");
    let mut peaks = Vec::new();
    for (k, runs) in [1, 3, 7].into_iter().enumerate() {
        let density = posterior(&outcomes[..runs], IDS, SMALL, Window::Rect).expect("a posterior");
        let points = density
            .iter()
            .enumerate()
            .step_by(4)
            .map(|(good, p)| [good as f64 / IDS as f64, p * IDS as f64]);
        canvas.path(&format!("line s{k}"), &panel.curve(points));
        let mut likeliest = 0;
        for (good, p) in density.iter().enumerate() {
            if *p > density[likeliest] {
                likeliest = good;
            }
        }
        let share = likeliest as f64 / IDS as f64;
        let held: f64 = (density.iter().enumerate())
            .filter(|(good, _)| (*good as f64 / IDS as f64 - share).abs() <= 0.05)
            .map(|(_, p)| p)
            .sum();
        let y = panel.edges[1] + 60.0 + 20.0 * k as f64;
        canvas.line(&format!("line s{k}"), [360.0, y - 5.0], [388.0, y - 5.0]);
        let label = format!("B = {runs}: likeliest {}", number(share));
        canvas.text("", [396.0, y], &label);
        peaks.push(format!(
            "B = {runs}: likeliest S/N {share:.4}, {:.1} % within 0.05 of it",
            100.0 * held
        ));
    }
    let says = format!(
        "Density of the posterior over S/N, prior uniform, rectangular window, T = 32, S/N = 0.345, \
         T theta = {:.2}; outcomes read: {}. {}.",
        known.theta() * 32.0,
        listed.join(", "),
        peaks.join("; ")
    );
    Figure::drawn(canvas, says)
}

/// Draws the distribution of a register if no, one, half, all but one or all indices are good.
pub(super) fn ends() -> Figure {
    const BITS: u32 = 5;
    const TOTAL: u64 = 1024;
    let title = "A phase register of T = 32 at the extremes, N = 1,024";
    let mut canvas = Canvas::new(title, 580.0, 560.0);
    let cases = [
        (0, "S = 0: certain"),
        (1, "S = 1: hardly told from 0"),
        (TOTAL / 2, "S = N/2: on the grid, certain"),
        (TOTAL - 1, "S = N \u{2212} 1"),
        (TOTAL, "S = N: certain"),
    ];
    let mut told = Vec::new();
    for (k, (good, name)) in cases.into_iter().enumerate() {
        let top = 62.0 + 98.0 * k as f64;
        let panel = Panel {
            edges: [76.0, top, 560.0, top + 62.0],
            x: [-0.7, 16.7],
            y: [0.0, 1.0],
        };
        canvas.text("", [panel.edges[0], top - 6.0], name);
        let last = k == 4;
        let outcomes = (0..=16).step_by(2).filter(|_| last).map(f64::from);
        let label = if last { "outcome y" } else { "" };
        panel.axes(
            &mut canvas,
            [&ticks(outcomes, 0), &ticks([0.0, 1.0], 0)],
            [label, ""],
        );
        let known = PhaseDistribution::new(good, TOTAL, BITS, Window::Rect).expect("it exists");
        let mut most = (0, 0.0);
        for y in 0..=16_u64 {
            let probability = known.probability(y);
            let [x, height] = panel.at([y as f64, probability]);
            let bar = [x - 8.0, height, 16.0, panel.edges[3] - height];
            canvas.rectangle("pale s0", bar);
            if probability > most.1 {
                most = (y, probability);
            }
        }
        told.push(format!("S = {good} reads {} with {:.4}", most.0, most.1));
    }
    let says = format!(
        "Probabilities of the outcomes of a phase register of five bits with the rectangular \
         window. {}.",
        told.join("; ")
    );
    Figure::drawn(canvas, says)
}

/// Draws each outcome of a short run: its probability, and its part in the mean square error.
pub(super) fn tail() -> Figure {
    const BITS: u32 = 4;
    let title = "One index of four is good, T = 16: one run, rectangular window";
    let mut canvas = Canvas::new(title, 580.0, 440.0);
    let known = PhaseDistribution::new(1, 4, BITS, Window::Rect).expect("a distribution");
    let outcomes = 0..=known.largest_outcome();
    let amplitude = |y: u64| libm::sin(PI * y as f64 / f64::from(1 << BITS)).powi(2);
    let brought = |y: u64| known.probability(y) * (amplitude(y) - 0.25).powi(2);
    let total: f64 = outcomes.clone().map(brought).sum();
    let share = |y: u64| brought(y) / total;
    let probability = |y: u64| known.probability(y);
    let names = [
        "how probable the outcome is",
        "how much of the mean square error it brings",
    ];
    for (style, name) in names.into_iter().enumerate() {
        let top = 62.0 + 180.0 * style as f64;
        let height = |y| if style == 0 { probability(y) } else { share(y) };
        let most = if style == 0 { 0.8 } else { 0.2 };
        let panel = Panel {
            edges: [76.0, top, 560.0, top + 130.0],
            x: [-0.7, 8.7],
            y: [0.0, most],
        };
        canvas.text("", [panel.edges[0], top - 8.0], name);
        let below = outcomes.clone().map(|y| (y as f64, format!("{y}")));
        let levels = ticks([0.0, most / 2.0, most], 1);
        let label = if style == 0 {
            ""
        } else {
            "outcome y, which says ã = sin²(πy/16)"
        };
        panel.axes(
            &mut canvas,
            [&below.collect::<Vec<_>>(), &levels],
            [label, ""],
        );
        for y in outcomes.clone() {
            let [x, upper] = panel.at([y as f64, height(y)]);
            let bar = [x - 14.0, upper, 28.0, panel.edges[3] - upper];
            canvas.rectangle(&format!("pale s{style}"), bar);
        }
        let truth = panel.at([known.theta() * f64::from(1 << BITS), 0.0])[0];
        canvas.line(
            "axis dash",
            [truth, panel.edges[1]],
            [truth, panel.edges[3]],
        );
    }
    let near = known.nearest_outcome();
    let says = format!(
        "Two rows of bars over the outcomes 0 to 8 of a phase register of four bits, at T theta = \
         {:.2}. Above, probabilities: outcome {near} has {:.1} %, those from 4 to 8 together {:.1} %. \
         Below, what each brings to the mean square error: outcome {near} {:.1} %, those from 4 to 8 \
         together {:.1} %.",
        known.theta() * f64::from(1 << BITS),
        100.0 * probability(near),
        100.0 * (4..=8).map(probability).sum::<f64>(),
        100.0 * share(near),
        100.0 * (4..=8).map(share).sum::<f64>(),
    );
    Figure::drawn(canvas, says)
}
