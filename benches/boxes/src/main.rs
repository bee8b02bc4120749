//! Compares qrt's hierarchy of boxes with crates that have one, on the rays of the same paths.
//!
//! `cargo run --release --manifest-path benches/boxes/Cargo.toml` prints million rays a second of
//! one core that find the nearest of 65,536 triangles, and the fraction of rays for which a crate's
//! triangle is ours. It fails where a crate is faster.

#![forbid(unsafe_code)]
// A bench that cannot run has nothing to report.
#![allow(clippy::unwrap_used, clippy::expect_used)]

mod contenders;
#[path = "../../common/knot.rs"]
mod knot;
#[path = "../../common/load.rs"]
mod load;
#[path = "../../common/mesh.rs"]
mod mesh;
mod paths;

use contenders::{Cwbvh, Doubles, Halves, Triangle};
use mesh::{CLOSE, SIDE, VIEW, WHOLE};
use qrt::tracer::NO_FACE;
use qrt::runtime::path_machines::{Real, SingleRay};
use std::path::Path;
use std::process::ExitCode;
use std::time::Instant;

/// Number of runs, in turns, of which the best counts: the machine's noise only ever slows.
const RUNS: usize = 15;

/// A function that finds the label of the nearest face of each ray.
type Find<'a> = Box<dyn Fn(&[SingleRay]) -> Vec<u32> + 'a>;

fn main() -> ExitCode {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let mut fastest = true;
    println!("million rays a second and core, best of {RUNS} runs | same triangle as ours");
    for (view, name) in [(VIEW, "on its table"), (CLOSE, "filling the film")] {
        let scene = mesh::mesh(&root, view, WHOLE, 8);
        let real = Real::new(&scene, 1).expect("a valid scene's sequence exists");
        let triangles = Triangle::all(real.stage().geometry());
        let ours = |rays: &[SingleRay]| -> Vec<u32> {
            let met = real.nearest(rays).into_iter();
            met.map(|met| met.map_or(NO_FACE, |met| met.face)).collect()
        };
        let (wide, narrow) = (Cwbvh::new(&triangles), Halves::new(&triangles));
        let doubles = Doubles::new(&triangles);
        let contenders: [(&str, Find); 5] = [
            ("qrt, f64, exact", Box::new(ours)),
            ("obvhs CWBVH, f32", Box::new(|rays| wide.find(rays))),
            ("obvhs BVH2, f32", Box::new(|rays| narrow.find(rays))),
            (
                "bvh, f64, in order",
                Box::new(|rays| doubles.find_in_order(rays)),
            ),
            (
                "bvh, f64, all boxes",
                Box::new(|rays| doubles.find_in_all(rays)),
            ),
        ];
        let rays = paths::rays(&scene, &real, SIDE);
        for (rays, kind) in [(&rays.primary, "camera"), (&rays.bounced, "scattered")] {
            println!("\nknot {name}, {} {kind} rays", rays.len());
            fastest &= compare(&contenders, rays);
        }
    }
    println!();
    if fastest {
        println!("kept   no crate is faster");
        ExitCode::SUCCESS
    } else {
        println!("BROKEN no crate is faster");
        ExitCode::FAILURE
    }
}

/// True if the first of `contenders` is the fastest.
fn compare(contenders: &[(&str, Find)], rays: &[SingleRay]) -> bool {
    let mut best = vec![f64::INFINITY; contenders.len()];
    let mut found = vec![Vec::new(); contenders.len()];
    for _ in 0..RUNS {
        for (number, (_, find)) in contenders.iter().enumerate() {
            let started = Instant::now();
            found[number] = find(rays);
            best[number] = best[number].min(started.elapsed().as_secs_f64());
        }
    }
    for (number, (name, _)) in contenders.iter().enumerate() {
        let pairs = found[0].iter().zip(&found[number]);
        let same = pairs.filter(|(a, b)| a == b).count();
        println!(
            "  {name:20} {:8.2} | {:9.4} %",
            rays.len() as f64 / best[number] / 1e6,
            100.0 * same as f64 / rays.len() as f64
        );
    }
    best[1..].iter().all(|&other| best[0] <= other)
}
