//! The entries of a scene, gathered into the same tree that YAML becomes.

use super::advice::example;
use super::tokens::{Token, join, place_of};
use super::values::{Reader, entry, faulty, text};
use proc_macro2::Delimiter;
use qrt_syntax::tree::{Entry, Node, Span, Value};
use qrt_syntax::{called, codes, listed, meant_by};
use std::sync::Arc;

/// The words that an entry can begin with.
pub(super) const ENTRIES: [&str; 22] = [
    "name",
    "camera",
    "film",
    "sky",
    "sun",
    "material",
    "quad",
    "triangle",
    "sphere",
    "disc",
    "box",
    "mesh",
    "depth",
    "sampling",
    "precision",
    "comparator",
    "counting",
    "circuit",
    "accuracy",
    "budget",
    "const",
    "for",
];
/// Entries that a loop may repeat.
const REPEATED: [&str; 9] = [
    "quad", "triangle", "sphere", "disc", "box", "mesh", "depth", "const", "for",
];

/// The origin of a primitive or a depth, with its author's label.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Origin {
    /// `quad`, `triangle`, `sphere`, `disc`, `box`, `mesh` or `depth`.
    pub(crate) kind: &'static str,
    /// The author's label; `None` if there is none.
    pub(crate) label: Option<String>,
    /// The loops' variables, such as `i = 3`; empty outside of loops.
    pub(crate) pass: String,
}

/// A scene's entries so far.
#[derive(Debug, Default)]
pub(crate) struct Body {
    pub(crate) reader: Reader,
    /// All entries but materials, primitives and depths.
    pub(crate) blocks: Vec<Entry>,
    pub(super) materials: Vec<Entry>,
    pub(super) geometry: Vec<Node>,
    pub(super) depths: Vec<Node>,
    /// The origin of each element of `geometry`.
    pub(crate) primitives: Vec<Origin>,
    /// The origin of each element of `depths`.
    pub(crate) rays: Vec<Origin>,
    pub(super) labels: Vec<(String, Span)>,
    /// Number of passes that loops have taken so far.
    pub(super) passes: usize,
}

impl Body {
    /// Reads the entries of a scene, or of a loop in it.
    pub(crate) fn entries(&mut self, tokens: &[Token], in_loop: bool) {
        let mut at = 0;
        let mut is_separated = true;
        while let Some(token) = tokens.get(at) {
            if token.is_sign('#') {
                at = self.attribute(tokens, at);
                continue;
            }
            if token.is_sign(',') {
                if is_separated {
                    let what = "nothing stands before this comma";
                    let faults = &mut self.reader.faults;
                    faults
                        .add(codes::MACRO_COMMA, token.place(), what)
                        .help("take it away");
                }
                is_separated = true;
                at += 1;
                continue;
            }
            let word = token.word().unwrap_or_default();
            if in_loop && ENTRIES.contains(&word) && !REPEATED.contains(&word) {
                let message = format!("`{word}` cannot stand in a loop");
                let faults = &mut self.reader.faults;
                faults
                    .add(codes::MACRO_LOOP_ENTRY, token.place(), message)
                    .help(format!(
                        "put it outside; a loop repeats {}",
                        listed(&REPEATED, "and")
                    ));
                if let Some(name) = tokens.get(at + 1).filter(|_| word == "material")
                    && let Some(key) = name.name()
                    && self.materials.iter().all(|material| material.key != key)
                {
                    let node = faulty(name.place());
                    self.materials.push(entry(key, name.place(), node));
                }
                (at, is_separated) = self.end(tokens, at);
                continue;
            }
            match word {
                "const" => {
                    at = self.constant(tokens, at);
                    is_separated = true;
                }
                "for" => {
                    at = self.repeat(tokens, at);
                    // A comma may follow, as after a match arm with braces.
                    is_separated = tokens.get(at).is_none_or(|next| !next.is_sign(','));
                }
                _ => {
                    let (end, next_is_separated) = self.end(tokens, at);
                    let own = tokens.get(at..end).unwrap_or_default();
                    let own = match own {
                        [own @ .., last] if last.is_sign(',') || last.is_sign(';') => own,
                        own => own,
                    };
                    self.entry(own);
                    at = end;
                    is_separated = next_is_separated;
                }
            }
        }
    }

    /// Skips a doc comment; reports any other attribute.
    fn attribute(&mut self, tokens: &[Token], at: usize) -> usize {
        let body = tokens.get(at + 1);
        let inner = body.and_then(|token| token.group(Delimiter::Bracket));
        let is_doc = inner.is_some_and(|inner| inner.first().is_some_and(|t| t.is_word("doc")));
        if !is_doc {
            let own = &tokens[at..tokens.len().min(at + 2)];
            let what = "an attribute has no meaning within a scene";
            self.reader
                .faults
                .add(
                    codes::MACRO_ATTRIBUTE,
                    place_of(own).unwrap_or_default(),
                    what,
                )
                .help("put it before the scene, or take it away");
        }
        at + 1 + usize::from(inner.is_some())
    }

    /// Returns the end of the entry at `at`, and whether a comma separates it from the next;
    /// reports a missing comma.
    fn end(&mut self, tokens: &[Token], at: usize) -> (usize, bool) {
        for next in at + 1..tokens.len() {
            let token = &tokens[next];
            if token.is_sign(',') {
                return (next + 1, true);
            }
            let faults = &mut self.reader.faults;
            if token.is_sign(';') {
                faults
                    .add(
                        codes::MACRO_COMMA,
                        token.place(),
                        "an entry ends in `,`, not in `;`",
                    )
                    .help("write `,`");
                return (next + 1, true);
            }
            let begins = token.word().is_some_and(|word| ENTRIES.contains(&word))
                && next > at + 1
                && !tokens[next - 1].is_sign(':')
                && tokens.get(next + 1).is_some_and(|after| {
                    after.is_sign(':')
                        || after.name().is_some()
                        || after.group(Delimiter::Brace).is_some()
                });
            if begins {
                let message = format!("there is no comma before {}", token.found());
                faults
                    .add(codes::MACRO_COMMA, token.place(), message)
                    .help("write `,` between two entries");
                return (next, true);
            }
        }
        (tokens.len(), false)
    }

    fn entry(&mut self, own: &[Token]) {
        let Some((first, rest)) = own.split_first() else {
            return;
        };
        let place = place_of(own).unwrap_or_default();
        let Some(word) = first.word() else {
            let message = format!("expected an entry of a scene, found {}", first.found());
            self.reader
                .faults
                .add(codes::MACRO_FORM, first.place(), message)
                .help(format!("entries begin with {}", listed(&ENTRIES, "or")));
            return;
        };
        match word {
            "name" => {
                if let Some(rest) = self.after_colon(first, rest) {
                    let node = self.reader.value("scene", "name", first.place(), rest);
                    self.block("name", first.place(), node);
                }
            }
            "camera" => {
                if let Some(rest) = self.after_colon(first, rest) {
                    let node = self.variant("camera", first, rest, place);
                    self.block("camera", first.place(), node);
                }
            }
            "film" => {
                if let Some(rest) = self.after_colon(first, rest) {
                    let node = self.film(first, rest);
                    self.block("film", first.place(), node);
                }
            }
            "material" => self.material(first, rest, place),
            "quad" => self.primitive("quad", first, rest, place),
            "triangle" => self.primitive("triangle", first, rest, place),
            "sphere" => self.primitive("sphere", first, rest, place),
            "disc" => self.primitive("disc", first, rest, place),
            "box" => self.primitive("box", first, rest, place),
            "mesh" => self.primitive("mesh", first, rest, place),
            "depth" => self.depth(first, rest, place),
            "sky" | "sun" | "sampling" | "precision" | "comparator" | "counting" | "circuit"
            | "accuracy" | "budget" => {
                let node = match self.braces(word, first, rest) {
                    Some((braces, inner)) => self.reader.record(word, inner, braces),
                    None => faulty(place),
                };
                self.block(word, first.place(), node);
            }
            _ => {
                let message = format!("no entry of a scene is called `{word}`");
                let near = meant_by("the scene", word, ENTRIES)
                    .or_else(|| meant_by("a primitive", word, ENTRIES));
                let help = called("the scene", word, &ENTRIES)
                    .or_else(|| called("a primitive", word, &ENTRIES));
                let faults = &mut self.reader.faults;
                faults
                    .add(codes::MACRO_ENTRY, first.place(), message)
                    .help(match (help, near) {
                        (Some(help), _) => help,
                        (None, Some(near)) => format!("did you mean `{near}`?"),
                        (None, None) => format!("there are {}", listed(&ENTRIES, "and")),
                    });
                // The entry that the author meant counts as present.
                let absent = |key: &str| self.blocks.iter().all(|block| block.key != key);
                if let Some(near @ ("name" | "camera" | "film")) = near
                    && absent(near)
                {
                    self.block(near, first.place(), faulty(place));
                }
            }
        }
    }

    /// Adds an entry that a scene has once.
    fn block(&mut self, key: &str, at: Span, node: Node) {
        self.reader.enter(&mut self.blocks, entry(key, at, node));
    }

    /// Reports that an entry is not in its form.
    #[cfg_attr(test, track_caller)]
    pub(super) fn form(&mut self, place: Span, message: impl Into<String>, key: &str) {
        let fault = self.reader.faults.add(codes::MACRO_FORM, place, message);
        fault.help(format!("write `{}`", example(key).unwrap_or(key)));
    }

    /// Returns the tokens after the colon that follows `first`.
    fn after_colon<'t>(&mut self, first: &Token, rest: &'t [Token]) -> Option<&'t [Token]> {
        if let [colon, rest @ ..] = rest
            && colon.is_sign(':')
        {
            return Some(rest);
        }
        let key = first.word().unwrap_or_default();
        let message = format!("`{key}` is not followed by `:`");
        self.form(first.place(), message, key);
        self.block(key, first.place(), faulty(first.place()));
        None
    }

    /// Returns the place of the braces that `rest` consists of, and the tokens in them.
    pub(super) fn braces<'t>(
        &mut self,
        key: &str,
        first: &Token,
        rest: &'t [Token],
    ) -> Option<(Span, &'t [Token])> {
        if let [token, more @ ..] = rest
            && let Some(inner) = token.group(Delimiter::Brace)
        {
            if let Some(next) = more.first() {
                let found = next.found();
                let (message, help) = if next.word().is_some() {
                    let message = format!("there is no comma before {found}");
                    (message, "write `,` between two entries")
                } else {
                    let message = format!("{found} behind the braces");
                    (message, "take away what stands behind them")
                };
                self.reader
                    .faults
                    .add(codes::MACRO_COMMA, next.place(), message)
                    .help(help);
            }
            return Some((token.place(), inner));
        }
        let (place, message) = match rest.first() {
            Some(found) => (
                found.place(),
                format!("expected `{{ ... }}`, found {}", found.found()),
            ),
            None => (
                first.place(),
                format!("`{key}` is not followed by `{{ ... }}`"),
            ),
        };
        self.form(place, message, key);
        None
    }

    /// Reads `kind { ... }` as a map with one key.
    pub(super) fn variant(
        &mut self,
        key: &str,
        first: &Token,
        rest: &[Token],
        place: Span,
    ) -> Node {
        let Some((kind, braces)) = rest.split_first() else {
            self.form(first.place(), format!("`{key}` has no value"), key);
            return faulty(place);
        };
        let Some(name) = kind.word() else {
            let message = format!("expected a kind of {key}, found {}", kind.found());
            self.form(kind.place(), message, key);
            return faulty(place);
        };
        let Some((at, inner)) = self.braces(key, kind, braces) else {
            return faulty(place);
        };
        let record = self.reader.record(name, inner, at);
        let entries = vec![entry(name, kind.place(), record)];
        Node {
            span: join(kind.place(), at),
            value: Value::Map(entries.into()),
        }
    }

    /// Returns the tree. `place` is that of the scene's name; `name` is the name, unless an entry
    /// gives another.
    pub(crate) fn tree(&mut self, name: &str, place: Span) -> Node {
        let mut entries = std::mem::take(&mut self.blocks);
        if entries.iter().all(|entry| entry.key != "name") {
            entries.push(entry("name", place, text(name, place)));
        }
        let map = |span, entries| Node {
            span,
            value: Value::Map(Arc::new(entries)),
        };
        let materials = map(place, std::mem::take(&mut self.materials));
        entries.push(entry("materials", place, materials));
        let geometry = Node {
            span: place,
            value: Value::List(Arc::new(std::mem::take(&mut self.geometry))),
        };
        entries.push(entry("geometry", place, geometry));
        if let (Some(first), Some(last)) = (self.depths.first(), self.depths.last()) {
            let span = join(first.span, last.span);
            let key_span = super::tokens::place(first.span.start, first.span.start);
            let value = Value::List(Arc::new(std::mem::take(&mut self.depths)));
            let depths = entry("depths", key_span, Node { span, value });
            let sampling = entries.iter_mut().find(|entry| entry.key == "sampling");
            match sampling.map(|entry| &mut entry.value.value) {
                None => entries.push(entry("sampling", key_span, map(span, vec![depths]))),
                Some(Value::Map(own)) => match own.iter().find(|entry| entry.key == "depths") {
                    None => Arc::make_mut(own).push(depths),
                    Some(first) => {
                        let what = "depths are given both here and within `sampling`";
                        self.reader
                            .faults
                            .add(codes::MACRO_DEPTHS, key_span, what)
                            .also(first.key_span, "the others are")
                            .help("keep one of the two");
                    }
                },
                Some(_) => {}
            }
        }
        map(place, entries)
    }
}
