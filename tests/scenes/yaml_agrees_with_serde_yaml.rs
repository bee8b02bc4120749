//! Tests that scenes are read like the standard YAML reader reads them: an independent one, `yaml_serde`,
//! finds the same values in every good scene and in random documents.

#![allow(clippy::format_push_string)]

use super::cases;
use proptest::prelude::*;
use qrt::scene::front::yaml;
use qrt::syntax::tree::{Kind, Node, Value};
use qrt::syntax::{Problems, Report, Source};
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
            // Beyond 64 bits, the other reader takes a number for text; here it becomes an error.
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
                    // Keys are texts here, even if they look like other values.
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
    /// Writes the document with `gap` after each indicator.
    fn write(&self, out: &mut String, gap: &str, indent: usize, flow: bool) {
        match self {
            Self::Scalar(text) => out.push_str(text),
            Self::List(items, in_flow) if flow || *in_flow || items.is_empty() => {
                out.push('[');
                for (i, item) in items.iter().enumerate() {
                    if i > 0 {
                        *out += &format!(",{gap}");
                    }
                    item.write(out, gap, indent, true);
                }
                out.push(']');
            }
            Self::Map(entries, in_flow) if flow || *in_flow || entries.is_empty() => {
                out.push('{');
                for (i, (key, value)) in entries.iter().enumerate() {
                    if i > 0 {
                        *out += &format!(",{gap}");
                    }
                    *out += &format!("{key}:{gap}");
                    value.write(out, gap, indent, true);
                }
                out.push('}');
            }
            Self::List(items, _) => {
                for item in items {
                    *out += &format!("\n{:indent$}-{gap}", "");
                    item.write(out, gap, indent + 2, false);
                }
            }
            Self::Map(entries, _) => {
                for (key, value) in entries {
                    *out += &format!("\n{:indent$}{key}:{gap}", "");
                    value.write(out, gap, indent + 1, false);
                    if matches!(value, Self::Scalar(text) if text.len() % 2 == 1) {
                        *out += &format!("{gap}# ü");
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
        document.write(&mut text, " ", 0, false);
        let mut tabbed = String::new();
        document.write(&mut tabbed, "\t", 0, false);
        let other = serde_yaml::from_str::<Other>(&text);
        if let (Some(node), Ok(other)) = (read(&text), &other) {
            prop_assert!(read(&tabbed).is_some_and(|node| same(&node, other)), "{tabbed}\n{node:?}");
        }
        match (read(&text), other) {
            (Some(node), Ok(other)) => prop_assert!(same(&node, &other), "{text}\n{node:?}\n{other:?}"),
            // An empty scene is an error here.
            (None, Ok(Other::Null) | Err(_)) => {}
            (node, other) => prop_assert!(false, "{text}\n{node:?}\n{other:?}"),
        }
    }
}

/// The same document with tabs and with spaces.
#[test]
fn tabs_separate_as_spaces_do() {
    for (tabbed, spaced) in [
        ("name:\twall", "name: wall"),
        ("name:\t\twall\t\nfilm:\t-1", "name: wall\nfilm: -1"),
        ("name: \twall", "name: wall"),
        ("name\t:\t1", "name: 1"),
        ("\"a:\tb\":\tc:d\n", "\"a:\\tb\": \"c:d\"\n"),
        ("'a:\tb':\td", "\"a:\\tb\": d"),
        ("a:\n  -\tb\n  -\t1", "a:\n  - b\n  - 1"),
        ("a: b\t# c:\td\nb:\t# e\n  c:\td", "a: b\nb:\n  c: d"),
        ("a:\t[\t1\t,\tb\t]\t# c", "a: [1, b]"),
        ("a:\t{\tb:\tc,\td\t:\t-2\t}", "a: { b: c, d: -2 }"),
        ("a: [1,\n \t2]", "a: [1, 2]"),
        ("a:\n\t\n  b: 1\n\t# only a comment\n", "a:\n  b: 1\n"),
        ("a: &x\tb\nc:\t*x\t\n", "a: b\nc: b"),
        ("a:\tb\tc:d", "a: \"b\\tc:d\""),
    ] {
        let right: Other = serde_yaml::from_str(spaced).unwrap();
        let node = read(tabbed);
        assert!(node.is_some_and(|node| same(&node, &right)), "{tabbed:?}");
    }
}

/// Tabs that YAML does not allow are refused at their place, with the remedy.
#[test]
fn tabs_that_indent_are_refused() {
    for (text, line, help) in [
        ("a:\n\tb: 1", 2, "indent with spaces"),
        ("a:\n  b: 1\n\tc: 2", 3, "indent with spaces"),
        ("a:\n  b: [1,\n\t2]", 3, "indent with spaces"),
        ("a:\n  b: \"c\n\td\"", 3, "indent with spaces"),
        ("a: b\n\tc", 2, "indent with spaces"),
        ("a: |\n\tb", 2, "indent with spaces"),
        ("a:\n  -\t- b", 2, "a space in place of the tab"),
    ] {
        let source = Source::new("text", text);
        let mut problems = Problems::default();
        assert!(yaml::read(&source, 0..text.len(), 0, &mut problems).is_none());
        let report = Report::new(vec![source], None, problems.all());
        let told = report.problems().next().unwrap();
        let place = told.place.as_ref().map(|place| place.line);
        assert_eq!((told.code, place), ("QRT0103", Some(line)), "{report}");
        assert!(told.help.unwrap_or_default().contains(help), "{report}");
    }
}
