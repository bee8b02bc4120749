//! Tests of `qrt render --portion` and `qrt merge`: the parts give the picture of one render, or an
//! error.

use crate::common::command::Folder;
use serde_json::Value;
use std::fs;

const BOX: &str = include_str!("../scenes/box.yaml");

/// Returns a box whose lamp is sampled: pixels that see it have another scale than the others.
fn aiming() -> String {
    let text = BOX.replace("  lights: none\n", "");
    text.replace("{ bits: [8, 8] }]", "{ bits: [8, 8], light: [4, 4] }]")
}

/// Returns the box without the parameters that an accuracy replaces.
fn accurate() -> String {
    let text = BOX.replace("  path_bits: 10\n", "");
    let text = text.lines().filter(|line| !line.starts_with("counting"));
    let text = text.collect::<Vec<_>>().join("\n");
    // Each part plans by itself, for a time that grows with the film.
    let text = text.replace("width: 13, height: 11", "width: 5, height: 4");
    format!("{text}\naccuracy: {{ error: 0.3, confidence: 0.9 }}\n")
}

/// Renders all parts, each with another number of threads; returns their names in a shuffled order.
fn parts(folder: &Folder, count: usize, options: &[&str]) -> Vec<String> {
    let names: Vec<String> = (0..count).map(|index| format!("part.{index}")).collect();
    for (index, name) in names.iter().enumerate() {
        let portion = format!("{index}/{count}");
        let threads = (1 + index % 3).to_string();
        let own = [
            "render",
            "box.yaml",
            "-q",
            "--portion",
            &portion,
            "-o",
            name,
        ];
        folder.works(&[&own[..], &["--threads", &threads], options].concat());
    }
    let mut shuffled: Vec<usize> = (0..count).collect();
    shuffled.sort_unstable_by_key(|index| (index * 7 + 3) % 11);
    shuffled
        .into_iter()
        .map(|index| names[index].clone())
        .collect()
}

/// Returns the statistics without times.
fn timeless(folder: &Folder, name: &str) -> Value {
    let mut stats: Value = serde_json::from_slice(&folder.read(name)).unwrap();
    for key in [
        "seconds",
        "paths_per_second",
        "threads",
        "peak_memory_bytes",
    ] {
        assert!(stats[key].is_number(), "{key}");
        stats[key] = Value::Null;
    }
    stats
}

fn merged(folder: &Folder, parts: &[String], options: &[&str]) -> Vec<u8> {
    let parts = parts.iter().map(String::as_str);
    let mut arguments = vec!["merge"];
    arguments.extend(parts);
    arguments.extend(options);
    folder.works(&arguments).into_bytes()
}

#[test]
fn parts_merge_to_the_files_of_one_render() {
    let cases: [(&str, usize, &[&str]); 8] = [
        (BOX, 1, &["--estimator", "exact"]),
        (BOX, 5, &["--estimator", "exact", "--seed", "7"]),
        // Each part is one pixel.
        (BOX, 6, &["--estimator", "paper", "--crop", "3,2,3,2"]),
        (&aiming(), 4, &["--estimator", "adaptive-bayes"]),
        (
            &aiming(),
            3,
            &[
                "--model",
                "fixed",
                "--crop",
                "2,3,9,5",
                "--estimator",
                "sine",
            ],
        ),
        (
            BOX,
            4,
            &[
                "--colour",
                "one-run",
                "--noise",
                "depolarising=0.001,readout=0.01",
            ],
        ),
        (
            BOX,
            3,
            &[
                "--model",
                "fixed",
                "--visibility",
                "grover",
                "--set",
                "sampling.path_bits=4",
            ],
        ),
        (&accurate(), 2, &[]),
    ];
    for (number, (scene, count, options)) in cases.into_iter().enumerate() {
        let folder = Folder::with("box.yaml", scene);
        let pictures = [("png", &["--exposure", "-1"][..]), ("exr", &[])];
        let (picture, own) = pictures[number % 2];
        let [whole, again] = ["whole", "again"].map(|name| format!("{name}.{picture}"));
        let files = ["--counts", "whole.csv", "--stats", "whole.json", "-q"];
        let arguments = [&["render", "box.yaml", "-o", &whole], options, &files, own];
        folder.works(&arguments.concat());
        let parts = parts(&folder, count, options);
        let files = [
            "-o",
            &again,
            "--counts",
            "again.csv",
            "--stats",
            "again.json",
        ];
        merged(&folder, &parts, &[&files[..], own].concat());
        assert_eq!(folder.read(&whole), folder.read(&again), "{options:?}");
        assert_eq!(
            folder.read("whole.csv"),
            folder.read("again.csv"),
            "{options:?}"
        );
        let [one, other] = ["whole.json", "again.json"].map(|name| timeless(&folder, name));
        assert_eq!(one, other, "{options:?}");
        let left = folder.names();
        assert!(
            left.iter().all(|name| !name.contains("partial")),
            "{left:?}"
        );
    }
}

#[test]
fn every_part_has_its_fraction_of_the_pixels() {
    let folder = Folder::with("box.yaml", BOX);
    for (index, pixels) in [36, 36, 36, 35].into_iter().enumerate() {
        let portion = format!("{index}/4");
        let said = folder.works(&["render", "box.yaml", "--portion", &portion, "-o", "part"]);
        let expected = format!("part: part {portion} of the picture, {pixels} pixels, ");
        assert!(said.starts_with(&expected), "{said}");
        let paths = format!(" {} paths in ", pixels << 10);
        assert!(said.contains(&paths), "{said}");
    }
}

#[test]
fn parts_that_make_no_picture_are_named_and_nothing_is_written() {
    let folder = Folder::with("box.yaml", BOX);
    parts(&folder, 4, &[]);
    let other = ["render", "box.yaml", "-q", "--portion"];
    for (portion, name, options) in [
        ("1/4", "seed", &["--seed", "1"][..]),
        (
            "1/4",
            "scene",
            &["--set", "materials.lamp.emitter.radiance=[12, 9, 7]"],
        ),
        ("1/4", "estimator", &["--estimator", "paper"]),
        ("1/4", "crop", &["--crop", "0,0,13,10"]),
        ("1/5", "parts", &[]),
    ] {
        folder.works(&[&other[..], &[portion, "-o", name], options].concat());
    }
    folder.works(&["render", "box.yaml", "-q", "-o", "box.png"]);
    fs::write(folder.path("empty"), "").unwrap();
    let before = folder.names();
    let fails = |names: &str, expected: &[&str]| {
        let names: Vec<&str> = names.split(' ').collect();
        let files = ["-o", "p.exr", "--counts", "p.csv", "--stats", "p.json"];
        let errors = folder.fails(1, &[&["merge"], &names[..], &files].concat());
        for expected in expected {
            assert!(errors.contains(expected), "{names:?}: {errors}");
        }
        assert_eq!(folder.names(), before);
    };
    fails("part.0 part.1 part.3", &["1 of 4 parts is missing: 2/4"]);
    fails("part.3", &["3 of 4 parts are missing: 0/4, 1/4, 2/4"]);
    fails(
        "part.0 part.1 part.2 part.3 part.1",
        &["`part.1` and `part.1` are both part 1/4"],
    );
    for (name, reason) in [
        ("seed", "seed: 1 and 0"),
        ("scene", "scene: "),
        ("estimator", "estimator: paper and sine"),
        ("crop", "crop: 0,0,13,10 and 0,0,13,11"),
        ("parts", "parts: 5 and 4"),
    ] {
        let both = format!("`{name}` and `part.0` are parts of different pictures");
        fails(&format!("part.0 {name} part.2 part.3"), &[&both, reason]);
    }
    for name in ["box.yaml", "box.png", "empty"] {
        let foreign = format!("`{name}` is no part of a picture");
        fails(&format!("part.0 part.1 {name} part.3"), &[&foreign]);
    }
    fails("part.0 part.1 lost part.3", &["`lost`: "]);
}

#[test]
fn a_changed_byte_anywhere_is_noticed() {
    let folder = Folder::with("box.yaml", BOX);
    let names = parts(&folder, 2, &["--crop", "0,0,3,2"]);
    let whole = folder.read("part.1");
    let refused = |bytes: &[u8]| {
        fs::write(folder.path("part.1"), bytes).unwrap();
        let arguments = ["merge", &names[0], &names[1], "-o", "p.exr"];
        let errors = folder.fails(1, &arguments);
        assert!(errors.contains("`part.1`"), "{errors}");
        assert!(!folder.path("p.exr").exists());
        errors
    };
    for place in (0..whole.len()).step_by(13).chain([whole.len() - 1]) {
        let mut bytes = whole.clone();
        bytes[place] ^= 1 << (place % 8);
        refused(&bytes);
    }
    for length in [0, 4, 100, whole.len() / 2, whole.len() - 1] {
        refused(&whole[..length]);
    }
    refused(&[&whole[..], b"\0"].concat());
    let twice = refused(&[&whole[..], &whole[..]].concat());
    assert!(
        twice.contains("is damaged: render this part again"),
        "{twice}"
    );
    fs::write(folder.path("part.1"), &whole).unwrap();
    merged(&folder, &names, &["-o", "p.exr"]);
}

#[test]
fn what_is_no_part_of_a_picture_is_not_rendered() {
    let folder = Folder::with("box.yaml", BOX);
    for (arguments, reason) in [
        (
            "--portion 4/4 -o part",
            "there is no portion 4 of 4: they are 0/4 to 3/4",
        ),
        (
            "--portion 0/0 -o part",
            "a picture is not cut into 0 portions",
        ),
        (
            "--portion 1 -o part",
            "`1` is not K/N, such as 0/4 for the first of four",
        ),
        ("--portion -1/4 -o part", "is not K/N"),
        ("--portion 0/4294967296 -o part", "is not K/N"),
        (
            "--portion 0/144 -o part",
            "143 pixels can't be cut into 144 portions",
        ),
        ("--portion 0/4", "--output"),
        (
            "--portion 0/4 -o part.png",
            "and part 0/4 of one is none: give it another ending",
        ),
        (
            "--portion 0/4 -o part.exr",
            "and part 0/4 of one is none: give it another ending",
        ),
        (
            "--portion 0/4 -o part --stats s.json",
            "cannot be used with",
        ),
        (
            "--portion 0/4 -o part --counts c.csv",
            "cannot be used with",
        ),
        ("--portion 0/4 -o part --exposure 1", "cannot be used with"),
        ("--portion 0/4 -o box.yaml", "used for two different things"),
    ] {
        let arguments: Vec<&str> = ["render", "box.yaml"]
            .into_iter()
            .chain(arguments.split(' '))
            .collect();
        let errors = folder.fails(2, &arguments);
        assert!(errors.contains(reason), "{arguments:?}: {errors}");
        assert_eq!(folder.names(), ["box.yaml"]);
    }
}

#[test]
fn a_merge_writes_over_no_part() {
    let folder = Folder::with("box.yaml", BOX);
    parts(&folder, 2, &[]);
    fs::copy(folder.path("part.1"), folder.path("one.png")).unwrap();
    let part = folder.read("one.png");
    for arguments in [
        "part.0 one.png -o ./one.png",
        "part.0 one.png -o p.png --counts one.png",
        "part.0 one.png -o p.png --stats p.png",
    ] {
        let arguments: Vec<&str> = ["merge"].into_iter().chain(arguments.split(' ')).collect();
        let errors = folder.fails(2, &arguments);
        assert!(errors.contains("used for two different things"), "{errors}");
        assert_eq!(folder.read("one.png"), part);
    }
    let errors = folder.fails(2, &["merge", "part.0", "one.png", "-o", "p.jpg"]);
    assert!(errors.contains("p.jpg"), "{errors}");
    let errors = folder.fails(
        2,
        &[
            "merge",
            "part.0",
            "one.png",
            "-o",
            "p.png",
            "--max-memory",
            "4k",
        ],
    );
    assert!(
        errors.contains("merging these parts would take about"),
        "{errors}"
    );
    merged(
        &folder,
        &["part.0".into(), "one.png".into()],
        &["-o", "p.png", "-q"],
    );
}

/// An interrupted part is not complete; `--resume` completes it.
#[cfg(unix)]
#[test]
fn an_interrupted_part_goes_on() {
    use crate::common::command::signalled;
    let folder = Folder::with("box.yaml", BOX);
    let slow = ["--estimator", "exact", "--set", "sampling.path_bits=15"];
    folder.works(&[&["render", "box.yaml", "-q", "-o", "whole.exr"], &slow[..]].concat());
    let portion = |index| ["render", "box.yaml", "-q", "--portion", index, "-o"];
    let one = [&portion("1/2")[..], &["part.1"], &slow].concat();
    folder.works(&[&portion("0/2")[..], &["part.0"], &slow].concat());
    let child = folder.started(&one);
    let partial = folder.path("part.1.qrt-partial");
    while fs::metadata(&partial).map_or(0, |found| found.len()) < 1024 {
        std::thread::sleep(std::time::Duration::from_millis(1));
    }
    let (code, _, errors) = signalled(child, "-INT");
    assert_eq!(code, Some(1), "{errors}");
    assert!(errors.contains(" of 71 pixels, which `"), "{errors}");
    assert!(!folder.path("part.1").exists());
    let errors = folder.fails(1, &["merge", "part.0", "part.1.qrt-partial", "-o", "p.exr"]);
    let expected = "`part.1.qrt-partial`, part 1/2, is not whole";
    assert!(errors.contains(expected), "{errors}");
    // Neither another part nor the whole picture resumes from it.
    let errors = folder.fails(
        2,
        &[&portion("0/2")[..], &["part.1", "--resume"], &slow].concat(),
    );
    assert!(errors.contains("portion: there 1/2, here 0/2"), "{errors}");
    folder.works(&[&one[..], &["--resume"]].concat());
    assert!(!partial.exists());
    merged(
        &folder,
        &["part.1".into(), "part.0".into()],
        &["-o", "p.exr"],
    );
    assert_eq!(folder.read("p.exr"), folder.read("whole.exr"));
}
