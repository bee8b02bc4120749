//! Reads YAML text to the spanned tree.
//!
//! The events of `saphyr-parser` carry the places of every key and value. This module builds the
//! tree from them, with an explicit stack. YAML that has no meaning in a scene (duplicate keys,
//! tags, several documents, merge keys, keys that are not names) is an error with its place.
//! Aliases share their values. The number of values, the values that aliases add and the nesting
//! depth have limits.
//!
//! ARCHITECTURE.md explains why no deserializer goes from YAML straight to types.

mod locator;
mod tabs;

use locator::Locator;
use qrt_syntax::tree::{Entry, Node, Scalar, Span, Value, is_null};
use qrt_syntax::{Override, Problem, Problems, Source, Yaml};
use saphyr_parser::{Event, Parser, ScalarStyle};
use std::collections::HashMap;
use std::ops::Range;
use std::sync::Arc;

/// Maximum number of values in a scene's text, before aliases are expanded.
pub(crate) const MAX_VALUES: usize = 1 << 21;
/// Maximum number of values that aliases may add to a scene.
pub(crate) const ALIAS_BUDGET: usize = 1 << 18;
/// Maximum number of bytes of text that aliases may add to a scene.
pub(crate) const ALIAS_BYTES: usize = 1 << 24;
/// Maximum number of nested levels of lists and maps in a scene.
pub(crate) const MAX_DEPTH: usize = 64;

/// Reads the tree of the bytes `range` of `source`, without its faulty entries. `None` if it is
/// empty, cannot be read to its end, or has a merge key. Places have source number `number`. A
/// syntax error ends the reading.
pub fn read(
    source: &Source,
    range: Range<usize>,
    number: u32,
    problems: &mut Problems,
) -> Option<Node> {
    let text = source.text.get(range.clone()).unwrap_or_default();
    let spaced = tabs::spaced(text);
    let text = spaced.as_ref();
    let known = problems.count();
    let mut builder = Builder {
        locator: Locator::new(text, range.start, number),
        stack: Vec::new(),
        root: None,
        anchors: HashMap::new(),
        values: 0,
        expanded: [0; 2],
        documents: 0,
        problems,
        merged: false,
    };
    builder.build(Parser::new_from_str(text)).ok()?;
    let Builder { root, merged, .. } = builder;
    let root = root.filter(|node| node.value != Value::Null);
    if root.is_none() && problems.count() == known {
        // An override's value is only a part of its text.
        let is_scene = range == (0..source.text.len());
        let at = Span {
            source: number,
            start: range.start,
            end: if is_scene { range.start } else { range.end },
        };
        if is_scene {
            problems.add(at, Yaml::Empty);
        } else {
            problems.add(at, Override::Nothing);
        }
    }
    // The decoder would report the keys that a merge adds as missing.
    root.filter(|_| !merged)
}

/// The kind of a syntax error of `saphyr-parser`. Its errors have a message and a place, but no
/// kind. Only this type interprets the messages, and a test pins those of the version in use.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Refusal {
    UnknownAlias,
    TooDeep,
    /// A character that editors do not show.
    Invisible,
    /// A tab in the indentation of a line.
    Indentation,
    /// A tab between an indicator and what follows it.
    Separation,
    Syntax,
}

impl Refusal {
    fn from_message(words: &str) -> Self {
        match words {
            "while parsing node, found unknown anchor" => Self::UnknownAlias,
            "recursion limit exceeded" => Self::TooDeep,
            "found unprintable character"
            | "a byte order mark must not appear inside a document" => Self::Invisible,
            "tabs disallowed within this context (block indentation)"
            | "tab cannot be used as indentation"
            | "while scanning a plain scalar, found a tab"
            | "a block scalar content cannot start with a tab" => Self::Indentation,
            "':' must be followed by a valid YAML whitespace"
            | "'-' must be followed by a valid YAML whitespace"
            | "tabs disallowed in this context" => Self::Separation,
            _ => Self::Syntax,
        }
    }
}

/// The error of a reading that cannot continue; the reason is among the problems.
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
    /// True if the key is faulty, so that its value is dropped.
    faulty: bool,
}

struct Builder<'a> {
    locator: Locator<'a>,
    stack: Vec<Frame>,
    root: Option<Node>,
    anchors: HashMap<usize, Node>,
    values: usize,
    /// Number of values and of bytes that aliases have added.
    expanded: [usize; 2],
    documents: usize,
    problems: &'a mut Problems,
    /// True if there was a merge key.
    merged: bool,
}

impl<'a> Builder<'a> {
    fn build(&mut self, mut parser: Parser<'a, saphyr_parser::StrInput<'a>>) -> Result<(), Stop> {
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
        let is_value = match &event {
            Event::Alias(_) | Event::SequenceStart(..) | Event::MappingStart(..) => true,
            Event::Scalar(..) => !self.at_key(),
            _ => false,
        };
        self.values += usize::from(is_value);
        if self.values > MAX_VALUES {
            return self.stop(span, Yaml::TooMany { most: MAX_VALUES });
        }
        let tag = match &event {
            Event::Scalar(_, _, _, tag)
            | Event::SequenceStart(_, tag)
            | Event::MappingStart(_, tag) => tag.as_deref(),
            _ => None,
        };
        if let Some(tag) = tag {
            let tag = format!("{}{}", tag.handle, tag.suffix);
            self.problems.add(span, Yaml::Tag { tag });
        }
        match event {
            Event::Nothing | Event::StreamStart | Event::StreamEnd | Event::DocumentEnd => Ok(()),
            Event::DocumentStart(_) => {
                self.documents += 1;
                if self.documents == 1 {
                    return Ok(());
                }
                self.stop(span, Yaml::SecondDocument)
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

    fn stop(&mut self, at: Span, what: Yaml) -> Result<(), Stop> {
        self.problems.add(at, what);
        Err(Stop)
    }

    fn syntax_error(&mut self, why: &str, at: usize) -> Result<(), Stop> {
        let refusal = Refusal::from_message(why);
        let why = why.to_owned();
        let tab = self.locator.indented_by_tab(at);
        let (at, what) = match refusal {
            Refusal::UnknownAlias => (at, Yaml::UnknownAlias),
            Refusal::TooDeep => (at, Yaml::TooDeep { most: MAX_DEPTH }),
            Refusal::Invisible => (at, Yaml::Invisible { why }),
            Refusal::Separation => (at, Yaml::TabSeparates { why }),
            // For a text of several lines, the parser reports the first line.
            Refusal::Indentation => (tab.unwrap_or(at), Yaml::TabIndents { why }),
            // The tab may be the cause of the error.
            Refusal::Syntax if tab == Some(at) => (at, Yaml::TabIndents { why }),
            Refusal::Syntax => (at, Yaml::Syntax { why }),
        };
        let span = self.locator.word(at);
        self.stop(span, what)
    }

    /// True if the next event is a key, not a value.
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
            return self.stop(span, Yaml::ComplexKey);
        }
        if self.stack.len() == MAX_DEPTH {
            return self.stop(span, Yaml::TooDeep { most: MAX_DEPTH });
        }
        self.stack.push(Frame {
            start: span,
            anchor,
            body,
        });
        Ok(())
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
                (Value::List(Arc::new(items)), last)
            }
            Body::Map { entries, .. } => {
                let last = entries.last().map_or(start.end, |entry| {
                    entry.key_span.end.max(entry.value.span.end)
                });
                (Value::Map(Arc::new(entries)), last)
            }
        };
        // The parser reports the end of a block at the token that follows it, often lines below.
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
            return self.stop(span, Yaml::ComplexKey);
        }
        let mut faulty = false;
        if !quoted && text == "<<" {
            self.problems.add(span, Yaml::MergeKey);
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
            let key = text.to_owned();
            let problem = Problem::new(span, Yaml::DuplicateKey { key });
            self.problems.push(problem.also(*first));
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
            return self.stop(span, Yaml::ComplexKey);
        }
        let Some(node) = self.anchors.get(&anchor) else {
            return self.stop(span, Yaml::RecursiveAlias);
        };
        let (size, height) = (node.size(), node.height());
        for (sum, more) in self.expanded.iter_mut().zip(size) {
            *sum = sum.saturating_add(more);
        }
        if self.expanded[0] > ALIAS_BUDGET {
            return self.stop(span, Yaml::AliasBudget { most: ALIAS_BUDGET });
        }
        if self.expanded[1] > ALIAS_BYTES {
            return self.stop(span, Yaml::AliasBytes { most: ALIAS_BYTES });
        }
        if self.stack.len() + height > MAX_DEPTH {
            return self.stop(span, Yaml::TooDeep { most: MAX_DEPTH });
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Checks that the parser words its errors as expected: otherwise problems would lose detail.
    #[test]
    fn refusals_are_known_by_the_words_of_the_parser() {
        let deep = "[".repeat(1 << 17);
        for (text, expected) in [
            ("a: *b", Refusal::UnknownAlias),
            (deep.as_str(), Refusal::TooDeep),
            ("a: 1\n\0", Refusal::Invisible),
            ("a: \u{feff}1", Refusal::Invisible),
            ("a: [1 \n- ", Refusal::Syntax),
            ("a:\n\tb: 1", Refusal::Indentation),
            ("a:\n  b: [\n\t1]", Refusal::Indentation),
            ("a:\n  b: \"c\n\td\"", Refusal::Indentation),
            ("a: b\n\tc", Refusal::Indentation),
            ("a: |\n\tb", Refusal::Indentation),
            ("a:\tb", Refusal::Separation),
            ("-\t- a", Refusal::Separation),
            ("? \ta", Refusal::Separation),
        ] {
            let refused = Parser::new_from_str(text).find_map(Result::err);
            let words = refused.as_ref().map(saphyr_parser::ScanError::info);
            assert_eq!(
                words.map(Refusal::from_message),
                Some(expected),
                "{words:?}"
            );
        }
    }
}
