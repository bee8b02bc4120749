//! The furnace: pictures at every depth, and the values by the formula.

use super::{Figure, root};
use qrt::drawing::{Canvas, Panel, ticks};
use qrt::runtime::render::{Model, RenderOptions, render};
use qrt::scene::Estimator;
use qrt::scene::front;

/// Emission and albedo of the furnace.
const EMITTED: [f64; 3] = [0.15, 0.2, 0.15];
const ALBEDO: [f64; 3] = [0.25, 0.5, 0.8];
const LONGEST: i32 = 8;

/// Returns one pixel of the furnace for paths of `depth` rays, by the circuit's program on integers.
fn pixel(depth: i32) -> [f64; 3] {
    let rays = vec!["{ bits: [2, 2] }"; depth as usize].join(", ");
    let sets = [
        "film={ width: 1, height: 1 }".to_owned(),
        "sampling.path_bits=4".to_owned(),
        format!("sampling.depths=[{rays}]"),
    ];
    let loaded = front::load(&root().join("scenes-yaml/furnace.yaml"), &sets);
    let scene = loaded.unwrap_or_else(|report| panic!("{report}")).valid;
    let options = RenderOptions {
        model: Some(Model::Fixed),
        estimator: Some(Estimator::Exact),
        ..RenderOptions::default()
    };
    render(&scene, &options).expect("a picture").image.pixels[0]
}

pub(super) fn depths() -> Figure {
    let title = "The furnace: every wall glows and reflects alike";
    let mut canvas = Canvas::new(title, 580.0, 320.0);
    let panel = Panel {
        edges: [76.0, 40.0, 560.0, 262.0],
        x: [0.6, 8.4],
        y: [0.0, 0.8],
    };
    let depths = ticks((1..=LONGEST).map(f64::from), 0);
    let levels = ticks([0.0, 0.2, 0.4, 0.6, 0.8], 1);
    panel.axes(
        &mut canvas,
        [&depths, &levels],
        ["D, rays of a path", "radiance"],
    );
    let found: Vec<[f64; 3]> = (1..=LONGEST).map(pixel).collect();
    let mut worst = 0.0_f64;
    let names = [("s1", "red"), ("s2", "green"), ("s0", "blue")];
    for (channel, (class, name)) in names.into_iter().enumerate() {
        let (emitted, rho) = (EMITTED[channel], ALBEDO[channel]);
        let closed = |depth: f64| emitted * (1.0 - libm::pow(rho, depth)) / (1.0 - rho);
        let curve = (0..=70)
            .map(|k| 1.0 + 0.1 * f64::from(k))
            .map(|d| [d, closed(d)]);
        canvas.path(&format!("line {class}"), &panel.curve(curve));
        let limit = emitted / (1.0 - rho);
        let [from, to] = [0.6, 8.4].map(|x| panel.at([x, limit]));
        canvas.line(&format!("thin dash {class}"), from, to);
        let of: Vec<[f64; 2]> = (found.iter().enumerate())
            .map(|(k, pixel)| [k as f64 + 1.0, pixel[channel]])
            .collect();
        for [depth, value] in &of {
            worst = worst.max((value / closed(*depth) - 1.0).abs());
        }
        canvas.dots(class, of.iter().map(|at| panel.at(*at)));
        let albedo = format!("{name}, albedo {rho}");
        canvas.text(
            "end",
            [panel.edges[2] - 6.0, panel.at([0.0, limit])[1] - 6.0],
            &albedo,
        );
    }
    let says = format!(
        "One pixel of the furnace for paths of 1 to 8 rays, by the circuit's integers (dots), on the \
         curve of the formula; dashed the limit of endless paths. Greatest relative difference \
         {worst:.1e}. Blue, with albedo 0.8, has {:.0} % of its light after 4 rays.",
        100.0 * (1.0 - libm::pow(0.8, 4.0))
    );
    Figure::drawn(canvas, says)
}
