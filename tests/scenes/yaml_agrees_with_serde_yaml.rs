//! Scenes are read as the standard YAML reader reads them: an independent one, `yaml_serde`, finds
//! the same values in every good scene and in documents made at random.

#![allow(clippy::format_push_string)]

use super::cases;
use proptest::prelude::*;
use qrt::core::front::yaml;
use qrt::core::syntax::tree::{Kind, Node, Value};
use qrt::core::syntax::{Problems, Source};
use serde_yaml::Value as Other;

fn read(text: &str) -> Option<Node> {
    let source = Source::new("text", text);
    let mut problems = Problems::default();
    let tree = yaml::read(&source, 0..source.text.len(), 0, &mut problems);
    assert!(tree.is_some() || problems.count() > 0);
    tree.filter(|_| problems.count() == 0)
}

fn same(node: &Node, other: &Other) -> bool {
    match (&node.value, other) {
        (Value::Null, Other::Null) => true,
        (Value::Scalar(scalar), other) => match (scalar.kind(), other) {
            (Kind::Number(a), Other::Number(number)) => number
                .as_f64()
                .is_some_and(|b| a == b || a.is_nan() && b.is_nan()),
            // Beyond 64 bits, the other reader takes it for text; here it becomes an error.
            (Kind::Number(a), Other::String(text)) => a.is_infinite() && scalar.text == *text,
            (Kind::Bool(a), Other::Bool(b)) => a == *b,
            (Kind::Text, Other::String(text)) => scalar.text == *text,
            _ => false,
        },
        (Value::List(items), Other::Sequence(others)) => {
            items.len() == others.len() && items.iter().zip(others).all(|(a, b)| same(a, b))
        }
        (Value::Map(entries), Other::Mapping(others)) => {
            entries.len() == others.len()
                && entries.iter().all(|entry| {
                    // Keys are texts here, whatever they look like.
                    let find = |(key, _): &(&Other, &Other)| match key {
                        Other::String(key) => *key == entry.key,
                        Other::Number(key) => key.to_string() == entry.key,
                        Other::Bool(key) => key.to_string() == entry.key,
                        _ => false,
                    };
                    others
                        .iter()
                        .find(find)
                        .is_some_and(|(_, other)| same(&entry.value, other))
                })
        }
        _ => false,
    }
}

#[test]
fn scenes_are_read_alike() {
    let mut count = 0;
    for folder in ["tests/good_scenes", "scenes-yaml", "tests/bad_scenes"] {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            let Ok(text) = std::fs::read_to_string(&path) else {
                continue;
            };
            if path.extension().is_none_or(|end| end != "yaml") {
                continue;
            }
            if let (Some(node), Ok(other)) = (read(&text), serde_yaml::from_str::<Other>(&text)) {
                assert!(same(&node, &other), "{}", path.display());
                count += 1;
            }
        }
    }
    assert!(count >= 60, "{count}");
}

/// A document and a random way to write it: block or flow, quoted or plain, comments between.
#[derive(Clone, Debug)]
enum Document {
    Scalar(String),
    List(Vec<Document>, bool),
    Map(Vec<(String, Document)>, bool),
}

impl Document {
    fn write(&self, out: &mut String, indent: usize, flow: bool) {
        match self {
            Self::Scalar(text) => out.push_str(text),
            Self::List(items, in_flow) if flow || *in_flow || items.is_empty() => {
                out.push('[');
                for (i, item) in items.iter().enumerate() {
                    out.push_str(if i > 0 { ", " } else { "" });
                    item.write(out, indent, true);
                }
                out.push(']');
            }
            Self::Map(entries, in_flow) if flow || *in_flow || entries.is_empty() => {
                out.push('{');
                for (i, (key, value)) in entries.iter().enumerate() {
                    out.push_str(if i > 0 { ", " } else { "" });
                    *out += key;
                    out.push_str(": ");
                    value.write(out, indent, true);
                }
                out.push('}');
            }
            Self::List(items, _) => {
                for item in items {
                    *out += &format!("\n{:indent$}- ", "");
                    item.write(out, indent + 2, false);
                }
            }
            Self::Map(entries, _) => {
                for (key, value) in entries {
                    *out += &format!("\n{:indent$}{key}: ", "");
                    value.write(out, indent + 1, false);
                    if matches!(value, Self::Scalar(text) if text.len() % 2 == 1) {
                        *out += " # ü";
                    }
                }
            }
        }
    }
}

fn scalars() -> impl Strategy<Value = String> {
    prop_oneof![
        any::<i32>().prop_map(|n| n.to_string()),
        any::<f64>()
            .prop_filter("finite", |x| x.is_finite())
            .prop_map(|x| format!("{x:?}")),
        any::<f32>()
            .prop_filter("finite", |x| x.is_finite())
            .prop_map(|x| format!("{x:e}")),
        "[+-]?[1-9][0-9]{0,3}(\\.[0-9]{0,3})?([eE][+-]?[0-9]{1,2})?",
        "[+-]?\\.[0-9]{1,3}",
        Just("0x1F".to_owned()),
        Just("0o17".to_owned()),
        "(true|false|null|~|True|NULL|\\.inf|-\\.inf|\\.nan|yes|no|on|off|y|inf|nan)",
        "[a-zA-Z_][a-zA-Z0-9_ -]{0,8}[a-z]",
        "'[a-zA-Z0-9 ,:#\\[\\]{}]{0,10}'",
        "\"[a-zA-Z0-9 ,:#\\[\\]{}äß漢]{0,10}\"",
        "\"(\\\\n|\\\\t|\\\\\"|\\\\\\\\|\\\\u00e4|\\\\x41|a){0,5}\"",
    ]
}

fn documents() -> impl Strategy<Value = Document> {
    let leaf = scalars().prop_map(Document::Scalar);
    leaf.prop_recursive(4, 40, 5, |inner| {
        let key = "[a-z]{1,6}";
        prop_oneof![
            (prop::collection::vec(inner.clone(), 0..5), any::<bool>())
                .prop_map(|(items, flow)| Document::List(items, flow)),
            (prop::collection::btree_map(key, inner, 0..5), any::<bool>())
                .prop_map(|(map, flow)| Document::Map(map.into_iter().collect(), flow)),
        ]
    })
}

proptest! {
    #![proptest_config(cases(2000))]

    #[test]
    fn random_documents_are_read_alike(document in documents()) {
        let mut text = String::new();
        document.write(&mut text, 0, false);
        let other = serde_yaml::from_str::<Other>(&text);
        match (read(&text), other) {
            (Some(node), Ok(other)) => prop_assert!(same(&node, &other), "{text}\n{node:?}\n{other:?}"),
            // An empty scene is an error here.
            (None, Ok(Other::Null) | Err(_)) => {}
            (node, other) => prop_assert!(false, "{text}\n{node:?}\n{other:?}"),
        }
    }
}
