//! Tests that commands report the same figures for the same oracle, and name the oracle.

use crate::common::command::Folder;
use serde_json::Value;

const CHANNELS: [&str; 3] = ["r", "g", "b"];

/// Overrides for few paths and pixels, so that all can be verified: the oracles do not depend on the film's size.
const FEW: [&str; 4] = [
    "--set",
    "sampling.path_bits=2",
    "--set",
    "film={ width: 8, height: 8 }",
];

fn example(name: &str) -> String {
    format!("{}/scenes-yaml/{name}.yaml", env!("CARGO_MANIFEST_DIR"))
}

fn json(folder: &Folder, arguments: &[&str]) -> Value {
    let text = folder.works(&[arguments, &["--json"], &FEW].concat());
    serde_json::from_str(&text).unwrap()
}

fn number(value: &Value) -> u64 {
    let number = value.as_u64();
    number.unwrap_or_else(|| panic!("{value} is no whole number"))
}

/// Returns the qubits and Toffolis of the oracle that `qrt inspect` shows.
fn inspected(answer: &Value) -> [u64; 2] {
    [&answer["qubits"]["peak"], &answer["gates"]["toffoli"]].map(number)
}

/// Returns the qubits and Toffolis of an oracle in a list of `qrt inspect` or `qrt verify`.
fn listed(answer: &Value, channel: &Value, class: &Value) -> [u64; 2] {
    let oracles = answer["oracles"].as_array().unwrap().iter();
    let mut found = oracles.filter(|one| one["channel"] == *channel && one["class"] == *class);
    let one = found.next().unwrap();
    assert!(found.next().is_none());
    [&one["qubits"], &one["toffoli"]].map(number)
}

/// Checks every command's figures for the oracles of `channels` of `pixels` of a scene. Returns the costs of the
/// first channel in each pixel.
fn check(folder: &Folder, scene: &str, pixels: &[&str], channels: &[&str]) -> Vec<[u64; 2]> {
    let all = json(folder, &["inspect", scene]);
    let verified = json(folder, &["verify", scene, "--pixels", "64"]);
    // Without a pixel, the command shows the most expensive oracle of the list.
    let own = listed(&all, &all["channel"], &all["class"]);
    assert_eq!(own, inspected(&all), "{scene}");
    let costs = all["oracles"].as_array().unwrap().iter();
    assert_eq!(costs.map(|one| number(&one["toffoli"])).max(), Some(own[1]));
    assert!(all["pixel"].is_null() && all["includes"] == "compute, compare and flip, uncompute");
    let mut first = Vec::new();
    for pixel in pixels {
        for &channel in channels {
            let asked = ["--pixel", pixel, "--channel", channel];
            let one = json(folder, &[&["inspect", scene][..], &asked].concat());
            let figures = inspected(&one);
            assert_eq!(one["channel"], channel);
            assert_eq!(one["pixel"], pair(pixel));
            // The list is of the oracles that serve all pixels of a class.
            let of_class = listed(&all, &one["channel"], &one["class"]);
            assert_eq!(of_class, listed(&one, &one["channel"], &one["class"]));
            assert_eq!(of_class, listed(&verified, &one["channel"], &one["class"]));
            // The oracle of a pixel alone has its position built in.
            assert!(
                figures < of_class && figures[1] < of_class[1],
                "{figures:?} {of_class:?}"
            );
            exported(folder, scene, &asked, &one);
            if channel == channels[0] {
                first.push(figures);
            }
        }
    }
    first
}

fn pair(pixel: &str) -> Value {
    let numbers = pixel
        .split(',')
        .map(|number| number.parse::<u32>().unwrap());
    numbers.collect()
}

/// Checks that the exported circuit has the gates and qubits of `inspected`, gate by gate.
fn exported(folder: &Folder, scene: &str, asked: &[&str], inspected: &Value) {
    let write = [
        "export",
        scene,
        "-o",
        "one.qasm",
        "--max-gates",
        "100000000",
    ];
    let answer = json(folder, &[&write[..], asked].concat());
    let text = String::from_utf8(folder.read("one.qasm")).unwrap();
    let lines = |gate: &str| text.lines().filter(|line| line.starts_with(gate)).count() as u64;
    for (name, gate) in [("toffoli", "ccx "), ("cnot", "cx "), ("x", "x ")] {
        assert_eq!(
            lines(gate),
            number(&inspected["gates"][name]),
            "{scene} {asked:?} {name}"
        );
    }
    let registers = text.lines().filter_map(|line| line.strip_prefix("qubit["));
    let qubits = registers.map(|line| line.split(']').next().unwrap().parse::<u64>().unwrap());
    assert_eq!(qubits.sum::<u64>(), number(&inspected["qubits"]["peak"]));
    assert_eq!(answer["qubits"], inspected["qubits"]["peak"]);
    assert_eq!(answer["oracle"]["qubits"], inspected["qubits"]["peak"]);
    assert_eq!(answer["oracle"]["gates"], inspected["gates"]);
    assert_eq!(answer["class"], inspected["class"]);
    assert!(answer["beside_oracle"].is_null());
}

#[test]
fn every_command_prices_the_new_scene_alike() {
    let folder = Folder::new();
    folder.works(&["new", "room"]);
    check(&folder, "room.yaml", &["5,6"], &CHANNELS);
    // The lamp is above the picture, so no pixel sees it.
    let answer = json(&folder, &["inspect", "room.yaml"]);
    assert_eq!(answer["class"], "all");
}

#[test]
fn every_command_prices_scenes_alike_that_have_two_classes_of_pixels() {
    // The middle pixel shows the back wall, and the lamp is above.
    let costs = check(
        &Folder::new(),
        &example("lit-box"),
        &["4,4", "4,1"],
        &CHANNELS,
    );
    assert!(costs[0] != costs[1], "{costs:?}");
}

#[test]
#[ignore = "ten seconds: the same as of scenes with sampled lamps"]
fn every_command_prices_scenes_alike_without_sampled_lamps() {
    for (scene, channel) in [("cornell-box", "g"), ("cornell-glass", "b")] {
        check(&Folder::new(), &example(scene), &["3,4"], &[channel]);
    }
}

#[test]
fn a_part_with_more_than_the_oracle_says_so_and_gives_the_oracle_s_figures() {
    let folder = Folder::with("wall.yaml", include_str!("../../examples/lit-wall.yaml"));
    let asked = ["--pixel", "1,1", "--channel", "g"];
    let one = json(&folder, &[&["inspect", "wall.yaml"][..], &asked].concat());
    for part in ["grover", "counting"] {
        let set = ["--set", "counting.phase_bits=2"];
        let write = ["export", "wall.yaml", "-o", "part.qasm", "--part", part];
        let answer = json(&folder, &[&write[..], &asked, &set].concat());
        assert_eq!(answer["oracle"]["qubits"], one["qubits"]["peak"]);
        assert_eq!(answer["oracle"]["gates"], one["gates"]);
        let beside = answer["beside_oracle"].as_str().unwrap();
        assert!(beside.contains("reflection"), "{beside}");
        assert_eq!(beside.contains("phase register"), part == "counting");
        let text = String::from_utf8(folder.read("part.qasm")).unwrap();
        assert!(text.contains(beside));
        let more = number(&answer["qubits"]) >= number(&one["qubits"]["peak"]);
        assert!(more && number(&answer["gates"]["ccx"]) > number(&one["gates"]["toffoli"]));
    }
}

#[test]
fn tables_name_the_oracle_and_list_the_others() {
    let folder = Folder::new();
    let scene = example("lit-box");
    let show = |more: &[&str]| folder.works(&[&["inspect", &scene][..], more].concat());
    let text = show(&[]);
    let second = text.lines().nth(1).unwrap();
    assert!(
        second.ends_with(": of the scene's 6 oracles the one with the most Toffolis"),
        "{second}"
    );
    for name in [
        "channel r, pixels that may see a lamp",
        "channel b, pixels that see no lamp",
    ] {
        assert!(text.contains(name), "{text}");
    }
    assert_eq!(
        text.lines()
            .filter(|line| line.starts_with("* channel"))
            .count(),
        1
    );
    let text = show(&["--pixel", "128,40", "--channel", "b"]);
    let second = "channel b, pixel 128,40 alone, of the pixels that may see a lamp, seed 0";
    assert!(text.contains(second), "{text}");
    // The list is of oracles that serve more pixels than that one.
    assert!(
        text.contains("\n  channel b, pixels that may see a lamp "),
        "{text}"
    );
    let said = folder.works(&[&["verify", &scene, "--pixels", "64"][..], &FEW].concat());
    for words in [
        "all three channels in one: compute, compare and flip for each, uncompute",
        "channel g, pixels that may see a lamp ",
        "channel g, pixels that see no lamp ",
    ] {
        assert!(said.contains(words), "{said}");
    }
}

#[test]
fn a_pixel_that_the_film_lacks_is_refused() {
    let folder = Folder::new();
    folder.works(&["new", "room"]);
    for arguments in [["inspect", "room.yaml"], ["export", "room.yaml"]] {
        let errors = folder.fails(2, &[&arguments[..], &["--pixel", "128,0"]].concat());
        assert!(
            errors.contains("there is no pixel 128,0 on a film of 128 x 128"),
            "{errors}"
        );
    }
    let errors = folder.fails(2, &["inspect", "room.yaml", "--seed", "3"]);
    assert!(errors.contains("--pixel"), "{errors}");
}

/// Another seed has other paths, whose shifts are other X gates of the same circuit.
#[test]
fn a_seed_changes_the_gates_of_a_pixel_as_it_changes_its_circuit() {
    let folder = Folder::new();
    folder.works(&["new", "room"]);
    let at = |seed| ["--pixel", "5,6", "--channel", "g", "--seed", seed];
    let gates = ["0", "7"].map(|seed| {
        let one = json(
            &folder,
            &[&["inspect", "room.yaml"][..], &at(seed)].concat(),
        );
        exported(&folder, "room.yaml", &at(seed), &one);
        one["gates"].clone()
    });
    assert_eq!(gates[0]["toffoli"], gates[1]["toffoli"]);
    assert_ne!(gates[0]["x"], gates[1]["x"]);
}

/// The README and the crate's page name the figures of the box whose picture they show.
#[test]
fn the_first_page_has_the_figures_of_the_box() {
    let text = Folder::new().works(&["inspect", &example("lit-box"), "--json"]);
    let answer: Value = serde_json::from_str(&text).unwrap();
    let [qubits, toffoli] = inspected(&answer).map(grouped);
    let claim = format!("at most {toffoli} Toffolis and {qubits} qubits a channel");
    for (page, text) in [
        ("README.md", include_str!("../../README.md")),
        ("src/lib.rs", include_str!("../../src/lib.rs")),
    ] {
        let lines = text
            .lines()
            .map(|line| line.trim_start_matches("//!").trim());
        let text = lines.collect::<Vec<_>>().join(" ");
        assert!(text.contains(&claim), "{page} does not say `{claim}`");
    }
}

fn grouped(number: u64) -> String {
    qrt::core::inspect::grouped(number)
}
