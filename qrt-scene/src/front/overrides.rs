//! Overrides of the command line: `--set sampling.depths[1].bits=[4, 4]`.
//!
//! A key that holds `.`, `=` or `[` is written in quotation marks, double or single, as in YAML:
//! `materials."a.b".mirror={}`.
//!
//! Overrides change the tree before it is decoded, so that a value from the command line is read
//! and checked like one of the file. Its place is in the override's own text.

use crate::front::yaml;
use crate::scene::text::Data;
use crate::scene::{Circuit, Comparator, Counting, Precision, Sampling, shape::Part};
use qrt_syntax::tree::{Entry, Node, Scalar, Span, Value};
use qrt_syntax::{Override as Fault, Problems, Source, Step};
use std::sync::Arc;

/// A parsed override: a path, and the value to put there.
#[derive(Clone, Debug)]
pub struct Override {
    steps: Vec<(Step, Span)>,
    value: Node,
}

/// Reads `key=value`, the text of `source`, which is source number `number`. Reports problems with
/// the key, and with the value as YAML.
pub fn read(source: &Source, number: u32, problems: &mut Problems) -> Option<Override> {
    let text = source.text.as_str();
    let span = |start: usize, end: usize| Span {
        source: number,
        start,
        end,
    };
    let mut syntax = |start: usize, end: usize, what: Fault| {
        problems.add(span(start, end), what);
        None
    };
    let equals = match end_of_keys(text) {
        Ok(Some(equals)) => equals,
        Ok(None) => return syntax(0, text.len(), Fault::NotAPair),
        Err(quote) => return syntax(quote, text.len(), Fault::OpenQuote),
    };
    let mut steps = Vec::new();
    let mut at = 0;
    while at < equals {
        let rest = &text[at..equals];
        let item = rest.strip_prefix('[').and_then(|rest| rest.split_once(']'));
        let (step, length) = if let (Some((index, _)), false) = (item, steps.is_empty()) {
            let Ok(value) = index.trim().parse::<usize>() else {
                return syntax(at, equals, Fault::NotAnIndex);
            };
            (Step::Item(value), index.len() + 2)
        } else {
            let dot = usize::from(!steps.is_empty() && rest.starts_with('.'));
            let word = &rest[dot..];
            let (key, length) = quoted(word).unwrap_or_else(|| {
                let length = word.find(['.', '[']).unwrap_or(word.len());
                (word[..length].trim().to_owned(), length)
            });
            if length == 0 || (dot == 0 && !steps.is_empty()) {
                return syntax(at, equals, Fault::NoKey);
            }
            at += dot;
            (Step::Key(key), length)
        };
        steps.push((step, span(at, at + length)));
        at += length;
    }
    if steps.is_empty() {
        return syntax(0, text.len(), Fault::NoFirstKey);
    }
    if text[equals + 1..].trim().is_empty() {
        return syntax(equals, text.len(), Fault::NoValue);
    }
    let known = problems.count();
    let value = yaml::read(source, equals + 1..text.len(), number, problems)?;
    (problems.count() == known).then_some(Override { steps, value })
}

/// Returns the place of the `=` after the keys, outside quotes; `None` if there is none.
///
/// # Errors
/// The place of a quotation mark that is never closed.
fn end_of_keys(text: &str) -> Result<Option<usize>, usize> {
    let mut at = 0;
    loop {
        let rest = &text[at..];
        if let Some((_, length)) = quoted(rest) {
            at += length;
        } else if rest.trim_start().starts_with(['"', '\'']) {
            return Err(text.len() - rest.trim_start().len());
        }
        match text[at..].find(['.', '=']) {
            None => return Ok(None),
            Some(found) if text[at + found..].starts_with('=') => return Ok(Some(at + found)),
            // A key follows, in quotes or not.
            Some(found) => at += found + 1,
        }
    }
}

/// Returns a quoted key at the beginning of `text`, and the number of bytes of the quoted key and
/// the spaces around it. Between double quotation marks, as in [`Path`](qrt_syntax::Path), a
/// backslash stands before a quotation mark or a backslash of the key's own. Between single ones, a
/// mark of the key's own is doubled.
fn quoted(text: &str) -> Option<(String, usize)> {
    let inner = text.trim_start();
    let mark = inner
        .chars()
        .next()
        .filter(|mark| ['"', '\''].contains(mark))?;
    let inner = &inner[1..];
    let start = text.len() - inner.len();
    let mut key = String::new();
    let mut letters = inner.char_indices().peekable();
    while let Some((place, letter)) = letters.next() {
        match letter {
            '\'' if mark == '\'' && letters.peek().is_some_and(|(_, next)| *next == '\'') => {
                letters.next();
                key.push('\'');
            }
            letter if letter == mark => {
                let behind = &inner[place + 1..];
                let spaces = behind.len() - behind.trim_start().len();
                return Some((key, start + place + 1 + spaces));
            }
            '\\' if mark == '"' => key.push(letters.next()?.1),
            other => key.push(other),
        }
    }
    None
}

/// Puts the override's value into the tree. Adds a key that is missing, and fills optional blocks
/// with their defaults. Reports a step that leads to nothing.
pub fn apply(tree: &mut Node, set: Override, problems: &mut Problems) {
    let defaults = defaults();
    let mut default = Some(&defaults);
    let mut node = tree;
    for (step, span) in set.steps {
        if node.value == Value::Null {
            node.value = Value::Map(Arc::default());
            node.span = span;
        }
        let found = node.found();
        node = match (step, &mut node.value) {
            (Step::Key(key) | Step::Name(key), Value::Map(entries)) => {
                let entries = Arc::make_mut(entries);
                default = default.and_then(|data| data.get(&key));
                let index = entries.iter().position(|entry| entry.key == key);
                let index = index.unwrap_or_else(|| {
                    let value = default.map_or(Value::Null, |data| value_of(data, span));
                    let value = Node { span, value };
                    entries.push(Entry {
                        key,
                        key_span: span,
                        value,
                    });
                    entries.len() - 1
                });
                &mut entries[index].value
            }
            (Step::Item(index), Value::List(items)) => {
                default = None;
                let count = items.len();
                let Some(item) = Arc::make_mut(items).get_mut(index) else {
                    return problems.add(span, Fault::NoElement { index, count });
                };
                item
            }
            (Step::Key(key) | Step::Name(key), _) => {
                return problems.add(span, Fault::NotAMap { key, found });
            }
            (Step::Item(index), _) => return problems.add(span, Fault::NotAList { index, found }),
        };
    }
    *node = set.value;
}

/// Returns the defaults of optional blocks, as far as an override may reach into them. `path_bits`
/// is left out: under the product lattice it follows from the other keys.
fn defaults() -> Data {
    let mut sampling = Sampling::default().encode();
    if let Data::Map(entries) = &mut sampling {
        entries.retain(|(key, _)| key == "depths");
    }
    Data::map([
        ("sampling", sampling),
        ("precision", Precision::default().encode()),
        ("comparator", Comparator::default().encode()),
        ("counting", Counting::default().encode()),
        ("circuit", Circuit::default().encode()),
    ])
}

fn value_of(data: &Data, span: Span) -> Value {
    let node = |data: &Data| Node {
        span,
        value: value_of(data, span),
    };
    match data {
        Data::Text(text) => Value::Scalar(Scalar {
            text: text.clone(),
            quoted: true,
        }),
        Data::List(items) => Value::List(Arc::new(items.iter().map(node).collect())),
        Data::Map(entries) => {
            let entry = |(key, data): &(String, Data)| Entry {
                key: key.clone(),
                key_span: span,
                value: node(data),
            };
            Value::Map(Arc::new(entries.iter().map(entry).collect()))
        }
        Data::Number(_) | Data::Bool(_) => Value::Scalar(Scalar {
            text: data.canonical(),
            quoted: false,
        }),
    }
}
