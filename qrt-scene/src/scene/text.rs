//! Plain data as text: the scene printed back as YAML, its canonical text and fingerprint, and the
//! JSON Schema.

use qrt_syntax::number;
use std::fmt::Write as _;

/// Untyped data to which a scene is encoded: JSON's model, with ordered entries.
#[derive(Clone, Debug, PartialEq)]
pub enum Data {
    /// A number. NaN and infinities print as in YAML; a valid scene has none.
    Number(f64),
    /// `true` or `false`.
    Bool(bool),
    /// A text, which is not read as a number or a word.
    Text(String),
    /// A list of elements, in their order.
    List(Vec<Data>),
    /// A map of keys to values, in the order written.
    Map(Vec<(String, Data)>),
}

impl Data {
    /// A text, which is not read as a number or a word.
    pub fn text(text: impl Into<String>) -> Self {
        Self::Text(text.into())
    }

    /// A map of entries.
    pub fn map<const N: usize>(entries: [(&str, Data); N]) -> Self {
        Self::Map(
            entries
                .into_iter()
                .map(|(key, value)| (key.to_owned(), value))
                .collect(),
        )
    }

    /// Returns this map with one more entry; other data stay as they are.
    pub fn with(mut self, key: &str, value: Data) -> Self {
        if let Self::Map(entries) = &mut self {
            entries.push((key.to_owned(), value));
        }
        self
    }

    /// The value of `key` in a map.
    pub fn get(&self, key: &str) -> Option<&Data> {
        match self {
            Self::Map(entries) => entries.iter().find(|(name, _)| name == key).map(|(_, v)| v),
            _ => None,
        }
    }

    /// Formats the data as JSON on indented lines; short lists and maps stay on one line. The text
    /// ends in a line feed.
    pub(crate) fn to_json(&self) -> String {
        let mut out = String::new();
        self.json(&mut out, 0);
        out.push('\n');
        out
    }

    fn json(&self, out: &mut String, indent: usize) {
        let mut line = String::new();
        self.flow(&mut line, true);
        let short = indent + line.len() <= 90;
        let leaf = match self {
            Self::List(items) => items.iter().all(Self::is_scalar),
            Self::Map(entries) => entries.iter().all(|(_, value)| value.is_scalar()),
            _ => true,
        };
        if leaf && short || self.is_scalar() {
            out.push_str(&line);
            return;
        }
        let (open, close) = if matches!(self, Self::List(_)) {
            ('[', ']')
        } else {
            ('{', '}')
        };
        out.push(open);
        let mut first = true;
        let mut separate = |out: &mut String| {
            out.push_str(if std::mem::take(&mut first) {
                "\n"
            } else {
                ",\n"
            });
            out.extend(std::iter::repeat_n(' ', indent + 2));
        };
        match self {
            Self::List(items) => {
                for item in items {
                    separate(out);
                    item.json(out, indent + 2);
                }
            }
            Self::Map(entries) => {
                for (key, value) in entries {
                    separate(out);
                    quote(out, key);
                    out.push_str(": ");
                    value.json(out, indent + 2);
                }
            }
            _ => {}
        }
        out.push('\n');
        out.extend(std::iter::repeat_n(' ', indent));
        out.push(close);
    }

    /// Returns the canonical text, of which fingerprints are computed: one line of YAML flow style.
    pub fn canonical(&self) -> String {
        let mut out = String::new();
        self.flow(&mut out, false);
        out
    }

    /// Formats the data as YAML in blocks; lists and maps that fit into 100 columns stay on one
    /// line. The text ends in a line feed.
    pub fn to_yaml(&self) -> String {
        let mut out = String::new();
        self.block(&mut out, 0);
        out
    }

    fn is_scalar(&self) -> bool {
        !matches!(self, Self::List(_) | Self::Map(_))
    }

    fn is_empty(&self) -> bool {
        match self {
            Self::List(items) => items.is_empty(),
            Self::Map(entries) => entries.is_empty(),
            _ => false,
        }
    }

    /// Appends the data on one line. With `json`, keys and texts are always in quotes.
    fn flow(&self, out: &mut String, json: bool) {
        match self {
            Self::Number(value) => out.push_str(&number(*value)),
            Self::Bool(value) => out.push_str(if *value { "true" } else { "false" }),
            Self::Text(text) if json => quote(out, text),
            Self::Text(text) => word(out, text),
            Self::List(items) => {
                out.push('[');
                for (i, item) in items.iter().enumerate() {
                    if i > 0 {
                        out.push_str(", ");
                    }
                    item.flow(out, json);
                }
                out.push(']');
            }
            Self::Map(entries) if entries.is_empty() => out.push_str("{}"),
            Self::Map(entries) => {
                for (i, (key, value)) in entries.iter().enumerate() {
                    out.push_str(if i > 0 { ", " } else { "{ " });
                    if json {
                        quote(out, key);
                    } else {
                        word(out, key);
                    }
                    out.push_str(": ");
                    value.flow(out, json);
                }
                out.push_str(" }");
            }
        }
    }

    fn block(&self, out: &mut String, indent: usize) {
        let margin = |out: &mut String| out.extend(std::iter::repeat_n(' ', indent));
        match self {
            Self::Map(entries) if !entries.is_empty() => {
                for (key, value) in entries {
                    margin(out);
                    word(out, key);
                    out.push(':');
                    value.after(out, indent);
                }
            }
            Self::List(items) if !items.is_empty() => {
                for item in items {
                    margin(out);
                    out.push('-');
                    item.behind_dash(out, indent);
                }
            }
            _ => {
                margin(out);
                self.flow(out, false);
                out.push('\n');
            }
        }
    }

    /// Appends the value after a key: on the same line if it fits, else below.
    fn after(&self, out: &mut String, indent: usize) {
        if !self.fits(out) {
            out.push('\n');
            self.block(out, indent + 2);
        }
    }

    /// Appends the value after a dash, always from the dash's line on: a dash never stands alone.
    fn behind_dash(&self, out: &mut String, indent: usize) {
        if !self.fits(out) {
            let mut below = String::new();
            self.block(&mut below, indent + 2);
            out.push(' ');
            // The dash takes the place of the first line's margin.
            out.push_str(below.trim_start_matches(' '));
        }
    }

    /// Appends the data to the current line if they fit, and returns whether they do.
    fn fits(&self, out: &mut String) -> bool {
        let mut line = String::new();
        self.flow(&mut line, false);
        let used = out.len() - out.rfind('\n').map_or(0, |at| at + 1);
        let fits = self.is_scalar() || self.is_empty() || used + 1 + line.len() <= 100;
        if fits {
            out.push(' ');
            out.push_str(&line);
            out.push('\n');
        }
        fits
    }
}

/// Appends a text: plain if it can be read as nothing else, otherwise in quotes.
fn word(out: &mut String, text: &str) {
    let mut bytes = text.bytes();
    let plain = bytes.next().is_some_and(|b| b.is_ascii_alphabetic())
        && bytes.all(|b| b.is_ascii_alphanumeric() || b == b'_' || b == b'-')
        && !["true", "false", "null", "yes", "no", "on", "off", "y", "n"]
            .contains(&text.to_ascii_lowercase().as_str());
    if plain {
        out.push_str(text);
    } else {
        quote(out, text);
    }
}

/// Appends a text in double quotes, with the escapes that JSON and YAML share.
fn quote(out: &mut String, text: &str) {
    out.push('"');
    for c in text.chars() {
        match c {
            '"' => out.push_str("\\\""),
            '\\' => out.push_str("\\\\"),
            '\n' => out.push_str("\\n"),
            '\t' => out.push_str("\\t"),
            ' '..='~' => out.push(c),
            _ if c.is_alphanumeric() || u32::from(c) > 0xffff => out.push(c),
            _ => {
                // Writing to a String cannot fail.
                let _ = write!(out, "\\u{:04x}", u32::from(c));
            }
        }
    }
    out.push('"');
}

/// A 128-bit fingerprint of a scene: FNV-1a over bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Fingerprint(u128);

impl Fingerprint {
    /// The fingerprint of no bytes.
    pub const EMPTY: Self = Self(0x6c62_272e_07bb_0142_62b8_2175_6295_c58d);

    /// Returns the fingerprint of the bytes so far, followed by `bytes`.
    pub fn and(self, bytes: &[u8]) -> Self {
        const PRIME: u128 = 0x0000_0000_0100_0000_0000_0000_0000_013b;
        let step = |hash: u128, byte: &u8| (hash ^ u128::from(*byte)).wrapping_mul(PRIME);
        Self(bytes.iter().fold(self.0, step))
    }
}

impl std::fmt::Display for Fingerprint {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{:032x}", self.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fingerprints_are_fnv_1a() {
        // The published test vectors of the 128-bit variant.
        assert_eq!(
            Fingerprint::EMPTY.to_string(),
            "6c62272e07bb014262b821756295c58d"
        );
        assert_eq!(
            Fingerprint::EMPTY.and(b"a").to_string(),
            "d228cb696f1a8caf78912b704e4a8964"
        );
        assert_eq!(
            Fingerprint::EMPTY.and(b"foobar").to_string(),
            "343e1662793c64bf6f0d3597ba446f18"
        );
    }
}
