//! Tests of `qrt verify` from the outside.

use super::paths::{CORNER, film, oracle, paths};
use crate::common::command::Folder;
use crate::common::scene::written;
use qrt::runtime::path_machines::{OracleMachine, Real};
use serde_json::{Value, json};

fn folder() -> Folder {
    Folder::with("corner.yaml", CORNER)
}

fn answer(folder: &Folder, arguments: &[&str]) -> Value {
    let all = [&["verify", "corner.yaml", "--json"], arguments].concat();
    serde_json::from_str(&folder.works(&all)).unwrap()
}

#[test]
fn a_reader_learns_what_was_checked_and_that_it_holds() {
    let folder = folder();
    let said = folder.works(&["verify", "corner.yaml"]);
    assert!(
        said.starts_with("corner.yaml: 12 of 12 pixels, 384 paths, on "),
        "{said}"
    );
    for words in [
        "every borrowed qubit zero again   yes",
        "phases flipped as compared        yes",
        "fixed and gates agree             yes, bit for bit",
        "fixed against real: E_W",
        "% of the mean, with 8 fraction bits",
        "\nall of it holds\n",
    ] {
        assert!(said.contains(words), "{words}: {said}");
    }
    assert_eq!(folder.names(), ["corner.yaml"]);
}

#[test]
fn sampled_lamps_are_checked_as_well() {
    let folder = Folder::with("box.yaml", include_str!("../scenes/box.yaml"));
    let lit = "{ bits: [6, 6], light: [6, 6] }";
    for lights in ["auto", "mis"] {
        let sets = [
            format!(
                "sampling={{ path_bits: 5, lights: {lights}, depths: [{{ bits: [6, 6] }}, {lit}, {lit}] }}"
            ),
            "precision.fraction=12".to_owned(),
        ];
        let [sampling, precision] = &sets;
        let all = [
            "verify", "box.yaml", "--pixels", "6", "--set", sampling, "--set", precision,
        ];
        let said = folder.works(&all);
        assert!(said.contains("\nall of it holds\n"), "{said}");
    }
}

#[test]
fn the_answer_is_versioned_json() {
    let folder = folder();
    let answer = answer(
        &folder,
        &["--seed", "5", "--set", "circuit.uncompute=scoped"],
    );
    for (key, value) in [
        ("version", json!(1)),
        ("qrt", json!(env!("CARGO_PKG_VERSION"))),
        ("scene", json!("corner")),
        ("seed", json!(5)),
        ("holds", json!(true)),
        ("paths", json!(384)),
        ("fraction_bits", json!(8)),
        ("mismatched", json!(0)),
        ("mismatches", json!([])),
        ("defect", Value::Null),
    ] {
        assert_eq!(answer[key], value, "{key}");
    }
    assert_eq!(answer["pixels"].as_array().unwrap().len(), 12);
    assert!(answer["qubits"].as_u64().unwrap() > 100);
    assert!(answer["gates"].as_u64().unwrap() > 1000);
}

/// Portions check each pixel once, and give together the result of one process.
#[test]
fn portions_check_all_pixels_together() {
    let folder = folder();
    let whole = answer(&folder, &[]);
    let parts: Vec<Value> = (0..5)
        .map(|k| answer(&folder, &["--portion", &format!("{k}/5")]))
        .collect();
    let pixels = |of: &Value| of["pixels"].as_array().unwrap().clone();
    let mut all: Vec<String> = parts
        .iter()
        .flat_map(pixels)
        .map(|p| p.to_string())
        .collect();
    let mut asked: Vec<String> = pixels(&whole).iter().map(Value::to_string).collect();
    all.sort();
    asked.sort();
    assert_eq!(all, asked);
    // Root mean squares are weighted with the number of pixels of each portion.
    let squares = |of: &Value| {
        let rmse = of["width_error"]["rmse_rgb"][0].as_f64().unwrap();
        rmse * rmse * pixels(of).len() as f64
    };
    let sum: f64 = parts.iter().map(squares).sum();
    assert!((sum - squares(&whole)).abs() < 1e-12 * sum);
    let errors = folder.fails(2, &["verify", "corner.yaml", "--portion", "0/13"]);
    assert!(
        errors.contains("12 pixels can't be dealt out to 13 portions"),
        "{errors}"
    );
}

/// Computes E_W by its definition, from the pictures of both models.
#[test]
fn the_width_error_is_that_of_the_pictures() {
    let folder = folder();
    let answer = answer(&folder, &["--seed", "3"]);
    let scene = written(CORNER, &[]);
    let oracle = oracle(&scene);
    let pixels = film(&oracle);
    let fixed = paths(&OracleMachine::fixed(oracle.clone(), 3, true), &pixels).unwrap();
    let real = Real::new(&scene, 3).unwrap().sums(&pixels);
    let mut squares = 0.0;
    let mut means = 0.0;
    for c in 0..3 {
        let ulp = oracle.channels[c].scale / 256.0;
        let differences = fixed.colours[c]
            .chunks(32)
            .zip(&real)
            .map(|(colours, sum)| {
                let fixed = colours.iter().sum::<i64>() as f64 * ulp / 32.0;
                fixed - sum.colour[c] / 32.0
            });
        let differences: Vec<f64> = differences.collect();
        let mean = real.iter().map(|sum| sum.colour[c] / 32.0).sum::<f64>() / 12.0;
        let square = differences.iter().map(|d| d * d).sum::<f64>() / 12.0;
        let greatest = differences
            .iter()
            .fold(0.0, |most: f64, d| most.max(d.abs()));
        for (found, expected) in [
            (&answer["mean_rgb"][c], mean),
            (&answer["width_error"]["rmse_rgb"][c], square.sqrt()),
            (&answer["width_error"]["greatest_rgb"][c], greatest),
        ] {
            let found = found.as_f64().unwrap();
            assert!((found - expected).abs() < 1e-12, "{found} {expected}");
            assert!(found > 0.0);
        }
        squares += square / 3.0;
        means += mean / 3.0;
    }
    let relative = answer["width_error"]["relative"].as_f64().unwrap();
    assert!((relative - squares.sqrt() / means).abs() < 1e-12);
}

#[test]
fn threads_do_not_change_the_answer_and_seeds_do() {
    let folder = folder();
    let timeless = |arguments: &[&str]| {
        let mut answer = answer(&folder, arguments);
        assert!(answer["seconds"].take().as_f64().unwrap() > 0.0);
        answer
    };
    let many = ["--set", "sampling.path_bits=15", "--pixels", "3"];
    let one = timeless(&[&many[..], &["--threads", "1"]].concat());
    assert_eq!(one["paths"], 3 << 15);
    let pixels = one["pixels"].as_array().unwrap();
    assert!(pixels.len() == 3 && pixels[0] != pixels[1] && pixels[1] != pixels[2]);
    assert_eq!(one, timeless(&[&many[..], &["--threads", "3"]].concat()));
    let other = timeless(&[&many[..], &["--seed", "1"]].concat());
    assert_ne!(one["width_error"], other["width_error"]);
}

#[test]
fn an_accuracy_is_checked_with_the_parameters_that_keep_it() {
    let accurate = CORNER.replace("  path_bits: 5\n", "");
    let accurate = accurate.replace("precision: { fraction: 8 }\ncomparator: { bits: 4 }\n", "");
    let accurate = accurate + "accuracy: { error: 0.5, confidence: 0.7 }\n";
    let folder = Folder::with("accurate.yaml", &accurate);
    let found = folder.works(&["verify", "accurate.yaml", "--pixels", "1", "--json"]);
    let found: Value = serde_json::from_str(&found).unwrap();
    let inspected = folder.works(&["inspect", "accurate.yaml", "--json"]);
    let inspected: Value = serde_json::from_str(&inspected).unwrap();
    assert_eq!(
        found["paths"],
        1_u64 << inspected["plan"]["path_bits"].as_u64().unwrap()
    );
    assert_eq!(inspected["fraction_bits"], inspected["plan"]["fraction"]);
    let text = folder.works(&["inspect", "accurate.yaml"]);
    assert!(text.starts_with("plan for an error of 0.5"), "{text}");
}

#[test]
fn wrong_requests_exit_with_2() {
    let folder = folder();
    for (arguments, words) in [
        (&["missing.yaml"][..], "QRT0101"),
        (&["corner.yaml", "--set", "film.widt=3"], "QRT0120"),
        (&["corner.yaml", "--set", "film"], "QRT0901"),
        (&["corner.yaml", "--pixels", "0"], "--pixels"),
        (&["corner.yaml", "--threads", "0"], "--threads"),
        (&["corner.yaml", "--seed=-1"], "--seed"),
        (&["corner.yaml", "--model", "real"], "--model"),
        (&[], "<SCENE>"),
    ] {
        let errors = folder.fails(2, &[&["verify"], arguments].concat());
        assert!(errors.contains(words), "{arguments:?}: {errors}");
    }
    assert_eq!(folder.names(), ["corner.yaml"]);
}

#[cfg(unix)]
#[test]
fn an_interruption_ends_it_and_memory_is_bounded_whatever_the_paths() {
    use crate::common::command::signalled;
    use std::time::Duration;

    let folder = folder();
    let long = [
        "--set",
        "sampling.path_bits=24",
        "--set",
        "comparator.bits=12",
    ];
    let mut child = folder.started(&[&["verify", "corner.yaml"], &long[..]].concat());
    let id = child.id();
    // Wait until the command has begun to trace paths.
    std::thread::sleep(Duration::from_millis(2500));
    assert!(child.try_wait().unwrap().is_none(), "finished too soon");
    let status = std::fs::read_to_string(format!("/proc/{id}/status")).unwrap_or_default();
    let peak = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    if let Some(peak) = peak {
        let kibibytes: u64 = peak.trim().trim_end_matches(" kB").parse().unwrap();
        // The paths of one pixel alone would take 800 MB.
        assert!(kibibytes < 300 << 10, "{kibibytes} kB");
    }
    let (code, said, errors) = signalled(child, "-INT");
    assert_eq!(code, Some(1));
    assert!(errors.contains("interrupted after "), "{errors}");
    assert_eq!(said, "", "no verdict on what was not checked");
}

#[test]
fn a_circuit_beyond_its_budget_is_not_checked() {
    let text = format!("{CORNER}budget: {{ toffoli: 1000 }}\n");
    let folder = Folder::with("corner.yaml", &text);
    let said = folder.fails(2, &["verify", "corner.yaml"]);
    assert!(said.contains("error[QRT0602]"), "{said}");
    folder.works(&["verify", "corner.yaml", "--set", "budget.toffoli=100000000"]);
}
