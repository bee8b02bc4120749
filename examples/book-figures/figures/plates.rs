//! A scene with a known answer at any length of paths: two parallel plates, of which half glows.
//!
//! Between infinite plates at distance 1 that scatter with the cosine, each bounce moves a path
//! along x by an independent step of density `1 / (2 (1 + x^2)^(3/2))`, whose characteristic
//! function is `w K_1(w)`. Beyond x = c both plates shine with radiance 1, and all reflect the
//! fraction RHO. So a path's expected colour is a sum of the probabilities that 0, 1, 2, ... steps
//! lead beyond c, each of them one integral.

use super::{Figure, scene, style};
use qrt::drawing::{Drawn, Plot, PlotAxis, Series};
use qrt::runtime::path_machines::Real;
use qrt::runtime::sample::tallies;
use qrt::runtime::workers::Workers;
use qrt::scene::valid::ValidScene;
use std::f64::consts::PI;

const RHO: f64 = 0.8;
/// Position where the glow begins: inside of a pixel.
const EDGE: f64 = 0.03;
/// Pixels along each side of a film of size 1.
const SIDE: u32 = 8;
/// R = 2^12.
const PATH_BITS: u32 = 12;
const LONGEST: usize = 8;

/// Spreads the bits of a lattice over `coordinates` coordinates, the earlier first.
fn spread(coordinates: usize) -> Vec<u32> {
    let n = coordinates as u32;
    (0..n)
        .map(|k| PATH_BITS / n + u32::from(k < PATH_BITS % n))
        .collect()
}

fn plates(depth: usize, lattice: bool) -> ValidScene {
    let bits = if lattice {
        spread(2 * depth)
    } else {
        vec![12; 2 * depth]
    };
    let depths: Vec<String> = bits
        .chunks(2)
        .map(|pair| format!("{{ bits: [{}, {}] }}", pair[0], pair[1]))
        .collect();
    let sequence = if lattice {
        "product-lattice"
    } else {
        "digital-net"
    };
    let text = format!(
        "name: plates
camera: {{ orthographic: {{ eye: [0, 0.5, 0], target: [0, 0, 0], up: [0, 0, 1], height: 1 }} }}
film: {{ width: {SIDE}, height: {SIDE} }}
materials:
  dark: {{ lambertian: {{ albedo: [{RHO}, {RHO}, {RHO}] }} }}
  glow: {{ emitter: {{ radiance: [1, 1, 1], albedo: [{RHO}, {RHO}, {RHO}] }} }}
geometry:
  - quad: {{ vertices: [[-9e3, 0, -9e3], [-9e3, 0, 9e3], [{EDGE}, 0, 9e3], [{EDGE}, 0, -9e3]], \
         material: dark }}
  - quad: {{ vertices: [[{EDGE}, 0, -9e3], [{EDGE}, 0, 9e3], [9e3, 0, 9e3], [9e3, 0, -9e3]], \
         material: glow }}
  - quad: {{ vertices: [[-9e3, 1, -9e3], [{EDGE}, 1, -9e3], [{EDGE}, 1, 9e3], [-9e3, 1, 9e3]], \
         material: dark }}
  - quad: {{ vertices: [[{EDGE}, 1, -9e3], [9e3, 1, -9e3], [9e3, 1, 9e3], [{EDGE}, 1, 9e3]], \
         material: glow }}
sampling: {{ sequence: {sequence}, path_bits: {PATH_BITS}, depths: [{}], lights: none }}
",
        depths.join(", ")
    );
    scene(&text, "plates.yaml")
}

/// Returns `w K_1(w)`, the integral of `w exp(-w cosh t) cosh t`, by the trapezoidal rule.
fn characteristic(w: f64) -> f64 {
    if w == 0.0 {
        return 1.0;
    }
    let step = 0.1;
    let term = |k: i32| {
        let cosh = libm::cosh(step * f64::from(k));
        libm::exp(-w * cosh) * cosh
    };
    w * step * (0.5 * term(0) + (1..160).map(term).sum::<f64>())
}

/// Returns the pixel of a column of the film for every length of paths up to the longest.
fn known(column: u32, phi: &[f64], step: f64) -> Vec<f64> {
    let width = 1.0 / f64::from(SIDE);
    // x is least at the film's right edge.
    let middle = 0.5 - (f64::from(column) + 0.5) * width - EDGE;
    let mut sum = (middle / width + 0.5).clamp(0.0, 1.0);
    let mut all = vec![sum];
    for bounce in 1..LONGEST {
        let integrand = |k: usize| {
            let w = step * k as f64;
            let half = 0.5 * w * width;
            if k == 0 {
                return middle;
            }
            libm::sin(w * middle) / w * libm::sin(half) / half * libm::pow(phi[k], bounce as f64)
        };
        // Simpson's rule.
        let last = phi.len() - 1;
        let inner = (1..last).map(|k| f64::from(2 + 2 * (k as u32 % 2)) * integrand(k));
        let integral = (inner.sum::<f64>() + integrand(0) + integrand(last)) * step / 3.0;
        sum += libm::pow(RHO, bounce as f64) * (0.5 + integral / PI);
        all.push(sum);
    }
    all
}

/// Draws the error of both sequences, and of random paths, over the length of paths.
pub(super) fn dimensions() -> Figure {
    let step = 0.02;
    let phi: Vec<f64> = (0..=1500)
        .map(|k| characteristic(step * f64::from(k)))
        .collect();
    let columns: Vec<Vec<f64>> = (0..SIDE).map(|column| known(column, &phi, step)).collect();
    let pixels: Vec<[u32; 2]> = (0..SIDE * SIDE).map(|k| [k % SIDE, k / SIDE]).collect();
    let paths = 1_u64 << PATH_BITS;
    let error = |real: &Real, depth: usize| {
        let sums =
            tallies(real, &pixels, 0..paths, &[], &Workers::default()).expect("nobody cancels");
        let (mut squares, mut mean) = (0.0, 0.0);
        for (pixel, sum) in pixels.iter().zip(sums) {
            let truth = columns[pixel[0] as usize][depth - 1];
            let off = sum.colour[0] / paths as f64 - truth;
            squares += off * off / pixels.len() as f64;
            mean += truth / pixels.len() as f64;
        }
        squares.sqrt() / mean
    };
    let mut found = [const { Vec::new() }; 3];
    for depth in 2..=LONGEST {
        let machine = |lattice| Real::new(&plates(depth, lattice), 1).expect("a machine");
        let machines = [
            machine(true),
            machine(false).monte_carlo(paths),
            machine(false),
        ];
        for (errors, real) in found.iter_mut().zip(&machines) {
            errors.push((depth as f64, error(real, depth)));
        }
    }
    let names = ["product lattice", "random paths", "digital net"];
    let says: Vec<String> = (names.iter().zip(&found))
        .map(|(name, errors)| {
            let errors = errors.iter().map(|(_, e)| format!("{:.3} %", 100.0 * e));
            format!("{name}: {}", errors.collect::<Vec<_>>().join(", "))
        })
        .collect();
    let says = format!(
        "RMSE over the mean of 8 x 8 pixels between two plates whose answer is known, 2^12 paths a \
         pixel, for D = 2 to 8 rays (2 D coordinates). {}.",
        says.join(". ")
    );
    let series = names.iter().zip(found);
    let plot = Plot {
        title: "4,096 paths of D rays against a known answer".to_owned(),
        x: PlotAxis::bits("D, rays of a path (2 D coordinates)"),
        y: PlotAxis::log("RMSE over the mean"),
        series: series
            .map(|(name, errors)| Series::new(name, errors, Drawn::Joined).styled(style(name)))
            .collect(),
    };
    Figure::drawn(plot.draw(), says)
}
