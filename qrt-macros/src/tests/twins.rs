//! Whatever YAML says, right or wrong, the macro says too.

use super::{code, read_text, writer};
use proc_macro2::TokenStream;
use qrt_core::codes;
use qrt_core::diagnostics::Source;
use qrt_core::front::{load, yaml};
use qrt_core::scene::{Bsdf, Jacobian, Material, Scene};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// The scenes of a folder of the workspace.
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

/// The scene of a YAML file as the macro's text, if it has one.
fn written(file: &Path) -> Option<String> {
    let source = Source::new("", std::fs::read_to_string(file).ok()?);
    let reading = yaml::read(&source, 0..source.text.len(), 0);
    let text = writer::scene(&reading.tree.filter(|_| reading.problems.is_empty())?)?;
    // Brackets that do not match are the compiler's business.
    text.parse::<TokenStream>().is_ok().then_some(text)
}

/// Spaces in expressions say nothing, and tokens lose them.
fn without_spaces(mut scene: Scene) -> Scene {
    for (_, material) in &mut scene.materials {
        if let Material::Bsdf(Bsdf {
            map,
            jacobian,
            value,
        }) = material
        {
            let stated = match jacobian {
                Jacobian::Auto => None,
                Jacobian::Stated(text) => Some(text),
            };
            for text in map.iter_mut().chain(value).chain(stated) {
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
    }
}

/// Faulty scenes that say by YAML's own means, or at its own places, what tokens cannot say or say
/// in another way.
const YAML_ALONE: &[&str] = &["expression-blank", "expression-empty"];

#[test]
fn every_faulty_scene_gets_the_same_codes() {
    let mut reached = BTreeSet::new();
    let mut skipped = Vec::new();
    let mut failures = Vec::new();
    for file in scenes("tests/bad_scenes") {
        let name = file.file_stem().unwrap().to_string_lossy().into_owned();
        let text = String::from_utf8_lossy(&std::fs::read(&file).unwrap()).into_owned();
        let Some(text) = written(&file).filter(|_| !text.contains("# --set")) else {
            skipped.push(name);
            continue;
        };
        if YAML_ALONE.contains(&name.as_str()) {
            skipped.push(name);
            continue;
        }
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
    println!("{skipped:?}");
    let unreached: Vec<_> = codes::TABLE
        .iter()
        .map(|row| row.code)
        .filter(|code| ("QRT012".."QRT06").contains(code) && !reached.contains(code))
        .collect();
    println!("{unreached:?}");
}
