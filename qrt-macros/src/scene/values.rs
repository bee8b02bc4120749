//! Values and records: the tokens after a key, as nodes of the same tree that YAML becomes.

use super::expression::{Expression, number};
use super::fault::Faults;
use super::names::Names;
use super::tokens::{Kind, Token, between_commas, join, place_of, written};
use proc_macro2::Delimiter;
use qrt_syntax::codes;
use qrt_syntax::tree::{Entry, Node, Scalar, Span, Value};
use std::sync::Arc;

/// A reader of values, with the state that later readers and reports need.
#[derive(Debug, Default)]
pub(crate) struct Reader {
    /// All faults found so far.
    pub(crate) faults: Faults,
    /// The author's names that stand for numbers here.
    pub(crate) names: Names,
    /// The names of all constants of the scene, including those that are defined later.
    pub(crate) later: Vec<String>,
    /// The expressions: a node of source `n` is number `n - 1`.
    pub(crate) expressions: Vec<Expression>,
    /// Records in which a key could not be read: a key that they lack may be that one.
    pub(crate) incomplete: Vec<Span>,
}

/// The kind of value of a key.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Sort {
    /// Numbers, points and colours.
    Plain,
    /// One of the words that the key allows.
    Word,
    /// A text in quotes.
    Text,
    /// An expression in the variables of a BSDF.
    Expression,
    /// One expression in the variables of a BSDF, or three: red, green and blue.
    Channels,
    /// A map from the unit square to directions: `|u, v| (x, y, z)`.
    Map,
}

impl Sort {
    /// Returns the kind of value that `key` has in a record with the name `record`.
    fn of_key(record: &str, key: &str) -> Self {
        match (record, key) {
            ("bsdf", "map") => Self::Map,
            ("bsdf", "jacobian" | "pdf") => Self::Expression,
            ("bsdf", "value") => Self::Channels,
            (
                _,
                "sequence" | "map" | "at" | "window" | "estimator" | "uncompute" | "nearest"
                | "fraction" | "lights" | "light" | "colors",
            ) => Self::Word,
            (_, "name" | "obj" | "ply" | "gltf") => Self::Text,
            _ => Self::Plain,
        }
    }
}

/// Creates a node of a text, as in quotes.
pub(crate) fn text(text: &str, span: Span) -> Node {
    scalar(text.to_owned(), true, span)
}

/// Creates a node of a number or a word; with `quoted`, of a text.
pub(crate) fn scalar(text: String, quoted: bool, span: Span) -> Node {
    let value = Value::Scalar(Scalar { text, quoted });
    Node { span, value }
}

/// Creates a node in place of a value that could not be read and has been reported.
pub(crate) fn faulty(span: Span) -> Node {
    let value = Value::Unread;
    Node { span, value }
}

/// Creates an entry of a map.
pub(crate) fn entry(key: &str, key_span: Span, value: Node) -> Entry {
    Entry {
        key: key.to_owned(),
        key_span,
        value,
    }
}

impl Reader {
    /// Reads the value of `key`, which stands at `at`, in a record with the name `record`.
    pub(crate) fn value(&mut self, record: &str, key: &str, at: Span, tokens: &[Token]) -> Node {
        let Some(place) = place_of(tokens) else {
            let message = format!("`{key}` has no value");
            let fault = self.faults.add(codes::MACRO_VALUE, at, message);
            fault.help(match super::advice::example(key) {
                Some(example) => format!("write `{example}`"),
                None => format!("write `{key}: ...`"),
            });
            return faulty(at);
        };
        match Sort::of_key(record, key) {
            Sort::Plain => self.plain(key, tokens, place),
            Sort::Word => self.word(key, tokens, place),
            Sort::Text => self.text(key, tokens, place),
            Sort::Expression => self.expression(tokens, place),
            Sort::Channels => self.channels(tokens, place),
            Sort::Map => self.map(tokens, place),
        }
    }

    fn plain(&mut self, key: &str, tokens: &[Token], place: Span) -> Node {
        match tokens {
            [
                Token {
                    kind: Kind::Text(own),
                    ..
                },
            ] => return text(own, place),
            [only] => {
                if let Some(items) = list(only) {
                    return self.list(key, items, place, Self::plain);
                }
                if let Some(inner) = only.group(Delimiter::Brace) {
                    return self.record(key, inner, place);
                }
            }
            [rgb, channels] if rgb.is_word("rgb") => {
                if let Some(inner) = channels.group(Delimiter::Parenthesis) {
                    return self.list(key, between_commas(inner), place, Self::plain);
                }
            }
            [first, second, ..] if list(first).is_some() && list(second).is_some() => {
                self.faults
                    .add(
                        codes::MACRO_COMMA,
                        second.place(),
                        "there is no comma before this",
                    )
                    .help("write `,` between two points");
                return faulty(place);
            }
            _ => {}
        }
        match number(tokens, &self.names, &self.later, &mut self.faults) {
            Some(text) => scalar(text, false, place),
            None => faulty(place),
        }
    }

    /// Reads the points of a primitive, whose braces stand at `place`.
    pub(crate) fn points(&mut self, tokens: &[Token], place: Span) -> Node {
        self.list("vertices", between_commas(tokens), place, Self::plain)
    }

    /// Reads the elements of a list, each by `read`.
    fn list(
        &mut self,
        key: &str,
        items: Vec<&[Token]>,
        place: Span,
        read: fn(&mut Self, &str, &[Token], Span) -> Node,
    ) -> Node {
        let mut nodes = Vec::with_capacity(items.len());
        // A missing element is shown at the one before it.
        let mut before = place;
        for item in items {
            let Some(here) = place_of(item) else {
                self.faults
                    .add(
                        codes::MACRO_VALUE,
                        before,
                        "nothing stands between two commas",
                    )
                    .help("write a value, or take one of the commas away");
                nodes.push(faulty(before));
                continue;
            };
            before = here;
            nodes.push(read(self, key, item, here));
        }
        let value = Value::List(Arc::new(nodes));
        Node { span: place, value }
    }

    fn word(&mut self, key: &str, tokens: &[Token], place: Span) -> Node {
        match tokens {
            [only] => {
                if let Some(word) = only.word().filter(|word| self.names.value(word).is_none()) {
                    return scalar(word.replace('_', "-"), false, place);
                }
            }
            [first, .., last] if first.word().is_some() && last.word().is_some() => {
                let hyphens = tokens.iter().skip(1).step_by(2);
                if tokens.len() % 2 == 1 && hyphens.clone().all(|token| token.is_sign('-')) {
                    let words: Vec<&str> = tokens.iter().filter_map(Token::word).collect();
                    let message = format!("`{}` is not one word", words.join("-"));
                    self.faults
                        .add(codes::MACRO_WORD, place, message)
                        .help(format!("write `{}`", words.join("_")));
                    return faulty(place);
                }
            }
            _ => {}
        }
        self.plain(key, tokens, place)
    }

    fn text(&mut self, key: &str, tokens: &[Token], place: Span) -> Node {
        if let Some(word) = tokens.first().and_then(Token::word) {
            let message = format!("the text of `{key}` is not in quotes");
            self.faults
                .add(codes::MACRO_TEXT, place, message)
                .help(format!("write `{key}: \"{word}\"`"));
            return faulty(place);
        }
        self.plain(key, tokens, place)
    }

    fn expression(&mut self, tokens: &[Token], place: Span) -> Node {
        if let [bar, rest @ ..] = tokens
            && bar.is_sign('|')
        {
            let body = rest.iter().position(|token| token.is_sign('|'));
            let body = body.map_or(rest, |end| &rest[end + 1..]);
            let message = "an expression names its variables without declaring them";
            self.faults
                .add(codes::MACRO_VALUE, place, message)
                .help(format!("write `{}`", written(body)));
            return faulty(place);
        }
        if let Some(help) = apart(tokens) {
            let message = "`rgb(..)` stands for all of `value`";
            self.faults
                .add(codes::MACRO_VALUE, place, message)
                .help(help);
            return faulty(place);
        }
        let Some(expression) = Expression::from_tokens(tokens, &self.names, &mut self.faults)
        else {
            return faulty(place);
        };
        if self.names.are_faulty(tokens) {
            return faulty(place);
        }
        self.text_of(expression, place)
    }

    fn text_of(&mut self, expression: Expression, place: Span) -> Node {
        let text = expression.text.clone();
        self.expressions.push(expression);
        let source = u32::try_from(self.expressions.len()).unwrap_or_default();
        scalar(text, false, Span { source, ..place })
    }

    fn channels(&mut self, tokens: &[Token], place: Span) -> Node {
        let inner = match tokens {
            [rgb, channels] if rgb.is_word("rgb") => {
                channels.group(Delimiter::Parenthesis).map(between_commas)
            }
            [only] => list(only),
            _ => None,
        };
        match inner {
            Some(items) => self.list("value", items, place, |reader, _, tokens, place| {
                reader.expression(tokens, place)
            }),
            None => self.expression(tokens, place),
        }
    }

    /// Reads `|u, v| (x, y, z)`.
    fn map(&mut self, tokens: &[Token], place: Span) -> Node {
        if let [bar, u, comma, v, close, body] = tokens
            && bar.is_sign('|')
            && comma.is_sign(',')
            && close.is_sign('|')
            && let (Some(first), Some(second)) = (u.word(), v.word())
        {
            if (first, second) != ("u", "v") {
                let message =
                    format!("a map's variables are `u` and `v`, not `{first}` and `{second}`");
                self.faults
                    .add(codes::MACRO_MAP, join(u.place(), v.place()), message)
                    .help("write `|u, v|`: the Jacobian and the value use the same names");
                return faulty(place);
            }
            if let Kind::Group(Delimiter::Parenthesis | Delimiter::Bracket, inner) = &body.kind {
                let items = between_commas(inner);
                return self.list("map", items, body.place(), |reader, _, tokens, place| {
                    reader.expression(tokens, place)
                });
            }
        }
        if let [bar, rest @ ..] = tokens
            && bar.is_sign('|')
            && let Some(end) = rest.iter().position(|token| token.is_sign('|'))
            && rest[..end].iter().any(|token| token.is_sign(':'))
        {
            let message = "the variables of a map have no types: both are numbers from 0 to 1";
            let bars = place_of(&tokens[..end + 2]).unwrap_or(place);
            self.faults
                .add(codes::MACRO_MAP, bars, message)
                .help("write `|u, v|`");
            return faulty(place);
        }
        self.faults
            .add(
                codes::MACRO_MAP,
                place,
                "a map is a function of `u` and `v`",
            )
            .help(format!(
                "write `{}`",
                super::advice::example("map").unwrap_or("map")
            ));
        faulty(place)
    }
}

/// Returns the advice for an expression with `rgb(r, g, b)` in it: the expression of each channel.
fn apart(tokens: &[Token]) -> Option<String> {
    let at = tokens.windows(2).position(|pair| {
        pair[0].is_word("rgb") && pair[1].group(Delimiter::Parenthesis).is_some()
    })?;
    let channels = between_commas(tokens[at + 1].group(Delimiter::Parenthesis)?);
    let (before, after) = (written(&tokens[..at]), written(&tokens[at + 2..]));
    let channels = channels.into_iter().map(|channel| {
        let own = match channel {
            [_] => written(channel),
            several => format!("({})", written(several)),
        };
        format!("{before} {own} {after}").trim().to_owned()
    });
    let channels: Vec<String> = channels.collect();
    Some(format!("write `rgb({})`", channels.join(", ")))
}

/// Returns the elements of `(a, b)`, `(a,)` or `[...]`; `(a)` is no list but a number in
/// parentheses.
fn list(token: &Token) -> Option<Vec<&[Token]>> {
    if let Some(inner) = token.group(Delimiter::Bracket) {
        return Some(between_commas(inner));
    }
    let inner = token.group(Delimiter::Parenthesis)?;
    let is_list = inner.is_empty() || inner.iter().any(|token| token.is_sign(','));
    is_list.then(|| between_commas(inner))
}
