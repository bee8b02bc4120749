//! YAML text to the spanned tree.
//!
//! The events of `saphyr-parser` carry the places of every key and value, and from them the tree is
//! built here, with an explicit stack: what YAML allows but a scene does not mean (duplicate keys,
//! tags, several documents, merge keys, keys that are not names) is an error with its place; aliases
//! are expanded within a budget of nodes, and nesting has a limit.
//!
//! Readers that go from YAML straight to types were tried first. `yaml_serde` 0.10, which continues
//! `serde_yaml`, stops at the first error; its generic values carry no places, so that nothing that
//! is found after reading (a material that no one defined, a quad without area) can be shown in the
//! text; and it takes the single-key maps of materials for enumerations only through a wrapper.
//! `serde-saphyr` 2.0 shows the first error well, duplicate keys included, but only the first. With
//! both, defaults, ranges and the schema would have to be said a second time. So the events of
//! `saphyr-parser` 0.3, a crate of two small dependencies, become a tree here, and one definition of
//! each part (see [`crate::scene`]) does the rest. `yaml_serde` stays as the independent reader that
//! the tests compare with.

mod locator;

use crate::codes;
use crate::diagnostics::{Placed, Source};
use crate::front::tree::{Entry, Node, Scalar, Span, Value, is_null, shorten};
use crate::report::{Path, Problem};
use locator::Locator;
use saphyr_parser::{Event, Parser, ScalarStyle};
use std::collections::HashMap;
use std::ops::Range;

/// Nodes that aliases may add to a scene.
pub const ALIAS_BUDGET: usize = 1 << 18;
/// Levels of lists and maps in a scene.
pub const MAX_DEPTH: usize = 64;

/// What was read of a text.
#[derive(Debug)]
pub struct Reading {
    /// The tree, if the text could be read to its end; without what is wrong with it.
    pub tree: Option<Node>,
    /// What is wrong with the text as YAML. Syntax errors end the reading.
    pub problems: Vec<Placed>,
}

/// The tree of `source`'s bytes `range`; places are marked as of source number `number`.
pub fn read(source: &Source, range: Range<usize>, number: u32) -> Reading {
    let text = source.text.get(range.clone()).unwrap_or_default();
    let mut builder = Builder {
        locator: Locator::new(text, range.start, number),
        stack: Vec::new(),
        root: None,
        anchors: HashMap::new(),
        expanded: 0,
        documents: 0,
        problems: Vec::new(),
        merged: false,
    };
    let ended = builder.run(Parser::new_from_str(text));
    let Builder {
        root,
        mut problems,
        merged,
        ..
    } = builder;
    let tree = match (ended, root) {
        (Ok(()), Some(node)) if node.value != Value::Null => Some(node),
        (Err(Stop), _) => None,
        (Ok(()), _) => {
            if problems.is_empty() {
                let at = Span {
                    source: number,
                    start: range.start,
                    end: range.start,
                };
                let what = Problem::new(codes::EMPTY, Path::root(), "the scene is empty");
                let what = what.help("`qrt new NAME` writes a scene to start from");
                problems.push(Placed {
                    problem: what,
                    span: Some(at),
                    also: None,
                });
            }
            None
        }
    };
    // What a merge would have brought in would be reported as missing.
    Reading {
        tree: tree.filter(|_| !merged),
        problems,
    }
}

/// Reading cannot go on; the reason is among the problems.
struct Stop;

/// A list or map that is not yet complete.
struct Frame {
    start: Span,
    anchor: usize,
    body: Body,
}

enum Body {
    List(Vec<Node>),
    Map {
        entries: Vec<Entry>,
        seen: HashMap<String, Span>,
        key: Option<Key>,
    },
}

/// A key whose value comes next.
struct Key {
    text: String,
    span: Span,
    /// Whether the value is to be dropped, the key being faulty.
    faulty: bool,
}

struct Builder<'a> {
    locator: Locator<'a>,
    stack: Vec<Frame>,
    root: Option<Node>,
    anchors: HashMap<usize, Node>,
    expanded: usize,
    documents: usize,
    problems: Vec<Placed>,
    /// Whether there was a merge key.
    merged: bool,
}

impl<'a> Builder<'a> {
    fn run(&mut self, mut parser: Parser<'a, saphyr_parser::StrInput<'a>>) -> Result<(), Stop> {
        while let Some(event) = parser.next_event() {
            match event {
                Ok((event, span)) => {
                    let span = self.locator.span(&span);
                    self.event(event, span)?;
                }
                Err(error) => {
                    let at = self.locator.offset(error.marker());
                    return self.syntax_error(error.info(), at);
                }
            }
        }
        Ok(())
    }

    fn event(&mut self, event: Event<'a>, span: Span) -> Result<(), Stop> {
        let tag = match &event {
            Event::Scalar(_, _, _, tag)
            | Event::SequenceStart(_, tag)
            | Event::MappingStart(_, tag) => tag.as_deref(),
            _ => None,
        };
        if let Some(tag) = tag {
            let tag = shorten(&format!("{}{}", tag.handle, tag.suffix));
            let problem = problem(
                codes::TAG,
                format!("the YAML tag `{tag}` has no meaning here"),
            )
            .help("remove it: a value's type follows from its place in the scene");
            self.problems.push(Placed {
                problem,
                span: Some(span),
                also: None,
            });
        }
        match event {
            Event::Nothing | Event::StreamStart | Event::StreamEnd | Event::DocumentEnd => Ok(()),
            Event::DocumentStart(_) => {
                self.documents += 1;
                if self.documents == 1 {
                    return Ok(());
                }
                let what = problem(codes::SECOND_DOCUMENT, "a second YAML document starts here");
                self.stop(what.help("a file holds one scene"), span)
            }
            Event::Alias(anchor) => self.alias(anchor, span),
            Event::Scalar(text, style, anchor, _) => self.scalar(&text, style, anchor, span),
            Event::SequenceStart(anchor, _) => self.open(anchor, span, Body::List(Vec::new())),
            Event::MappingStart(anchor, _) => {
                let body = Body::Map {
                    entries: Vec::new(),
                    seen: HashMap::new(),
                    key: None,
                };
                self.open(anchor, span, body)
            }
            Event::SequenceEnd | Event::MappingEnd => {
                self.close(span);
                Ok(())
            }
        }
    }

    fn stop(&mut self, problem: Problem, span: Span) -> Result<(), Stop> {
        self.problems.push(Placed {
            problem,
            span: Some(span),
            also: None,
        });
        Err(Stop)
    }

    fn syntax_error(&mut self, info: &str, at: usize) -> Result<(), Stop> {
        if info.contains("unknown anchor") {
            let span = self.locator.word(at);
            let what = problem(codes::ALIAS, "this alias has no anchor before it");
            return self.stop(
                what.help("write `&name` before the value it stands for"),
                span,
            );
        }
        if info.contains("recursion limit") {
            return self.too_deep(self.locator.word(at));
        }
        let mut what = problem(codes::SYNTAX, format!("not YAML: {info}"));
        if self
            .locator
            .line_of(at)
            .bytes()
            .take_while(|b| b" \t".contains(b))
            .any(|b| b == b'\t')
        {
            what = what.help("indent with spaces: YAML has no tabs in its indentation");
        } else if info.contains("unprintable") || info.contains("byte order mark") {
            what = what.help("remove the invisible character");
        }
        let span = self.locator.word(at);
        self.stop(what, span)
    }

    fn too_deep(&mut self, span: Span) -> Result<(), Stop> {
        let what = problem(
            codes::TOO_DEEP,
            format!("more than {MAX_DEPTH} levels of nesting"),
        );
        self.stop(what.help("a scene needs fewer than ten"), span)
    }

    /// Whether the next value is a key, not a value.
    fn at_key(&self) -> bool {
        matches!(
            self.stack.last(),
            Some(Frame {
                body: Body::Map { key: None, .. },
                ..
            })
        )
    }

    fn open(&mut self, anchor: usize, span: Span, body: Body) -> Result<(), Stop> {
        if self.at_key() {
            return self.complex_key(span);
        }
        if self.stack.len() == MAX_DEPTH {
            return self.too_deep(span);
        }
        self.stack.push(Frame {
            start: span,
            anchor,
            body,
        });
        Ok(())
    }

    fn complex_key(&mut self, span: Span) -> Result<(), Stop> {
        let what = problem(codes::COMPLEX_KEY, "a key must be a word or a text");
        self.stop(
            what.help("a list, a map, an alias or nothing cannot be a key"),
            span,
        )
    }

    fn close(&mut self, event: Span) {
        let Some(Frame {
            start,
            anchor,
            body,
        }) = self.stack.pop()
        else {
            return;
        };
        let (value, last) = match body {
            Body::List(items) => {
                let last = items.last().map_or(start.end, |item| item.span.end);
                (Value::List(items), last)
            }
            Body::Map { entries, .. } => {
                let last = entries.last().map_or(start.end, |entry| {
                    entry.key_span.end.max(entry.value.span.end)
                });
                (Value::Map(entries), last)
            }
        };
        // The end of a block is found only at what follows it, often lines below.
        let end = if self.locator.is_bracket(event) {
            event.end
        } else {
            last
        };
        let span = Span {
            end: end.max(start.end),
            ..start
        };
        self.add(Node { span, value }, anchor);
    }

    fn scalar(
        &mut self,
        text: &str,
        style: ScalarStyle,
        anchor: usize,
        span: Span,
    ) -> Result<(), Stop> {
        let quoted = style != ScalarStyle::Plain;
        if !self.at_key() {
            let value = if !quoted && is_null(text) {
                Value::Null
            } else {
                Value::Scalar(Scalar {
                    text: text.to_owned(),
                    quoted,
                })
            };
            self.add(Node { span, value }, anchor);
            return Ok(());
        }
        if !quoted && is_null(text) {
            return self.complex_key(span);
        }
        let mut faulty = false;
        if !quoted && text == "<<" {
            let what = problem(codes::MERGE_KEY, "merge keys are not part of YAML 1.2");
            let what = what.help("write the entries out; whole values can be shared by `*alias`");
            self.problems.push(Placed {
                problem: what,
                span: Some(span),
                also: None,
            });
            faulty = true;
            self.merged = true;
        }
        let Some(Frame {
            body: Body::Map { seen, key, .. },
            ..
        }) = self.stack.last_mut()
        else {
            return Ok(());
        };
        if let (Some(first), false) = (seen.get(text), faulty) {
            let what = problem(
                codes::DUPLICATE_KEY,
                format!("the key `{}` is written twice", shorten(text)),
            )
            .label("again here")
            .help("keep one of the two")
            .also(Path::root(), "first written here");
            self.problems.push(Placed {
                problem: what,
                span: Some(span),
                also: Some(*first),
            });
            faulty = true;
        } else {
            seen.insert(text.to_owned(), span);
        }
        *key = Some(Key {
            text: text.to_owned(),
            span,
            faulty,
        });
        if anchor != 0 {
            let value = Value::Scalar(Scalar {
                text: text.to_owned(),
                quoted,
            });
            self.anchors.insert(anchor, Node { span, value });
        }
        Ok(())
    }

    fn alias(&mut self, anchor: usize, span: Span) -> Result<(), Stop> {
        if self.at_key() {
            return self.complex_key(span);
        }
        let Some(node) = self.anchors.get(&anchor) else {
            let what = problem(codes::ALIAS, "this alias stands within its own anchor");
            return self.stop(what.help("a value cannot contain itself"), span);
        };
        let (count, height) = (node.count(), node.height());
        self.expanded = self.expanded.saturating_add(count);
        if self.expanded > ALIAS_BUDGET {
            let what = problem(
                codes::ALIAS_BUDGET,
                format!("aliases expand to more than {ALIAS_BUDGET} values by here"),
            );
            return self.stop(what.help("put large geometry into OBJ meshes"), span);
        }
        if self.stack.len() + height > MAX_DEPTH {
            return self.too_deep(span);
        }
        let node = node.clone();
        self.add(node, 0);
        Ok(())
    }

    fn add(&mut self, node: Node, anchor: usize) {
        if anchor != 0 {
            self.anchors.insert(anchor, node.clone());
        }
        match self.stack.last_mut().map(|frame| &mut frame.body) {
            None => self.root = Some(node),
            Some(Body::List(items)) => items.push(node),
            Some(Body::Map { entries, key, .. }) => {
                if let Some(Key {
                    text,
                    span,
                    faulty: false,
                }) = key.take()
                {
                    entries.push(Entry {
                        key: text,
                        key_span: span,
                        value: node,
                    });
                }
            }
        }
    }
}

fn problem(code: &'static str, message: impl Into<String>) -> Problem {
    Problem::new(code, Path::root(), message)
}
