//! The film: `64 x 64`, which Rust may read as one token, two or three.

use super::body::Body;
use super::tokens::{Kind, Token, place_of};
use super::values::{entry, faulty};
use proc_macro2::Delimiter;
use qrt_syntax::tree::{Node, Value};
use std::sync::Arc;

impl Body {
    /// Reads the tokens after `film:`.
    pub(super) fn film(&mut self, first: &Token, rest: &[Token]) -> Node {
        let Some(place) = place_of(rest) else {
            self.form(first.place(), "`film` has no value", "film");
            return faulty(first.place());
        };
        if let [only] = rest
            && let Some(inner) = only.group(Delimiter::Brace)
        {
            return self.reader.record("film", inner, place);
        }
        let Some((width, height)) = sides(rest) else {
            self.form(place, "a film is its width, `x` and its height", "film");
            return faulty(place);
        };
        let mut side = |key: &str, tokens: &[Token]| {
            let node = self.reader.value("film", key, place, tokens);
            entry(key, node.span, node)
        };
        let value = Value::Map(Arc::new(vec![
            side("width", &width),
            side("height", &height),
        ]));
        Node { span: place, value }
    }
}

/// Returns the two sides of `64 x 64`, whose parts may be one token or several.
fn sides(tokens: &[Token]) -> Option<(Vec<Token>, Vec<Token>)> {
    let at = tokens.iter().position(|token| match &token.kind {
        Kind::Word(word) => split_x("", word).is_some(),
        Kind::Number(digits, suffix) => split_x(digits, suffix).is_some(),
        _ => false,
    })?;
    let token = &tokens[at];
    let (before, after) = match &token.kind {
        Kind::Word(word) => split_x("", word)?,
        Kind::Number(digits, suffix) => split_x(digits, suffix)?,
        _ => return None,
    };
    let number = |digits: String| Token {
        kind: Kind::Number(digits, String::new()),
        ..token.clone()
    };
    let mut width = tokens[..at].to_vec();
    width.extend(Some(before).filter(|text| !text.is_empty()).map(number));
    let mut height: Vec<Token> = Some(after)
        .filter(|text| !text.is_empty())
        .map(number)
        .into_iter()
        .collect();
    height.extend_from_slice(&tokens[at + 1..]);
    (!width.is_empty() && !height.is_empty()).then_some((width, height))
}

/// Returns `digits`, and the digits after the `x` that `text` begins with.
fn split_x(digits: &str, text: &str) -> Option<(String, String)> {
    let after = text.strip_prefix('x')?.replace('_', "");
    let is_number = after.bytes().all(|byte| byte.is_ascii_digit());
    is_number.then(|| (digits.to_owned(), after))
}
