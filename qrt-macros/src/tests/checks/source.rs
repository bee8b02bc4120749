//! The places in the macros' source that report errors.

use super::{Place, rust_files};
use proc_macro2::{Delimiter, TokenStream, TokenTree};
use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

/// The attribute of a function whose reports count as its caller's.
const HANDED_ON: &str = "# [ cfg_attr ( test , track_caller ) ]";

/// The tokens of a file below `src`, brackets included, each with its line.
struct Source {
    file: String,
    tokens: Vec<(String, usize)>,
}

impl Source {
    fn read(path: &Path) -> Self {
        let (_, file) = path.to_str().unwrap().rsplit_once("src/").unwrap();
        let mut tokens = Vec::new();
        let text = fs::read_to_string(path).unwrap();
        flatten(text.parse().unwrap(), &mut tokens);
        let file = file.to_owned();
        Self { file, tokens }
    }

    fn token(&self, at: usize) -> &str {
        self.tokens.get(at).map_or("", |(text, _)| text)
    }

    /// Returns the tokens from index `from` on.
    fn texts(&self, from: usize) -> impl Iterator<Item = &str> {
        self.tokens[from..].iter().map(|(text, _)| text.as_str())
    }

    /// Returns the functions whose reports count as their callers': the name, its index, and the
    /// index of the body's end.
    fn reporters(&self) -> Vec<(&str, usize, usize)> {
        let mark: Vec<&str> = HANDED_ON.split(' ').collect();
        let marked = |at: &usize| self.texts(*at).take(mark.len()).eq(mark.iter().copied());
        let mut reporters = Vec::new();
        for at in (0..self.tokens.len()).filter(marked) {
            let name = at + 1 + self.texts(at).position(|text| text == "fn").unwrap();
            let mut depth = 0;
            let length = self.texts(name).position(|text| {
                depth += i32::from(text == "{") - i32::from(text == "}");
                depth == 0 && text == "}"
            });
            reporters.push((self.token(name), name, name + length.unwrap()));
        }
        reporters
    }

    /// Returns the calls of `reporters`, unless within these functions.
    fn places(&self, reporters: &BTreeSet<String>) -> BTreeSet<Place> {
        let own = self.reporters();
        let calls = (2..self.tokens.len()).filter(|&at| {
            let of_all = match self.token(at) {
                // Other types have a method `add`, too.
                "add" => matches!(self.token(at - 2), "problems" | "faults"),
                name => reporters.contains(name),
            };
            let handed_on = own.iter().any(|(_, from, to)| (from..=to).contains(&&at));
            of_all && !handed_on && matches!(self.token(at + 1), "(" | ":")
        });
        calls
            .map(|at| (self.file.clone(), self.tokens[at].1))
            .collect()
    }
}

fn flatten(stream: TokenStream, tokens: &mut Vec<(String, usize)>) {
    for tree in stream {
        let line = tree.span().start().line;
        if let TokenTree::Group(group) = &tree {
            let [open, close] = match group.delimiter() {
                Delimiter::Parenthesis => ["(", ")"],
                Delimiter::Brace => ["{", "}"],
                Delimiter::Bracket => ["[", "]"],
                Delimiter::None => ["", ""],
            };
            tokens.push((open.to_owned(), line));
            flatten(group.stream(), tokens);
            tokens.push((close.to_owned(), group.span_close().start().line));
        } else {
            tokens.push((tree.to_string(), line));
        }
    }
}

/// Returns every place in the source that reports.
pub(super) fn places() -> BTreeSet<Place> {
    let mut places = BTreeSet::new();
    for part in ["scene", "reversible"] {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("src").join(part);
        let mut files = Vec::new();
        rust_files(&folder, &mut files);
        files.retain(|file| {
            !file.ends_with("tests.rs") && !file.to_str().unwrap().contains("snapshots")
        });
        let sources: Vec<Source> = files.iter().map(|file| Source::read(file)).collect();
        let reporters = sources.iter().flat_map(Source::reporters);
        let reporters = reporters.map(|(name, ..)| name.to_owned()).collect();
        places.extend(sources.iter().flat_map(|source| source.places(&reporters)));
    }
    places
}
