//! Tests of `qrt count` from the outside.

use std::process::{Command, Output};

use serde_json::Value;

fn qrt(arguments: &str) -> Output {
    Command::new(env!("CARGO_BIN_EXE_qrt"))
        .args(arguments.split(' '))
        .output()
        .unwrap()
}

fn json(arguments: &str) -> Value {
    let output = qrt(&format!("count {arguments} --json"));
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    serde_json::from_slice(&output.stdout).unwrap()
}

fn refused(arguments: &str, message: &str) {
    let output = qrt(&format!("count {arguments}"));
    let errors = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{arguments}: {errors}");
    assert!(errors.contains(message), "{arguments}: {errors}");
    assert!(output.stdout.is_empty());
}

#[test]
fn all_outcomes_of_a_small_register_are_listed_and_sum_to_one() {
    for window in ["rect", "sine"] {
        let answer = json(&format!(
            "--good 300 --total 1000 --phase-bits 6 --window {window}"
        ));
        assert_eq!(answer["version"], 1);
        assert_eq!(answer["good"], 300);
        assert_eq!(answer["total"], 1000);
        assert_eq!(answer["phase_bits"], 6);
        assert_eq!(answer["window"], window);
        assert_eq!(answer["shown"], "all");
        let theta = 0.3_f64.sqrt().asin() / std::f64::consts::PI;
        assert!((answer["theta"].as_f64().unwrap() - theta).abs() < 1e-15);
        let outcomes = answer["outcomes"].as_array().unwrap();
        assert_eq!(outcomes.len(), 33);
        let mut sum = 0.0;
        for (y, outcome) in outcomes.iter().enumerate() {
            assert_eq!(outcome["y"], y);
            assert_eq!(outcome["theta"], y as f64 / 64.0);
            sum += outcome["probability"].as_f64().unwrap();
        }
        assert!((sum - 1.0).abs() < 1e-13);
        assert!(answer.get("draws").is_none() && answer.get("estimate").is_none());
    }
}

/// The expected values were computed with 60 digits: K(y - T theta) + K(y + T theta).
#[test]
fn asked_outcomes_of_the_largest_register_are_right() {
    let arguments = "--good 1000000007 --total 4611686018427387904 --phase-bits 40";
    for (window, expected) in [
        (
            "rect",
            [
                0.043_135_605_078_651_98,
                0.676_777_055_139_365_2,
                0.175_990_953_334_826_22,
                0.0,
            ],
        ),
        (
            "sine",
            [
                0.005_090_517_210_214_046,
                0.652_848_259_095_577_4,
                0.339_152_577_203_778_5,
                0.0,
            ],
        ),
    ] {
        let answer = json(&format!(
            "{arguments} --window {window} --outcomes 5153710,5153711,5153712,549755813888"
        ));
        assert_eq!(answer["shown"], "asked");
        let outcomes = answer["outcomes"].as_array().unwrap();
        assert_eq!(outcomes.len(), 4);
        for (outcome, expected) in outcomes.iter().zip(expected) {
            let p = outcome["probability"].as_f64().unwrap();
            assert!((p - expected).abs() < 1e-12, "{outcome}, not {expected}");
        }
    }
}

#[test]
fn a_large_register_shows_its_peak_and_says_so() {
    let answer = json("--good 3 --total 10 --phase-bits 40");
    assert_eq!(answer["shown"], "peak");
    assert_eq!(answer["outcomes"].as_array().unwrap().len(), 33);
    let output = qrt("count --good 3 --total 10 --phase-bits 40 --window sine");
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(
        text.contains("33 outcomes about the peak, of 549755813889"),
        "{text}"
    );
    assert!(text.lines().count() < 45);
}

#[test]
fn draws_are_counted_estimated_from_and_repeatable() {
    let arguments = "--good 300 --total 1000 --phase-bits 8 --shots 200 --seed 5";
    let answer = json(arguments);
    assert_eq!(answer, json(arguments));
    assert_ne!(
        answer["draws"],
        json(&arguments.replace("seed 5", "seed 6"))["draws"]
    );
    let draws = answer["draws"].as_array().unwrap();
    let drawn: u64 = draws
        .iter()
        .map(|draw| draw["count"].as_u64().unwrap())
        .sum();
    assert_eq!(drawn, 200);
    let estimate = &answer["estimate"];
    assert_eq!(estimate["shots"], 200);
    assert_eq!(estimate["queries"], 200 * 255);
    assert!(estimate["good"].as_u64().unwrap().abs_diff(300) <= 2);
    let (low, high) = (&estimate["interval"][0], &estimate["interval"][1]);
    assert!(low.as_f64().unwrap() < 0.3 && 0.3 < high.as_f64().unwrap());
    let posterior = &answer["posterior"];
    assert!((posterior["mean"].as_f64().unwrap() - 300.0).abs() < 2.0);
    assert_eq!(posterior["likeliest"][0]["good"], estimate["good"]);
}

#[test]
fn tables_say_the_same() {
    let output = qrt("count --good 1 --total 2 --phase-bits 3 --shots 3");
    assert!(output.status.success());
    let text = String::from_utf8(output.stdout).unwrap();
    let expected = "\
S = 1 of N = 2, T = 2^3, rectangular window
theta = 0.25

  y  y/T                S/N                probability
  0  0.000000000000000  0.000000000000000  0.000000000000000e0
  1  0.125000000000000  0.146446609406726  0.000000000000000e0
  2  0.250000000000000  0.500000000000000  1.000000000000000e0
  3  0.375000000000000  0.853553390593274  0.000000000000000e0
  4  0.500000000000000  1.000000000000000  0.000000000000000e0

  y  drawn (seed 0)
  2  3

likeliest S   1
S/N           0.5
";
    assert!(text.starts_with(expected), "{text}");
}

#[test]
fn questions_without_an_answer_are_refused() {
    refused(
        "--good 3 --total 2 --phase-bits 4",
        "3 good indices out of 2",
    );
    refused("--good 0 --total 0 --phase-bits 4", "at least 1");
    refused("--good 1 --total 2 --phase-bits 0", "0 is not in 1..=40");
    refused("--good 1 --total 2 --phase-bits 41", "41 is not in 1..=40");
    refused(
        "--good 1 --total 2 --phase-bits 4 --outcomes 2,9",
        "outcome 9 is beyond T/2 = 8",
    );
    refused(
        "--good 1 --total 2 --phase-bits 4 --shots 0",
        "0 is not in 1..=1000000",
    );
    refused("--good 1 --total 2 --phase-bits 4 --seed 1", "--shots");
    refused("--good -1 --total 2 --phase-bits 4", "--good");
    refused(
        "--good 1 --total 2 --phase-bits 4 --window hann",
        "rect, sine",
    );
}
