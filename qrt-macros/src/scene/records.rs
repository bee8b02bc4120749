//! Records: `{ key: value, ... }`.

use super::fault::Faults;
use super::tokens::{Kind, Token, join, place_of};
use super::values::{Reader, entry, text};
use qrt_syntax::codes;
use qrt_syntax::tree::{Entry, Node, Span, Value};
use std::sync::Arc;

impl Reader {
    /// Reads a map of keys; `place` is that of its braces.
    pub(crate) fn record(&mut self, name: &str, tokens: &[Token], place: Span) -> Node {
        let mut entries: Vec<Entry> = Vec::new();
        for part in fields(tokens, &mut self.faults) {
            let Some((key, at, rest)) = self.key(name, part) else {
                self.incomplete.push(place);
                continue;
            };
            if let ("mesh" | "sphere" | "disc" | "box" | "quad" | "triangle", "material") =
                (name, key)
            {
                let white = place_of(rest).map_or(at, |end| join(at, end));
                self.faults
                    .add(
                        codes::MACRO_MATERIAL,
                        white,
                        "the material stands before the braces",
                    )
                    .help(format!(
                        "write `{name}: white {{ {} }}`",
                        match name {
                            "mesh" => "obj: \"mesh.obj\"",
                            "box" => "min: (-1, 0, -1), max: (1, 2, 1)",
                            "quad" => "(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)",
                            "triangle" => "(0, 0, 0), (1, 0, 0), (0, 1, 0)",
                            _ => "center: (0, 1, 0), radius: 1",
                        }
                    ));
                if let Some(name) = rest.first().filter(|name| name.name().is_some()) {
                    let material = text(name.name().unwrap_or_default(), name.place());
                    entries.push(entry(key, at, material));
                }
                continue;
            }
            let value = self.value(name, key, at, rest);
            self.enter(&mut entries, entry(key, at, value));
        }
        let value = Value::Map(Arc::new(entries));
        Node { span: place, value }
    }

    /// Splits `key: ...` into the key, its place and the tokens after the colon.
    fn key<'t>(&mut self, record: &str, part: &'t [Token]) -> Option<(&'t str, Span, &'t [Token])> {
        if let [first, colon, rest @ ..] = part
            && let Some(key) = first.word()
            && colon.is_sign(':')
        {
            return Some((key, first.place(), rest));
        }
        let place = place_of(part)?;
        let words: Vec<&str> = part
            .iter()
            .take_while(|token| !token.is_sign(':'))
            .filter_map(Token::word)
            .collect();
        let (message, help) = match part {
            [first, sign, ..] if first.word().is_some() && sign.is_sign('=') => (
                "a key is followed by `:`, not by `=`".to_owned(),
                format!("write `{}: ...`", words.join("_")),
            ),
            [first, sign, ..] if first.word().is_some() && sign.is_sign('-') => (
                "there are no hyphens in keys".to_owned(),
                format!("write `{}`", words.join("_")),
            ),
            [
                Token {
                    kind: Kind::Text(text),
                    ..
                },
                sign,
                ..,
            ] if sign.is_sign(':') => (
                "a key is not in quotes".to_owned(),
                format!("write `{text}: ...`"),
            ),
            _ => {
                let example = super::advice::record(record);
                let message = "expected `key: value`".to_owned();
                (message, format!("write {example}"))
            }
        };
        // The error is in front of the value.
        let before = part.iter().position(|token| token.is_sign(':'));
        let front = &part[..before.unwrap_or(part.len()).max(1)];
        let place = place_of(front).unwrap_or(place);
        self.faults.add(codes::MACRO_KEY, place, message).help(help);
        None
    }

    /// Adds an entry; reports a key that is already there.
    pub(crate) fn enter(&mut self, entries: &mut Vec<Entry>, new: Entry) {
        let Some(first) = entries.iter().find(|old| old.key == new.key) else {
            entries.push(new);
            return;
        };
        let message = format!("`{}` is written twice", new.key);
        self.faults
            .add(codes::DUPLICATE_KEY, new.key_span, message)
            .also(first.key_span, "the first is")
            .help("keep one of the two");
    }
}

/// Returns the entries of a record; reports a missing comma between two of them.
fn fields<'t>(tokens: &'t [Token], faults: &mut Faults) -> Vec<&'t [Token]> {
    let mut fields = Vec::new();
    let mut end = 0;
    for mut part in split_fields(tokens) {
        end += part.len() + 1;
        // A colon after the first belongs to another key, unless it stands between the bars of a
        // map.
        let bars = |tokens: &[Token]| tokens.iter().filter(|token| token.is_sign('|')).count();
        while let Some(at) = (2..part.len().saturating_sub(1)).find(|&at| {
            part[at].word().is_some()
                && bars(&part[..at]).is_multiple_of(2)
                && matches!(part[at + 1].kind, Kind::Sign(':', false))
                && !part[at - 1].is_sign(':')
                && !(part[at - 1].is_sign('-') && part[..at].iter().all(|t| !t.is_sign(':')))
        }) {
            no_comma(&part[at], faults);
            let (first, rest) = part.split_at(at);
            fields.push(first);
            part = rest;
        }
        if part.is_empty() {
            if let Some(comma) = tokens.get(end - 1) {
                let message = "nothing stands before this comma";
                faults
                    .add(codes::MACRO_COMMA, comma.place(), message)
                    .help("take it away");
            }
            continue;
        }
        fields.push(part);
    }
    fields
}

/// Reports that no comma stands in front of `key`.
pub(super) fn no_comma(key: &Token, faults: &mut Faults) {
    let message = format!("there is no comma before {}", key.found());
    faults
        .add(codes::MACRO_COMMA, key.place(), message)
        .help("write `,` in front of each key");
}

/// Returns the parts between commas; commas between the bars of a map separate nothing.
fn split_fields(tokens: &[Token]) -> Vec<&[Token]> {
    let mut parts = Vec::new();
    let mut start = 0;
    let mut in_bars = false;
    for (at, token) in tokens.iter().enumerate() {
        in_bars ^= token.is_sign('|');
        if token.is_sign(',') && !in_bars {
            parts.push(&tokens[start..at]);
            start = at + 1;
        }
    }
    if start < tokens.len() {
        parts.push(&tokens[start..]);
    }
    parts
}
