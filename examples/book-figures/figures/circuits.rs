//! Drawings of circuits, and their costs.

#[path = "../../../benches/common/growth.rs"]
mod scenes;

use super::{Figure, cornell, scene};
use qrt::circuit::lower;
use qrt::core::compile::Role;
use qrt::core::inspect::{CallPart, Inspection, grouped};
use qrt::core::oracle::{Oracle, OracleOptions, Oracles};
use qrt::drawing::{Canvas, Drawn, Plot, PlotAxis, Series};
use qrt::lab::draw;
use qrt::runtime::render::{self, Model, Rendered};
use qrt::scene::Estimator;
use qrt::scene::valid::ValidScene;
use qrt::tracer::PixelClass;

/// A lamp in front of a wall: a circuit small enough to be seen whole.
const WALL: &str = include_str!("../../lit-wall.yaml");

pub(super) fn inspected(scene: &ValidScene) -> Inspection {
    let oracles = Oracles::new(scene);
    Inspection::of_class(&oracles, None, PixelClass::default()).expect("the scene has a circuit")
}

fn figures(inspection: &Inspection) -> String {
    let total = inspection.total();
    format!(
        "{} Toffoli, {} qubits, Toffoli depth {}",
        grouped(total.toffoli),
        grouped(u64::from(inspection.qubits)),
        grouped(inspection.toffoli_depth)
    )
}

/// Draws the call in the paper's frame.
pub(super) fn frame() -> Figure {
    let inspection = inspected(&scene(WALL, "lit-wall.yaml"));
    let says = format!(
        "One call of the oracle of a lamp before a wall (2 quads, 2 rays, 2^5 paths, 8 fraction \
         bits) as boxes on wires, from the compiled program: compute, compare and flip, uncompute; \
         {}. As `qrt inspect SCENE --circuit FILE.svg` draws it.",
        figures(&inspection)
    );
    Figure::drawn(draw::frame(&inspection, "lit-wall"), says)
}

/// Qubits of one stage and one role, from the first computation to the last uncomputation.
struct Held {
    stage: String,
    role: Role,
    qubits: u64,
    instructions: [usize; 2],
}

/// Returns the map of registers, summed up by stage and role.
fn held(inspection: &Inspection) -> Vec<Held> {
    let stages = inspection.stages();
    let mut all: Vec<Held> = Vec::new();
    for lifetime in &inspection.layout.lifetimes {
        let register = &inspection.whole.registers[lifetime.register.index()];
        let span = &lifetime.instructions;
        let stage = if inspection.whole.inputs.contains(&lifetime.register) {
            named(&register.name)
        } else {
            let within = stages
                .iter()
                .find(|stage| stage.instructions.contains(&span.start));
            within.map_or_else(String::new, ToString::to_string)
        };
        let (role, qubits) = (Role::from_register(register), u64::from(register.width));
        let known = all
            .iter_mut()
            .find(|held| held.stage == stage && held.role == role);
        if let Some(held) = known {
            held.qubits += qubits;
            held.instructions[0] = held.instructions[0].min(span.start);
            held.instructions[1] = held.instructions[1].max(span.end);
        } else {
            all.push(Held {
                stage,
                role,
                qubits,
                instructions: [span.start, span.end],
            });
        }
    }
    all.sort_by_key(|held| held.instructions[0]);
    all
}

/// Draws the qubits that each stage holds over time.
pub(super) fn registers() -> Figure {
    let inspection = inspected(&scene(WALL, "lit-wall.yaml"));
    let all = held(&inspection);
    let mut times = vec![0.0];
    for cost in &inspection.costs {
        times.push(times.last().copied().unwrap_or(0.0) + cost.toffoli as f64);
    }
    let last = times.last().copied().unwrap_or(1.0);
    let bottom = 72.0 + 22.0 * all.len() as f64;
    let title = "One oracle call: which stage's qubits are held, and when";
    let mut canvas = Canvas::new(title, 720.0, bottom + 58.0);
    let (left, right) = (170.0, 700.0);
    let x = |instruction: usize| left + (right - left) * times[instruction] / last;
    let mut at = 14.0;
    for role in Role::ALL {
        let name = named(&role.to_string());
        canvas.rectangle(class(role), [at, 38.0, 12.0, 12.0]);
        canvas.text("small", [at + 17.0, 48.0], &name);
        at += 34.0 + 7.0 * name.len() as f64;
    }
    canvas.text("small soft end", [left - 8.0, 60.0], "qubits");
    for (row, held) in all.iter().enumerate() {
        let y = 66.0 + 22.0 * row as f64;
        canvas.text("small end", [left - 44.0, y + 13.0], &held.stage);
        let [from, to] = held.instructions.map(x);
        let width = (to - from).max(3.0);
        canvas.rectangle(class(held.role), [from, y + 1.0, width, 17.0]);
        let qubits = grouped(held.qubits);
        canvas.text("small soft end", [left - 8.0, y + 13.0], &qubits);
    }
    let flip = inspection.instructions(CallPart::Flip);
    let middle = f64::midpoint(x(flip.start), x(flip.end));
    canvas.line("wire", [middle, 60.0], [middle, bottom + 4.0]);
    canvas.text("small mid", [middle, bottom + 18.0], "flip");
    canvas.text("small", [left, bottom + 18.0], "compute");
    canvas.text("small end", [right, bottom + 18.0], "uncompute");
    let axis = format!("Toffolis so far, to {}", grouped(last as u64));
    canvas.text(
        "soft mid",
        [f64::midpoint(left, right), bottom + 42.0],
        &axis,
    );
    let says = format!(
        "Qubits of one oracle call of a lamp before a wall (2 quads, 2 rays, 2^5 paths, 8 fraction \
         bits), by stage and role, from the first register that is computed to the last that is \
         uncomputed; {}, {} registers.",
        figures(&inspection),
        grouped(inspection.layout.registers())
    );
    Figure::drawn(canvas, says)
}

/// Returns the book's name of a register or a role.
fn named(name: &str) -> String {
    if name == "id" { "path index" } else { name }.to_owned()
}

/// Returns the class of a role's colour.
fn class(role: Role) -> &'static str {
    match role {
        Role::Id => "id",
        Role::Comparator => "comparator",
        Role::Work => "work",
        Role::Scratch => "scratch",
        Role::Colour => "colour",
        Role::Flag => "flag",
    }
}

/// Returns the Toffolis of one call, first channel.
fn toffolis(scene: &ValidScene) -> f64 {
    let oracle = Oracle::new(scene, 0, OracleOptions::default()).expect("the scene has a circuit");
    let costs = lower::tally(&oracle.whole(0));
    costs.iter().map(|cost| cost.toffoli as f64).sum()
}

/// Draws the growth of the cost.
pub(super) fn growth() -> Figure {
    let quads = [4, 8, 16, 32, 64, 128].map(|count| {
        let scene = scene(&scenes::quads(count), "quads.yaml");
        (f64::from(count), toffolis(&scene))
    });
    let rays = [1, 2, 3, 4, 6, 8, 12, 16, 20, 24].map(|count: u32| {
        let depths = vec!["{ bits: [10, 10] }"; count as usize].join(", ");
        let scene = cornell(&[&format!("sampling.depths=[{depths}]")]);
        (f64::from(count), toffolis(&scene))
    });
    // The first ray is the cheapest, so the power laws are fitted over more rays.
    let (few, many) = (&rays[..6], &rays[5..]);
    let fractions = [6, 10, 14, 16, 18, 22, 26, 30].map(|bits: u32| {
        let scene = cornell(&[&format!("precision.fraction={bits}")]);
        (f64::from(bits), toffolis(&scene))
    });
    let all: [(&str, &[(f64, f64)]); 3] = [
        ("quads P", &quads),
        ("rays D from 8", many),
        ("fraction bits w", &fractions),
    ];
    let parts: Vec<String> = all
        .iter()
        .map(|(name, points)| said(name, points))
        .collect();
    let mut series = all
        .map(|(name, points)| Series::new(name, points.to_vec(), Drawn::Fit))
        .to_vec();
    series.push(Series::new("rays D to 8", few.to_vec(), Drawn::Joined));
    let plot = Plot {
        title: "Toffolis of one oracle call, and how they grow".to_owned(),
        x: PlotAxis::log("quads P, rays D or fraction bits w"),
        y: PlotAxis::log("Toffolis of one call"),
        series,
    };
    let says = format!(
        "Toffolis of one oracle call (first channel, uncompute: keep) of generated scenes of quads \
         with 3 rays, and of the Cornell box with other numbers of rays and of fraction bits, with \
         power laws fitted. {}.",
        parts.join("; ")
    );
    Figure::drawn(plot.draw(), says)
}

fn said(name: &str, points: &[(f64, f64)]) -> String {
    let slope = scenes::fit(points.iter().map(|&(x, y)| [x, y])).slope;
    let ends = [points.first(), points.last()].map(|p| p.copied().unwrap_or_default());
    let [from, to] = ends.map(|(x, y)| format!("{} at {x}", grouped(y as u64)));
    format!("{name}: {from} to {to}, slope {slope:.2}")
}

/// Compares the circuit's numbers with floating point.
pub(super) fn width() -> Figure {
    let rendered = |fraction: u32, model: Model| -> Rendered {
        let scene = cornell(&[
            "film={ width: 32, height: 32 }",
            "sampling.path_bits=12",
            "comparator.bits=20",
            &format!("precision.fraction={fraction}"),
        ]);
        let options = render::RenderOptions {
            model: Some(model),
            estimator: Some(Estimator::Exact),
            ..render::RenderOptions::default()
        };
        render::render(&scene, &options).expect("a picture")
    };
    let real = rendered(16, Model::Real);
    let truth = real.image.pixels.as_flattened();
    let mean = truth.iter().sum::<f64>() / truth.len() as f64;
    let points = (6..=22_u32).step_by(2).map(|fraction| {
        let fixed = rendered(fraction, Model::Fixed);
        let squares = (fixed.image.pixels.as_flattened().iter().zip(truth))
            .map(|(a, b)| (a - b) * (a - b))
            .sum::<f64>();
        let rmse = (squares / truth.len() as f64).sqrt();
        (f64::from(fraction), rmse / mean)
    });
    let points: Vec<(f64, f64)> = points.collect();
    let listed: Vec<String> = points
        .iter()
        .map(|(bits, error)| format!("{bits}: {:.3} %", 100.0 * error))
        .collect();
    let says = format!(
        "RMSE of the fixed machine's picture to the real model's on the same paths, over the mean, \
         by fraction bits; Cornell box, 32 x 32 pixels, 2^12 paths, 20 comparator bits. {}.",
        listed.join(", ")
    );
    let plot = Plot {
        title: "Error of the circuit's numbers, Cornell box".to_owned(),
        x: PlotAxis::bits("fraction bits"),
        y: PlotAxis::log("RMSE to real over the mean"),
        series: vec![Series::new("fixed to real", points, Drawn::Fit)],
    };
    Figure::drawn(plot.draw(), says)
}
