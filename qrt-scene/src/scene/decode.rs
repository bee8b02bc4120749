//! Decodes a tree to typed data, with every error: a faulty value is reported, marked, and replaced
//! by a harmless one, so that the rest is still read and checked.

use qrt_syntax::tree::{Node, Value};
use qrt_syntax::{Expected, Place, Problems, Structure, called, meant_by};

/// A key that a record may have.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Field {
    /// The key.
    pub(crate) name: &'static str,
    /// True if the key is required.
    pub(crate) required: bool,
}

/// Reports that `node` is not what is expected, unless it could not be read: then it is
/// reported already.
pub(crate) fn wrong_type(problems: &mut Problems, node: &Node, at: &Place<'_>, expected: Expected) {
    if node.value == Value::Unread {
        return problems.mark(at.path());
    }
    let found = node.found();
    problems.refuse(at, Structure::WrongType { expected, found });
}

/// Returns whether `node` is a map. Reports keys that are not in `fields`, and required keys
/// that are missing.
pub(crate) fn record(
    problems: &mut Problems,
    node: &Node,
    at: &Place<'_>,
    noun: &'static str,
    fields: &[Field],
) -> bool {
    let keys: Vec<&'static str> = fields.iter().map(|field| field.name).collect();
    let Value::Map(entries) = &node.value else {
        wrong_type(problems, node, at, Expected::Record { noun, keys });
        return false;
    };
    let mut misspelt = Vec::new();
    for entry in entries.iter() {
        let key = entry.key.as_str();
        if keys.contains(&key) {
            continue;
        }
        misspelt.extend(meant_by(noun, key, keys.iter().copied()));
        let (key, keys) = (key.to_owned(), keys.clone());
        let path = at.path().name(key.as_str());
        problems.add(path, Structure::UnknownKey { key, noun, keys });
    }
    let is_missing = |field: &&Field| {
        field.required && node.entry(field.name).is_none() && !misspelt.contains(&field.name)
    };
    let missing = fields.iter().filter(is_missing);
    let keys: Vec<_> = missing.map(|field| field.name).collect();
    if !keys.is_empty() {
        problems.add(at.name(), Structure::MissingKeys { noun, keys });
    }
    true
}

/// Returns the single entry of a variant, whose key is in `kinds`; reports anything else.
pub(crate) fn variant<'n>(
    problems: &mut Problems,
    node: &'n Node,
    at: &Place<'_>,
    noun: &'static str,
    kinds: &'static [&'static str],
) -> Option<(&'n str, &'n Node)> {
    let Value::Map(entries) = &node.value else {
        wrong_type(problems, node, at, Expected::Variant { noun, kinds });
        return None;
    };
    let known = entries
        .iter()
        .find(|entry| kinds.contains(&entry.key.as_str()));
    let other = entries.iter().find(|entry| Some(*entry) != known);
    match (known, other) {
        (Some(_), None) => {}
        (None, Some(entry)) if entries.len() == 1 || called(noun, &entry.key, kinds).is_some() => {
            let name = entry.key.clone();
            let path = at.path().name(name.as_str());
            problems.mark(at.path());
            problems.add(path, Structure::UnknownKind { name, noun, kinds });
        }
        _ => {
            let path = match (known, other) {
                (Some(_), Some(other)) => at.path().name(other.key.as_str()),
                _ => at.name(),
            };
            if known.is_none() {
                problems.mark(at.path());
            }
            let (count, known) = (entries.len(), known.map(|entry| entry.key.clone()));
            let what = Structure::NotOneKind {
                noun,
                count,
                known,
                kinds,
            };
            problems.add(path, what);
        }
    }
    known.map(|entry| (entry.key.as_str(), &entry.value))
}

/// Returns the index of `node`'s word in `words`; reports anything else.
pub(crate) fn word(
    problems: &mut Problems,
    node: &Node,
    at: &Place<'_>,
    noun: &'static str,
    words: &'static [&'static str],
) -> Option<usize> {
    let Value::Scalar(scalar) = &node.value else {
        wrong_type(problems, node, at, Expected::Word { noun, words });
        return None;
    };
    let found = words.iter().position(|word| *word == scalar.text);
    if found.is_none() {
        let word = scalar.text.clone();
        problems.refuse(at, Structure::UnknownWord { word, noun, words });
    }
    found
}
