//! Tests that the JSON Schema for editors agrees with the types: every good scene is valid under it, and
//! for every change of a scene's structure, both accept it or both refuse it.
//!
//! An independent validator applies the schema, and reads scenes with an independent YAML reader.

#![allow(clippy::format_push_string)]

use qrt::scene::Scene;
use qrt::scene::{front, schema};
use qrt::syntax::codes;
use serde_json::{Value, json};
use std::path::Path;

const FILE: &str = "scenes-yaml/scene.schema.json";

struct Judge {
    schemas: boon::Schemas,
    index: boon::SchemaIndex,
}

impl Judge {
    fn new() -> Self {
        let mut schemas = boon::Schemas::new();
        let mut compiler = boon::Compiler::new();
        let schema = serde_json::from_str(&schema::text()).unwrap();
        compiler.add_resource("scene.json", schema).unwrap();
        let index = compiler.compile("scene.json", &mut schemas).unwrap();
        Self { schemas, index }
    }

    fn accepts(&self, scene: &Value) -> bool {
        self.schemas.validate(scene, self.index).is_ok()
    }
}

/// Codes of errors that relate values to each other, or concern files: a schema cannot express them.
const RELATIONS: [&str; 24] = [
    codes::SKY,
    codes::NO_LENS,
    codes::PRIMARY_LIGHT,
    codes::FEW_LIGHT_BITS,
    codes::LIGHT_UNBOUNDED,
    codes::DUPLICATE_NAME,
    codes::UNKNOWN_MATERIAL,
    codes::PHONG_ENERGY,
    codes::CAMERA_TARGET,
    codes::CAMERA_UP,
    codes::CAMERA_ON_SPHERE,
    codes::COINCIDENT,
    codes::ZERO_AREA,
    codes::NOT_CONVEX,
    codes::CROSSING,
    codes::GLASS_TOUCHES,
    codes::PATH_BITS_SUM,
    codes::TOO_MANY_IDS,
    codes::TOO_MANY_DIMENSIONS,
    codes::PRIMARY_MAP,
    codes::ACCURACY_CONFLICT,
    codes::STRATA,
    codes::NEVER_STOPS,
    codes::LEVEL_BITS,
];

fn is_relation(code: &str) -> bool {
    // The contents of meshes, expressions and BSDFs decide, not the structure.
    let of_contents = ["QRT032", "QRT033", "QRT034", "QRT035", "QRT04"];
    RELATIONS.contains(&code) || of_contents.iter().any(|start| code.starts_with(start))
}

fn yaml(path: &Path) -> Value {
    serde_yaml::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}

#[test]
fn the_schema_on_file_is_that_of_the_types() {
    if std::env::var_os("QRT_BLESS").is_some() {
        std::fs::write(FILE, schema::text()).unwrap();
    }
    let on_file = std::fs::read_to_string(FILE).unwrap_or_default();
    assert_eq!(
        on_file,
        schema::text(),
        "{FILE} is out of date: `qrt schema > {FILE}` writes it anew"
    );
}

#[test]
fn good_scenes_are_valid() {
    let judge = Judge::new();
    let mut count = 0;
    for folder in ["tests/good_scenes", "scenes-yaml"] {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.extension().is_some_and(|end| end == "yaml") {
                let scene = yaml(&path);
                let outcome = judge.schemas.validate(&scene, judge.index);
                assert!(
                    outcome.is_ok(),
                    "{}: {:#}",
                    path.display(),
                    outcome.unwrap_err()
                );
                count += 1;
            }
        }
    }
    assert!(count >= 8);
}

#[test]
fn bad_scenes_are_refused_where_a_schema_can_tell() {
    let judge = Judge::new();
    let mut refused = 0;
    for entry in std::fs::read_dir("tests/bad_scenes").unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_none_or(|end| end != "yaml") {
            continue;
        }
        let text = String::from_utf8_lossy(&std::fs::read(&path).unwrap()).into_owned();
        let head = text.trim_start_matches('\u{feff}').lines().next().unwrap();
        let code = &head[2..9];
        // The schema cannot judge texts that the other reader reads differently or not at all.
        let structural = code >= "QRT0120" && !text.contains("# --set");
        let of_yaml = [codes::UNREPRESENTABLE, codes::NOT_FINITE];
        // A mesh's errors are in its file.
        let of_files = text.contains("- mesh:");
        if !structural || of_files || of_yaml.contains(&code) || is_relation(code) {
            continue;
        }
        if let Ok(scene) = serde_yaml::from_str::<Value>(&text) {
            assert!(!judge.accepts(&scene), "{}", path.display());
            refused += 1;
        }
    }
    assert!(refused >= 30, "{refused}");
}

/// Returns the replacements of a value; `null` stands for the key without a value.
fn replacements() -> Vec<Value> {
    let mut values = vec![
        json!(null),
        json!(true),
        json!("text"),
        json!(""),
        json!("auto"),
        json!("1"),
        json!([]),
        json!({}),
        json!([1]),
        json!([1, 2]),
        json!([1, 2, 3]),
        json!([0.5, 0.5, 0.5]),
        json!(["0.1", "0.2", 3]),
        json!({ "lambertian": {} }),
        json!({ "a": 1 }),
    ];
    let numbers = [
        0.0, 1.0, -1.0, 0.5, 1.5, 12.0, 30.0, 31.0, 53.0, 180.0, 65_536.0, 65_537.0,
    ];
    values.extend(numbers.map(|number| json!(number)));
    values.extend([1e6, 1e6 + 1.0, 1e30, 1.1e30, -1e30, 1e300, 1e-9].map(|number| json!(number)));
    values
}

/// Returns every way to change one thing: replace a value, drop a key, add a key, double an element.
fn mutations(value: &Value) -> Vec<Value> {
    let mut out = replacements();
    match value {
        Value::Object(map) => {
            for (key, inner) in map {
                for changed in mutations(inner) {
                    let mut map = map.clone();
                    map.insert(key.clone(), changed);
                    out.push(Value::Object(map));
                }
                let mut without = map.clone();
                without.remove(key);
                out.push(Value::Object(without));
                let mut renamed = map.clone();
                let inner = renamed.remove(key).unwrap();
                renamed.insert(format!("{key}x"), inner);
                out.push(Value::Object(renamed));
            }
            let mut with = map.clone();
            with.insert("extra".into(), json!(1));
            out.push(Value::Object(with));
        }
        Value::Array(items) => {
            // The elements of a list are alike.
            if let Some(first) = items.first() {
                for changed in mutations(first) {
                    let mut items = items.clone();
                    items[0] = changed;
                    out.push(Value::Array(items));
                }
                let mut longer = items.clone();
                longer.push(first.clone());
                out.push(Value::Array(longer));
                out.push(Value::Array(items[1..].to_vec()));
            }
        }
        _ => {}
    }
    out
}

#[test]
fn whatever_is_changed_both_accept_or_both_refuse() {
    let judge = Judge::new();
    let mut verdicts = [0, 0];
    let mut everything = yaml(Path::new("tests/good_scenes/everything.yaml"));
    let mut least = yaml(Path::new("tests/good_scenes/least.yaml"));
    let aliases = yaml(Path::new("tests/good_scenes/aliases.yaml"));
    // A BSDF takes a while to check, so it stands in a scene of its own.
    let cloth = everything["materials"]["cloth"].take();
    everything["materials"]
        .as_object_mut()
        .unwrap()
        .retain(|_, material| material.is_object());
    everything["materials"]
        .as_object_mut()
        .unwrap()
        .remove("grey cloth");
    everything["geometry"][1]["triangle"]["material"] = json!("white");
    least["camera"] = everything["camera"].clone();
    let with_cloth = mutations(&cloth).into_iter().map(|cloth| {
        let mut scene = least.clone();
        scene["materials"] = json!({ "cloth": cloth });
        scene
    });
    let plain = mutations(&everything)
        .into_iter()
        .chain(mutations(&aliases));
    for changed in plain.chain(mutations(&least)).chain(with_cloth) {
        let text = changed.to_string();
        let by_schema = judge.accepts(&changed);
        // JSON is YAML, so the parser takes the scene as it is.
        let by_types = match front::parse(&text, "changed.json", &[], "tests/good_scenes".as_ref())
        {
            Ok(_) => true,
            Err(report) => report.codes().iter().all(|code| is_relation(code)),
        };
        assert_eq!(
            by_schema,
            by_types,
            "{text}\n{:?}",
            Scene::from_yaml(&text, "changed.json")
        );
        verdicts[usize::from(by_schema)] += 1;
    }
    assert!(verdicts.iter().all(|&count| count > 200), "{verdicts:?}");
}
