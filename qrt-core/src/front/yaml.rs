//! YAML text to the spanned tree.
//!
//! The events of `saphyr-parser` carry the places of every key and value, and from them the tree is
//! built here, with an explicit stack: what YAML allows but a scene does not mean (duplicate keys,
//! tags, several documents, merge keys, keys that are not names) is an error with its place. Aliases
//! share what they stand for; how many values a scene holds, what aliases add to them and how deep
//! they nest has limits.
//!
//! ARCHITECTURE.md says why this is not left to a reader that goes from YAML straight to types.

mod locator;
mod tabs;

use crate::syntax::tree::{Entry, Node, Scalar, Span, Value, is_null};
use crate::syntax::{Override, Problem, Problems, Source, Yaml};
use locator::Locator;
use saphyr_parser::{Event, Parser, ScalarStyle};
use std::collections::HashMap;
use std::ops::Range;
use std::sync::Arc;

/// Values that a scene's text may hold, before aliases are expanded.
pub const MAX_VALUES: usize = 1 << 21;
/// Values that aliases may add to a scene.
pub const ALIAS_BUDGET: usize = 1 << 18;
/// Bytes of text that aliases may add to a scene.
pub const ALIAS_BYTES: usize = 1 << 24;
/// Levels of lists and maps in a scene.
pub const MAX_DEPTH: usize = 64;

/// The tree of `source`'s bytes `range`, if they could be read to their end; without what is wrong with
/// it. Places are marked as of source number `number`. Syntax errors end the reading.
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
    builder.run(Parser::new_from_str(text)).ok()?;
    let Builder { root, merged, .. } = builder;
    let root = root.filter(|node| node.value != Value::Null);
    if root.is_none() && problems.count() == known {
        // A value of an override is a part of its text.
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
    // What a merge would have brought in would be reported as missing.
    root.filter(|_| !merged)
}

/// What kind of text `saphyr-parser` refuses. Its errors are words and a place, without a kind: the words are
/// read here and nowhere else, and a test holds those of the version in use.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Refusal {
    UnknownAlias,
    TooDeep,
    /// A character that no editor shows.
    Invisible,
    /// A tab in the indentation of a line.
    Indentation,
    /// A tab between an indicator and what follows it.
    Separation,
    Syntax,
}

impl Refusal {
    fn of(words: &str) -> Self {
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
    values: usize,
    /// Values and bytes that aliases have added.
    expanded: [usize; 2],
    documents: usize,
    problems: &'a mut Problems,
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
        let refusal = Refusal::of(why);
        let why = why.to_owned();
        let tab = self.locator.indented_by_tab(at);
        let (at, what) = match refusal {
            Refusal::UnknownAlias => (at, Yaml::UnknownAlias),
            Refusal::TooDeep => (at, Yaml::TooDeep { most: MAX_DEPTH }),
            Refusal::Invisible => (at, Yaml::Invisible { why }),
            Refusal::Separation => (at, Yaml::TabSeparates { why }),
            // Of a text of several lines, the parser names the first.
            Refusal::Indentation => (tab.unwrap_or(at), Yaml::TabIndents { why }),
            // It may be the tab that the parser stumbled over.
            Refusal::Syntax if tab == Some(at) => (at, Yaml::TabIndents { why }),
            Refusal::Syntax => (at, Yaml::Syntax { why }),
        };
        let span = self.locator.word(at);
        self.stop(span, what)
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

    /// Were the parser to word its errors otherwise, authors would be told less.
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
            assert_eq!(words.map(Refusal::of), Some(expected), "{words:?}");
        }
    }
}
