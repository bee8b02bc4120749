//! Tests that good scenes are accepted, print to YAML that reads back as the same scene, and keep their
//! fingerprint in every way to write them.

#![allow(clippy::format_push_string)]

use super::cases;
use crate::common::scene::from_file;
use proptest::prelude::*;
use qrt::scene::front;
use qrt::scene::valid::ValidScene;
use qrt::scene::{Camera, Estimator, Lights, Scene, Sequence};
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

fn files() -> Vec<PathBuf> {
    let mut files: Vec<_> = ["tests/good_scenes", "scenes-yaml"]
        .iter()
        .flat_map(|folder| std::fs::read_dir(folder).unwrap())
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|end| end == "yaml"))
        .collect();
    files.sort();
    assert!(files.len() >= 8);
    files
}

fn read(text: &str, folder: &Path) -> ValidScene {
    let loaded = front::parse(text, "printed.yaml", &[], folder);
    loaded.unwrap_or_else(|report| panic!("{report}")).valid
}

#[test]
fn scenes_print_and_read_back() {
    for file in files() {
        let valid = from_file(file.to_str().unwrap(), &[]);
        let scene = valid.scene();
        let folder = file.parent().unwrap();
        let again = read(&scene.to_yaml(), folder);
        assert_eq!(again.scene(), scene, "{}", file.display());
        assert_eq!(again.fingerprint(), valid.fingerprint());
        let line = scene.encode().canonical();
        assert_eq!(read(&line, folder).scene(), scene, "{}", file.display());
    }
}

#[test]
fn every_key_is_read() {
    let valid = from_file("tests/good_scenes/everything.yaml", &[]);
    let scene = valid.scene();
    assert!(matches!(scene.camera, Camera::Orthographic(camera) if camera.height == 560.0));
    assert_eq!((scene.film.width, scene.film.height), (64, 48));
    assert_eq!(scene.materials.len(), 8);
    assert_eq!(scene.sampling.sequence, Sequence::ProductLattice);
    assert_eq!(scene.sampling.depths[0].bits, [6, 4]);
    assert_eq!(scene.sampling.depths[1].light, [3, 4].into());
    assert_eq!(scene.sampling.lights, Lights::Mis);
    assert_eq!(scene.precision.fraction, Some(14));
    assert_eq!(
        (scene.comparator.bits, scene.comparator.at.name()),
        (12, "edges")
    );
    assert_eq!(scene.counting.estimator(), Estimator::AdaptiveBayes);
    assert_eq!(
        (scene.counting.phase_bits, scene.counting.repetitions),
        (9, 3)
    );
    assert_eq!(scene.circuit.uncompute.name(), "scoped");
    assert_eq!(scene.budget.unwrap().qubits, Some(2000));
    assert_eq!(valid.polygons().len(), 1 + 1 + 1 + 4);
}

#[test]
fn defaults_are_those_of_the_manual() {
    let valid = from_file("tests/good_scenes/least.yaml", &[]);
    let scene = valid.scene();
    assert!(
        matches!(scene.camera, Camera::Perspective(camera) if camera.up == [0.0, 1.0, 0.0].into())
    );
    assert_eq!(
        (scene.sampling.sequence.name(), scene.sampling.path_bits),
        ("digital-net", 12)
    );
    assert_eq!(scene.sampling.depths.len(), 3);
    assert!(
        scene
            .sampling
            .depths
            .iter()
            .all(|depth| depth.bits == [8, 8])
    );
    assert_eq!(scene.precision.fraction, None);
    assert_eq!(
        (scene.comparator.bits, scene.comparator.at.name()),
        (10, "midpoints")
    );
    assert_eq!(
        (scene.counting.phase_bits, scene.counting.repetitions),
        (8, 1)
    );
    assert_eq!(
        (
            scene.counting.window.name(),
            scene.counting.estimator().name()
        ),
        ("sine", "auto")
    );
    assert_eq!(
        (scene.circuit.uncompute.name(), scene.circuit.nearest.name()),
        ("keep", "running")
    );
    assert!(scene.accuracy.is_none() && scene.budget.is_none());
    assert!(valid.polygons().is_empty());
}

#[test]
fn yaml_is_read_as_yaml() {
    let valid = from_file("tests/good_scenes/aliases.yaml", &[]);
    let scene = valid.scene();
    assert_eq!(scene.name, "it's a \"scene\"");
    assert!(matches!(scene.camera, Camera::Perspective(camera)
        if camera.eye == [0.0, 2.0, 5.0].into() && camera.target == [0.0, 0.5, 0.0].into()));
    assert_eq!(scene.materials[0].1, scene.materials[1].1);
    assert_eq!(valid.polygons()[0].vertices[0], [0.0, 2.0, 5.0].into());
    assert_eq!(valid.polygons()[1].surface, 0);
}

#[test]
fn overrides_change_what_they_name() {
    let file = "tests/good_scenes/cornell.yaml";
    let plain = from_file(file, &[]);
    let sets = [
        "film.width=3",
        "sampling.depths[1].bits=[4, 5]",
        "sampling.path_bits=9",
        "sampling.path_bits=10",
        "materials.white.lambertian.albedo[2]=0.25",
        "counting={ estimator: paper, repetitions: 3 }",
        "comparator.at=edges",
        "budget.qubits=100",
        " name = 'other' ",
    ];
    let changed = from_file(file, &sets);
    let (before, after) = (plain.scene(), changed.scene());
    assert_eq!(
        (after.film.width, after.film.height),
        (3, before.film.height)
    );
    assert_eq!(after.sampling.depths[0].bits, [8, 8]);
    assert_eq!(after.sampling.depths[1].bits, [4, 5]);
    assert_eq!(after.sampling.path_bits, 10);
    let text = after.to_yaml();
    assert!(text.contains("0.698859, 0.25]"), "{text}");
    assert_eq!(after.counting.estimator(), Estimator::Paper);
    assert_eq!(
        (after.comparator.at.name(), after.comparator.bits),
        ("edges", 10)
    );
    assert_eq!(after.budget.unwrap().qubits, Some(100));
    assert_eq!(after.name, "other");
    assert_eq!(after.geometry, before.geometry);
    assert_ne!(plain.fingerprint(), changed.fingerprint());
}

#[test]
fn a_default_block_can_be_overridden_in_part() {
    let file = "tests/good_scenes/least.yaml";
    let valid = from_file(file, &["sampling.depths[2].bits=[3, 3]"]);
    let bits: Vec<_> = valid
        .scene()
        .sampling
        .depths
        .iter()
        .map(|depth| depth.bits)
        .collect();
    assert_eq!(bits, [[8, 8], [8, 8], [3, 3]]);
    let sets = [
        "sampling.sequence=product-lattice",
        "sampling.depths=[{ bits: [2, 3] }]",
    ];
    assert_eq!(from_file(file, &sets).scene().sampling.path_bits, 5);
}

#[test]
fn fingerprints_see_meshes() {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("fingerprints");
    std::fs::create_dir_all(&folder).unwrap();
    let scene = std::fs::read_to_string("tests/good_scenes/least.yaml").unwrap();
    let scene = scene
        .replace(
            "materials: {}",
            "materials: { m: { mirror: { reflectance: [1, 1, 1] } } }",
        )
        .replace(
            "geometry: []",
            "geometry: [{ mesh: { obj: m.obj, material: m } }]",
        );
    let mesh = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    let print = |mesh: &str| {
        std::fs::write(folder.join("m.obj"), mesh).unwrap();
        read(&scene, &folder).fingerprint()
    };
    let first = print(mesh);
    assert_eq!(first, print(mesh));
    assert_ne!(
        first,
        print(&mesh.replace("v 1 0 0", "v 1.0000000000000002 0 0"))
    );
}

#[test]
fn a_mesh_is_the_same_in_every_format() {
    let scene = std::fs::read_to_string("tests/good_scenes/least.yaml").unwrap();
    let materials = "materials: { m: { mirror: { reflectance: [1, 1, 1] } } }";
    let scene = scene.replace("materials: {}", materials);
    let mesh = |file: &str| {
        let mesh = format!("geometry: [{{ mesh: {{ {file} }} }}]");
        read(
            &scene.replace("geometry: []", &mesh),
            "tests/good_scenes".as_ref(),
        )
    };
    let expected = mesh("obj: tetrahedron.obj, material: m");
    assert_eq!(expected.polygons().len(), 4);
    for file in ["ply: tetrahedron.ply", "gltf: tetrahedron.gltf"] {
        let found = mesh(&format!("{file}, material: m"));
        assert_eq!(found.polygons(), expected.polygons(), "{file}");
    }
    // With its own material it is another picture, and another fingerprint.
    let gold = mesh("gltf: tetrahedron.gltf");
    assert_eq!(gold.surfaces()[1].name, "tetrahedron.gltf:gold");
    let satin = mesh("gltf: tetrahedron.gltf, material: m");
    assert_ne!(gold.fingerprint(), satin.fingerprint());
}

/// Generates scenes as a program may build them: any text, any finite number.
fn scenes() -> impl Strategy<Value = Scene> {
    let text = "\\PC{1,12}";
    let number = prop_oneof![
        any::<f64>().prop_filter("in range", |x| x.abs() <= 1e30),
        (-1000i32..1000).prop_map(f64::from),
        Just(-0.0),
        Just(5e-324),
    ];
    let point = [number.clone(), number.clone(), number];
    (
        text,
        text,
        point,
        1u32..=65_536,
        0u32..=52,
        "[ -~\n\t]{1,40}",
    )
        .prop_map(|(name, material, point, width, path_bits, expression)| {
            static BASE: LazyLock<Scene> = LazyLock::new(|| {
                from_file("tests/good_scenes/everything.yaml", &[])
                    .scene()
                    .clone()
            });
            let mut scene = BASE.clone();
            scene.name = name;
            scene.film.width = width;
            scene.materials[0].0 = material;
            scene.sampling.sequence = Sequence::DigitalNet;
            scene.sampling.path_bits = path_bits;
            if let Camera::Orthographic(camera) = &mut scene.camera {
                camera.eye = point.into();
            }
            for (_, material) in &mut scene.materials {
                if let qrt::scene::Material::Bsdf(bsdf) = material {
                    bsdf.value[0].clone_from(&expression);
                }
            }
            scene
        })
}

proptest! {
    #![proptest_config(cases(200))]

    #[test]
    fn any_scene_prints_to_yaml_that_reads_back(scene in scenes()) {
        for text in [scene.to_yaml(), scene.encode().canonical()] {
            let again = Scene::from_yaml(&text, "printed.yaml");
            prop_assert_eq!(again.as_ref().map_err(ToString::to_string), Ok(&scene), "{}", text);
        }
    }
}
