//! No check of the macros can be taken away unnoticed: each place in the source that reports an
//! error is reached by a program of `tests/ui`, and what it says there is among the words beside
//! the program, which the compiler must show.

use crate::scene::Asked;
use proc_macro2::{Delimiter, Group, TokenStream, TokenTree};
use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::panic::Location;
use std::path::{Path, PathBuf};

/// A file below `src`, and a line of it.
type Place = (String, usize);

/// An error: where in the source it was reported, its code if it has one, and its words.
struct Report {
    place: Place,
    code: String,
    message: String,
}

thread_local! {
    static REPORTS: RefCell<Vec<Report>> = const { RefCell::new(Vec::new()) };
}

/// Takes note of a report.
pub(crate) fn reached(place: &Location<'_>, code: &str, message: &str) {
    let (_, file) = place.file().rsplit_once("src/").unwrap();
    let report = Report {
        place: (file.to_owned(), place.line() as usize),
        code: code.to_owned(),
        message: message.to_owned(),
    };
    REPORTS.with_borrow_mut(|reports| reports.push(report));
}

/// What stands before a function whose reports are its caller's.
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

    /// The tokens behind the first `from`.
    fn texts(&self, from: usize) -> impl Iterator<Item = &str> {
        self.tokens[from..].iter().map(|(text, _)| text.as_str())
    }

    /// The functions whose reports are their callers': the name, where it stands, and where the
    /// body ends.
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

    /// The calls of `reporters`, unless within such a function.
    fn places(&self, reporters: &BTreeSet<String>) -> BTreeSet<Place> {
        let own = self.reporters();
        let calls = (2..self.tokens.len()).filter(|&at| {
            let of_all = match self.token(at) {
                // Other things are added, too.
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

/// Every place in the source that reports.
fn places() -> BTreeSet<Place> {
    let mut places = BTreeSet::new();
    for part in ["scene", "reversible"] {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("src").join(part);
        let mut files = Vec::new();
        programs_below(&folder, &mut files);
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

/// The Rust files of a folder, and of those within.
fn programs_below(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            programs_below(&path, found);
        } else if path.extension().is_some_and(|end| end == "rs") {
            found.push(path);
        }
    }
}

/// A program of `tests/ui`, whose macros run in the order of the text.
struct Program<'a> {
    folder: &'a Path,
    /// The functions with `#[reversible]` so far, by their names.
    functions: BTreeMap<String, TokenStream>,
}

impl Program<'_> {
    fn run(&mut self, tokens: TokenStream) {
        let trees: Vec<TokenTree> = tokens.into_iter().collect();
        for (at, tree) in trees.iter().enumerate() {
            let TokenTree::Group(group) = tree else {
                continue;
            };
            let before = trees[..at].iter().rev().take(2).map(ToString::to_string);
            let before: Vec<String> = before.collect();
            if before == ["!", "qrt"] {
                self.scene(Asked::new(group.stream()));
            } else if before.first().is_some_and(|sign| sign == "#") {
                self.attribute(group, &trees[at + 1..]);
            }
            self.run(group.stream());
        }
    }

    /// An attribute in front of these tokens.
    fn attribute(&mut self, attribute: &Group, behind: &[TokenTree]) {
        let mut attribute = attribute.stream().into_iter();
        if attribute
            .next()
            .is_none_or(|name| name.to_string() != "reversible")
        {
            return;
        }
        let arguments = match attribute.next() {
            Some(TokenTree::Group(arguments)) => arguments.stream(),
            _ => TokenStream::new(),
        };
        let ends = |tree: &TokenTree| match tree {
            TokenTree::Group(group) => group.delimiter() == Delimiter::Brace,
            tree => tree.to_string() == ";",
        };
        let end = behind.iter().position(ends).unwrap();
        let item: TokenStream = behind[..=end].iter().cloned().collect();
        let mut words = behind.iter().map(ToString::to_string);
        if words.any(|word| word == "fn") {
            self.functions.insert(words.next().unwrap(), item.clone());
        }
        crate::reversible::expand(&arguments, item);
    }

    /// Runs `qrt!`, and hands over the functions that it asks for: `f! { [..] .. }`.
    fn scene(&self, asked: Asked) {
        let out = crate::scene::expand(asked, self.folder).into_iter();
        let out: Vec<TokenTree> = out.collect();
        let [.., name, _, TokenTree::Group(question)] = out.as_slice() else {
            return;
        };
        let mut question = question.stream().into_iter();
        let callback = question.next().map(|first| first.to_string());
        if callback.is_none_or(|callback| !callback.contains("__qrt_with_terms")) {
            return;
        }
        let Some(function) = self.functions.get(&name.to_string()) else {
            return;
        };
        let function = TokenTree::from(Group::new(Delimiter::Brace, function.clone()));
        self.scene(Asked::resumed(question.chain([function]).collect()));
    }
}

#[test]
fn every_check_is_failed_by_some_program() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/ui");
    let mut programs = Vec::new();
    programs_below(&folder, &mut programs);
    let mut missed = places();
    assert!(missed.len() > 150, "{} places", missed.len());
    let mut wrong = Vec::new();
    for path in &programs {
        REPORTS.take();
        let functions = BTreeMap::new();
        let mut program = Program {
            folder: &folder,
            functions,
        };
        program.run(fs::read_to_string(path).unwrap().parse().unwrap());
        let shown = fs::read_to_string(path.with_extension("stderr")).unwrap();
        let mut said = BTreeSet::new();
        for Report {
            place,
            code,
            message,
        } in REPORTS.take()
        {
            missed.remove(&place);
            // Where a file is wrong, the codes stand in its own report.
            let is_shown = match code.as_str() {
                "" => shown.contains(&message),
                code if shown.contains(&format!("error[{code}]")) => shown.contains(&message),
                code => shown.contains(&format!("{message} [{code}]")),
            };
            if !is_shown {
                wrong.push(format!("{} lacks: {message} [{code}]", path.display()));
            }
            said.insert(format!("{message} [{code}]"));
        }
        let errors = shown
            .lines()
            .filter_map(|line| line.strip_prefix("error: "));
        for error in errors.filter(|error| error.contains(" [QRT") && !said.contains(*error)) {
            wrong.push(format!("{} is not told: {error}", path.display()));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
    assert!(missed.is_empty(), "no program reaches {missed:#?}");
}
