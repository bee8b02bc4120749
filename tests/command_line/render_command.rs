//! Tests of `qrt render` from the outside.

use crate::common::command::Folder;
use exr::meta::attribute::AttributeValue;
use exr::prelude as openexr;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

const BOX: &str = include_str!("../scenes/box.yaml");
/// Number of pixels: 13 x 11.
const PIXELS: usize = 143;

fn folder() -> Folder {
    Folder::with("box.yaml", BOX)
}

/// Returns the width, the pixels by row, and the metadata without its prefix.
pub(super) fn read_exr(path: &Path) -> (usize, Vec<[f32; 3]>, BTreeMap<String, String>) {
    let read = openexr::read_first_rgba_layer_from_file(
        path,
        |size, _| (size.x(), vec![[0.0; 3]; size.area()]),
        |(width, pixels), at, (r, g, b, _): (f32, f32, f32, f32)| {
            pixels[at.y() * *width + at.x()] = [r, g, b];
        },
    );
    let layer = read.unwrap().layer_data;
    let metadata = layer.attributes.other.iter().filter_map(|(name, value)| {
        let name = name.to_string().strip_prefix("qrt:")?.to_owned();
        let AttributeValue::Text(text) = value else {
            return None;
        };
        Some((name, String::from_utf8(text.as_slice().to_vec()).unwrap()))
    });
    let metadata = metadata.collect();
    let (width, pixels) = layer.channel_data.pixels;
    (width, pixels, metadata)
}

fn stats(folder: &Folder, name: &str) -> Value {
    serde_json::from_slice(&folder.read(name)).unwrap()
}

#[test]
fn a_scene_becomes_a_picture_in_the_current_folder_and_nothing_else() {
    let folder = Folder::new();
    fs::create_dir(folder.path("scenes")).unwrap();
    fs::write(folder.path("scenes/box.yaml"), BOX).unwrap();
    let said = folder.works(&["render", "scenes/box.yaml"]);
    assert_eq!(folder.names(), ["box.png", "scenes"]);
    assert!(
        said.starts_with("box.png: 13 x 11 pixels, 146432 paths in "),
        "{said}"
    );
    assert!(said.contains("estimator sine, 54483 queries"), "{said}");
    let decoder = png::Decoder::new(std::io::Cursor::new(folder.read("box.png")));
    let reader = decoder.read_info().unwrap();
    assert_eq!((reader.info().width, reader.info().height), (13, 11));
    let quiet = folder.qrt(&["render", "-q", "scenes/box.yaml"]);
    assert!(quiet.status.success() && quiet.stdout.is_empty() && quiet.stderr.is_empty());
}

#[test]
fn two_runs_give_the_same_files() {
    let folder = folder();
    for estimator in ["exact", "sine", "paper", "monte-carlo"] {
        for extension in ["png", "exr"] {
            let names = ["1", "2"].map(|n| format!("{n}.{extension}"));
            for (name, threads) in names.iter().zip(["1", "3"]) {
                let options = ["--estimator", estimator, "--threads", threads, "-o", name];
                let options = [&["render", "box.yaml", "--counts", "c.csv"], &options[..]].concat();
                folder.works(&options);
                fs::rename(folder.path("c.csv"), folder.path(format!("{name}.csv"))).unwrap();
            }
            let [first, second] = &names;
            assert_eq!(folder.read(first), folder.read(second));
            let csv = |name: &String| folder.read(&format!("{name}.csv"));
            assert_eq!(csv(first), csv(second));
        }
    }
}

#[test]
fn a_large_picture_without_an_estimator_tells_by_which_it_is_counted() {
    let counting = BOX.lines().find(|line| line.starts_with("counting:"));
    let text = BOX.replace(counting.unwrap(), "").replace(
        "film: { width: 13, height: 11 }",
        "film: { width: 65, height: 64 }",
    );
    let folder = Folder::with("box.yaml", &text);
    let render = |more: &[&str]| {
        let set = ["render", "box.yaml", "--set", "sampling.path_bits=2"];
        let output = folder.qrt(&[&set[..], more].concat());
        assert!(output.status.success(), "{more:?}");
        [output.stdout, output.stderr].map(|text| String::from_utf8(text).unwrap())
    };
    let note = "no `counting.estimator`: a film of 65 x 64 pixels is counted by `sine`";
    let [said, notes] = render(&[]);
    assert!(said.contains("estimator sine"), "{said}");
    assert!(notes.contains(note), "{notes}");
    for more in [
        &["--estimator", "sine"][..],
        &["--set", "counting.estimator=sine"],
        &["--visibility", "exhaustive", "--model", "fixed"],
    ] {
        assert!(!render(more)[1].contains("is counted by"), "{more:?}");
    }
    let small = render(&["--set", "film.width=5", "--set", "film.height=4"]);
    assert!(
        small[0].contains("estimator auto") && !small[1].contains("is counted by"),
        "{small:?}"
    );
}

#[test]
fn counts_are_what_the_picture_shows() {
    let folder = folder();
    for (estimator, crop) in [("exact", None), ("sine", Some("2,3,5,4"))] {
        let mut arguments = vec![
            "render",
            "box.yaml",
            "--estimator",
            estimator,
            "-o",
            "p.exr",
        ];
        arguments.extend(["--counts", "c.csv", "--stats", "s.json"]);
        arguments.extend(crop.into_iter().flat_map(|crop| ["--crop", crop]));
        folder.works(&arguments);
        let (width, pixels, _) = read_exr(&folder.path("p.exr"));
        let (left, top) = if crop.is_some() { (2, 3) } else { (0, 0) };
        let bound = stats(&folder, "s.json")["bound_rgb"].clone();
        let text = String::from_utf8(folder.read("c.csv")).unwrap();
        let mut lines = text.lines();
        assert_eq!(lines.next(), Some("x,y,channel,value,good,total,scale"));
        for (number, line) in lines.by_ref().take(3 * pixels.len()).enumerate() {
            let (pixel, channel) = (number / 3, number % 3);
            let [x, y, name, value, good, total, scale] =
                <[&str; 7]>::try_from(line.split(',').collect::<Vec<_>>()).unwrap();
            assert_eq!(x.parse::<usize>().unwrap(), left + pixel % width);
            assert_eq!(y.parse::<usize>().unwrap(), top + pixel / width);
            assert_eq!(name, ["r", "g", "b"][channel]);
            assert_eq!(value.parse::<f64>().unwrap() as f32, pixels[pixel][channel]);
            let digits = value
                .split('e')
                .next()
                .unwrap()
                .matches(char::is_numeric)
                .count();
            assert_eq!(digits, 17, "{value}");
            assert_eq!(good, "");
            assert_eq!(total, (1_u64 << 20).to_string());
            assert_eq!(
                scale.parse::<f64>().unwrap(),
                bound[channel].as_f64().unwrap()
            );
        }
        assert_eq!(lines.next(), None);
    }
}

#[test]
fn pictures_say_how_they_were_made() {
    let folder = folder();
    let options = [
        "--seed",
        "18446744073709551615",
        "--crop",
        "1,2,3,4",
        "--stats",
        "s.json",
    ];
    for (name, estimator) in [("p.png", "paper"), ("p.exr", "paper"), ("e.exr", "exact")] {
        let own = ["render", "box.yaml", "-o", name, "--estimator", estimator];
        folder.works(&[&own[..], &options[..]].concat());
        let stats = stats(&folder, "s.json");
        let found: BTreeMap<String, String> = if name == "p.png" {
            let read = qrt::runtime::image::read_png_metadata(&folder.path(name)).unwrap();
            read.iter()
                .map(|(k, v)| (k.to_owned(), v.to_owned()))
                .collect()
        } else {
            read_exr(&folder.path(name)).2
        };
        let queries = stats["oracle_queries"].to_string();
        let mut expected = vec![
            ("version", env!("CARGO_PKG_VERSION")),
            ("scene", "box \"ä\""),
            ("scene_hash", stats["scene_hash"].as_str().unwrap()),
            ("model", "real"),
            ("estimator", estimator),
            ("seed", "18446744073709551615"),
            ("sequence", "digital-net"),
            ("path_bits", "10"),
            ("depths", "3"),
            ("film", "13x11"),
            ("crop", "1,2,3,4"),
            ("queries", &queries),
        ];
        if estimator == "paper" {
            expected.extend([("comparator_bits", "10"), ("comparator_at", "midpoints")]);
            expected.extend([
                ("phase_bits", "7"),
                ("repetitions", "1"),
                ("colour", "three-runs"),
                ("noise", "depolarising=0,readout=0"),
            ]);
        }
        if name == "p.png" {
            expected.push(("exposure", "0"));
        }
        let own = |(key, value): (&str, &str)| (key.to_owned(), value.to_owned());
        assert_eq!(found, expected.into_iter().map(own).collect());
    }
}

#[test]
fn stats_tell_the_cost() {
    let folder = folder();
    let set = "sampling.path_bits=8";
    let arguments = [
        "render",
        "box.yaml",
        "--set",
        set,
        "--seed",
        "9",
        "--threads",
        "2",
    ];
    folder.works(&[&arguments[..], &["--stats", "s.json", "-o", "p.exr"]].concat());
    let stats = stats(&folder, "s.json");
    for (key, value) in [
        ("version", json!(2)),
        ("qrt", json!(env!("CARGO_PKG_VERSION"))),
        ("scene", json!("box \"ä\"")),
        ("model", json!("real")),
        ("estimator", json!("sine")),
        ("seed", json!(9)),
        ("width", json!(13)),
        ("height", json!(11)),
        ("crop", json!([0, 0, 13, 11])),
        ("depths", json!(3)),
        ("path_bits", json!(8)),
        ("paths", json!(PIXELS << 8)),
        ("paths_resumed", json!(0)),
        ("oracle_queries", json!(PIXELS * 3 * 127)),
        ("clipped_pixels", json!(0)),
        ("threads", json!(2)),
    ] {
        assert_eq!(stats[key], value, "{key}");
    }
    let seconds = stats["seconds"].as_f64().unwrap();
    let speed = stats["paths_per_second"].as_f64().unwrap();
    assert!((seconds * speed / (PIXELS << 8) as f64 - 1.0).abs() < 1e-9);
    if cfg!(target_os = "linux") && !stats["peak_memory_bytes"].is_null() {
        assert!(stats["peak_memory_bytes"].as_u64().unwrap() > 1 << 20);
    }
    let (_, pixels, _) = read_exr(&folder.path("p.exr"));
    for channel in 0..3 {
        let sum: f64 = pixels.iter().map(|pixel| f64::from(pixel[channel])).sum();
        let mean = stats["mean_rgb"][channel].as_f64().unwrap();
        assert!((sum / PIXELS as f64 - mean).abs() < 1e-6 * mean);
        let bound = stats["bound_rgb"][channel].as_f64().unwrap();
        assert!(
            pixels
                .iter()
                .all(|pixel| f64::from(pixel[channel]) <= bound)
        );
    }
}

#[test]
fn exposure_is_for_png() {
    let folder = folder();
    let mut levels = Vec::new();
    for exposure in ["-3", "0", "2.5"] {
        let options = ["--estimator", "exact", "--exposure", exposure];
        folder.works(&[&["render", "box.yaml"], &options[..]].concat());
        let decoder = png::Decoder::new(std::io::Cursor::new(folder.read("box.png")));
        let mut reader = decoder.read_info().unwrap();
        let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut bytes).unwrap();
        levels.push(bytes.iter().map(|&b| u64::from(b)).sum::<u64>());
    }
    assert!(levels[0] < levels[1] && levels[1] < levels[2]);
    let arguments = ["render", "box.yaml", "-o", "p.exr", "--exposure", "1"];
    assert!(folder.fails(2, &arguments).contains("no exposure"));
}

#[test]
fn wrong_requests_exit_with_2_and_leave_nothing() {
    let folder = folder();
    for (arguments, words) in [
        (&["missing.yaml"][..], "QRT0101"),
        (&["box.yaml", "--set", "film.widt=3"], "QRT0120"),
        (&["box.yaml", "--set", "film"], "QRT0901"),
        (&["box.yaml", "-o", "p.jpg"], "`.png` or `.exr`"),
        (&["box.yaml", "-o", "p"], "`.png` or `.exr`"),
        (&["box.yaml", "--exposure", "NaN"], "stops"),
        (&["box.yaml", "--exposure", "bright"], "--exposure"),
        (&["box.yaml", "--crop", "1,2,3"], "10,20,4,4"),
        (&["box.yaml", "--crop", "1,2,3,-1"], "10,20,4,4"),
        (&["box.yaml", "--crop", "1,2,0,1"], "no pixels"),
        (&["box.yaml", "--crop", "12,0,2,1"], "film of 13 x 11"),
        (
            &["box.yaml", "--crop", "1,1,4294967295,4294967295"],
            "film of 13 x 11",
        ),
        (&["box.yaml", "--threads", "0"], "--threads"),
        (&["box.yaml", "--threads", "99999"], "--threads"),
        (&["box.yaml", "--seed=-1"], "--seed"),
        (
            &["box.yaml", "--model", "abacus"],
            "[possible values: real, fixed, gates]",
        ),
        (
            &[
                "box.yaml",
                "--model",
                "gates",
                "--set",
                "budget={toffoli: 1000}",
            ],
            "QRT0602",
        ),
        (
            &["box.yaml", "--estimator", "best"],
            "exact, monte-carlo, paper, posterior-mean, sine, adaptive-bayes",
        ),
        (
            &["box.yaml", "--set", "counting.estimator=best"],
            "`exact`, `monte-carlo`, `paper`",
        ),
        (&["box.yaml", "--stats", "box.yaml"], "two different things"),
        (&["box.yaml", "--counts", "box.png"], "two different things"),
        (&["box.yaml", "--sed", "1"], "--seed"),
        (&[], "<SCENE>"),
    ] {
        let errors = folder.fails(2, &[&["render"], arguments].concat());
        assert!(errors.contains(words), "{arguments:?}: {errors}");
        assert_eq!(folder.names(), ["box.yaml"], "{arguments:?}");
    }
    assert_eq!(folder.read("box.yaml"), BOX.as_bytes());
    fs::create_dir(folder.path("p.png")).unwrap();
    assert!(
        folder
            .fails(2, &["render", "box.yaml", "-o", "p.png"])
            .contains("a folder")
    );
}

/// Returns the box without the parameters that an accuracy replaces.
fn accurate(error: f64, confidence: f64) -> Folder {
    let text = BOX.replace("  path_bits: 10\n", "");
    let text = text.lines().filter(|line| !line.starts_with("counting"));
    let text = text.collect::<Vec<_>>().join("\n");
    // Planning takes a time that grows with the film.
    let text = text.replace("width: 13, height: 11", "width: 5, height: 4");
    let text = format!("{text}\naccuracy: {{ error: {error}, confidence: {confidence} }}\n");
    Folder::with("box.yaml", &text)
}

#[test]
fn an_accuracy_takes_the_parameters_that_keep_it_and_says_which() {
    let folder = accurate(0.3, 0.9);
    let options = ["-o", "p.exr", "--stats", "s.json"];
    let output = folder.qrt(&[&["render", "box.yaml"], &options[..]].concat());
    assert!(output.status.success());
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(
        said.contains("plan for an error of 0.3 of the mean radiance"),
        "{said}"
    );
    let stats = stats(&folder, "s.json");
    let (parameters, plan) = (&stats["parameters"], &stats["plan"]);
    for parameter in [
        "path_bits",
        "fraction",
        "comparator_bits",
        "phase_bits",
        "repetitions",
    ] {
        assert_eq!(parameters[parameter], plan[parameter], "{parameter}");
        assert!(parameters[parameter].as_u64().unwrap() > 0, "{parameter}");
    }
    assert!(plan["errors"]["total"].as_f64().unwrap() <= 0.3);
    assert!(plan["within"].as_f64().unwrap() >= 0.9);
    assert_eq!(parameters["counting_error"], plan["counting_error"]);
    let (_, _, metadata) = read_exr(&folder.path("p.exr"));
    assert_eq!(metadata["accuracy_error"], "0.3");
    for parameter in ["path_bits", "comparator_bits", "phase_bits", "fraction"] {
        assert_eq!(
            metadata[parameter],
            parameters[parameter].to_string(),
            "{parameter}"
        );
    }
    // The parameters do not depend on the seed and the threads, and the picture is that of the parameters
    // alone.
    let other = [
        "--seed",
        "5",
        "--threads",
        "1",
        "-q",
        "-o",
        "q.exr",
        "--stats",
        "t.json",
    ];
    folder.works(&[&["render", "box.yaml"], &other[..]].concat());
    assert_eq!(self::stats(&folder, "t.json")["plan"], *plan);
    let parameter = |key: &str, name: &str| format!("{key}={}", parameters[name]);
    let estimator = format!("counting.estimator={}", plan["estimator"].as_str().unwrap());
    let sets = [
        estimator,
        parameter("sampling.path_bits", "path_bits"),
        parameter("precision.fraction", "fraction"),
        parameter("comparator.bits", "comparator_bits"),
        parameter("counting.phase_bits", "phase_bits"),
        parameter("counting.repetitions", "repetitions"),
        parameter("counting.error", "counting_error"),
    ];
    let plain = BOX.replace("width: 13, height: 11", "width: 5, height: 4");
    std::fs::write(folder.path("box.yaml"), plain).unwrap();
    let sets = sets.iter().flat_map(|set| ["--set", set.as_str()]);
    let plain = ["render", "box.yaml", "-q", "-o", "r.exr"]
        .into_iter()
        .chain(sets);
    folder.works(&plain.collect::<Vec<_>>());
    assert_eq!(
        read_exr(&folder.path("p.exr")).1,
        read_exr(&folder.path("r.exr")).1
    );
}

#[test]
fn an_accuracy_that_cannot_be_shown_is_refused() {
    let folder = accurate(0.3, 0.999_999_9);
    let errors = folder.fails(2, &["render", "box.yaml"]);
    assert!(errors.contains("`accuracy` cannot be kept"), "{errors}");
    assert_eq!(folder.names(), ["box.yaml"]);
}

#[test]
fn every_error_of_a_scene_is_shown_at_its_place() {
    let text = BOX
        .replace("width: 13", "width: 0")
        .replace("material: red", "material: rde");
    let folder = Folder::with("box.yaml", &text);
    let errors = folder.fails(2, &["render", "box.yaml"]);
    for words in ["QRT0201", "box.yaml:4:16", "QRT0206", "`red`", "2 errors"] {
        assert!(errors.contains(words), "{words}: {errors}");
    }
}

#[test]
fn files_that_cannot_be_written_are_told_before_the_work() {
    let folder = folder();
    for option in ["--output", "--stats", "--counts"] {
        let file = "none/file.png";
        let errors = folder.fails(1, &["render", "box.yaml", option, file]);
        assert!(errors.contains("no folder `none`"), "{errors}");
        assert_eq!(folder.names(), ["box.yaml"]);
    }
    let text = BOX.replace("box \\\"ä\\\"", "nul\\0");
    fs::write(folder.path("nul.yaml"), text).unwrap();
    assert!(folder.fails(2, &["render", "nul.yaml"]).contains("NUL"));
    assert_eq!(folder.names(), ["box.yaml", "nul.yaml"]);
}

#[cfg(target_os = "linux")]
#[test]
fn a_failed_job_exits_with_1_and_loses_no_work() {
    let folder = folder();
    for option in ["--stats", "--counts"] {
        let errors = folder.fails(1, &["render", "box.yaml", option, "/dev/full"]);
        assert!(errors.contains("`/dev/full`: "), "{errors}");
        assert_eq!(
            folder.names(),
            ["box.png", "box.png.qrt-partial", "box.yaml"]
        );
    }
    folder.works(&["render", "box.yaml", "--stats", "s.json", "--resume"]);
    assert_eq!(folder.names(), ["box.png", "box.yaml", "s.json"]);
    let stats = stats(&folder, "s.json");
    assert_eq!(stats["paths_resumed"], stats["paths"]);
}

#[cfg(target_os = "linux")]
#[test]
fn resuming_something_else_is_refused_and_replacing_it_is_said() {
    let folder = folder();
    folder.fails(1, &["render", "box.yaml", "--stats", "/dev/full"]);
    let errors = folder.fails(2, &["render", "box.yaml", "--seed", "1", "--resume"]);
    assert!(errors.contains("seed: there 0, here 1"), "{errors}");
    let set = "materials.white.lambertian.albedo[0]=0.5";
    let errors = folder.fails(2, &["render", "box.yaml", "--set", set, "--resume"]);
    assert!(errors.contains("scene: there "), "{errors}");
    let anew = folder.qrt(&["render", "box.yaml", "--seed", "1"]);
    assert!(anew.status.success());
    assert!(String::from_utf8_lossy(&anew.stderr).contains("--resume"));
    // Without a checkpoint, `--resume` starts from the beginning.
    folder.works(&["render", "box.yaml", "--resume"]);
    assert_eq!(folder.names(), ["box.png", "box.yaml"]);
}

/// The file's header names the build that wrote it: a hash of the sources that decide a picture's bits.
#[cfg(target_os = "linux")]
#[test]
fn a_checkpoint_of_another_build_is_refused_and_left_as_it_was() {
    let folder = folder();
    folder.fails(1, &["render", "box.yaml", "--stats", "/dev/full"]);
    let mut bytes = folder.read("box.png.qrt-partial");
    let name = bytes.windows(5).position(|bytes| bytes == b"build");
    // The value follows the name and the value's length.
    let value = name.unwrap() + 9;
    let here = String::from_utf8(bytes[value..value + 16].to_vec()).unwrap();
    bytes[value] = if bytes[value] == b'0' { b'1' } else { b'0' };
    let there = String::from_utf8(bytes[value..value + 16].to_vec()).unwrap();
    // Correct the checksum, as another build would have written it.
    let length = u32::from_le_bytes(bytes[12..16].try_into().unwrap());
    let end = 16 + length as usize;
    let sum = crc32fast::hash(&bytes[..end]);
    bytes[end..end + 4].copy_from_slice(&sum.to_le_bytes());
    fs::write(folder.path("box.png.qrt-partial"), &bytes).unwrap();
    let errors = folder.fails(2, &["render", "box.yaml", "--resume"]);
    let named = format!("build: there {there}, here {here}\n");
    assert!(errors.contains(&named), "{errors}");
    assert!(
        errors.contains("another build of qrt may compute"),
        "{errors}"
    );
    assert_eq!(folder.read("box.png.qrt-partial"), bytes);
}

/// Size of a checkpoint with the header and at least one tile.
#[cfg(unix)]
const BEGUN: u64 = 2048;

#[cfg(unix)]
#[test]
fn interrupted_by_a_signal_and_resumed_gives_the_same_file() {
    use crate::common::command::signalled;

    let folder = folder();
    let slow = [
        "--set",
        "film={ width: 48, height: 48 }",
        "--set",
        "sampling.path_bits=13",
    ];
    let slow = [&["render", "box.yaml", "-o", "p.png"], &slow[..]].concat();
    folder.works(&slow);
    let expected = folder.read("p.png");
    for (signal, code) in [("-INT", Some(1)), ("-KILL", None)] {
        fs::remove_file(folder.path("p.png")).unwrap();
        let mut child = folder.started(&slow);
        let partial = folder.path("p.png.qrt-partial");
        while fs::metadata(&partial).map_or(0, |found| found.len()) < BEGUN {
            assert!(child.try_wait().unwrap().is_none(), "finished too soon");
            std::thread::sleep(std::time::Duration::from_millis(1));
        }
        let (found, _, errors) = signalled(child, signal);
        assert_eq!(found, code);
        if code.is_some() {
            assert!(errors.contains("interrupted after "), "{errors}");
            assert!(errors.contains("`p.png.qrt-partial`"), "{errors}");
            assert!(errors.contains("--resume"), "{errors}");
        }
        assert_eq!(folder.names(), ["box.yaml", "p.png.qrt-partial"]);
        folder.works(&[&slow[..], &["--resume", "--stats", "s.json"]].concat());
        let stats = folder.path("s.json");
        let resumed: Value = serde_json::from_slice(&fs::read(&stats).unwrap()).unwrap();
        fs::remove_file(stats).unwrap();
        assert!(resumed["paths_resumed"].as_u64().unwrap() > 0);
        assert_eq!(folder.read("p.png"), expected);
        assert_eq!(folder.names(), ["box.yaml", "p.png"]);
    }
}

#[cfg(unix)]
#[test]
fn a_picture_goes_through_a_link_to_a_device() {
    let folder = folder();
    std::os::unix::fs::symlink("/dev/null", folder.path("p.exr")).unwrap();
    folder.works(&["render", "box.yaml", "-o", "p.exr"]);
    assert_eq!(folder.names(), ["box.yaml", "p.exr"]);
}

/// The instruction set changes no byte of a picture, by any model.
#[test]
fn whatever_the_instruction_set_the_picture_is_the_same() {
    use qrt::machines::InstructionSet;

    let folder = folder();
    for model in ["real", "fixed", "gates"] {
        let small = ["--set", "film={ width: 2, height: 2 }", "--model", model];
        let with = |name: &str, set: Option<InstructionSet>| {
            let options = ["render", "box.yaml", "-q", "-o", name];
            let mut command = folder.command(&[&options[..], &small].concat());
            match set {
                Some(set) => command.env(InstructionSet::VARIABLE, set.name()),
                None => command.env_remove(InstructionSet::VARIABLE),
            };
            let output = command.output().unwrap();
            assert!(output.status.success(), "{set:?}: {output:?}");
            folder.read(name)
        };
        let expected = with("widest.exr", None);
        for set in InstructionSet::available() {
            assert!(
                with("forced.exr", Some(set)) == expected,
                "{model}, {set:?}"
            );
        }
    }
    let mut command = folder.command(&["render", "box.yaml"]);
    let output = command
        .env(InstructionSet::VARIABLE, "mmx")
        .output()
        .unwrap();
    assert_eq!(output.status.code(), Some(2));
    let errors = String::from_utf8(output.stderr).unwrap();
    assert!(
        errors.contains("QRT_INSTRUCTIONS=mmx: this processor has"),
        "{errors}"
    );
    assert!(!folder.path("box.png").exists());
}

/// True if a process handles SIGINT.
#[cfg(target_os = "linux")]
fn handles_interrupts(process: u32) -> bool {
    let status = fs::read_to_string(format!("/proc/{process}/status")).unwrap_or_default();
    let caught = status.lines().find_map(|line| line.strip_prefix("SigCgt:"));
    let caught = caught.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
    caught.is_some_and(|mask| mask >> 1 & 1 == 1)
}

#[cfg(target_os = "linux")]
#[test]
fn an_interrupt_before_the_first_path_ends_it_at_once() {
    use crate::common::command::signalled;
    use std::time::{Duration, Instant};

    let folder = Folder::new();
    // The knot's circuit takes many seconds to compile.
    let knot = concat!(env!("CARGO_MANIFEST_DIR"), "/scenes-yaml/knot.yaml");
    let mut child = folder.started(&["render", knot, "--model", "fixed", "-o", "k.png"]);
    while !handles_interrupts(child.id()) {
        assert!(child.try_wait().unwrap().is_none(), "finished too soon");
        std::thread::sleep(Duration::from_millis(1));
    }
    let start = Instant::now();
    let (code, said, errors) = signalled(child, "-INT");
    assert_eq!(code, Some(1), "{errors}");
    assert!(
        errors.contains("error: interrupted before the first path"),
        "{errors}"
    );
    assert!(said.is_empty() && start.elapsed() < Duration::from_secs(2));
    assert!(folder.names().is_empty(), "{:?}", folder.names());
}

#[test]
fn what_takes_long_is_told_beforehand() {
    use std::io::{BufRead as _, BufReader};

    let folder = folder();
    let many = ["--set", "sampling.path_bits=40"];
    for command in [
        &["render", "box.yaml"][..],
        &["render", "box.yaml", "--model", "gates"],
        &["verify", "box.yaml", "--pixels", "1"],
        &["trade", "box.yaml", "--quick", "-o", "out"],
    ] {
        let mut child = folder.started(&[command, &many].concat());
        let mut lines = BufReader::new(child.stderr.take().unwrap()).lines();
        let told = lines.next().unwrap().unwrap();
        child.kill().unwrap();
        child.wait().unwrap();
        let words = [" of 2^40 paths each take about ", "`sampling.path_bits`"];
        assert!(words.iter().all(|words| told.contains(words)), "{told}");
        let _ = fs::remove_file(folder.path("box.png.qrt-partial"));
    }
    let output = folder.qrt(&["render", "box.yaml"]);
    assert!(output.stderr.is_empty(), "{output:?}");
}

/// Parts are merged with layers of the scene alone, whose hash must be theirs.
#[test]
fn an_estimator_of_the_command_leaves_the_scene_as_it_is() {
    let folder = folder();
    let hash = |estimator: &[&str]| {
        let run = [
            "render",
            "box.yaml",
            "-o",
            "h.png",
            "--set",
            "counting.phase_bits=4",
        ];
        folder.works(&[&run[..], &["--stats", "h.json"], estimator].concat());
        stats(&folder, "h.json")["scene_hash"].clone()
    };
    assert_eq!(hash(&["--estimator", "paper"]), hash(&[]));
}

#[test]
fn an_estimator_is_judged_with_the_keys_that_are_set_beside_it() {
    let folder = Folder::with("box.yaml", BOX);
    let run = |scene: &str, estimator: &str| {
        let strata = format!("counting={{ phase_bits: 6, estimator: {scene} }}");
        let sets = ["--set", &strata, "--set", "counting.strata=4"];
        let own = [
            "render",
            "box.yaml",
            "-o",
            "s.png",
            "--estimator",
            estimator,
        ];
        let output = folder.qrt(&[&own[..], &sets].concat());
        let errors = String::from_utf8(output.stderr).unwrap();
        (output.status.code(), errors)
    };
    let (code, errors) = run("sine", "auto");
    assert_eq!(code, Some(0), "{errors}");
    let (code, errors) = run("auto", "sine");
    assert!(code == Some(2) && errors.contains("strata"), "{errors}");
    for scene in ["auto", "paper"] {
        let (code, errors) = run(scene, "exact");
        assert_eq!(code, Some(0), "{errors}");
    }
}
