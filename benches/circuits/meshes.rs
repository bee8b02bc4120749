//! Cost of meshes as circuits, and of the inspection of a large one.
//!
//! `cargo bench --bench circuits -- meshes` prints, for the knot of the example scene and for knots of
//! 128 to 65,536 faces in its place, Toffolis of a call, Toffolis a face and search, and seconds and
//! memory of an inspection. On systems without `/proc` there is no column of memory.
//!
//! It fails where a promise is broken: bounds on the knot's Toffolis, and on the Toffolis, the seconds
//! and the memory of the mesh of 65,536 faces.

use crate::common::{Arguments, Promises, knot, load, mesh};
use qrt::core::compile::StageName;
use qrt::core::inspect::{CallPart, grouped};
use qrt::core::oracle::Oracles;
use qrt::lab::inspect::InspectFigures;
use qrt::runtime::Prepared;
use qrt::runtime::memory::{CircuitWork, Memory};
use qrt::scene::valid::ValidScene;
use std::path::Path;
use std::time::Instant;

/// The example scene, and the greatest number of Toffolis of a call under two strategies.
const KNOT: &str = "scenes-yaml/knot.yaml";
const TOFFOLIS: [(&str, u64); 2] = [("keep", 4_000_000), ("scoped", 12_000_000)];

/// Corners of a section of a knot's tube, and sections.
const SIZES: [[u32; 2]; 4] = [[4, 16], [8, 96], [16, 512], [128, 256]];

/// Most Toffolis a face and search, seconds and bytes of the largest.
const A_FACE: f64 = 400.0;
const SECONDS: f64 = 60.0;
const BYTES: u64 = 4_000_000_000;

pub(crate) fn run(_: &Arguments, promises: &mut Promises) {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    for (strategy, most) in TOFFOLIS {
        let scene = load::load(root, KNOT, &[format!("circuit.uncompute={strategy}")]);
        let cost = Oracles::new(&scene).most_expensive();
        let toffoli = cost.unwrap_or_else(|error| panic!("{error}")).call.toffoli;
        let text = format!("knot, {strategy}: {} Toffolis a call", grouped(toffoli));
        promises.judge(&text, toffoli <= most);
    }
    println!("\n  faces       Toffoli  a face and search   seconds    memory");
    for [around, along] in SIZES {
        let faces = 2 * around * along;
        let sets = vec!["circuit.uncompute=keep".to_owned()];
        let scene = mesh::with_obj(root, KNOT, &knot::torus_knot(around, along), sets);
        forget_most_bytes();
        let started = Instant::now();
        let (toffoli, search) = inspected(&scene);
        let seconds = started.elapsed().as_secs_f64();
        let a_face = search as f64 / f64::from(faces);
        let bytes = most_bytes();
        let memory = bytes.map_or(String::new(), |bytes| {
            format!("{:.1} GB", bytes as f64 / 1e9)
        });
        let total = grouped(toffoli);
        println!("{faces:7}  {total:>12}  {a_face:17.0}  {seconds:8.1}  {memory:>8}");
        if [around, along] == SIZES[SIZES.len() - 1] {
            let text = format!("{faces} faces: {a_face:.0} Toffolis a face and search");
            promises.judge(&text, a_face <= A_FACE);
            let text = format!("{faces} faces: inspected in {seconds:.0} s");
            promises.judge(&text, seconds <= SECONDS);
            if let Some(bytes) = bytes {
                let text = format!("{faces} faces: inspected in {memory}");
                promises.judge(&text, bytes <= BYTES);
            }
        }
    }
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

/// Lets [`most_bytes`] count from now on, on Linux.
fn forget_most_bytes() {
    // See proc(5). Without it, the figure includes what came before.
    let _ = std::fs::write("/proc/self/clear_refs", "5");
}

/// The most memory that this process has held.
fn most_bytes() -> Option<u64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status
        .lines()
        .find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kilobytes: u64 = line.trim().strip_suffix(" kB")?.parse().ok()?;
    Some(1024 * kilobytes)
}
