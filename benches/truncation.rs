//! What a finite number of paths costs, by the way they are chosen.
//!
//! `cargo bench --bench truncation` compares the digital net, independent random paths and the
//! paper's product lattice on the Cornell box at D = 3 with an independent renderer's picture,
//! prints the table, draws `book/src/figures/truncation.svg`, and fails unless the net beats random
//! paths and random paths beat the lattice.

// A bench that cannot run has nothing to report.
#![allow(clippy::unwrap_used, clippy::expect_used)]

#[path = "../tests/independent/mod.rs"]
mod independent;

use independent::{Picture, SIDE, asking, mean, picture, reference, rms_difference, scene, traced};
use qrt_runtime::machines::Real;
use std::fmt::Write as _;

const SCENE: &str = "cornell_mg";
const DEPTH: usize = 3;

/// Bits of the lattice's three rays, for 2^6 to 2^18 paths.
const LATTICES: [(u32, [[u32; 2]; 3]); 5] = [
    (6, [[1, 1]; 3]),
    (9, [[2, 1]; 3]),
    (12, [[2, 2]; 3]),
    (15, [[3, 2]; 3]),
    (18, [[3, 3]; 3]),
];

/// One way of choosing paths: (path bits, RMSE over the mean), away from the lamp and over all.
struct Series {
    name: &'static str,
    class: &'static str,
    dark: Vec<(u32, f64)>,
    all: Vec<(u32, f64)>,
}

impl Series {
    fn new(name: &'static str, class: &'static str) -> Self {
        let (dark, all) = (Vec::new(), Vec::new());
        Self {
            name,
            class,
            dark,
            all,
        }
    }

    fn at(&self, bits: u32) -> Option<f64> {
        self.dark.iter().find(|p| p.0 == bits).map(|p| p.1)
    }

    /// The least-squares line of log2(error) over log2(paths): slope and value at 0.
    fn line(&self) -> (f64, f64) {
        let points = self
            .dark
            .iter()
            .map(|&(bits, error)| (f64::from(bits), error.log2()));
        let n = self.dark.len() as f64;
        let (x, y) = points
            .clone()
            .fold((0.0, 0.0), |s, p| (s.0 + p.0 / n, s.1 + p.1 / n));
        let (xx, xy) = points.fold((0.0, 0.0), |s, p| {
            (s.0 + (p.0 - x) * (p.0 - x), s.1 + (p.0 - x) * (p.1 - y))
        });
        (xy / xx, y - xy / xx * x)
    }
}

/// Measures a picture against the reference, away from the lamp and over all pixels.
struct Judge {
    reference: Picture,
    /// Its own root mean square error, over the mean, away from the lamp.
    noise: f64,
    /// Pixels that do not see the lamp.
    dark: Vec<bool>,
}

impl Judge {
    fn new() -> Self {
        let seen = reference(SCENE, 1).picture;
        let theirs = reference(SCENE, DEPTH);
        let mut judge = Self {
            reference: theirs.picture,
            noise: 0.0,
            dark: seen.iter().map(|pixel| *pixel == [0.0; 3]).collect(),
        };
        let noise = judge.dark(&theirs.standard_error);
        let none = vec![[0.0; 3]; noise.len()];
        judge.noise = rms_difference(&noise, &none) / mean(&judge.dark(&judge.reference));
        judge
    }

    fn dark(&self, picture: &Picture) -> Picture {
        let pairs = picture.iter().zip(&self.dark);
        pairs.filter(|pair| *pair.1).map(|pair| *pair.0).collect()
    }

    fn add(&self, series: &mut Series, bits: u32, picture: &Picture) {
        let (ours, theirs) = (self.dark(picture), self.dark(&self.reference));
        let error = rms_difference(&ours, &theirs) / mean(&theirs);
        series.dark.push((bits, error));
        let error = rms_difference(picture, &self.reference) / mean(&self.reference);
        series.all.push((bits, error));
    }
}

fn main() -> std::process::ExitCode {
    let judge = Judge::new();
    let mut net = Series::new("digital net", "net");
    let mut random = Series::new("random paths", "random");
    let mut lattice = Series::new("product lattice", "lattice");
    for bits in 6..=18 {
        let valid = scene(SCENE, &asking(DEPTH, bits));
        judge.add(&mut net, bits, &traced(&valid, 1));
        let machine = match Real::new(&valid, 1) {
            Ok(machine) => machine.monte_carlo(1 << bits),
            Err(error) => {
                eprintln!("{error}");
                return std::process::ExitCode::FAILURE;
            }
        };
        judge.add(&mut random, bits, &picture(&machine, SIDE, SIDE));
    }
    for (bits, depths) in LATTICES {
        let depths = depths
            .map(|[u, v]| format!("{{bits: [{u}, {v}]}}"))
            .join(", ");
        let valid = scene(
            SCENE,
            &[
                "sampling.sequence=product-lattice".to_owned(),
                format!("sampling.path_bits={bits}"),
                format!("sampling.depths=[{depths}]"),
            ],
        );
        judge.add(&mut lattice, bits, &traced(&valid, 1));
    }

    let series = [net, random, lattice];
    println!("RMSE over the mean; Cornell box, D = 3, 16 x 16 pixels; (all pixels in brackets)");
    println!(
        "paths    {}",
        series
            .each_ref()
            .map(|s| format!("{:>18}", s.name))
            .concat()
    );
    for bits in [12, 15, 18] {
        let cells = series.each_ref().map(|s| {
            let of =
                |points: &[(u32, f64)]| points.iter().find(|p| p.0 == bits).map_or(0.0, |p| p.1);
            format!("   {:.4} ({:.4})", of(&s.dark), of(&s.all))
        });
        println!("2^{bits:<6} {}", cells.concat());
    }
    let slopes = series.each_ref().map(|s| format!("{:>18.2}", s.line().0));
    println!("slope    {}", slopes.concat());

    let root = env!("CARGO_MANIFEST_DIR");
    let folder = format!("{root}/book/src/figures");
    let written = std::fs::create_dir_all(&folder)
        .and_then(|()| std::fs::write(format!("{folder}/truncation.svg"), plot(&series)));
    if let Err(error) = written {
        eprintln!("{folder}/truncation.svg: {error}");
        return std::process::ExitCode::FAILURE;
    }
    let [net, random, lattice] = &series;
    let ordered = [12, 15, 18].into_iter().all(|bits| {
        let errors = [net, random, lattice].map(|s| s.at(bits));
        matches!(errors, [Some(a), Some(b), Some(c)] if a < b && b < c)
    });
    if ordered {
        std::process::ExitCode::SUCCESS
    } else {
        eprintln!("the order net < random < lattice does not hold");
        std::process::ExitCode::FAILURE
    }
}

/// A log-log plot that follows its reader's colour scheme.
fn plot(series: &[Series; 3]) -> String {
    const LEFT: f64 = 70.0;
    const TOP: f64 = 20.0;
    const WIDTH: f64 = 480.0;
    const HEIGHT: f64 = 300.0;
    // Paths 2^6 to 2^18 across; errors 2^-8 (0.4 %) to 2^3 (800 %) upwards.
    let x = |bits: f64| LEFT + WIDTH * (bits - 6.0) / 12.0;
    let y = |log: f64| TOP + HEIGHT * (3.0 - log) / 11.0;
    let mut svg = String::from(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 720 380\" role=\"img\" \
         font-family=\"sans-serif\" font-size=\"13\">\n\
         <title>Error of a picture over the number of paths, by the way they are chosen</title>\n\
         <style>\n\
         text { fill: #24292f } .axis { stroke: #57606a } .grid { stroke: #d0d7de }\n\
         .net { stroke: #0969da; fill: #0969da } .random { stroke: #9a6700; fill: #9a6700 }\n\
         .lattice { stroke: #cf222e; fill: #cf222e }\n\
         path, line { fill: none } text { stroke: none }\n\
         @media (prefers-color-scheme: dark) {\n\
         text { fill: #e6edf3 } .axis { stroke: #9198a1 } .grid { stroke: #3d444d }\n\
         .net { stroke: #58a6ff; fill: #58a6ff } .random { stroke: #d29922; fill: #d29922 }\n\
         .lattice { stroke: #ff7b72; fill: #ff7b72 }\n\
         }\n\
         </style>\n",
    );
    // Writing to a string cannot fail.
    let mut put = |line: std::fmt::Arguments<'_>| {
        let _ = svg.write_fmt(line);
        svg.push('\n');
    };
    let (right, bottom) = (LEFT + WIDTH, TOP + HEIGHT);
    for bits in (6..=18).step_by(3) {
        let at = x(f64::from(bits));
        put(format_args!(
            "<line class=\"grid\" x1=\"{at:.1}\" y1=\"{TOP}\" x2=\"{at:.1}\" y2=\"{bottom}\"/>\
             <text x=\"{at:.1}\" y=\"{:.1}\" text-anchor=\"middle\">2<tspan dy=\"-5\" \
             font-size=\"10\">{bits}</tspan></text>",
            bottom + 20.0
        ));
    }
    for (label, error) in [("1 %", 0.01), ("10 %", 0.1), ("100 %", 1.0)] {
        let at = y(f64::log2(error));
        put(format_args!(
            "<line class=\"grid\" x1=\"{LEFT}\" y1=\"{at:.1}\" x2=\"{right}\" y2=\"{at:.1}\"/>\
             <text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"end\">{label}</text>",
            LEFT - 8.0,
            at + 4.0
        ));
    }
    put(format_args!(
        "<path class=\"axis\" d=\"M{LEFT} {TOP}V{bottom}H{right}\"/>\
         <text x=\"{:.1}\" y=\"{:.1}\" text-anchor=\"middle\">paths a pixel</text>\
         <text transform=\"translate(16 {:.1}) rotate(-90)\" text-anchor=\"middle\">RMSE over the \
         mean</text>",
        LEFT + WIDTH / 2.0,
        bottom + 44.0,
        TOP + HEIGHT / 2.0
    ));
    for s in series {
        let (slope, start) = s.line();
        let ends = [s.dark.first(), s.dark.last()].map(|p| p.map_or(0.0, |p| f64::from(p.0)));
        let [a, b] = ends.map(|bits| (x(bits), y(start + slope * bits)));
        put(format_args!(
            "<line class=\"{}\" stroke-dasharray=\"5 4\" x1=\"{:.1}\" y1=\"{:.1}\" x2=\"{:.1}\" \
             y2=\"{:.1}\"/>",
            s.class, a.0, a.1, b.0, b.1
        ));
        for &(bits, error) in &s.dark {
            put(format_args!(
                "<circle class=\"{}\" cx=\"{:.1}\" cy=\"{:.1}\" r=\"3.5\"/>",
                s.class,
                x(f64::from(bits)),
                y(error.log2())
            ));
        }
        put(format_args!(
            "<text x=\"{:.1}\" y=\"{:.1}\">{}</text>\
             <text x=\"{:.1}\" y=\"{:.1}\" font-size=\"11\">slope {slope:.2}</text>",
            right + 12.0,
            b.1,
            s.name,
            right + 12.0,
            b.1 + 14.0
        ));
    }
    svg.push_str("</svg>\n");
    svg
}
