//! Tests of `qrt render --visibility grover` from the outside.

use crate::common::command::Folder;
use serde_json::Value;

const BLOCKS: &str = include_str!("../scenes/blocks.yaml");

/// Creates a folder with the small scene, seen by parallel rays.
fn folder() -> Folder {
    Folder::with("blocks.yaml", BLOCKS)
}

fn stats(folder: &Folder, name: &str) -> Value {
    serde_json::from_slice(&folder.read(name)).unwrap()
}

#[test]
fn primary_hits_are_searched_for_and_the_picture_is_the_same() {
    let folder = folder();
    let said: Vec<String> = ["classical", "exhaustive", "grover"]
        .into_iter()
        .map(|how| {
            let (png, csv) = (format!("{how}.png"), format!("{how}.csv"));
            let json = format!("{how}.json");
            let mut arguments = vec!["render", "blocks.yaml", "--model", "fixed", "-o", &png];
            arguments.extend(["--visibility", how, "--counts", &csv, "--stats", &json]);
            if how == "grover" {
                arguments.extend(["--search-failure", "1e-12", "--first-guess", "random"]);
            }
            folder.works(&arguments)
        })
        .collect();
    assert!(folder.read("classical.csv") == folder.read("exhaustive.csv"));
    assert!(folder.read("classical.csv") == folder.read("grover.csv"));

    assert!(!said[0].contains("primary hits"), "{}", said[0]);
    let all =
        "primary hits by exhaustive: P = 8 faces, 8.00 queries a ray = 2.83 sqrt(P) = 1.000 P";
    assert!(said[1].contains(all), "{}", said[1]);
    assert!(
        said[2].contains("primary hits by grover: P = 8 faces, "),
        "{}",
        said[2]
    );
    assert!(said[2].contains("e-13 likely\n"), "{}", said[2]);

    // The metadata of pictures name the search.
    let says = |name: &str, text: &str| {
        let bytes = folder.read(name);
        bytes
            .windows(text.len())
            .any(|part| part == text.as_bytes())
    };
    assert!(says("grover.png", "visibility\0grover"));
    assert!(says("grover.png", "search_failure\x000.000000000001"));
    assert!(says("grover.png", "first_guess\0random"));
    assert!(says("exhaustive.png", "visibility\0exhaustive"));
    assert!(!says("classical.png", "visibility"));

    let classical = stats(&folder, "classical.json");
    assert_eq!(classical["visibility"], "classical");
    assert_eq!(classical["search"], Value::Null);
    let grover = stats(&folder, "grover.json");
    assert_eq!(grover["visibility"], "grover");
    let search = &grover["search"];
    assert_eq!(
        (&search["faces"], &search["states"]),
        (&8.into(), &8.into())
    );
    assert_eq!(search["first_guess"], "random");
    let number = |key: &str| search[key].as_f64().unwrap();
    let rays = 16.0 * 16.0 * 64.0;
    let mean = grover["oracle_queries"].as_f64().unwrap() / rays;
    assert!((number("queries_per_ray") - mean).abs() < 1e-9);
    assert!((number("queries_per_sqrt_faces") - mean / 8_f64.sqrt()).abs() < 1e-9);
    assert!((number("queries_per_face") - mean / 8.0).abs() < 1e-9);
    assert!(number("failure_bound") <= 1e-12 && number("failure_bound") > 1e-13);
    assert!(number("toffoli_per_query") > 100.0 && number("qubits") > 100.0);
}

#[test]
fn gates_find_what_integers_find() {
    let folder = folder();
    for model in ["fixed", "gates"] {
        let (exr, csv) = (format!("{model}.exr"), format!("{model}.csv"));
        let arguments = [
            "render",
            "blocks.yaml",
            "--model",
            model,
            "-o",
            &exr,
            "--counts",
            &csv,
        ];
        let small = [
            "--crop",
            "4,4,6,6",
            "--visibility",
            "grover",
            "--search-failure",
            "0.1",
        ];
        folder.works(&[&arguments[..], &small].concat());
    }
    assert!(folder.read("fixed.csv") == folder.read("gates.csv"));
}

#[test]
fn what_cannot_be_searched_is_refused_before_the_work() {
    let folder = folder();
    for (arguments, message) in [
        (
            &["--visibility", "grover"][..],
            "which the model `real` does not have",
        ),
        (
            &[
                "--visibility",
                "exhaustive",
                "--model",
                "fixed",
                "--estimator",
                "sine",
            ],
            "the estimator `sine` counts paths in superposition",
        ),
        (
            &[
                "--visibility",
                "grover",
                "--model",
                "fixed",
                "--search-failure",
                "0",
            ],
            "a search cannot fail with probability 0: give one from",
        ),
        (
            &["--model", "fixed", "--search-failure", "0.1"],
            "--search-failure is of a search: it needs --visibility grover",
        ),
        (
            &[
                "--visibility",
                "exhaustive",
                "--model",
                "fixed",
                "--first-guess",
                "random",
            ],
            "--first-guess is of a search: it needs --visibility grover",
        ),
    ] {
        let errors = folder.fails(2, &[&["render", "blocks.yaml"], arguments].concat());
        assert!(errors.contains(message), "{errors}");
        assert_eq!(folder.names(), ["blocks.yaml"]);
    }
}
