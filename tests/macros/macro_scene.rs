//! Tests that a scene written with `qrt!` equals the scene in YAML: the same data, the same image bytes.

use qrt::prelude::*;
use qrt::scene::front::{load, parse};
use std::path::{Path, PathBuf};

qrt! {
    /// A corner of a room, and a ball of string.
    #[derive(Clone, Copy, Debug)]
    pub scene LitCorner<Fixed<2, 14>> {
        const GREY: f64 = 0.75;
        const SIDE: f64 = 2 * GREY + 0.5;
        camera: perspective { eye: (3, 3, 4), target: (0, 0.5, 0), vfov: 40 },
        film: 8x6,
        material grey: lambertian { albedo: rgb(GREY, GREY, GREY / 2) },
        material "warm lamp": emitter { radiance: rgb(17, 12, 4) },
        material cloth: bsdf {
            map: |u, v| (sqrt(u) * cos(2 * pi * v), sqrt(u) * sin(2 * pi * v), sqrt(1 - u)),
            jacobian: auto,
            value: 0.5 / pi * (1 + 0.3 * cos_i * cos_o) * GREY * (1 + 0.1 * sin(x + 2 * y - z)),
        },
        /// The floor is two strips.
        for i in 0..2 {
            const LEFT: f64 = -SIDE + SIDE * i;
            quad floor: grey {
                (LEFT, 0, SIDE), (LEFT + SIDE, 0, SIDE), (LEFT + SIDE, 0, -SIDE), (LEFT, 0, -SIDE),
            },
        }
        quad lamp: "warm lamp" { (-1, 3, -1), (1, 3, -1), (1, 3, 1), (-1, 3, 1) },
        mesh knot: cloth { obj: "scenes-yaml/meshes/knot.obj", smooth: 40, translate: (0, 0.5, 0) },
        mesh: grey { obj: "tests/good_scenes/coloured.obj", colors: vertices, scale: 0.25, translate: (-1, 0.25, 1) },
        sampling { path_bits: 6, lights: none },
        depth primary { bits: (6, 6) },
        depth secondary { bits: (6, 6), map: cosine_hemisphere },
        comparator { bits: 8 },
        budget { qubits: 100_000_000 },
    }

    pub scene Knot from "scenes-yaml/knot.yaml"
}

const TWIN: &str = r#"
name: lit-corner
camera: { perspective: { eye: [3, 3, 4], target: [0, 0.5, 0], vfov: 40 } }
film: { width: 8, height: 6 }
materials:
  grey: { lambertian: { albedo: [0.75, 0.75, 0.375] } }
  warm lamp: { emitter: { radiance: [17, 12, 4] } }
  cloth:
    bsdf:
      map: ["sqrt(u)*cos(2*pi*v)", "sqrt(u)*sin(2*pi*v)", "sqrt(1-u)"]
      value: ["0.5/pi*(1+0.3*cos_i*cos_o)*0.75*(1+0.1*sin(x+2*y-z))"]
geometry:
  - quad: { vertices: [[-2, 0, 2], [0, 0, 2], [0, 0, -2], [-2, 0, -2]], material: grey }
  - quad: { vertices: [[0, 0, 2], [2, 0, 2], [2, 0, -2], [0, 0, -2]], material: grey }
  - quad: { vertices: [[-1, 3, -1], [1, 3, -1], [1, 3, 1], [-1, 3, 1]], material: warm lamp }
  - mesh: { obj: scenes-yaml/meshes/knot.obj, material: cloth, smooth: 40, translate: [0, 0.5, 0] }
  - mesh: { obj: tests/good_scenes/coloured.obj, material: grey, colors: vertices, scale: 0.25, translate: [-1, 0.25, 1] }
sampling: { path_bits: 6, depths: [{ bits: [6, 6] }, { bits: [6, 6], map: cosine-hemisphere }], lights: none }
precision: { fraction: 14 }
comparator: { bits: 8 }
budget: { qubits: 100000000 }
"#;

fn picture(scene: &ValidScene, name: &str) -> Vec<u8> {
    let exact = RenderOptions {
        estimator: Some(Estimator::Exact),
        ..RenderOptions::default()
    };
    let rendered = render(scene, &exact).unwrap();
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    rendered.save(&path).unwrap();
    std::fs::read(path).unwrap()
}

#[test]
fn a_macro_and_its_yaml_twin_are_one_scene_and_one_picture() {
    let twin = parse(TWIN, "twin.yaml", &[], "".as_ref()).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(LitCorner::scene().scene(), twin.valid.scene());
    assert_eq!(LitCorner::scene().fingerprint(), twin.valid.fingerprint());
    let ours = picture(LitCorner::scene(), "macro.exr");
    assert_eq!(ours, picture(&twin.valid, "twin.exr"));
}

#[test]
fn a_scene_from_a_file_is_the_scene_of_the_file() {
    let loaded = load(Path::new("scenes-yaml/knot.yaml"), &[]).unwrap();
    assert_eq!(Knot::scene().scene(), loaded.valid.scene());
    assert_eq!(Knot::scene().fingerprint(), loaded.valid.fingerprint());
    // The program contains the mesh.
    assert_eq!(Knot::scene().files(), [PathBuf::from("meshes/knot.obj")]);
}
