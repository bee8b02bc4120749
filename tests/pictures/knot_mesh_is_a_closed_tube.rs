//! Tests that the mesh beside the scenes is the output of its generator, and that it is a closed smooth tube.

#[path = "../../benches/common/knot.rs"]
mod knot;

use qrt::scene::front::obj;
use qrt::scene::meshes::Wanted;
use std::collections::HashMap;
use std::path::Path;

type Corner = [u64; 3];

#[test]
fn the_mesh_beside_the_scenes_is_the_generators() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes-yaml/meshes/knot.obj");
    let text = std::fs::read_to_string(path).unwrap();
    assert_eq!(text, knot::torus_knot(8, 96));
}

#[test]
fn the_knot_is_a_closed_tube_that_rests_on_the_floor() {
    let dir = std::env::temp_dir();
    for (around, along, tolerance) in [(8, 96, 0.05), (32, 1024, 1e-3)] {
        let path = dir.join(format!("qrt-knot-{}-{along}.obj", std::process::id()));
        std::fs::write(&path, knot::torus_knot(around, along)).unwrap();
        let mesh = obj::load(&path, Wanted::default()).unwrap();
        std::fs::remove_file(&path).unwrap();
        assert_eq!(mesh.faces.len() as u32, 2 * around * along);

        // Closed: every edge has a neighbour that runs the other way.
        let mut edges: HashMap<(Corner, Corner), i32> = HashMap::new();
        let (mut area, mut volume) = (0.0, 0.0);
        let (mut least, mut most) = (mesh.faces[0].vertices[0], mesh.faces[0].vertices[0]);
        for face in &mesh.faces {
            let [a, b, c] = face.vertices;
            for (from, to) in [(a, b), (b, c), (c, a)] {
                let bits = |v: [f64; 3]| v.map(f64::to_bits);
                let (from, to) = (bits(from.to_array()), bits(to.to_array()));
                *edges.entry((from, to)).or_default() += 1;
                *edges.entry((to, from)).or_default() -= 1;
            }
            area += (b - a).cross(c - a).length() / 2.0;
            volume += a.dot(b.cross(c)) / 6.0;
            for v in face.vertices {
                least = least.min(v);
                most = most.max(v);
            }
        }
        assert!(edges.values().all(|count| *count == 0));
        assert_eq!(
            edges.len() as u32,
            6 * around * along,
            "every edge twice, once either way"
        );
        assert_eq!(least.y, 0.0);
        assert!(least.x > -0.5 && most.x < 0.5 && least.z > -0.5 && most.z < 0.5 && most.y < 0.5);

        // Pappus: a tube of radius r has the area 2 pi r L and the volume pi r^2 L, and so their
        // ratio is r/2: less for a section that is a polygon, whose apothem
        // counts; sections that are apart lose more where the tube bends.
        let radius = 2.0 * volume / area;
        let apothem = 0.065 * (std::f64::consts::PI / f64::from(around)).cos();
        assert!(
            (radius / apothem - 1.0).abs() < tolerance,
            "{radius} {apothem}"
        );
    }
}
