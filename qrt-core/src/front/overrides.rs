//! Overrides of the command line: `--set sampling.depths[1].bits=[4, 4]`.
//!
//! They change the tree before it is decoded, so that a value from the command line is read and
//! checked like one of the file; its place is the override's own text.

use crate::codes;
use crate::diagnostics::{Placed, Source};
use crate::front::tree::{Entry, Node, Span, Value};
use crate::front::yaml::{self, Reading};
use crate::report::{Path, Problem};
use crate::scene::text::Data;
use crate::scene::{Circuit, Comparator, Counting, Precision, Sampling, shape::Part};

/// An override that was read: where to put what.
#[derive(Clone, Debug)]
pub struct Override {
    steps: Vec<(Step, Span)>,
    value: Node,
}

#[derive(Clone, Debug, PartialEq)]
enum Step {
    Key(String),
    Item(usize),
}

/// Reads `key=value`, the text of `source`, which is source number `number`.
///
/// # Errors
/// What is wrong with the key or with the value as YAML.
pub fn read(source: &Source, number: u32) -> Result<Override, Vec<Placed>> {
    let text = source.text.as_str();
    let syntax = |start: usize, end: usize, message: &str| {
        let problem = Problem::new(codes::SET_SYNTAX, Path::root(), message)
            .help("write it as `--set sampling.path_bits=14`");
        vec![placed(
            problem,
            Span {
                source: number,
                start,
                end,
            },
        )]
    };
    let Some(equals) = text.find('=') else {
        return Err(syntax(0, text.len(), "an override is written key=value"));
    };
    let mut steps = Vec::new();
    let mut at = 0;
    while at < equals {
        let rest = &text[at..equals];
        let item = rest.strip_prefix('[').and_then(|rest| rest.split_once(']'));
        let (step, length) = if let (Some((index, _)), false) = (item, steps.is_empty()) {
            let Ok(value) = index.trim().parse::<usize>() else {
                return Err(syntax(at, equals, "an index is a whole number from 0"));
            };
            (Step::Item(value), index.len() + 2)
        } else {
            let dot = usize::from(!steps.is_empty() && rest.starts_with('.'));
            let word = &rest[dot..];
            let length = word.find(['.', '[']).unwrap_or(word.len());
            if length == 0 || (dot == 0 && !steps.is_empty()) {
                return Err(syntax(at, equals, "a key is missing here"));
            }
            at += dot;
            (Step::Key(word[..length].trim().to_owned()), length)
        };
        steps.push((
            step,
            Span {
                source: number,
                start: at,
                end: at + length,
            },
        ));
        at += length;
    }
    if steps.is_empty() {
        return Err(syntax(0, text.len(), "an override begins with a key"));
    }
    if text[equals + 1..].trim().is_empty() {
        return Err(syntax(equals, text.len(), "the value is missing here"));
    }
    match yaml::read(source, equals + 1..text.len(), number) {
        Reading {
            tree: Some(value),
            problems,
        } if problems.is_empty() => Ok(Override { steps, value }),
        Reading { problems, .. } => Err(problems),
    }
}

/// Puts the override's value into the tree. A key that is not there is added (blocks that may be
/// left out are filled with their defaults); an element that is not there is an error.
///
/// # Errors
/// The step that leads nowhere.
pub fn apply(tree: &mut Node, set: Override) -> Result<(), Box<Placed>> {
    let defaults = defaults();
    let mut default = Some(&defaults);
    let mut node = tree;
    for (step, span) in set.steps {
        if node.value == Value::Null {
            node.value = Value::Map(Vec::new());
            node.span = span;
        }
        let found = node.found();
        let lost = |message: String| {
            Box::new(placed(
                Problem::new(codes::SET_PLACE, Path::root(), message),
                span,
            ))
        };
        node = match (step, &mut node.value) {
            (Step::Key(key), Value::Map(entries)) => {
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
                let Some(item) = items.get_mut(index) else {
                    let message = format!("there is no element {index}: the list has {count}");
                    return Err(lost(message));
                };
                item
            }
            (Step::Key(key), _) => {
                return Err(lost(format!("there is no key `{key}` in {found}")));
            }
            (Step::Item(index), _) => {
                return Err(lost(format!("there is no element {index} in {found}")));
            }
        };
    }
    *node = set.value;
    Ok(())
}

/// What the blocks that may be left out hold then, as far as an override may reach into it.
/// `path_bits` is not among it: under the product lattice it follows from the rest.
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
    use crate::front::tree::Scalar;
    let node = |data: &Data| Node {
        span,
        value: value_of(data, span),
    };
    match data {
        Data::Text(text) => Value::Scalar(Scalar {
            text: text.clone(),
            quoted: true,
        }),
        Data::List(items) => Value::List(items.iter().map(node).collect()),
        Data::Map(entries) => {
            let entry = |(key, data): &(String, Data)| Entry {
                key: key.clone(),
                key_span: span,
                value: node(data),
            };
            Value::Map(entries.iter().map(entry).collect())
        }
        Data::Number(_) | Data::Bool(_) => Value::Scalar(Scalar {
            text: data.canonical(),
            quoted: false,
        }),
    }
}

fn placed(problem: Problem, span: Span) -> Placed {
    Placed {
        problem,
        span: Some(span),
        also: None,
    }
}
