//! Tests of `qrt inspect` from the outside.

use crate::common::command::Folder;
use serde_json::Value;
use std::fs;

/// A lamp over a floor: two rays a path.
const SCENE: &str = "\
name: lit-floor
camera: { perspective: { eye: [0, 1, 2], target: [0, 0, 0], vfov: 45 } }
film: { width: 4, height: 4 }
materials:
  floor: { lambertian: { albedo: [0.8, 0.5, 0.2] } }
  sky: { emitter: { radiance: [1, 1, 1] } }
geometry:
  - quad: { vertices: [[-9, 0, 9], [9, 0, 9], [9, 0, -9], [-9, 0, -9]], material: floor }
  - quad: { vertices: [[-9, 5, -9], [9, 5, -9], [9, 5, 9], [-9, 5, 9]], material: sky }
sampling: { path_bits: 6, depths: [{ bits: [3, 3] }, { bits: [3, 3] }], lights: none }
precision: { fraction: 10 }
comparator: { bits: 5 }
";

fn folder() -> Folder {
    Folder::with("floor.yaml", SCENE)
}

fn json(folder: &Folder, arguments: &[&str]) -> Value {
    let all = ["inspect", "--json"].iter().chain(arguments);
    let text = folder.works(&all.copied().collect::<Vec<_>>());
    serde_json::from_str(&text).unwrap()
}

fn example(name: &str) -> String {
    format!("{}/scenes-yaml/{name}.yaml", env!("CARGO_MANIFEST_DIR"))
}

fn number(value: &Value) -> u64 {
    value
        .as_u64()
        .unwrap_or_else(|| panic!("{value} is no whole number"))
}

const GATES: [&str; 4] = ["toffoli", "and_measured", "cnot", "x"];

fn gates(value: &Value) -> [u64; 4] {
    GATES.map(|gate| number(&value[gate]))
}

fn add(costs: impl IntoIterator<Item = [u64; 4]>) -> [u64; 4] {
    costs.into_iter().fold([0; 4], |sum, cost| {
        std::array::from_fn(|gate| sum[gate] + cost[gate])
    })
}

fn list<'a>(answer: &'a Value, key: &str) -> &'a [Value] {
    answer[key].as_array().unwrap()
}

#[test]
fn json_says_what_was_compiled() {
    let answer = json(&folder(), &["floor.yaml"]);
    assert_eq!(answer["version"], 1);
    assert_eq!(answer["scene"], "lit-floor");
    assert_eq!(answer["fraction_bits"], 10);
    assert_eq!(answer["comparator_bits"], 5);
    assert_eq!(answer["path_bits"], 6);
    assert_eq!(answer["depths"], 2);
    assert_eq!(answer["strategy"], "keep");
    assert_eq!(answer["nearest"], "running");
    let answer = json(
        &folder(),
        &["floor.yaml", "--set", "circuit.uncompute=scoped"],
    );
    assert_eq!(answer["strategy"], "scoped");
}

#[test]
fn parts_stages_blocks_and_roles_add_up() {
    for how in ["keep", "scoped"] {
        let set = format!("circuit.uncompute={how}");
        let answer = json(&folder(), &["floor.yaml", "--set", &set]);
        let total = gates(&answer["gates"]);
        let parts = ["compute", "flip", "uncompute"].map(|part| gates(&answer["parts"][part]));
        assert_eq!(add(parts), total);
        assert!(total.iter().all(|&gates| gates > 0), "{total:?}");
        let stages = list(&answer, "stages");
        assert_eq!(
            add(stages.iter().map(|stage| gates(&stage["compute"]))),
            parts[0]
        );
        let blocks = list(&answer, "blocks");
        assert_eq!(add(blocks.iter().map(|block| gates(&block["own"]))), total);
        assert_eq!(blocks[0]["path"], "oracle");
        assert_eq!(gates(&blocks[0]["total"]), total);
        for block in &blocks[1..] {
            // Paths are distinct, and those within a block begin with the block's own.
            let path = block["path"].as_str().unwrap();
            let inside = |other: &&Value| {
                let other = other["path"].as_str().unwrap();
                other == path || other.starts_with(&format!("{path}/"))
            };
            let own = blocks
                .iter()
                .filter(inside)
                .map(|block| gates(&block["own"]));
            assert_eq!(add(own), gates(&block["total"]), "{path}");
        }
        let peak = number(&answer["qubits"]["peak"]);
        let roles = answer["qubits"]["by_role"].as_object().unwrap();
        assert_eq!(roles.values().map(number).sum::<u64>(), peak);
        assert_eq!(number(&answer["toffoli_x_qubits"]), peak * total[0]);
        let depth = number(&answer["gates"]["toffoli_depth"]);
        assert!(0 < depth && depth <= total[0]);
        assert_eq!(
            total[0],
            gates(&answer["parts"]["flip"])[0] + 2 * parts[0][0]
        );
    }
}

#[test]
fn kept_registers_stand_one_above_the_other() {
    let answer = json(&folder(), &["floor.yaml"]);
    let mut offset = 0;
    for register in list(&answer, "registers") {
        assert_eq!(number(&register["offset"]), offset, "{register}");
        offset += number(&register["width"]);
    }
    assert_eq!(number(&answer["qubits"]["layout"]), offset);
    // At the peak all registers exist, with the ancillas of one operation.
    let ancillas = number(&answer["qubits"]["by_role"]["ancilla"]);
    assert!(number(&answer["qubits"]["peak"]) <= offset + ancillas);
    let first = &list(&answer, "registers")[0];
    assert_eq!(
        (&first["name"], &first["role"]),
        (&"id".into(), &"id".into())
    );
    assert_eq!(
        (&first["type"], &first["width"]),
        (&"UInt<6>".into(), &6.into())
    );
    assert!(first["depth"].is_null());
    let names: Vec<&Value> = list(&answer, "registers")
        .iter()
        .map(|r| &r["name"])
        .collect();
    let channel = answer["channel"].as_str().unwrap();
    for name in ["comparator", "flag", &format!("colour.{channel}")] {
        assert!(names.contains(&&Value::from(name)), "{name} in {names:?}");
    }
}

#[test]
fn scopes_use_qubits_again() {
    let kept = json(&folder(), &["floor.yaml"]);
    let scoped = json(
        &folder(),
        &["floor.yaml", "--set", "circuit.uncompute=scoped"],
    );
    let widths = list(&scoped, "registers")
        .iter()
        .map(|r| number(&r["width"]));
    assert!(number(&scoped["qubits"]["layout"]) < widths.sum());
    assert!(number(&scoped["qubits"]["peak"]) < number(&kept["qubits"]["peak"]));
    assert!(number(&scoped["gates"]["toffoli"]) > number(&kept["gates"]["toffoli"]));
}

#[test]
fn passes_lead_from_nothing_done_to_the_circuit() {
    let answer = json(&folder(), &[&example("cornell-box")]);
    let passes = list(&answer, "passes");
    let names: Vec<&Value> = passes.iter().map(|pass| &pass["name"]).collect();
    let all = ["share", "tabulate", "needed", "merge", "multiples"];
    assert_eq!(names, all);
    for key in ["toffoli", "ops", "qubits"] {
        for pair in passes.windows(2) {
            assert_eq!(pair[0][key]["after"], pair[1][key]["before"]);
        }
    }
    let last = &passes[4];
    assert_eq!(last["toffoli"]["after"], answer["gates"]["toffoli"]);
    assert_eq!(last["qubits"]["after"], answer["qubits"]["peak"]);
    assert!(number(&last["toffoli"]["after"]) < number(&passes[0]["toffoli"]["before"]));
}

#[test]
fn the_most_expensive_channel_is_shown_unless_one_is_asked_for() {
    // The floor reflects only red light: the other channels need no products.
    let set = "materials.floor.lambertian.albedo=[0.7, 1, 0]";
    let scene = ["floor.yaml", "--set", set];
    let of = |channel| json(&folder(), &[&scene[..], &["--channel", channel]].concat());
    let all = ["r", "g", "b"].map(of);
    for (answer, channel) in all.iter().zip(["r", "g", "b"]) {
        assert_eq!(answer["channel"], channel);
    }
    let costs = all
        .each_ref()
        .map(|answer| number(&answer["gates"]["toffoli"]));
    let most = *costs.iter().max().unwrap();
    assert!(costs.iter().any(|&cost| cost < most), "{costs:?}");
    let most_expensive = &all[costs.iter().position(|&cost| cost == most).unwrap()];
    assert_eq!(&json(&folder(), &scene), most_expensive);
}

#[test]
fn tables_fit_and_name_the_boxes_of_the_paper() {
    for scene in ["furnace", "floor-and-light", "cornell-box", "cornell-ggx"] {
        for more in [&[][..], &["--planes"], &["-v", "--circuit", "-"]] {
            let path = example(scene);
            let text = folder().works(&[&["inspect", &path][..], more].concat());
            for line in text.lines() {
                assert!(
                    line.chars().count() <= 100 && line.trim_end() == line,
                    "{line}"
                );
            }
            for name in [
                "Toffoli x qubits",
                "compute",
                "generate_ray",
                "find_intersection",
                "compare and flip",
                "uncompute",
                "O_f",
                "tabulate",
                "scratch",
            ] {
                assert!(text.contains(name), "{scene}: {name}");
            }
            // Where only a lamp's front can be met, there is no material to choose.
            let chooses = scene.starts_with("cornell");
            assert!(text.contains("shade") || !chooses, "{scene}");
        }
    }
    let text = folder().works(&["inspect", "floor.yaml"]);
    assert!(
        text.starts_with("lit-floor: one call of the oracle, O_f = "),
        "{text}"
    );
    assert!(text.contains("6 path bits, 2 depths, 5 comparator bits, 10 fraction bits"));
}

/// Under these strategies, parts of one search run at several times.
#[test]
fn the_parts_of_a_row_take_no_more_than_the_row() {
    let small = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes-yaml/small");
    for (scene, strategy) in [
        ("slanted", "pebbled"),
        ("shadow", "recompute"),
        // Two blocks of one name: rays of surfaces begin twice.
        ("corner", "recompute"),
    ] {
        let (file, set) = (
            format!("{small}/{scene}.yaml"),
            format!("circuit.uncompute={strategy}"),
        );
        let text = folder().works(&["inspect", &file, "--set", &set]);
        // The level of each open row, and the Toffolis that its parts may still take.
        let mut open: Vec<(usize, u64)> = Vec::new();
        let mut levels = 0;
        let rows = text.lines().skip_while(|row| !row.starts_with("compute"));
        for row in rows.take_while(|row| !row.starts_with("compare and flip")) {
            let is_branch = |c: &char| "\u{251c}\u{2514}\u{2502} ".contains(*c);
            let level = row.chars().take_while(is_branch).count();
            // The name has 28 characters, the number after it 14.
            let digits = row.chars().skip(28).take(14).filter(char::is_ascii_digit);
            let toffoli: u64 = digits.collect::<String>().parse().unwrap();
            open.retain(|(above, _)| *above < level);
            if let Some((_, left)) = open.last_mut() {
                *left = left
                    .checked_sub(toffoli)
                    .unwrap_or_else(|| panic!("{row}: {text}"));
            }
            open.push((level, toffoli));
            levels = levels.max(open.len());
        }
        assert_eq!(levels, 4, "{text}");
    }
}

#[test]
fn tables_say_what_json_says() {
    let answer = json(&folder(), &["floor.yaml"]);
    let text = folder().works(&["inspect", "floor.yaml"]);
    for (place, what) in [
        (&answer["qubits"]["peak"], "qubits"),
        (&answer["gates"]["toffoli"], "Toffoli"),
        (&answer["gates"]["toffoli_depth"], "Toffoli depth"),
        (&answer["toffoli_x_qubits"], "Toffoli x qubits"),
    ] {
        let line = text
            .lines()
            .find(|line| line.trim_start().ends_with(&format!(" {what}")));
        let digits: String = line.unwrap().chars().filter(char::is_ascii_digit).collect();
        assert_eq!(digits, number(place).to_string(), "{what}");
    }
    let toffoli = number(&answer["gates"]["toffoli"]);
    assert!(toffoli >= 1000 && text.contains(&qrt::core::inspect::grouped(toffoli)));
}

#[test]
fn planes_are_summed_unless_each_is_asked_for() {
    let scene = example("cornell-box");
    let planes = |text: &str| {
        text.lines()
            .filter(|line| line.contains("  plane "))
            .count()
    };
    let summed = folder().works(&["inspect", &scene]);
    assert_eq!(planes(&summed), 0);
    let first = summed
        .lines()
        .find(|line| line.contains(" planes "))
        .unwrap();
    // The planes of the lamp and of the room, of which floor and ceiling share one: they face each other.
    assert!(first.contains(" 6 planes "), "{first}");
    assert!(summed.contains(" 2 bodies "), "{summed}");
    // For the last ray, only planes that may hide a lamp count: no outer plane does.
    assert!(planes(&folder().works(&["inspect", &scene, "-v"])) >= 16 + 16 + 11);
}

/// Returns the output of `--logical-counts` for the floor's red channel.
fn logical_counts(folder: &Folder, sets: &[&str]) -> Value {
    let file = ["--channel", "r", "--logical-counts", "counts.json"];
    json(folder, &[&["floor.yaml"][..], &file, sets].concat());
    serde_json::from_slice(&folder.read("counts.json")).unwrap()
}

/// Q#'s names of the counts; Q# ignores other keys without a message.
const QSHARP: [&str; 7] = [
    "numQubits",
    "cczCount",
    "ccixCount",
    "tCount",
    "rotationCount",
    "rotationDepth",
    "measurementCount",
];

#[test]
fn logical_counts_are_those_of_the_gates_that_export_writes() {
    let folder = folder();
    for (estimator, rotations) in [("sine", true), ("paper", true), ("iqae", false)] {
        let set = format!("counting={{ phase_bits: 3, repetitions: 4, estimator: {estimator} }}");
        let sets = ["--set", &set];
        let counts = logical_counts(&folder, &sets);
        let inspected = json(&folder, &["floor.yaml", "--channel", "r", sets[0], sets[1]]);
        let toffoli = number(&inspected["gates"]["toffoli"]);
        let [unitary, measured] = ["unitary", "measured"].map(|kind| &counts[kind]);
        assert_eq!(unitary["oracle"]["cczCount"], toffoli);
        assert_eq!(unitary["oracle"]["numQubits"], inspected["qubits"]["peak"]);
        let ands = &measured["oracle"];
        let left = number(&ands["cczCount"]) + number(&ands["ccixCount"]);
        assert_eq!(inspected["gates"]["and_measured"], left);
        assert_eq!(ands["measurementCount"], toffoli - left);

        let export = |part: &str| -> Value {
            let part = [
                "--part",
                part,
                "--channel",
                "r",
                "-o",
                "part.qasm",
                "--json",
            ];
            let text = folder.works(&[&["export", "floor.yaml"][..], &part, &sets].concat());
            serde_json::from_str(&text).unwrap()
        };
        // A circuit is exported with its pixel built in. A picture is counted with the oracle of all pixels,
        // which has more gates in each query, and more qubits.
        let alone = export("oracle");
        let more_toffoli = toffoli - number(&alone["oracle"]["gates"]["toffoli"]);
        let more_qubits = number(&inspected["qubits"]["peak"]) - number(&alone["qubits"]);
        let run = &unitary["channel"];
        if rotations {
            let whole = export("counting");
            assert_eq!(
                4 * (number(&whole["gates"]["ccx"]) + 7 * more_toffoli),
                number(&run["cczCount"])
            );
            assert_eq!(
                number(&whole["qubits"]) + more_qubits,
                number(&run["numQubits"])
            );
            assert_eq!(run["measurementCount"], 4 * 3);
            // Two of the angles are quarter turns, one an eighth: an eighth takes three T gates on each side of a
            // CNOT, and a sixteenth three rotations. The sine window rotates each bit twice.
            let window = if estimator == "sine" { 2 * 3 } else { 0 };
            assert_eq!(run["tCount"], 4 * 2 * 3);
            assert_eq!(run["rotationCount"], 4 * (3 + window));
        } else {
            let iterate = number(&export("grover")["gates"]["ccx"]) + more_toffoli;
            assert_eq!(run["cczCount"], 4 * 7 * iterate);
            // The path and the comparator are measured after each query.
            assert_eq!(run["measurementCount"], 4 * 7 * (6 + 5));
            assert_eq!([&run["rotationCount"], &run["tCount"]], [0, 0]);
        }
        assert_eq!(counts["queries"]["channel"], 4 * 7);
        assert_eq!(counts["queries"]["film"], 3 * 16 * 4 * 7);
        for kind in [unitary, measured] {
            for part in ["oracle", "channel", "pixel", "film"] {
                assert_eq!(kind[part].as_object().unwrap().len(), QSHARP.len());
                for key in QSHARP {
                    number(&kind[part][key]);
                }
            }
            assert_eq!(
                number(&kind["film"]["ccixCount"]) + number(&kind["film"]["cczCount"]),
                16 * (number(&kind["pixel"]["ccixCount"]) + number(&kind["pixel"]["cczCount"]))
            );
        }
    }
}

#[test]
fn logical_counts_of_an_asked_accuracy_take_the_queries_that_are_planned() {
    // Remove the parameters that a plan chooses.
    let scene = SCENE.replace("path_bits: 6, ", "");
    let (scene, _) = scene.split_once("precision").unwrap();
    let folder = Folder::with("floor.yaml", scene);
    let asked = ["--set", "accuracy={ error: 0.2, confidence: 0.9 }"];
    let counts = logical_counts(&folder, &asked);
    let (plan, queries) = (&counts["plan"], &counts["queries"]);
    let planned: [f64; 3] = serde_json::from_value(plan["channel_queries"].clone()).unwrap();
    let sum: f64 = planned.iter().sum();
    assert!((sum - plan["queries"].as_f64().unwrap()).abs() < 1e-9 * sum);
    assert_eq!(number(&queries["channel"]), planned[0].ceil() as u64);
    let pixel: f64 = planned.iter().map(|queries| queries.ceil()).sum();
    assert_eq!(number(&queries["pixel"]), pixel as u64);
    // Channels stop by themselves, well before they have used all that they may.
    let most = ((1_u64 << number(&plan["phase_bits"])) - 1) * number(&plan["repetitions"]);
    assert!(
        2.0 * planned[0] < most as f64,
        "{planned:?}, at most {most}"
    );
    let index = number(&plan["path_bits"]) + number(&plan["comparator_bits"]);
    let measured = number(&counts["unitary"]["channel"]["measurementCount"]);
    assert_eq!(measured, number(&queries["channel"]) * index);
    assert!(
        counts["assumed"]["queries"]
            .as_str()
            .unwrap()
            .contains("planned")
    );
}

#[test]
fn logical_counts_leave_out_what_is_not_counted() {
    let folder = folder();
    let one = logical_counts(
        &folder,
        &["--set", "materials.sky.emitter.radiance=[1, 0, 0]"],
    );
    assert_eq!(one["queries"]["pixel"], one["queries"]["channel"]);
    assert_eq!(one["unitary"]["pixel"], one["unitary"]["channel"]);
    let arguments = ["inspect", "floor.yaml", "--logical-counts", "new.json"];
    let refused = |set: &str| folder.fails(2, &[&arguments[..], &["--set", set]].concat());
    let errors = refused("counting.estimator=exact");
    assert!(
        errors.contains("`exact` does not only iterate G"),
        "{errors}"
    );
    let errors = refused("counting={ phase_bits: 40, repetitions: 1000000 }");
    assert!(errors.contains("more gates than 2^64"), "{errors}");
    assert_eq!(folder.names(), ["counts.json", "floor.yaml"]);
}

#[test]
fn a_budget_beyond_which_a_circuit_goes_is_an_error_at_its_place() {
    let text = format!("{SCENE}budget: {{ qubits: 9, toffoli: 7 }}\n");
    let folder = Folder::with("floor.yaml", &text);
    let output = folder.qrt(&["inspect", "floor.yaml", "--json"]);
    assert_eq!(output.status.code(), Some(2));
    // The figures that the user needs to change the scene.
    let answer: Value = serde_json::from_slice(&output.stdout).unwrap();
    let errors = String::from_utf8(output.stderr).unwrap();
    let grouped = |value| qrt::core::inspect::grouped(number(value));
    for expected in [
        "error[QRT0601]: the circuit has ",
        &format!("has {} qubits, ", grouped(&answer["qubits"]["peak"])),
        "--> floor.yaml:13:19",
        "^ at most 9",
        "`circuit.uncompute: auto`",
        "error[QRT0602]: the circuit has ",
        &format!(
            "has {} Toffoli gates, ",
            grouped(&answer["gates"]["toffoli"])
        ),
        "--> floor.yaml:13:31",
        "`precision.fraction`",
        "floor.yaml: 2 errors",
    ] {
        assert!(errors.contains(expected), "{expected}:\n{errors}");
    }
    // A single figure, given on the command line.
    let sets = ["--set", "budget={ qubits: 100000, toffoli: 8 }"];
    let errors = folder.fails(2, &["inspect", "floor.yaml", sets[0], sets[1]]);
    assert!(errors.contains("--> <--set>:1:"), "{errors}");
    assert!(
        errors.contains("QRT0602") && !errors.contains("QRT0601"),
        "{errors}"
    );
    folder.works(&[
        "inspect",
        "floor.yaml",
        "--set",
        "budget={ qubits: 100000, toffoli: 10000000 }",
    ]);
}

#[test]
fn a_limit_that_is_met_exactly_is_kept() {
    let answer = json(&folder(), &["floor.yaml"]);
    let (qubits, toffoli) = (
        number(&answer["qubits"]["peak"]),
        number(&answer["gates"]["toffoli"]),
    );
    let set = |qubits, toffoli| format!("budget={{ qubits: {qubits}, toffoli: {toffoli} }}");
    folder().works(&["inspect", "floor.yaml", "--set", &set(qubits, toffoli)]);
    let errors = folder().fails(
        2,
        &["inspect", "floor.yaml", "--set", &set(qubits - 1, toffoli)],
    );
    assert!(errors.contains("1 more than the budget allows"), "{errors}");
}

#[test]
fn files_that_cannot_be_written_are_known_before_the_work() {
    let folder = folder();
    let inspect =
        |code, more: &[&str]| folder.fails(code, &[&["inspect", "floor.yaml"][..], more].concat());
    assert!(inspect(1, &["--registers", "none/map.svg"]).contains("there is no folder `none`"));
    fs::create_dir(folder.path("map.svg")).unwrap();
    assert!(inspect(2, &["--registers", "map.svg"]).contains("is a folder"));
    assert!(inspect(2, &["--circuit", "floor.yaml"]).contains("two different things"));
    assert!(inspect(2, &["--circuit", "a.svg", "--registers", "a.svg"]).contains("two different"));
    assert!(inspect(2, &["--logical-counts", "floor.yaml"]).contains("two different things"));
    let twice = ["--logical-counts", "a", "--circuit", "a"];
    assert!(inspect(2, &twice).contains("two different things"));
    assert!(inspect(2, &["--logical-counts", "a", "--pareto"]).contains("cannot be used with"));
    assert!(inspect(2, &["--circuit", "-", "--json"]).contains("`--circuit -`"));
    assert!(inspect(2, &["--channel", "x"]).contains("possible values: r, g, b"));
    assert_eq!(folder.names(), ["floor.yaml", "map.svg"]);
}

/// Each strategy of the list, given by its name, has the listed figures.
#[test]
fn every_listed_strategy_is_one_that_a_scene_may_name() {
    let folder = folder();
    let pareto: Value = json(&folder, &["floor.yaml", "--pareto", "--channel", "r"]);
    let front = list(&pareto, "front");
    assert!(front.len() > 6, "{}", front.len());
    for (place, layout) in front.iter().enumerate() {
        let name = layout["strategy"].as_str().unwrap();
        let plain = |c: char| c.is_ascii_lowercase() || c == '-';
        assert!(name.chars().all(plain), "{name}");
        // Each takes its time to compile: some of the front, and both its ends.
        if place % 4 == 0 || place + 1 == front.len() {
            let set = format!("circuit.uncompute={name}");
            let found = json(&folder, &["floor.yaml", "--channel", "r", "--set", &set]);
            assert_eq!(found["strategy"].as_str(), Some(name), "{found}");
            assert_eq!(found["qubits"]["peak"], layout["qubits"], "{name}");
            assert_eq!(found["gates"]["toffoli"], layout["toffoli"], "{name}");
        }
    }
    let text = folder.works(&["inspect", "floor.yaml", "--pareto", "--channel", "r"]);
    for layout in front {
        let name = layout["strategy"].as_str().unwrap();
        assert!(
            text.lines()
                .any(|line| line.ends_with(&format!("  {name}"))),
            "{text}"
        );
    }
    for jargon in ["xyz", "ghost", "nobody", "garbage"] {
        assert!(!text.contains(jargon), "{text}");
    }
    for (wrong, says) in [
        ("plane-floor", "no part of a strategy is called `floor`"),
        ("planes", "did you mean `plane`?"),
        ("keep-plane", "no part of a strategy is called `keep`"),
        ("scopd", "did you mean `scoped`?"),
    ] {
        let set = format!("circuit.uncompute={wrong}");
        let errors = folder.fails(2, &["inspect", "floor.yaml", "--set", &set]);
        assert!(errors.contains(says), "{errors}");
    }
}

#[test]
fn the_front_goes_together_with_drawings() {
    let folder = folder();
    let all = [
        "inspect",
        "floor.yaml",
        "--pareto",
        "--pareto-plot",
        "front.svg",
        "--circuit",
        "c.svg",
        "--registers",
        "r.svg",
    ];
    let said = folder.works(&all);
    assert!(said.contains("those that no other beats"), "{said}");
    assert_eq!(
        folder.names(),
        ["c.svg", "floor.yaml", "front.svg", "r.svg"]
    );
    for drawing in ["c.svg", "r.svg"] {
        let by_itself = format!("own-{drawing}");
        let flag = if drawing == "c.svg" {
            "--circuit"
        } else {
            "--registers"
        };
        folder.works(&["inspect", "floor.yaml", flag, &by_itself]);
        assert_eq!(folder.read(drawing), folder.read(&by_itself));
    }
    let drawn = folder.works(&["inspect", "floor.yaml", "--pareto", "--circuit", "-"]);
    assert!(
        drawn.starts_with(said.trim_end()) && drawn.len() > said.len() + 100,
        "{drawn}"
    );
    // The longest name beside the panel ends within the drawing: 26 letters of at least 7 units.
    let plot = String::from_utf8(folder.read("front.svg")).unwrap();
    let view = plot.split("viewBox=\"0 0 ").nth(1).unwrap();
    let width: f64 = view.split(' ').next().unwrap().parse().unwrap();
    assert!(width >= 452.0 + 26.0 * 7.0, "{width}");
}

#[test]
fn drawings_are_xml_and_show_every_register_and_box() {
    let folder = folder();
    for how in ["keep", "scoped"] {
        let set = format!("circuit.uncompute={how}");
        let drawn = [
            "--registers",
            "map.svg",
            "--circuit",
            "frame.svg",
            "--set",
            &set,
        ];
        let answer = json(&folder, &[&["floor.yaml"][..], &drawn].concat());
        let [map, frame] = ["map.svg", "frame.svg"].map(|name| folder.read(name));
        let [map, frame] = [map, frame].map(|bytes| String::from_utf8(bytes).unwrap());
        let [map, frame] = [&map, &frame].map(|text| roxmltree::Document::parse(text).unwrap());
        let titles = |drawing: &roxmltree::Document<'_>| -> Vec<String> {
            let titles = drawing
                .descendants()
                .filter(|node| node.has_tag_name(("http://www.w3.org/2000/svg", "title")));
            titles.map(|node| node.text().unwrap().to_owned()).collect()
        };
        let shown = titles(&map);
        for register in list(&answer, "registers") {
            let begin = format!(
                "{}: {}",
                register["name"].as_str().unwrap(),
                register["type"].as_str().unwrap()
            );
            assert!(
                shown.iter().any(|title| title.starts_with(&begin)),
                "{begin}"
            );
        }
        let boxes = titles(&frame);
        for name in [
            "Generate Ray 0",
            "Find Intersection 1",
            "Find Intersection 1\u{2020}",
            "Compare",
            "Z",
        ] {
            assert!(
                boxes
                    .iter()
                    .any(|title| title.starts_with(&format!("{name}: "))),
                "{name}"
            );
        }
        for drawing in [map, frame] {
            for node in drawing.descendants() {
                for name in ["x", "y", "width", "height"] {
                    let value: f64 = node.attribute(name).unwrap_or("0").parse().unwrap();
                    assert!(value.is_finite() && value >= 0.0);
                }
            }
        }
    }
}

#[test]
fn drawings_of_large_circuits_stay_small() {
    let folder = Folder::new();
    // A circuit of many qubits, and one with many short-lived registers.
    for (scene, how) in [("velvet", "keep"), ("cornell-ggx", "scoped")] {
        let scene = example(scene);
        let set = format!("circuit.uncompute={how}");
        let arguments = ["inspect", &scene, "--set", &set];
        let drawn = ["--registers", "map.svg", "--circuit", "frame.svg"];
        folder.works(&[&arguments[..], &drawn].concat());
        for name in ["map.svg", "frame.svg"] {
            let bytes = folder.read(name);
            assert!(bytes.len() < 2_000_000, "{how} {name}: {}", bytes.len());
            roxmltree::Document::parse(std::str::from_utf8(&bytes).unwrap()).unwrap();
        }
    }
}
