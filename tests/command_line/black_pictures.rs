//! Tests that `qrt render` says why a picture is black.

use super::render_command::read_exr;
use crate::common::command::Folder;
use qrt::runtime::path_machines::Real;
use qrt::scene::front::parse;

#[test]
fn a_trace_of_a_lamp_that_faces_away_is_no_light() {
    // The lamp touches the wall. Rounding may leave a trace of its light on it, and the bound is 0.
    let scene = "name: away
camera: { perspective: { eye: [0, 0, 3], target: [0, 0, 0], vfov: 40 } }
film: { width: 8, height: 8 }
materials:
  wall: { SCATTER }
  lamp: { emitter: { radiance: [3, 3, 3], albedo: [0.5, 0.5, 0.5] } }
geometry:
  - FACE
  - quad: { vertices: [[-1, -1, -1], [1, -1, -1], [1, 1, -1], [-1, 1, -1]], material: wall }
sampling:
  path_bits: 12
  depths: [{ bits: [10, 10] }, { bits: [10, 10], light: [8, 8] }, { bits: [10, 10], light: [8, 8] }]
";
    let quad =
        "quad: { vertices: [[-1, 1, 1], [1, 1, 1], [1, 1, -1], [-1, 1, -1]], material: lamp }";
    let triangle = "triangle: { vertices: [[-1, 1, 1], [1, 1, 1], [1, 1, -1]], material: lamp }";
    let matte = "lambertian: { albedo: [0.8, 0.8, 0.8] }";
    let mut traces = 0;
    for (scatter, face) in [
        (matte, quad),
        (matte, triangle),
        ("mirror: { reflectance: [0.9, 0.8, 0.7] }", quad),
    ] {
        let scene = scene.replace("SCATTER", scatter).replace("FACE", face);
        let loaded = parse(&scene, "away.yaml", &[], "".as_ref()).unwrap();
        let pixels: Vec<[u32; 2]> = (0..64).map(|n| [n % 8, n / 8]).collect();
        let sums = Real::new(&loaded.valid, 0).unwrap().sums(&pixels);
        traces += u32::from(
            sums.iter()
                .any(|sum| sum.colour.iter().any(|&colour| colour > 0.0)),
        );
        let folder = Folder::with("away.yaml", &scene);
        for model in ["real", "fixed"] {
            let output = folder.qrt(&["render", "away.yaml", "-o", "a.exr", "--model", model]);
            let errors = String::from_utf8(output.stderr).unwrap();
            assert_eq!(output.status.code(), Some(0), "{errors}");
            assert!(errors.contains("QRT0221"), "{errors}");
            assert!(!errors.contains("carry light"), "{model}: {errors}");
            let (_, pixels, _) = read_exr(&folder.path("a.exr"));
            assert!(pixels.iter().flatten().all(|&c| c == 0.0), "{model}");
        }
    }
    assert!(traces > 0, "rounding leaves none");
}

/// An enclosed lamp and an enclosed camera make black pictures, of which the scene has no warning.
#[test]
fn a_picture_without_light_says_so() {
    let scene = "name: shut
camera: { perspective: { eye: EYE, target: [0, 0, 0], vfov: 40 } }
film: { width: 8, height: 8 }
materials:
  wall: { lambertian: { albedo: [0.8, 0.8, 0.8] } }
  lamp: { emitter: { radiance: [3, 3, 3] } }
geometry:
  - sphere: { center: [0, 0, 0], radius: 0.5, material: lamp }
  - OTHER
  - quad: { vertices: [[-4, -4, -3], [4, -4, -3], [4, 4, -3], [-4, 4, -3]], material: wall }
sampling: { path_bits: 6, depths: [{ bits: [6, 6] }, { bits: [6, 6] }], lights: none }
counting: { phase_bits: 6 }
";
    let shut = "box: { min: [-1, -1, -1], max: [1, 1, 1], material: wall }";
    let open = "sphere: { center: [3, 0, -2], radius: 0.5, material: wall }";
    for (eye, other, black) in [
        ("[0, 0, 5]", shut, true),
        ("[0, 0.1, 0.2]", open, true),
        ("[0, 0, 5]", open, false),
    ] {
        let folder = Folder::with(
            "shut.yaml",
            &scene.replace("EYE", eye).replace("OTHER", other),
        );
        for model in ["real", "fixed"] {
            let output = folder.qrt(&["render", "shut.yaml", "-o", "a.exr", "--model", model]);
            let errors = String::from_utf8(output.stderr).unwrap();
            assert_eq!(output.status.code(), Some(0), "{errors}");
            let (_, pixels, _) = read_exr(&folder.path("a.exr"));
            assert_eq!(
                pixels.iter().flatten().all(|&c| c == 0.0),
                black,
                "{eye} {model}"
            );
            let told = errors
                .contains("the picture is black: none of 4,096 paths that were tried has light");
            assert_eq!(told, black, "{eye} {model}: {errors}");
        }
    }
}

/// A portion may well be black in a picture that is not, so the merge says it.
#[test]
fn a_merged_picture_without_light_says_so() {
    let scene = "name: shut
camera: { perspective: { eye: [0, 0, 5], target: [0, 0, 0], vfov: 40 } }
film: { width: 8, height: 8 }
materials:
  wall: { lambertian: { albedo: 0.8 } }
  lamp: { emitter: { radiance: 3 } }
geometry:
  - sphere: { center: [0, 0, 0], radius: 0.5, material: lamp }
  - box: { min: [-1, -1, -1], max: [1, 1, 1], material: wall }
sampling: { path_bits: 6, depths: 2 }
counting: { phase_bits: 6 }
";
    let folder = Folder::with("shut.yaml", scene);
    let told = |arguments: &[&str]| {
        let output = folder.qrt(arguments);
        let errors = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(0), "{errors}");
        errors
    };
    for (portion, part) in [("0/2", "0.part"), ("1/2", "1.part")] {
        let errors = told(&[
            "render",
            "shut.yaml",
            "--seed",
            "2",
            "--portion",
            portion,
            "-o",
            part,
        ]);
        assert!(!errors.contains("is black"), "{errors}");
    }
    let merged = told(&["merge", "0.part", "1.part", "-o", "a.exr"]);
    assert!(
        merged.contains("the picture is black: `qrt render` says why"),
        "{merged}"
    );
    let layers = told(&[
        "merge",
        "0.part",
        "1.part",
        "-o",
        "b.exr",
        "--layers",
        "shut.yaml",
    ]);
    let why = "the picture is black: none of 4,096 paths that were tried has light";
    assert!(layers.contains(why), "{layers}");
}

#[test]
fn a_picture_below_the_first_threshold_says_why_it_is_black() {
    // The weight of nearly smooth metal under the cosine map is bounded by 0.8 / 0.05^4.
    let scene = "name: dim
camera: { orthographic: { eye: [0, 0, 2], target: [0, 0, 0], height: 1 } }
film: { width: 4, height: 3 }
sky: { radiance: 1 }
materials: { satin: { ggx: { alpha: 0.05, reflectance: 0.8 } } }
geometry:
  - quad: { vertices: [[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], material: satin }
sampling: { path_bits: 12, depths: [{ bits: [4, 4] }, { bits: [8, 8], map: cosine-hemisphere }], lights: none }
comparator: { bits: 4 }
";
    let folder = Folder::with("dim.yaml", scene);
    let told = |more: &[&str]| {
        let run = [
            &["render", "dim.yaml", "--estimator", "exact", "-o", "d.exr"],
            more,
        ]
        .concat();
        let output = folder.qrt(&run);
        assert_eq!(output.status.code(), Some(0));
        String::from_utf8(output.stderr).unwrap()
    };
    let note = "the picture is black, but its paths carry light";
    let errors = told(&["--model", "fixed"]);
    assert!(errors.contains(note), "{errors}");
    // What it advises gives a picture.
    let (_, advice) = errors.split_once("--set ").unwrap();
    let (advice, _) = advice.split_once('`').unwrap();
    let errors = told(&["--model", "fixed", "--set", advice]);
    assert!(!errors.contains(note), "{errors}");
    let (_, pixels, _) = read_exr(&folder.path("d.exr"));
    assert!(pixels.iter().flatten().any(|&c| c > 0.0), "{advice}");
    assert!(!told(&["--model", "real"]).contains(note));
    // Too few queries find no good index, though colours are above thresholds: this is no such picture.
    let few = [
        "--set",
        "counting={ phase_bits: 1, repetitions: 1 }",
        "--set",
        "comparator.bits=24",
    ];
    let run = [
        &["render", "dim.yaml", "-o", "d.exr", "--model", "fixed"],
        &few[..],
    ]
    .concat();
    let output = folder.qrt(&run);
    assert_eq!(output.status.code(), Some(0));
    assert!(!String::from_utf8_lossy(&output.stderr).contains(note));
    // A scene without light is black by right.
    assert!(!told(&["--model", "fixed", "--set", "sky.radiance=0"]).contains(note));
}
