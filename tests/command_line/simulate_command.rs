//! Tests of `qrt simulate` from the outside.

use super::pictures_by_circuits::decoded;
use crate::common::command::Folder;
use serde_json::Value;

const EDGE: &str = include_str!("../../scenes-yaml/small/edge.yaml");

fn folder() -> Folder {
    Folder::with("edge.yaml", EDGE)
}

fn json(folder: &Folder, more: &[&str]) -> Value {
    let words = ["simulate", "edge.yaml", "--pixel", "1,0", "--json"];
    serde_json::from_str(&folder.works(&[&words, more].concat())).unwrap()
}

fn probabilities(answer: &Value, key: &str) -> Vec<f64> {
    let outcomes = answer["outcomes"].as_array().unwrap();
    let one = |outcome: &Value| outcome[key].as_f64().unwrap();
    outcomes.iter().map(one).collect()
}

/// For each outcome, the table has a bar of the simulated probability, with a mark where theory's bar ends.
#[test]
fn the_table_draws_both_distributions() {
    let folder = folder();
    let table = folder.works(&["simulate", "edge.yaml", "--pixel", "1,0"]);
    let mut lines = table.lines().skip_while(|line| !line.contains("S/N  "));
    let head = lines.next().unwrap();
    assert!(head.ends_with("# simulated, | theory"), "{head}");
    let theory = probabilities(&json(&folder, &[]), "theory");
    for (y, probability) in theory.iter().enumerate() {
        let line = lines.next().unwrap();
        let bar = "#".repeat((32.0 * probability).round() as usize);
        assert!(
            line.starts_with(&format!("{y:>3}  ")) && line.ends_with(&format!(" {bar}|")),
            "{line}"
        );
    }
}

#[test]
fn the_plot_has_a_bar_of_each_distribution_for_each_outcome() {
    let folder = folder();
    let words = [
        "simulate",
        "edge.yaml",
        "--pixel",
        "1,0",
        "--plot",
        "edge.svg",
    ];
    let table = folder.works(&words);
    assert_eq!(table, folder.works(&words[..4]));
    let drawing = String::from_utf8(folder.read("edge.svg")).unwrap();
    assert!(
        drawing.starts_with("<svg") && drawing.contains("simulated") && drawing.contains("theory")
    );
    let answer = json(&folder, &["--plot", "edge.svg"]);
    for key in ["simulated", "theory"] {
        for (y, probability) in probabilities(&answer, key).iter().enumerate() {
            let bar = format!("y = {y}: {probability:.9}");
            assert!(drawing.contains(&bar), "{key}: {bar}");
        }
    }
    let bars = drawing.matches("y = ").count();
    assert_eq!(bars, 2 * probabilities(&answer, "theory").len());
}

#[test]
fn the_window_of_the_command_stands_in_for_the_scenes() {
    let folder = folder();
    let [plain, rect, sine] =
        [&[][..], &["--window", "rect"], &["--window", "sine"]].map(|window| json(&folder, window));
    assert_eq!(plain, sine);
    assert_eq!([&rect["window"], &sine["window"]], ["rect", "sine"]);
    // The sine window has fewer probabilities far from the peak, and a qubit more.
    let far = |answer: &Value| probabilities(answer, "simulated")[5..].iter().sum::<f64>();
    assert!(10.0 * far(&sine) < far(&rect));
    for answer in [&rect, &sine] {
        assert!(answer["largest_difference"].as_f64().unwrap() < 1e-12);
    }
    let said = folder.fails(2, &["simulate", "edge.yaml", "--window", "round"]);
    assert!(said.contains("[possible values: rect, sine]"), "{said}");
}

#[test]
fn the_film_is_a_picture_of_all_estimates() {
    let folder = folder();
    let repeated = ["--shots", "64", "--seed", "1"];
    let film = ["simulate", "edge.yaml", "--film", "edge.png"];
    let said = folder.works(&[&film, &repeated[..]].concat());
    let told = "edge.png: 2 x 2 pixels, 12 counting circuits of at most 20 qubits";
    assert!(said.contains(told), "{said}");
    let (size, pixels) = decoded(folder.read("edge.png"));
    assert_eq!(size, [2, 2]);
    // Each pixel alone has the same estimate.
    for (place, pixel) in pixels.chunks(3).enumerate() {
        let at = format!("{},{}", place % 2, place / 2);
        let words = [
            "simulate",
            "edge.yaml",
            "--json",
            "--channel",
            "r",
            "--pixel",
            &at,
        ];
        let one = folder.works(&[&words, &repeated[..]].concat());
        let one: Value = serde_json::from_str(&one).unwrap();
        let radiance = one["estimate"]["radiance"].as_f64().unwrap();
        let linear = qrt::runtime::image::linear_of_srgb(f64::from(pixel[0]) / 255.0);
        assert!(
            (linear - radiance.min(1.0)).abs() < 0.01,
            "{at}: {linear} {radiance}"
        );
    }
    for (more, says) in [
        (["--pixel", "1,0"], "--pixel"),
        (["--plot", "edge.svg"], "--plot"),
        (["--mean-phase", "2"], "--mean-phase"),
    ] {
        let said = folder.fails(2, &[&film, &more[..]].concat());
        assert!(
            said.contains("cannot be used with") && said.contains(says),
            "{said}"
        );
    }
}
