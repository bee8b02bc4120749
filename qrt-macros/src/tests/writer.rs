//! Writes a YAML scene as text of `qrt!`, as far as it has a form there.

use qrt_syntax::tree::{Entry, Kind, Node, Scalar, Value};
use std::sync::Arc;

/// Returns the scene as tokens' text. `None` if YAML states something that no token can.
pub(super) fn scene(tree: &Node) -> Option<String> {
    let mut text = "scene Written {\n".to_owned();
    for entry in map(tree)? {
        text += &block(entry)?;
    }
    Some(text + "}\n")
}

fn map(node: &Node) -> Option<&[Entry]> {
    match &node.value {
        Value::Map(entries) => Some(entries),
        _ => None,
    }
}

fn list(node: &Node) -> Option<&[Node]> {
    match &node.value {
        Value::List(items) => Some(items),
        _ => None,
    }
}

fn block(entry: &Entry) -> Option<String> {
    let node = &entry.value;
    let key = entry.key.as_str();
    Some(match key {
        "name" => format!("name: {},\n", value("scene", "name", node)?),
        "camera" => format!("camera: {},\n", variant(node)?),
        "film" => format!("film: {},\n", record("film", node)?),
        "materials" => {
            let mut text = String::new();
            for entry in map(node)? {
                let name = name(&entry.key);
                text += &format!("material {name}: {},\n", variant(&entry.value)?);
            }
            text
        }
        "geometry" => {
            let mut text = String::new();
            for item in list(node)? {
                text += &primitive(item)?;
            }
            text
        }
        "sampling" => sampling(node)?,
        "sky" | "sun" | "precision" | "comparator" | "counting" | "circuit" | "accuracy"
        | "budget" => {
            format!("{key} {},\n", record(key, node)?)
        }
        _ => return None,
    })
}

fn sampling(node: &Node) -> Option<String> {
    let depths = node.entry("depths").and_then(|entry| list(&entry.value));
    let Some(depths) = depths.filter(|depths| !depths.is_empty()) else {
        return Some(format!("sampling {},\n", record("sampling", node)?));
    };
    let rest = Node {
        value: Value::Map(
            map(node)?
                .iter()
                .filter(|entry| entry.key != "depths")
                .cloned()
                .collect::<Vec<_>>()
                .into(),
        ),
        ..*node
    };
    let mut text = format!("sampling {},\n", record("sampling", &rest)?);
    for depth in depths {
        text += &format!("depth {},\n", record("depth", depth)?);
    }
    Some(text)
}

fn primitive(node: &Node) -> Option<String> {
    let [
        Entry {
            key, value: node, ..
        },
    ] = map(node)?
    else {
        return None;
    };
    let material = match node.entry("material") {
        None => String::new(),
        Some(entry) => match &entry.value.value {
            Value::Scalar(scalar) => format!(": {}", name(&scalar.text)),
            _ => return None,
        },
    };
    let body = if let "mesh" | "sphere" | "disc" | "box" = key.as_str() {
        let rest = map(node)?.iter().filter(|entry| entry.key != "material");
        let value = Value::Map(Arc::new(rest.cloned().collect()));
        record(key, &Node { value, ..*node })?
    } else {
        let points = list(&node.entry("vertices")?.value)?;
        let points = points.iter().map(|point| value("", "", point));
        let keys = map(node)?.iter();
        let keys = keys.filter(|entry| !matches!(entry.key.as_str(), "vertices" | "material"));
        let keys = keys.map(|entry| {
            let written = value(key, &entry.key, &entry.value)?;
            Some(format!("{}: {written}", entry.key))
        });
        let parts: Option<Vec<_>> = points.chain(keys).collect();
        format!("{{ {} }}", parts?.join(", "))
    };
    Some(format!("{key}{material} {body},\n"))
}

/// Writes a map of a single key.
fn variant(node: &Node) -> Option<String> {
    let [entry] = map(node)? else {
        return None;
    };
    Some(format!(
        "{} {}",
        entry.key,
        record(&entry.key, &entry.value)?
    ))
}

fn record(name: &str, node: &Node) -> Option<String> {
    let mut fields = Vec::new();
    for entry in map(node)? {
        let value = value(name, &entry.key, &entry.value)?;
        fields.push(format!("{}: {value}", entry.key));
    }
    Some(format!("{{ {} }}", fields.join(", ")))
}

fn value(record_name: &str, key: &str, node: &Node) -> Option<String> {
    let is_expression = record_name == "bsdf";
    Some(match &node.value {
        Value::Null | Value::Unread => return None,
        Value::Map(_) => record(key, node)?,
        Value::Scalar(scalar) if is_expression => scalar.text.clone(),
        Value::Scalar(scalar) => self::scalar(key, scalar),
        Value::List(items) => {
            let items = items.iter().map(|item| value(record_name, key, item));
            let items: Vec<_> = items.collect::<Option<_>>()?;
            match (is_expression, key, &items[..]) {
                (true, "map", _) => format!("|u, v| ({},)", items.join(", ")),
                (true, _, [_, _, _]) => format!("rgb({})", items.join(", ")),
                (true, _, [only]) => only.clone(),
                (_, "depths", _) | (true, ..) => format!("[{}]", items.join(", ")),
                (_, _, [only]) => format!("({only},)"),
                _ => format!("({})", items.join(", ")),
            }
        }
    })
}

fn scalar(key: &str, scalar: &Scalar) -> String {
    let text = scalar.text.as_str();
    let words = [
        "sequence",
        "map",
        "at",
        "window",
        "estimator",
        "uncompute",
        "nearest",
        "fraction",
        "colors",
    ];
    match scalar.kind() {
        Kind::Number(value) if value.is_nan() => "0 / 0".to_owned(),
        // `.inf`, not a number that is too large.
        Kind::Number(value) if value.is_infinite() && !scalar.has_digits() => {
            if value > 0.0 { "1 / 0" } else { "-1 / 0" }.to_owned()
        }
        // In Rust, a number begins with a digit.
        Kind::Number(_) if text.starts_with('.') => format!("0{text}"),
        Kind::Number(_) => text.to_owned(),
        _ if words.contains(&key) && !scalar.quoted => text.replace('-', "_"),
        _ => format!("{text:?}"),
    }
}

/// Returns a name: as a word if it is one, otherwise in quotes.
fn name(text: &str) -> String {
    if syn::parse_str::<syn::Ident>(text).is_ok() {
        text.to_owned()
    } else {
        format!("{text:?}")
    }
}
