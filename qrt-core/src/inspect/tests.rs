//! Figures of a small scene's oracle.

use super::*;
use qrt_circuit::lower::depth;
use qrt_scene::front::parse;

/// A lamp over a floor, with two rays per path.
const SCENE: &str = "
name: lit-floor
camera: { perspective: { eye: [0, 1, 2], target: [0, 0, 0], vfov: 45 } }
film: { width: 4, height: 4 }
materials:
  floor: { lambertian: { albedo: [0.8, 0.5, 0.2] } }
  sky: { emitter: { radiance: [1, 1, 1] } }
geometry:
  - quad: { vertices: [[-9, 0, 9], [9, 0, 9], [9, 0, -9], [-9, 0, -9]], material: floor }
  - quad: { vertices: [[-9, 5, -9], [9, 5, -9], [9, 5, 9], [-9, 5, 9]], material: sky }
sampling: { path_bits: 6, depths: [{ bits: [3, 3] }, { bits: [3, 3] }], lights: none }
precision: { fraction: 10 }
comparator: { bits: 5 }
";

fn inspection(sets: &[&str]) -> Inspection {
    let sets: Vec<String> = sets.iter().map(|&set| set.to_owned()).collect();
    let scene = parse(SCENE, "lit-floor.yaml", &sets, "".as_ref()).unwrap();
    let oracles = Oracles::new(&scene.valid);
    Inspection::of_class(&oracles, None, PixelClass::default()).unwrap()
}

fn both() -> [Inspection; 2] {
    ["keep", "scoped"].map(|how| inspection(&[&format!("circuit.uncompute={how}")]))
}

#[test]
fn parts_stages_and_blocks_each_add_up_to_the_call() {
    for inspection in both() {
        let total = inspection.total();
        let parts = CallPart::ALL.map(|part| inspection.part(part));
        assert_eq!(parts.into_iter().sum::<Cost>(), total);
        let stages = inspection.stages();
        assert_eq!(stages.iter().map(|stage| stage.cost).sum::<Cost>(), total);
        let mut at = 0;
        for stage in &stages {
            assert_eq!(stage.instructions.start, at);
            at = stage.instructions.end;
        }
        assert_eq!(at, inspection.whole.instructions.len());
        let blocks = inspection.blocks();
        assert_eq!(blocks.iter().map(|block| block.own).sum::<Cost>(), total);
        assert_eq!(blocks[0].total, total);
        assert_eq!(blocks[0].compute, inspection.part(CallPart::Compute));
        let (roles, ancillas) = inspection.peak_by_role();
        assert_eq!(roles.iter().sum::<u32>() + ancillas, inspection.qubits);
    }
}

#[test]
fn sizes_are_those_of_the_circuit() {
    for inspection in both() {
        let circuit = lower::circuit(&inspection.whole);
        assert_eq!(inspection.qubits, circuit.qubits);
        assert_eq!(inspection.in_use, circuit.in_use);
        assert_eq!(inspection.toffoli_depth, depth(&circuit));
    }
}

#[test]
fn the_boxes_are_those_of_the_paper_and_their_inverses() {
    for inspection in both() {
        let stages = inspection.stages();
        let names: Vec<String> = stages.iter().map(ToString::to_string).collect();
        let compute = stages
            .iter()
            .filter(|s| s.part == CallPart::Compute)
            .count();
        for name in [
            "generate_ray 0",
            "find_intersection 0",
            "generate_ray 1",
            "shade 1",
            "count",
        ] {
            let found = names[..compute].iter().filter(|known| *known == name);
            assert_eq!(found.count(), 1, "{name} in {names:?}");
        }
        assert_eq!(names[compute..compute + 3], ["compare", "flip", "compare"]);
        let mut mirrored = names[compute + 3..].to_vec();
        mirrored.reverse();
        assert_eq!(mirrored, names[..compute]);
    }
}

#[test]
fn wires_are_computed_once_and_returned() {
    for inspection in both() {
        let frame = CallDiagram::new(&inspection);
        let names: Vec<&str> = frame.wires.iter().map(|wire| wire.name.as_str()).collect();
        assert_eq!(names[..3], ["id", "comparator", "ray_0"]);
        assert_eq!(names[names.len() - 2..], ["flag", "work"]);
        assert_eq!([frame.wires[0].qubits, frame.wires[1].qubits], [6, 5]);
        for (n, wire) in frame.wires[..names.len() - 1].iter().enumerate() {
            let writers = frame.boxes.iter().filter(|b| b.writes.contains(&n));
            let writers: Vec<bool> = writers.map(|b| b.inverse).collect();
            let expected: &[bool] = if wire.input { &[] } else { &[false, true] };
            assert_eq!(writers, expected, "{}", wire.name);
            // No box reads a wire that holds no value.
            let held = frame.held(n);
            for (place, item) in frame.boxes.iter().enumerate() {
                let reads = item.reads.contains(&n);
                assert!(
                    !reads || held.contains(&place),
                    "{} reads {}",
                    item.name,
                    wire.name
                );
            }
        }
        // The paper draws the values that boxes read from other boxes.
        let read = |name: &str| {
            let item = frame.boxes.iter().find(|b| b.name == name).unwrap();
            item.reads
                .iter()
                .map(|&wire| names[wire])
                .collect::<Vec<_>>()
        };
        assert_eq!(read("Generate Ray 0"), ["id"]);
        assert_eq!(read("Find Intersection 0"), ["ray_0"]);
        assert!(read("Compare").contains(&"comparator"));
        assert_eq!(read("Z"), ["flag"]);
    }
}

#[test]
#[should_panic(expected = "there is no pixel 1,4 on a film of 4 x 4")]
fn a_pixel_beside_the_film_has_no_oracle() {
    let scene = parse(SCENE, "lit-floor.yaml", &[], "".as_ref()).unwrap();
    let pixel = OraclePixel {
        place: [1, 4],
        seed: 0,
    };
    let _ = Inspection::of_pixel(&Oracles::new(&scene.valid), None, pixel);
}
