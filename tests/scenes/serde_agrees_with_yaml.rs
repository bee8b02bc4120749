//! Tests that scenes through serde have the same keys and shapes as in YAML, in any of serde's formats, and
//! that errors have their code and their path.

use crate::common::scene::from_file;
use qrt::scene::{
    Camera, Counting, DepthSampling, Estimator, Film, Geometry, Jacobian, Lambertian, Material,
    Scene,
};
use std::path::PathBuf;

fn files() -> Vec<PathBuf> {
    let folders = ["tests/good_scenes", "scenes-yaml"];
    let files = folders
        .iter()
        .flat_map(|folder| std::fs::read_dir(folder).unwrap());
    let files = files.map(|entry| entry.unwrap().path());
    let files: Vec<PathBuf> = files
        .filter(|path| path.extension().is_some_and(|end| end == "yaml"))
        .collect();
    assert!(files.len() > 15);
    files
}

#[test]
fn every_scene_is_read_as_its_file_is() {
    let (mut bsdfs, mut meshes) = (0, 0);
    for file in files() {
        let expected = from_file(file.to_str().unwrap(), &[]).scene().clone();
        let text = std::fs::read_to_string(&file).unwrap();
        let read: Scene = serde_yaml::from_str(&text)
            .unwrap_or_else(|error| panic!("{}: {error}", file.display()));
        // Validation takes sampling of lamps back where there are none.
        let checked = read.clone().validate(file.parent().unwrap());
        let checked = checked.unwrap_or_else(|report| panic!("{}: {report}", file.display()));
        assert_eq!(*checked.scene(), expected, "{}", file.display());
        let is_bsdf = |(_, material): &(String, Material)| matches!(material, Material::Bsdf(_));
        bsdfs += read
            .materials
            .iter()
            .filter(|material| is_bsdf(material))
            .count();
        meshes += read
            .geometry
            .iter()
            .filter(|part| matches!(part, Geometry::Mesh(_)))
            .count();
    }
    assert!(bsdfs > 0 && meshes > 0);
}

#[test]
fn scenes_come_back_from_yaml_and_from_json() {
    for file in files() {
        let scene = from_file(file.to_str().unwrap(), &[]).scene().clone();
        let yaml = serde_yaml::to_string(&scene).unwrap();
        assert_eq!(
            serde_yaml::from_str::<Scene>(&yaml).unwrap(),
            scene,
            "{yaml}"
        );
        // The printed text is a scene file like others.
        let loaded = Scene::from_yaml(&yaml, "printed.yaml");
        assert_eq!(loaded.unwrap_or_else(|report| panic!("{report}")), scene);
        let json = serde_json::to_string(&scene).unwrap();
        let again: Scene = serde_json::from_str(&json).unwrap();
        assert_eq!(again, scene, "{json}");
        assert_eq!(again.fingerprint(), scene.fingerprint());
    }
}

#[test]
fn parts_are_read_and_written_by_themselves() {
    let film: Film = serde_json::from_str("{ \"width\": 4, \"height\": 3 }").unwrap();
    assert_eq!(
        film,
        Film {
            width: 4,
            height: 3
        }
    );
    assert_eq!(
        serde_json::to_string(&film).unwrap(),
        "{\"width\":4,\"height\":3}"
    );
    let matte = Material::from(Lambertian {
        albedo: [0.5, 0.25, 1.0].into(),
    });
    let text = serde_json::to_string(&matte).unwrap();
    assert_eq!(text, "{\"lambertian\":{\"albedo\":[0.5,0.25,1]}}");
    assert_eq!(serde_json::from_str::<Material>(&text).unwrap(), matte);
    let counting: Counting =
        serde_yaml::from_str("{ estimator: monte-carlo, strata: auto }").unwrap();
    assert_eq!(counting.estimator(), Estimator::MonteCarlo);
    assert_eq!((counting.strata, counting.phase_bits), (None, 8));
    let depth: DepthSampling = serde_yaml::from_str("bits: [3, 4]").unwrap();
    assert_eq!(depth, DepthSampling::of_bits([3, 4]));
    let bsdf = "{ bsdf: { map: [u, v, 1], value: 0.5, jacobian: auto } }";
    let Material::Bsdf(bsdf) = serde_yaml::from_str(bsdf).unwrap() else {
        panic!("another material")
    };
    assert_eq!((bsdf.map[2].as_str(), bsdf.jacobian), ("1", Jacobian::Auto));
    assert_eq!(bsdf.value, ["0.5"]);
    let camera: Camera = serde_json::from_str(
        "{ \"orthographic\": { \"eye\": [0, 0, 1e1], \"target\": [0, 0, 0], \"height\": 2 } }",
    )
    .unwrap();
    assert_eq!(camera.kind(), "orthographic");
}

fn refused<T: serde_core::de::DeserializeOwned + std::fmt::Debug>(text: &str) -> String {
    serde_yaml::from_str::<T>(text).unwrap_err().to_string()
}

#[test]
fn what_is_wrong_has_its_code_and_path() {
    let all = refused::<Scene>(
        "{ name: a, camera: { perspectiv: {} }, film: { width: 0, height: 1.5 }, geometry: [],
           materials: { m: { lambertian: { albedo: [2, 0, 0] } } }, budget: { qubit: 3 } }",
    );
    for part in [
        "error[QRT0201] at film.width: ",
        "film.height",
        "materials.m.lambertian.albedo[0]",
        "`qubit`",
        "help: ",
        "`perspectiv`",
    ] {
        assert!(all.contains(part), "{part}:\n{all}");
    }
    assert!(refused::<Film>("{ width: 3, height: \"3\" }").contains("height"));
    assert!(refused::<Film>("[3]").contains("QRT"));
    assert!(refused::<Counting>("{ estimator: monte }").contains("monte-carlo"));
    let twice = serde_json::from_str::<Film>("{\"width\": 1, \"width\": 2, \"height\": 1}");
    assert!(
        twice
            .unwrap_err()
            .to_string()
            .contains("the key `width` is there twice")
    );
}
