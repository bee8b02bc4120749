//! Tests that the macro accepts and reports the same as YAML, for right and for wrong scenes.

use super::{code, read_text, writer};
use proc_macro2::TokenStream;
use qrt_scene::front::{load, yaml};
use qrt_scene::{Bsdf, Jacobian, Material, Scene};
use qrt_syntax::{Problems, Source, codes};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Returns the scenes of a folder of the workspace.
fn scenes(folder: &str) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("..")
        .join(folder);
    let mut scenes: Vec<_> = std::fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .filter(|path| path.extension().is_some_and(|end| end == "yaml"))
        .collect();
    scenes.sort();
    assert!(scenes.len() >= 8);
    scenes
}

/// Returns the scene of a YAML file as the macro's text, if it has one.
fn written(file: &Path) -> Option<String> {
    let source = Source::new("", std::fs::read_to_string(file).ok()?);
    let mut problems = Problems::default();
    let tree = yaml::read(&source, 0..source.text.len(), 0, &mut problems);
    let text = writer::scene(&problems.result(tree?).ok()?)?;
    // The compiler reports brackets that do not match.
    text.parse::<TokenStream>().is_ok().then_some(text)
}

/// Removes spaces in expressions, which have no meaning and which tokens lose.
fn without_spaces(mut scene: Scene) -> Scene {
    for (_, material) in &mut scene.materials {
        if let Material::Bsdf(Bsdf {
            map,
            jacobian,
            value,
            pdf,
        }) = material
        {
            let stated = match jacobian {
                Jacobian::Auto => None,
                Jacobian::Stated(text) => Some(text),
            };
            for text in map.iter_mut().chain(value).chain(stated).chain(pdf) {
                text.retain(|c| c != ' ');
            }
        }
    }
    scene
}

#[test]
fn every_scene_is_the_same_in_both_languages() {
    for file in [scenes("scenes-yaml"), scenes("tests/good_scenes")].concat() {
        let text = written(&file).unwrap_or_else(|| panic!("{}", file.display()));
        let (scenes, faults) = read_text(&text, file.parent().unwrap());
        assert!(faults.is_empty(), "{}: {faults:#?}\n{text}", file.display());
        let valid = scenes[0].1.as_ref().unwrap();
        let twin = load(&file, &[]).unwrap().valid;
        assert_eq!(
            without_spaces(valid.scene().clone()),
            without_spaces(twin.scene().clone()),
            "{}",
            file.display()
        );
        assert_eq!(valid.polygons(), twin.polygons());
        assert_eq!(valid.balls(), twin.balls());
        assert_eq!(valid.coloured_faces(), twin.coloured_faces());
    }
}

/// Faulty scenes without a twin: those whose fault is YAML's own, or the command line's; those
/// whose macro twin is no scene in form, which are the grammar's errors `QRT07..`; and those with a
/// key or a material written twice, which YAML's tree does not keep.
const WITHOUT_TWIN: [&str; 45] = [
    "alias-bomb",
    "complex-key",
    "directional",
    "disk",
    "duplicate-key",
    "duplicate-material",
    "empty-document",
    "empty",
    "everything-at-once",
    "expression-blank",
    "expression-empty",
    "expressions-all-at-once",
    "material-not-a-map",
    "material-outside",
    "materials-not-a-map",
    "merge-key",
    "no-kind",
    "not-a-map",
    "not-a-scene",
    "not-utf8",
    "nothing-written",
    "null-geometry",
    "null-key",
    "recursive-alias",
    "second-document",
    "set-bad-index",
    "set-bad-value",
    "set-missing-element",
    "set-out-of-range",
    "set-through-number",
    "set-unknown-key",
    "set-without-key",
    "set-without-value",
    "syntax-bracket",
    "syntax-control-character",
    "syntax-quote",
    "syntax-tab",
    "tab-before-dash",
    "tab-in-flow",
    "tab-in-text",
    "tag",
    "too-deep",
    "two-kinds",
    "unknown-alias",
    "unknown-key",
];

/// Codes of the checker that these scenes do not reach. The grammar itself reports some (an
/// expression is not empty). Others need scenes built in Rust, files of 256 MiB,
/// millions of faces or disagreements of the OBJ library. Warnings are no errors.
const ELSEWHERE: [&str; 17] = [
    codes::DUPLICATE_NAME,
    codes::UNUSED_MATERIAL,
    codes::BLACK,
    codes::OPPOSITE_LAMP,
    codes::MESH_TOO_MANY,
    codes::OBJ_TOO_LARGE,
    codes::OBJ_REFUSED,
    codes::OBJ_COPY,
    codes::MTL_LEFT_OUT,
    codes::GLTF_FEATURE,
    codes::GLTF_POSE,
    codes::COLOURS_UNUSED,
    codes::EXPR_EMPTY,
    codes::BSDF_CHANNELS,
    codes::NOT_RECIPROCAL,
    codes::LIGHT_UNUSED,
    codes::FAINT_SUNLIGHT,
];

#[test]
fn every_faulty_scene_gets_the_same_codes() {
    let mut reached = BTreeSet::new();
    let mut skipped = Vec::new();
    let mut failures = Vec::new();
    for file in scenes("tests/bad_scenes") {
        let name = file.file_stem().unwrap().to_string_lossy().into_owned();
        let text = String::from_utf8_lossy(&std::fs::read(&file).unwrap()).into_owned();
        // An empty text in quotes is no value at all in the macro, which has no quotes there.
        let is_empty = ["expression-blank", "expression-empty"].contains(&name.as_str());
        let twin = written(&file).filter(|_| !text.contains("# --set") && !is_empty);
        let Some(text) = twin else {
            skipped.push(name);
            continue;
        };
        let mut expected = load(&file, &[]).unwrap_err().codes();
        expected.sort_unstable();
        let (_, faults) = read_text(&text, file.parent().unwrap());
        let mut found: Vec<&str> = faults.iter().map(|fault| code(fault)).collect();
        found.sort_unstable();
        if found != expected {
            failures.push(format!("{name}: {expected:?}, but {faults:#?}\n{text}"));
        }
        reached.extend(expected);
    }
    assert!(failures.is_empty(), "{}", failures.join("\n"));
    assert_eq!(skipped, WITHOUT_TWIN);
    let checked = "QRT0120".."QRT0600";
    let unreached: Vec<_> = codes::TABLE
        .iter()
        .map(|row| row.code)
        .filter(|code| checked.contains(code) && !reached.contains(code))
        .collect();
    assert_eq!(unreached, ELSEWHERE);
}
