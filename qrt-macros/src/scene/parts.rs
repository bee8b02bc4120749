//! Parsers of the entries that a scene may have several of: materials, primitives and rays.

use super::body::{Body, Origin};
use super::records::no_comma;
use super::tokens::{Token, join};
use super::values::{entry, faulty, text};
use qrt_syntax::codes;
use qrt_syntax::tree::{Node, Span, Value};
use std::sync::Arc;

impl Body {
    pub(super) fn material(&mut self, first: &Token, rest: &[Token], place: Span) {
        let Some((name, rest)) = rest.split_first() else {
            return self.form(first.place(), "a material has a name", "material");
        };
        let Some(key) = name.name() else {
            let message = format!("expected the name of a material, found {}", name.found());
            return self.form(name.place(), message, "material");
        };
        let node = match rest {
            [colon, rest @ ..] if colon.is_sign(':') => {
                self.variant("material", colon, rest, place)
            }
            _ => {
                let message = format!("`{key}` is not followed by `:` and a kind");
                self.form(name.place(), message, "material");
                faulty(place)
            }
        };
        let new = entry(key, name.place(), node);
        self.reader.enter(&mut self.materials, new);
    }

    /// Reads `quad label: white { ... }`; label and material may be missing.
    pub(super) fn primitive(
        &mut self,
        kind: &'static str,
        first: &Token,
        rest: &[Token],
        place: Span,
    ) {
        let (label, rest) = self.label(kind, rest);
        let (material, rest) = match rest {
            [colon, name, rest @ ..] if colon.is_sign(':') && name.name().is_some() => {
                let found = name.name().unwrap_or_default();
                (
                    Some(entry("material", name.place(), text(found, name.place()))),
                    rest,
                )
            }
            [colon, rest @ ..] if colon.is_sign(':') => {
                let message = "expected the name of a material behind `:`";
                self.form(colon.place(), message, kind);
                return self.add_primitive(kind, label, faulty(place));
            }
            rest => (None, rest),
        };
        let Some((at, inner)) = self.braces(kind, first, rest) else {
            return self.add_primitive(kind, label, faulty(place));
        };
        let mut record = if let "mesh" | "sphere" | "disc" | "box" = kind {
            self.reader.record(kind, inner, at)
        } else {
            let Some(record) = self.outline(kind, inner, at) else {
                return self.add_primitive(kind, label, faulty(place));
            };
            Node {
                span: place,
                ..record
            }
        };
        if let Value::Map(entries) = &mut record.value {
            Arc::make_mut(entries).extend(material);
        }
        let value = Value::Map(vec![entry(kind, first.place(), record)].into());
        self.add_primitive(kind, label, Node { span: place, value });
    }

    fn add_primitive(&mut self, kind: &'static str, label: Option<String>, node: Node) {
        let pass = self.reader.names.passes();
        self.primitives.push(Origin { kind, label, pass });
        self.geometry.push(node);
    }

    /// Reads the points of a quad or a triangle, and the keys after them.
    fn outline(&mut self, kind: &str, inner: &[Token], at: Span) -> Option<Node> {
        let is_key = |pair: &[Token]| pair[0].word().is_some() && pair[1].is_sign(':');
        let end = inner.windows(2).position(is_key).unwrap_or(inner.len());
        let (points, keys) = inner.split_at(end);
        let named = |pair: &&[Token]| is_key(pair) && (end == 0 || pair[0].is_word("vertices"));
        if let Some([key, colon]) = keys.windows(2).find(named) {
            let place = join(key.place(), colon.place());
            if key.is_word("material") {
                self.reader
                    .faults
                    .add(
                        codes::MACRO_MATERIAL,
                        place,
                        "the material stands before the braces",
                    )
                    .help(format!("write `{kind}: white {{ ... }}`"));
            } else {
                self.form(
                    place,
                    format!("the points of a {kind} stand first, without a key"),
                    kind,
                );
            }
            return None;
        }
        if let ([.., last], [key, ..]) = (points, keys)
            && !last.is_sign(',')
        {
            no_comma(key, &mut self.reader.faults);
        }
        let points = self.reader.points(points, at);
        let mut record = self.reader.record(kind, keys, at);
        if let Value::Map(entries) = &mut record.value {
            Arc::make_mut(entries).insert(0, entry("vertices", at, points));
        }
        Some(record)
    }

    pub(super) fn depth(&mut self, first: &Token, rest: &[Token], place: Span) {
        let (label, rest) = self.label("depth", rest);
        let node = match self.braces("depth", first, rest) {
            Some((at, inner)) => {
                let node = self.reader.record("depth", inner, at);
                if self.reader.incomplete.contains(&at) {
                    self.reader.incomplete.push(place);
                }
                node
            }
            None => faulty(place),
        };
        let (kind, pass) = ("depth", self.reader.names.passes());
        self.rays.push(Origin { kind, label, pass });
        // The place of the ray itself is that of its whole entry.
        self.depths.push(Node {
            span: place,
            ..node
        });
    }

    /// Reads the label in front of `rest`, which must be new.
    fn label<'t>(&mut self, kind: &str, rest: &'t [Token]) -> (Option<String>, &'t [Token]) {
        let Some((first, after)) = rest.split_first() else {
            return (None, rest);
        };
        let Some(label) = first.word() else {
            return (None, rest);
        };
        let found = self.labels.iter().find(|(other, _)| other == label);
        match found {
            // The same label, in another pass of a loop.
            Some((_, place)) if *place == first.place() => {}
            Some((_, place)) => {
                let message = format!("the label `{label}` is given twice");
                self.reader
                    .faults
                    .add(codes::MACRO_LABEL, first.place(), message)
                    .also(*place, "the first is")
                    .help(format!("give this {kind} another label, or none"));
            }
            None => self.labels.push((label.to_owned(), first.place())),
        }
        (Some(label.to_owned()), after)
    }
}
