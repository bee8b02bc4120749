//! Cost of meshes as circuits, and of the inspection of a large one.
//!
//! `cargo bench --bench circuits -- meshes` prints, for the knot of the example scene and for knots of
//! 128 to 65,536 faces in its place, Toffolis of a call, Toffolis a face and search, and the processor's
//! seconds of an inspection. That of the largest comes first, with its memory, where Linux reports it.
//!
//! A search costs a fixed part, the slots of the nearest faces, and a part for each face. The fixed part is
//! most of the search of 128 faces. The cost of one face more is therefore taken between neighbouring sizes.
//!
//! It fails where a promise is broken: bounds on the knot's Toffolis, on the Toffolis, the seconds and the
//! memory of the mesh of 65,536 faces, and on the growth of the cost of one face more.

use crate::common::{Arguments, Promises, knot, load, mesh, processor};
use qrt::core::compile::StageName;
use qrt::core::inspect::{CallPart, grouped};
use qrt::core::oracle::Oracles;
use qrt::lab::inspect::InspectFigures;
use qrt::runtime::Prepared;
use qrt::runtime::memory::{CircuitWork, Memory};
use qrt::scene::valid::ValidScene;
use std::path::Path;

/// The example scene, and the greatest number of Toffolis of a call under two strategies.
const KNOT: &str = "scenes-yaml/knot.yaml";
const TOFFOLIS: [(&str, u64); 2] = [("keep", 4_000_000), ("scoped", 12_000_000)];

/// Corners of a section of a knot's tube, and sections; the largest first.
const SIZES: [[u32; 2]; 4] = [[128, 256], [16, 512], [8, 96], [4, 16]];

/// Most Toffolis a face and search of the largest.
const A_FACE: f64 = 400.0;

/// Most seconds of a processor, and most gigabytes, of the largest.
const SECONDS: f64 = 60.0;
const GIGABYTES: f64 = 4.0;

/// The largest difference of the cost of one face more from its mean over all sizes, as a fraction of the mean.
const GROWTH: f64 = 0.2;

pub(crate) fn run(_: &Arguments, promises: &mut Promises) {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    for (strategy, most) in TOFFOLIS {
        let scene = load::load(root, KNOT, &[format!("circuit.uncompute={strategy}")]);
        let cost = Oracles::new(&scene).most_expensive();
        let toffoli = cost.unwrap_or_else(|error| panic!("{error}")).call.toffoli;
        let text = format!("knot, {strategy}: {} Toffolis a call", grouped(toffoli));
        promises.judge(&text, toffoli <= most);
    }
    println!("\n  faces       Toffoli  a face and search   seconds");
    let mut searches = Vec::new();
    for [around, along] in SIZES {
        let faces = 2 * around * along;
        let sets = vec!["circuit.uncompute=keep".to_owned()];
        let scene = mesh::with_obj(root, KNOT, &knot::torus_knot(around, along), sets);
        let started = processor::seconds();
        let (toffoli, search) = inspected(&scene);
        let seconds = processor::seconds() - started;
        searches.push([f64::from(faces), search as f64]);
        let a_face = search as f64 / f64::from(faces);
        let total = grouped(toffoli);
        println!("{faces:7}  {total:>12}  {a_face:17.0}  {seconds:8.1}");
        if [around, along] == SIZES[0] {
            let text = format!("{faces} faces: {a_face:.0} Toffolis a face and search");
            promises.judge(&text, a_face <= A_FACE);
            let text = format!("{faces} faces: inspected in {seconds:.1} s of a processor");
            promises.judge(&text, seconds <= SECONDS);
            if let Some(bytes) = most_bytes() {
                let gigabytes = bytes as f64 / 1e9;
                let text = format!("{faces} faces: inspected with {gigabytes:.2} GB");
                promises.judge(&text, gigabytes <= GIGABYTES);
            }
        }
    }
    let more = searches.windows(2).map(|pair| {
        let ([faces, search], [fewer, less]) = (pair[0], pair[1]);
        (search - less) / (faces - fewer)
    });
    let more: Vec<f64> = more.collect();
    let mean = more.iter().sum::<f64>() / more.len() as f64;
    let text = more.iter().map(|more| format!("{more:.0}"));
    let text = text.collect::<Vec<_>>().join(", ");
    promises.judge(
        &format!("one face more costs a search {text} Toffolis, from many faces to few"),
        more.iter().all(|more| (more / mean - 1.0).abs() <= GROWTH),
    );
}

/// Inspects the scene as the command does. Returns the Toffolis of a call and the most of a search for a
/// hit.
fn inspected(scene: &ValidScene) -> (u64, u64) {
    let prepared = Prepared::with_plan(scene, None, Memory::default());
    let checked = prepared.check_circuit(CircuitWork::Program);
    checked.unwrap_or_else(|error| panic!("{error}"));
    let figures = InspectFigures::new(&prepared, None, None);
    let inspection = figures.unwrap_or_else(|error| panic!("{error}")).inspection;
    let stages = inspection.stages().into_iter();
    let searches = stages.filter(|stage| {
        stage.name == StageName::FindIntersection && stage.part == CallPart::Compute
    });
    let most = searches.map(|stage| stage.cost.toffoli).max();
    (inspection.total().toffoli, most.unwrap_or(0))
}

/// The most memory that this process has held so far, in bytes.
fn most_bytes() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status
        .lines()
        .find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kilobytes: u64 = line.trim().strip_suffix(" kB")?.parse().ok()?;
    Some(1024 * kilobytes)
}
