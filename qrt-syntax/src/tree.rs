//! The syntax tree that every front end builds from its text, with the place of each node.
//!
//! YAML text and the tokens of the `qrt!` macro both become a tree of this type. Everything after
//! it (the decoder of scenes, their checks, the rendering of errors) is
//! shared.

use super::path::{Path, Step};
use std::fmt;
use std::sync::Arc;

/// A place in a source. The front end that created it defines the numbers: for text they are byte
/// offsets into source number `source`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Span {
    /// Number of the source: 0 is the scene itself, then one for each override.
    pub source: u32,
    /// The first byte of the place.
    pub start: usize,
    /// The byte after the last one of the place.
    pub end: usize,
}

/// A value and its place.
#[derive(Clone, Debug, PartialEq)]
pub struct Node {
    /// The place where the value stands.
    pub span: Span,
    /// The value itself.
    pub value: Value,
}

/// A value without a type.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// No value: nothing is written, or `~` or `null`.
    Null,
    /// A value that could not be read; the problem has been reported.
    Unread,
    /// A number, a word or a text; [`Scalar::kind`] tells which.
    Scalar(Scalar),
    /// A list of elements, in their order. Copies share them, as aliases do in YAML.
    List(Arc<Vec<Node>>),
    /// Entries in the order written; keys are distinct. Copies share them.
    Map(Arc<Vec<Entry>>),
}

/// The text of a scalar.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Scalar {
    /// The text without quotes, its escapes resolved.
    pub text: String,
    /// True if the scalar is in quotes or a block, so that it is always text.
    pub quoted: bool,
}

/// The type of a scalar by the core schema of YAML 1.2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    /// A number, whole or not; it is infinite where the text is beyond the range of 64 bits.
    Number(f64),
    /// `true` or `false`.
    Bool(bool),
    /// Anything else.
    Text,
}

impl Scalar {
    /// Returns the scalar's type by the core schema of YAML 1.2 (section 10.3.2).
    pub fn kind(&self) -> Kind {
        if self.quoted {
            return Kind::Text;
        }
        match self.text.as_str() {
            "true" | "True" | "TRUE" => Kind::Bool(true),
            "false" | "False" | "FALSE" => Kind::Bool(false),
            text => number(text).map_or(Kind::Text, Kind::Number),
        }
    }

    /// True if this number is written with a digit other than 0 in its mantissa.
    pub fn has_digits(&self) -> bool {
        let mantissa = self.text.split(['e', 'E']).next().unwrap_or_default();
        mantissa.bytes().any(|b| b.is_ascii_digit() && b != b'0')
    }
}

/// True if `text` without quotes means "nothing".
pub fn is_null(text: &str) -> bool {
    matches!(text, "" | "~" | "null" | "Null" | "NULL")
}

/// Reads `[-+]?(.inf|.Inf|.INF)`, `.nan`, `0o` and `0x` integers, decimal integers and floats.
fn number(text: &str) -> Option<f64> {
    if matches!(text, ".nan" | ".NaN" | ".NAN") {
        return Some(f64::NAN);
    }
    let (negative, body) = match text.as_bytes().first()? {
        b'-' => (true, &text[1..]),
        b'+' => (false, &text[1..]),
        _ => (false, text),
    };
    let sign = if negative { -1.0 } else { 1.0 };
    if matches!(body, ".inf" | ".Inf" | ".INF") {
        return Some(sign * f64::INFINITY);
    }
    if text.len() == body.len() {
        for (prefix, radix) in [("0o", 8), ("0x", 16)] {
            if let Some(digits) = body.strip_prefix(prefix) {
                return radix_number(digits, radix);
            }
        }
    }
    if !is_decimal(body) {
        return None;
    }
    // `f64::from_str` reads all floats of YAML's grammar.
    body.parse::<f64>().ok().map(|value| sign * value)
}

fn radix_number(digits: &str, radix: u32) -> Option<f64> {
    if digits.is_empty() {
        return None;
    }
    digits.chars().try_fold(0.0, |value: f64, c| {
        Some(value * f64::from(radix) + f64::from(c.to_digit(radix)?))
    })
}

/// True if `text` is `( \. [0-9]+ | [0-9]+ ( \. [0-9]* )? ) ( [eE] [-+]? [0-9]+ )?`.
fn is_decimal(text: &str) -> bool {
    let digits = |s: &str| s.bytes().take_while(u8::is_ascii_digit).count();
    let whole = digits(text);
    let mut rest = &text[whole..];
    let mut fraction = 0;
    if let Some(after) = rest.strip_prefix('.') {
        fraction = digits(after);
        rest = &after[fraction..];
    }
    if whole + fraction == 0 {
        return false;
    }
    match rest.strip_prefix(['e', 'E']) {
        None => rest.is_empty(),
        Some(exponent) => {
            let exponent = exponent.strip_prefix(['-', '+']).unwrap_or(exponent);
            !exponent.is_empty() && digits(exponent) == exponent.len()
        }
    }
}

/// A key and its value.
#[derive(Clone, Debug, PartialEq)]
pub struct Entry {
    /// The key, without quotes.
    pub key: String,
    /// The place of the key.
    pub key_span: Span,
    /// The value of the key.
    pub value: Node,
}

impl Node {
    /// Returns the entry of `key`, if this node is a map that has one.
    pub fn entry(&self, key: &str) -> Option<&Entry> {
        match &self.value {
            Value::Map(entries) => entries.iter().find(|entry| entry.key == key),
            _ => None,
        }
    }

    /// Returns the kind of this node, for "expected a number, found ...".
    pub fn found(&self) -> Found {
        match &self.value {
            Value::Null | Value::Unread => Found::Nothing,
            Value::List(items) => Found::List(items.len()),
            Value::Map(_) => Found::Map,
            Value::Scalar(scalar) => Found::Scalar(scalar.clone()),
        }
    }

    /// Returns the node at `path`, or its nearest ancestor that is written (a default is not
    /// written). The span to show is that of the key if the path ends in a name.
    pub fn resolve(&self, path: &Path) -> Resolved<'_> {
        let mut found = Resolved {
            node: self,
            span: self.span,
            exact: true,
        };
        for step in &path.0 {
            let Some((node, span)) = found.node.below(step) else {
                found.exact = false;
                break;
            };
            (found.node, found.span) = (node, span);
        }
        found
    }

    /// The node one step below, and its place.
    fn below(&self, step: &Step) -> Option<(&Node, Span)> {
        match (step, &self.value) {
            (Step::Key(key), Value::Map(_)) => {
                let Entry {
                    key_span, value, ..
                } = self.entry(key)?;
                let is_written = value.value != Value::Null;
                Some((value, if is_written { value.span } else { *key_span }))
            }
            (Step::Name(key), Value::Map(_)) => {
                let entry = self.entry(key)?;
                Some((&entry.value, entry.key_span))
            }
            (Step::Item(index), Value::List(items)) => {
                let item = items.get(*index)?;
                Some((item, item.span))
            }
            // A list of one may be written without its brackets.
            (Step::Item(0), Value::Scalar(_)) => Some((self, self.span)),
            _ => None,
        }
    }

    /// Number of nodes in this tree, the root included, and of bytes in their texts and keys. Nodes
    /// that copies share count once per copy.
    pub fn size(&self) -> [usize; 2] {
        let one = |bytes: usize, below: [usize; 2]| [1 + below[0], bytes + below[1]];
        let sum = |a: [usize; 2], b: [usize; 2]| [a[0] + b[0], a[1] + b[1]];
        match &self.value {
            Value::Null | Value::Unread => one(0, [0; 2]),
            Value::Scalar(scalar) => one(scalar.text.len(), [0; 2]),
            Value::List(items) => one(0, items.iter().map(Node::size).fold([0; 2], sum)),
            Value::Map(entries) => {
                let keys = entries.iter().map(|entry| entry.key.len()).sum();
                let values = entries.iter().map(|entry| entry.value.size());
                one(keys, values.fold([0; 2], sum))
            }
        }
    }

    /// Number of nested levels of lists and maps in this tree.
    pub fn height(&self) -> usize {
        match &self.value {
            Value::Null | Value::Unread | Value::Scalar(_) => 0,
            Value::List(items) => 1 + items.iter().map(Node::height).max().unwrap_or(0),
            Value::Map(entries) => {
                1 + entries
                    .iter()
                    .map(|entry| entry.value.height())
                    .max()
                    .unwrap_or(0)
            }
        }
    }
}

/// The node that a path leads to in a tree.
#[derive(Clone, Copy, Debug)]
pub struct Resolved<'a> {
    /// The node at the path, or its nearest ancestor.
    pub node: &'a Node,
    /// The place to show.
    pub span: Span,
    /// True if the whole path is written.
    pub exact: bool,
}

/// The kind of value found at a place.
#[derive(Clone, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum Found {
    Nothing,
    List(usize),
    Map,
    Scalar(Scalar),
}

impl fmt::Display for Found {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Nothing => f.write_str("nothing"),
            Self::List(1) => f.write_str("a list of one"),
            Self::List(count) => write!(f, "a list of {count}"),
            Self::Map => f.write_str("a map"),
            Self::Scalar(scalar) => match scalar.kind() {
                Kind::Number(_) => write!(f, "the number {}", scalar.text),
                Kind::Bool(_) => write!(f, "the truth value {}", scalar.text),
                Kind::Text => write!(f, "the text \"{}\"", shorten(&scalar.text)),
            },
        }
    }
}

/// Shortens `text` to 40 characters and appends `...`, if it is longer.
pub fn shorten(text: &str) -> String {
    let mut short: String = text.chars().take(40).collect();
    if short.len() < text.len() {
        short.push_str("...");
    }
    short
}

#[cfg(test)]
mod tests {
    use super::*;

    fn kind(text: &str) -> Kind {
        Scalar {
            text: text.into(),
            quoted: false,
        }
        .kind()
    }

    #[test]
    fn scalars_follow_the_core_schema() {
        for (text, value) in [
            ("0", 0.0),
            ("-19", -19.0),
            ("+12", 12.0),
            ("010", 10.0),
            ("0o14", 12.0),
            ("0x3A", 58.0),
            ("0.", 0.0),
            ("-0.0", 0.0),
            (".5", 0.5),
            ("+12e03", 12000.0),
            ("-2E+05", -200_000.0),
            ("1e999", f64::INFINITY),
            ("-.INF", f64::NEG_INFINITY),
        ] {
            assert_eq!(kind(text), Kind::Number(value), "{text}");
        }
        assert!(matches!(kind(".nan"), Kind::Number(v) if v.is_nan()));
        for text in [
            "", ".", "-", "e3", "1e", "1e+", "1_000", "inf", "nan", "-0x1", "0x", "1.2.3", "1 2",
        ] {
            assert_eq!(kind(text), Kind::Text, "{text}");
        }
        assert_eq!(kind("True"), Kind::Bool(true));
        assert_eq!(
            Scalar {
                text: "1".into(),
                quoted: true
            }
            .kind(),
            Kind::Text
        );
    }
}
