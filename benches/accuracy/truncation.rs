//! Error of a finite number of paths, by the way they are chosen.
//!
//! `cargo bench --bench accuracy -- truncation` compares the digital net, independent random paths
//! and the paper's product lattice on the Cornell box at D = 3 with an independent renderer's
//! picture, prints the table, writes it to `book/data/truncation.csv`, from which `cargo run
//! --release --example book-figures` draws the book's figure, and fails unless the net beats random
//! paths and random paths beat the lattice.

#[path = "../../tests/pictures/independent.rs"]
mod independent;

use crate::common::{Arguments, Promises};
use independent::{Picture, SIDE, asking, mean, picture, reference, rms_difference, scene, traced};
use qrt::drawing::Fit;
use qrt_runtime::path_machines::Real;
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
    dark: Vec<(u32, f64)>,
    all: Vec<(u32, f64)>,
}

impl Series {
    fn new(name: &'static str) -> Self {
        let (dark, all) = (Vec::new(), Vec::new());
        Self { name, dark, all }
    }

    fn at(&self, bits: u32) -> Option<f64> {
        self.dark.iter().find(|p| p.0 == bits).map(|p| p.1)
    }

    /// Returns the slope of the error over the paths.
    fn slope(&self) -> f64 {
        let points = self.dark.iter();
        let points = points.map(|&(bits, error)| (f64::from(bits), error.log2()));
        Fit::from_points(points)
            .expect("several numbers of paths")
            .slope
    }
}

/// Measures a picture against the reference, away from the lamp and over all pixels.
struct Judge {
    reference: Picture,
    /// Root mean square error of the reference itself, over the mean, away from the lamp.
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

pub(crate) fn run(_: &Arguments, promises: &mut Promises) {
    let judge = Judge::new();
    let mut net = Series::new("digital net");
    let mut random = Series::new("random paths");
    let mut lattice = Series::new("product lattice");
    for bits in 6..=18 {
        let valid = scene(SCENE, &asking(10, DEPTH, bits, "none"));
        judge.add(&mut net, bits, &traced(&valid, 1));
        let machine = match Real::new(&valid, 1) {
            Ok(machine) => machine.monte_carlo(1 << bits),
            Err(error) => panic!("{error}"),
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
    let slopes = series.each_ref().map(|s| format!("{:>18.2}", s.slope()));
    println!("slope    {}", slopes.concat());

    let file = concat!(env!("CARGO_MANIFEST_DIR"), "/book/data/truncation.csv");
    std::fs::write(file, csv(&series)).unwrap_or_else(|error| panic!("{file}: {error}"));
    let [net, random, lattice] = &series;
    let ordered = [12, 15, 18].into_iter().all(|bits| {
        let errors = [net, random, lattice].map(|s| s.at(bits));
        matches!(errors, [Some(a), Some(b), Some(c)] if a < b && b < c)
    });
    promises.judge("errors: net < random paths < lattice", ordered);
}

/// Returns the table: RMSE over the mean, away from the lamp (`dark`) and over all pixels.
fn csv(series: &[Series; 3]) -> String {
    let mut text = String::from("paths,path_bits,dark,all\n");
    for s in series {
        for (&(bits, dark), &(_, all)) in s.dark.iter().zip(&s.all) {
            // Writing to a string cannot fail.
            let _ = writeln!(text, "{},{bits},{dark:.6e},{all:.6e}", s.name);
        }
    }
    text
}
