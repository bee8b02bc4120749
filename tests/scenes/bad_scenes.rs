//! Tests that a faulty scene is refused with an error that names its rule, its place and its remedy: one scene
//! per rule in `tests/bad_scenes`, each with the whole text of the report beside it.
//!
//! The first line of a scene names its expected codes, in order. Lines `# --set key=value` stand for the
//! command line. After a deliberate change of a message, `QRT_BLESS=1 cargo test --test scenes bad_scenes`
//! writes the texts again.

#![allow(clippy::format_push_string)]

use qrt::scene::front;
use qrt::syntax::codes;
use std::path::{Path, PathBuf};

const FOLDER: &str = "tests/bad_scenes";

fn scenes() -> Vec<PathBuf> {
    let mut scenes: Vec<_> = std::fs::read_dir(FOLDER)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|end| end == "yaml"))
        .collect();
    scenes.sort();
    scenes
}

/// Compares `text` with the text beside `scene`, or writes it.
fn compare(scene: &Path, text: &str) -> Result<(), String> {
    let file = scene.with_extension("txt");
    if std::env::var_os("QRT_BLESS").is_some() {
        std::fs::write(&file, text).unwrap();
        return Ok(());
    }
    let expected = std::fs::read_to_string(&file).unwrap_or_default();
    if expected == text {
        return Ok(());
    }
    Err(format!(
        "{}:\n--- expected\n{expected}--- found\n{text}",
        file.display()
    ))
}

#[test]
fn every_faulty_scene_gets_its_error() {
    let mut failures = Vec::new();
    let scenes = scenes();
    assert!(scenes.len() >= 45, "{} scenes", scenes.len());
    for scene in scenes {
        let bytes = std::fs::read(&scene).unwrap();
        let text = String::from_utf8_lossy(&bytes);
        let text = text.trim_start_matches('\u{feff}');
        let sets: Vec<String> = text
            .lines()
            .filter_map(|line| line.strip_prefix("# --set "))
            .map(|set| set.trim_end().to_owned())
            .collect();
        let head = text.lines().next().unwrap().strip_prefix("# ").unwrap();
        let expected: Vec<&str> = head.split_once(':').unwrap().0.split(' ').collect();
        let Err(report) = front::load(&scene, &sets) else {
            failures.push(format!("{} was accepted", scene.display()));
            continue;
        };
        if report.codes() != expected {
            let codes = report.codes().join(" ");
            failures.push(format!(
                "{}: {codes} instead of {head}\n{report}",
                scene.display()
            ));
        }
        failures.extend(compare(&scene, &report.render(false)).err());
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

#[test]
fn a_file_that_cannot_be_read_is_an_error_like_others() {
    let missing = Path::new(FOLDER).join("missing-file.yaml");
    let report = front::load(&missing, &[]).unwrap_err();
    assert_eq!(report.codes(), [codes::UNREADABLE]);
    compare(&missing, &report.render(false)).unwrap();

    let report = front::load(Path::new(FOLDER), &[]).unwrap_err();
    assert_eq!(report.codes(), [codes::UNREADABLE]);
    compare(
        &Path::new(FOLDER).join("folder.yaml"),
        &report.render(false),
    )
    .unwrap();

    // The file is sparse: it takes no disk space, and no time until it is read.
    let large = Path::new(env!("CARGO_TARGET_TMPDIR")).join("large.yaml");
    let file = std::fs::File::create(&large).unwrap();
    file.set_len(front::MAX_BYTES + 1).unwrap();
    let report = front::load(&large, &[]).unwrap_err();
    assert_eq!(report.codes(), [codes::TOO_LARGE]);
    let text = report
        .render(false)
        .replace(&large.display().to_string(), "large.yaml");
    compare(&Path::new(FOLDER).join("too-large.yaml"), &text).unwrap();
    std::fs::remove_file(large).unwrap();
}

/// Codes that no scene file gets from its checks. The first two occur only in scenes built in Rust, the third
/// only for a file of 256 MiB, the fourth only for millions of faces, the fifth only if the OBJ library disagrees
/// with the checks before it, the next ones only when the scene's circuit is compiled, then eleven as warnings or in a build
/// without glTF, and the last when the scene is exported. The unit tests of `valid`, of the OBJ reader and of `oracle`,
/// `inspect_command` and the test below show them.
const ELSEWHERE: [&str; 24] = [
    codes::DUPLICATE_NAME,
    codes::BSDF_CHANNELS,
    codes::OBJ_TOO_LARGE,
    codes::MESH_TOO_MANY,
    codes::OBJ_REFUSED,
    codes::BUDGET_QUBITS,
    codes::BUDGET_TOFFOLI,
    codes::QUOTIENT_UNBOUNDED,
    codes::NUMBER_TOO_WIDE,
    codes::TOO_MANY_FACES,
    codes::SPHERE_IN_TABLE,
    codes::SMALL_PART,
    codes::NOT_RECIPROCAL,
    codes::LIGHT_UNUSED,
    codes::FAINT_SUNLIGHT,
    codes::UNUSED_MATERIAL,
    codes::BLACK,
    codes::OPPOSITE_LAMP,
    codes::OBJ_COPY,
    codes::MTL_LEFT_OUT,
    codes::COLOURS_UNUSED,
    codes::GLTF_FEATURE,
    codes::GLTF_POSE,
    codes::NO_COUNTERPART,
];

/// Returns the warnings of a scene with one lamp, or none if its name is `dark`; no ray samples a lamp.
fn warned(name: &str, material: &str, sampling: &str) -> String {
    let text = format!(
        "name: {name}
camera: {{ perspective: {{ eye: [0, 0, 1], target: [0, 0, 0], vfov: 45 }} }}
film: {{ width: 1, height: 1 }}
materials: {{ m: {material}, lamp: {{ emitter: {{ radiance: [1, 1, 1] }} }} }}
geometry:
  - quad: {{ vertices: [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], material: m }}
  - quad: {{ vertices: [[0, 0, 2], [0, 1, 2], [1, 1, 2], [1, 0, 2]], material: {} }}
sampling: {{ {sampling} }}
",
        if name == "dark" { "m" } else { "lamp" }
    );
    let loaded = front::parse(&text, &format!("{name}.yaml"), &[], "".as_ref()).unwrap();
    let sampling = &loaded.valid.scene().sampling;
    assert!((0..sampling.depths.len()).all(|depth| sampling.light(depth).is_none()));
    let warnings = loaded.warnings();
    warnings.map_or(String::new(), |report| report.render(false))
}

/// A scene without a lamp, and one of mirrors alone, give the same picture as without the bits.
#[test]
fn lamps_that_cannot_be_sampled_are_warned_of() {
    let bits = "depths: [{ bits: [8, 8] }, { bits: [8, 8], light: [8, 8] }]";
    let (matte, mirror) = (
        "{ lambertian: { albedo: [0.5, 0.5, 0.5] } }",
        "{ mirror: { reflectance: [0.5, 0.5, 0.5] } }",
    );
    let file = |name: &str| Path::new(FOLDER).join(format!("unused-light-{name}.yaml"));
    compare(&file("dark"), &warned("dark", matte, bits)).unwrap();
    compare(&file("mirrors"), &warned("mirrors", mirror, bits)).unwrap();
    // The same without the bits, where `lights` is written.
    let two = "depths: 2";
    assert_eq!(warned("mirrors", mirror, two), "");
    compare(
        &file("asked"),
        &warned("mirrors", mirror, &format!("lights: mis, {two}")),
    )
    .unwrap();
    for (sampling, cause) in [
        ("depths: 1", "the primary ray alone leaves no surface"),
        (
            "depths: [{ bits: [4, 4] }, { bits: [4, 4] }], sequence: product-lattice",
            "under `product-lattice` no ray samples a lamp unless its `light` is written",
        ),
        (
            "depths: [{ bits: [8, 8] }, { bits: [8, 8], light: none }]",
            "each ray says `light: none`",
        ),
    ] {
        assert!(!warned("auto", matte, sampling).contains("QRT0511"));
        for lights in ["mis", "next-event"] {
            let text = warned("asked", matte, &format!("lights: {lights}, {sampling}"));
            let expected = format!("warning[QRT0511]: `lights` changes nothing: {cause}\n");
            assert!(text.contains(&expected), "{text}");
        }
    }
}

/// Meshes are read without faces that have no area, copies, colours, and statements without a counterpart.
#[test]
fn what_a_mesh_leaves_out_is_warned_of() {
    let text = "name: left-out
camera: { perspective: { eye: [0, 0, 1], target: [0, 0, 0], vfov: 45 } }
film: { width: 1, height: 1 }
materials: { white: { lambertian: { albedo: [1, 1, 1] } } }
geometry:
  - mesh: { obj: room.obj }
  - mesh: { gltf: figure.gltf, material: white }
";
    let obj =
        b"mtllib room.mtl\nusemtl lamp\nv 0 0 0\nv 1 0 0 1 0.5 0\nv 0 1 0\nv 1 1 1\nf 1 2 3\nf 2 3 1\n\
                f 1 2 2\nl 1 2\nusemtl wall\nf 2 4 3\n";
    let mtl =
        b"newmtl lamp\nKe 4 4 4\nnewmtl wall\nKd 0.8 0.8 0.8\nKs 0.5 0.5 0.5\nNs 250\nbump a.png\n";
    // One triangle: the points (0, 0, 0), (1, 0, 0) and (0, 1, 0).
    let gltf = br#"{
      "asset": { "version": "2.0" }, "nodes": [{ "mesh": 0, "skin": 0 }], "skins": [{ "joints": [0] }],
      "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 } }] }],
      "accessors": [{
        "bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]
      }],
      "bufferViews": [{ "buffer": 0, "byteLength": 36 }],
      "buffers": [{ "byteLength": 36, "uri":
        "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA" }]
    }"#;
    let files: &[(&str, &[u8])] = &[("room.obj", obj), ("room.mtl", mtl), ("figure.gltf", gltf)];
    let loaded = front::parse_with(text, "left-out.yaml", &[], front::Files::held(files)).unwrap();
    assert_eq!(loaded.valid.polygons().len(), 3);
    let shown = loaded.warnings().unwrap().render(false);
    compare(&Path::new(FOLDER).join("mesh-left-out.yaml"), &shown).unwrap();
}

/// A scene with a material that is darker in one direction than in the other is rendered as written.
#[test]
fn a_value_that_is_not_reciprocal_is_warned_of() {
    let text = r#"name: one-way
camera: { perspective: { eye: [0, 0, 1], target: [0, 0, 0], vfov: 45 } }
film: { width: 1, height: 1 }
materials:
  lamp: { emitter: { radiance: [1, 1, 1] } }
  cloth:
    bsdf:
      map: ["sqrt(u)*cos(2*pi*v)", "sqrt(u)*sin(2*pi*v)", "sqrt(1-u)"]
      value: ["0.2", "0.2*(1+0.3*cos_i)", "0.05*(1+cos_i)*(1+cos_o)"]
geometry:
  - quad: { vertices: [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], material: cloth }
  - quad: { vertices: [[0, 0, 2], [0, 1, 2], [1, 1, 2], [1, 0, 2]], material: lamp }
"#;
    let loaded = front::parse(text, "one-way.yaml", &[], "".as_ref()).unwrap();
    let shown = loaded.warnings().unwrap().render(false);
    compare(&Path::new(FOLDER).join("not-reciprocal.yaml"), &shown).unwrap();
}

#[test]
fn every_code_is_shown_by_some_scene() {
    let mut all = String::new();
    for entry in std::fs::read_dir(FOLDER).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|end| end == "txt") {
            all += &std::fs::read_to_string(path).unwrap();
        }
    }
    let unseen: Vec<_> = codes::TABLE
        .iter()
        .filter(|row| !all.contains(&format!("error[{}]", row.code)))
        .filter(|row| !ELSEWHERE.contains(&row.code))
        // The macros have codes of their own: `tests/compile_fail` shows them.
        .filter(|row| !row.code.starts_with("QRT07") && !row.code.starts_with("QRT08"))
        .collect();
    assert!(unseen.is_empty(), "{unseen:#?}");
}

#[test]
fn every_code_in_the_source_is_in_the_table() {
    let mut folders = vec![
        PathBuf::from("qrt-scene/src"),
        PathBuf::from("qrt-core/src"),
        PathBuf::from("qrt-syntax/src"),
        PathBuf::from("qrt-tracer/src"),
    ];
    let mut found = std::collections::BTreeSet::new();
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
                continue;
            }
            let text = std::fs::read_to_string(path).unwrap();
            for part in text.split("\"QRT").skip(1) {
                if let Some((digits, _)) = part.split_once('"')
                    && digits.len() == 4
                {
                    found.insert(format!("QRT{digits}"));
                }
            }
        }
    }
    found.remove("QRT0000");
    let unlisted: Vec<_> = found
        .iter()
        .filter(|code| codes::lookup(code).is_none())
        .collect();
    assert!(unlisted.is_empty(), "{unlisted:?}");
    assert!(
        found.len() == codes::TABLE.len() && found.len() > 80,
        "{}",
        found.len()
    );
}

#[test]
fn colour_changes_nothing_but_the_colour() {
    let scene = Path::new(FOLDER).join("everything-at-once.yaml");
    let report = front::load(&scene, &[]).unwrap_err();
    let coloured = report.render(true);
    let mut bare = String::new();
    let mut rest = coloured.as_str();
    while let Some(at) = rest.find('\u{1b}') {
        bare += &rest[..at];
        let end = rest[at..].find('m').expect("an escape ends");
        rest = &rest[at + end + 1..];
    }
    bare += rest;
    assert_ne!(coloured, bare);
    assert_eq!(bare, report.render(false));
}

/// The real Sun beside a mirror: 60,000 levels of radiance, of which the floor has one.
#[test]
fn sunlight_of_few_levels_is_warned_of() {
    let warned = |material: &str, more: &str| {
        let text = format!(
            "name: faint-sunlight
camera: {{ perspective: {{ eye: [0, 2, 5], target: [0, 0, 0], vfov: 45 }} }}
film: {{ width: 1, height: 1 }}
materials: {{ m: {material} }}
geometry:
  - quad: {{ vertices: [[-1, 0, 1], [1, 0, 1], [1, 0, -1], [-1, 0, -1]], material: m }}
sampling: {{ depths: 2 }}
sun: {{ direction: [0, 1, 0], {more}
"
        );
        let loaded = front::parse(&text, "faint-sunlight.yaml", &[], "".as_ref()).unwrap();
        let warnings = loaded.warnings();
        warnings.map_or(String::new(), |report| report.render(false))
    };
    let (matte, mirror) = (
        "{ lambertian: { albedo: 0.5 } }",
        "{ mirror: { reflectance: 0.5 } }",
    );
    let real = "angle: 0.53, radiance: 60000 }";
    let file = Path::new(FOLDER).join("faint-sunlight.yaml");
    compare(&file, &warned(mirror, real)).unwrap();
    // More bits of the comparator alone do not help, and with few bits no sun does.
    for (more, help) in [
        ("comparator: { bits: 20 }", "write `angle: 3`"),
        (
            "comparator: { bits: 5 }",
            "= help: use more `comparator.bits`",
        ),
        ("comparator: { bits: 0 }", "tell 1 level of"),
    ] {
        let warning = warned(mirror, &format!("{real}\n{more}"));
        assert!(warning.contains(help), "{warning}");
    }
    // The help, followed: the larger sun, or more bits. A matte floor does not show the sun.
    for (material, more) in [
        (mirror, "angle: 21, radiance: 38 }"),
        (
            mirror,
            "angle: 0.53, radiance: 60000 }\ncomparator: { bits: 20 }\nprecision: { fraction: 20 }",
        ),
        (matte, real),
    ] {
        assert_eq!(warned(material, more), "", "{more}");
    }
}
