//! Tests of `qrt verify` and `qrt trade` in parts: together, parts give the result of one process.

use super::trade_command::LIT;
use crate::common::command::Folder;
use serde_json::Value;
use std::fs;

fn folder() -> Folder {
    Folder::with("lit.yaml", LIT)
}

/// Returns the answer of a check, and writes it to the file `name`.
fn verified(folder: &Folder, name: &str, arguments: &[&str]) -> Value {
    let said = folder.works(&[&["verify", "lit.yaml", "--json"], arguments].concat());
    fs::write(folder.path(name), &said).unwrap();
    serde_json::from_str(&said).unwrap()
}

fn checked_parts(folder: &Folder) {
    for k in 0..5 {
        let portion = format!("{k}/5");
        let answer = verified(folder, &format!("{k}.json"), &["--portion", &portion]);
        assert_eq!(answer["portion"], serde_json::json!([k, 5]));
    }
}

#[test]
fn portions_of_a_check_make_the_answer_of_the_whole() {
    let folder = folder();
    let whole = verified(&folder, "whole.json", &[]);
    assert!(whole["portion"].is_null());
    checked_parts(&folder);
    let names = ["2.json", "0.json", "4.json", "3.json", "1.json"];
    let parts = [&["--parts"], &names[..]].concat();
    let pooled = verified(&folder, "pooled.json", &parts);
    for key in [
        "version",
        "scene_hash",
        "seed",
        "portion",
        "holds",
        "paths",
        "qubits",
        "gates",
        "fraction_bits",
        "mismatched",
        "mismatches",
        "defect",
    ] {
        assert_eq!(pooled[key], whole[key], "{key}");
    }
    let pixels = |of: &Value| {
        let mut pixels: Vec<String> = (of["pixels"].as_array().unwrap().iter())
            .map(Value::to_string)
            .collect();
        pixels.sort();
        pixels
    };
    assert_eq!(pixels(&pooled), pixels(&whole));
    assert_eq!(pixels(&whole).len(), 16);
    for place in [
        "/mean_rgb/0",
        "/mean_rgb/2",
        "/width_error/rmse_rgb/0",
        "/width_error/rmse_rgb/1",
        "/width_error/greatest_rgb/2",
        "/width_error/relative",
        "/parted",
    ] {
        let [one, other] = [&pooled, &whole].map(|of| of.pointer(place).unwrap().as_f64().unwrap());
        assert!(
            (one - other).abs() <= 1e-12 * other,
            "{place}: {one} {other}"
        );
    }
    assert!(whole["mean_rgb"][0].as_f64().unwrap() > 0.0);
    let said = folder.works(&[&["verify", "lit.yaml"], &parts[..]].concat());
    assert!(
        said.starts_with("lit.yaml: 16 of 24 pixels, 1024 paths, on "),
        "{said}"
    );
    assert!(said.ends_with("all of it holds\n"), "{said}");
}

#[test]
fn portions_that_make_no_check_are_named() {
    let folder = folder();
    checked_parts(&folder);
    verified(&folder, "whole.json", &[]);
    verified(&folder, "seed.json", &["--portion", "1/5", "--seed", "1"]);
    verified(&folder, "count.json", &["--portion", "1/4"]);
    verified(
        &folder,
        "pixels.json",
        &["--portion", "1/5", "--pixels", "12"],
    );
    let other = ["--portion", "1/5", "--set", "precision.fraction=11"];
    verified(&folder, "scene.json", &other);
    let text = fs::read_to_string(folder.path("1.json")).unwrap();
    fs::write(folder.path("cut.json"), &text[..text.len() / 2]).unwrap();
    for (names, reason) in [
        ("0 2 3 4", "1 of 5 portions is missing: 1/5"),
        ("3", "4 of 5 portions are missing: 0/5, 1/5, 2/5, 4/5"),
        ("0 1 2 3 4 1", "`1.json` and `1.json` are both portion 1/5"),
        ("0 seed 2 3 4", "`seed.json` is of another seed"),
        ("0 scene 2 3 4", "`scene.json` is of another scene"),
        (
            "0 pixels 2 3 4",
            "`pixels.json` is of another number of --pixels",
        ),
        (
            "0 count 2 3 4",
            "`count.json` is portion 1/4, and `0.json` is portion 0/5",
        ),
        (
            "0 whole 2 3 4",
            "`whole.json` is no answer of `qrt verify --portion",
        ),
        (
            "0 cut 2 3 4",
            "`cut.json` is no answer of `qrt verify --portion",
        ),
    ] {
        let names: Vec<String> = names
            .split(' ')
            .map(|name| format!("{name}.json"))
            .collect();
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        let errors = folder.fails(
            2,
            &[&["verify", "lit.yaml", "--parts"], &names[..]].concat(),
        );
        assert!(errors.contains(reason), "{names:?}: {errors}");
    }
    let errors = folder.fails(1, &["verify", "lit.yaml", "--parts", "none.json"]);
    assert!(errors.contains("none.json"), "{errors}");
    let both = [
        "verify",
        "lit.yaml",
        "--portion",
        "0/5",
        "--parts",
        "0.json",
    ];
    assert!(folder.fails(2, &both).contains("cannot be used with"));
}

/// A fault that one portion found is a fault of the whole.
#[test]
fn a_portion_that_does_not_hold_decides() {
    let folder = folder();
    checked_parts(&folder);
    let name = folder.path("3.json");
    let mut answer: Value = serde_json::from_slice(&fs::read(&name).unwrap()).unwrap();
    let good = answer.clone();
    let parts = ["--parts", "0.json", "1.json", "2.json", "3.json", "4.json"];
    let words = [&["verify", "lit.yaml"], &parts[..]].concat();
    answer["mismatched"] = 2.into();
    answer["holds"] = false.into();
    answer["mismatches"] = serde_json::json!([{
        "pixel": [3, 1], "id": 5, "channel": 1, "colour": { "fixed": 7, "gates": 8 },
        "count": { "fixed": 1, "gates": 2, "thresholds": 1 },
    }]);
    fs::write(&name, answer.to_string()).unwrap();
    let errors = folder.fails(1, &words);
    let expected = "the models disagree on 2 of 3072 path colours: path 5 of pixel (3, 1), green";
    assert!(errors.contains(expected), "{errors}");
    let mut answer = good;
    answer["defect"] = serde_json::json!({ "message": "qubit 7 is not zero again", "qubit": 7 });
    for key in ["mean_rgb", "width_error", "parted"] {
        answer[key] = Value::Null;
    }
    fs::write(&name, answer.to_string()).unwrap();
    let errors = folder.fails(1, &words);
    assert!(
        errors.contains("qubit 7 is not zero again; this is a defect of qrt"),
        "{errors}"
    );
    for (model, advice) in [
        ("real", "; no rounding explains it"),
        ("fixed", "; numbers of 10 fraction bits may be too coarse"),
        ("gates", "; no rounding explains it"),
    ] {
        answer["defect"] = serde_json::json!({
            "message": "it is too bright", "model": model, "pixel": [3, 1], "id": 5,
            "channel": 1, "count": 70, "most": 64,
        });
        fs::write(&name, answer.to_string()).unwrap();
        let errors = folder.fails(1, &words);
        assert!(
            errors.contains(&format!("it is too bright{advice}")),
            "{errors}"
        );
        assert!(errors.contains("\nof this path, ray 0 meets"), "{errors}");
    }
}

fn trade(folder: &Folder, out: &str, more: &[&str]) -> String {
    let words = ["trade", "lit.yaml", "--quick", "--pixels", "4", "-o", out];
    folder.works(&[&words[..], more].concat())
}

/// Returns a table's lines without their seconds and checksums.
fn timeless(folder: &Folder, out: &str) -> Vec<String> {
    let text = String::from_utf8(folder.read(&format!("{out}/trade.csv"))).unwrap();
    let lines = text.lines().skip(1);
    let mut lines: Vec<String> = lines
        .map(|line| line.rsplitn(3, ',').nth(2).unwrap().to_owned())
        .collect();
    lines.sort();
    lines
}

#[test]
fn portions_of_a_table_make_the_table_and_what_is_lost_is_measured_again() {
    let folder = folder();
    trade(&folder, "whole", &["-q"]);
    for k in 0..3 {
        let [portion, out] = [format!("{k}/3"), format!("part{k}")];
        let said = trade(&folder, &out, &["--portion", &portion]);
        let rows = timeless(&folder, &out).len() - 1;
        let expected = format!("{out}/trade.csv: {rows} rows, portion {portion} of the settings\n");
        assert_eq!(said, expected);
        assert!(!folder.path(format!("{out}/index.html")).exists());
    }
    trade(&folder, "merged", &["--parts", "part2", "part0", "part1"]);
    assert_eq!(timeless(&folder, "merged"), timeless(&folder, "whole"));
    assert!(folder.path("merged/index.html").exists());
    // One of the parts is missing, and another is there twice.
    let words = [
        "trade", "lit.yaml", "--quick", "--pixels", "4", "-o", "again",
    ];
    let parts = ["--parts", "part2", "part0", "part2"];
    let done = folder.qrt(&[&words[..], &parts].concat());
    let notes = String::from_utf8(done.stderr).unwrap();
    let anew = timeless(&folder, "part1").len() - 1;
    assert!(done.status.success(), "{notes}");
    let expected = format!("{anew} rows were in none of the parts, and were measured here");
    assert!(notes.contains(&expected), "{notes}");
    assert_eq!(timeless(&folder, "again"), timeless(&folder, "whole"));
}

/// Computes CRC-32 by its definition: a remainder of polynomials.
fn crc32(bytes: &[u8]) -> u32 {
    let shift = |sum: u32| (sum >> 1) ^ (0xedb8_8320 * (sum & 1));
    !bytes.iter().fold(!0, |sum, &byte| {
        (0..8).fold(sum ^ u32::from(byte), |sum, _| shift(sum))
    })
}

#[test]
fn parts_of_a_table_that_disagree_are_refused() {
    let folder = folder();
    for out in ["one", "other"] {
        trade(&folder, out, &["-q", "--portion", "0/9"]);
    }
    // The same row may be measured twice, with different times.
    trade(&folder, "both", &["-q", "--portion", "0/9"]);
    let table = folder.path("other/trade.csv");
    let text = fs::read_to_string(&table).unwrap();
    let last = text.lines().last().unwrap();
    let row = last.rsplit_once(',').unwrap().0;
    let mut cells: Vec<&str> = row.split(',').collect();
    let queries = cells.len() - 1 - 18 - 5;
    cells[queries] = "1.00000e9";
    let changed = cells.join(",");
    let changed = format!("{changed},{:08x}", crc32(changed.as_bytes()));
    fs::write(&table, text.replace(last, &changed)).unwrap();
    let words = [
        "trade", "lit.yaml", "--quick", "--pixels", "4", "-o", "out", "--parts",
    ];
    let errors = folder.fails(2, &[&words[..], &["one", "other"]].concat());
    let expected =
        "`other/trade.csv` and `one/trade.csv` disagree about a setting that both have: ";
    assert!(errors.contains(expected), "{errors}");
    assert!(!folder.path("out/trade.csv").exists());
    let errors = folder.fails(
        2,
        &[
            "trade",
            "lit.yaml",
            "-o",
            "o",
            "--portion",
            "0/2",
            "--parts",
            "one",
        ],
    );
    assert!(errors.contains("cannot be used with"), "{errors}");
}
