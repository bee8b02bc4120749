//! The macro's input: one scene after another.

use super::body::Body;
use super::fault::{Faults, compile_error, compile_warning};
use super::header::Header;
use super::tokens::{self, Kind, Table, Token, place_of};
use super::values::{entry, scalar};
use super::{Parsed, REFUSED, check, earlier, emit};
use proc_macro2::{Delimiter, Ident, TokenStream, TokenTree};
use qrt_scene::front::load_below;
use qrt_scene::valid::ValidScene;
use qrt_syntax::tree::{Entry, Node, Span, Value};
use qrt_syntax::{Problem, codes};
use quote::{ToTokens as _, quote};
use std::path::Path;
use std::sync::Arc;

/// A scene that was read, and its checked form if it has no errors.
pub(crate) type Read = (Parsed, Option<ValidScene>);

/// Returns the expansion of `qrt!`. Files are relative to `root`. Warnings are left out if there are
/// errors.
pub(crate) fn expand(input: TokenStream, root: &Path) -> TokenStream {
    let mut table = Table::default();
    let mut faults = Faults::default();
    let mut out = TokenStream::new();
    let scenes = read(input, root, &mut table, &mut faults);
    let code = scenes.iter().map(|(parsed, valid)| {
        let valid = valid.as_ref()?;
        match generated(parsed, valid) {
            Ok(code) => Some(emit::expansion(parsed, valid, root, &code)),
            Err(problems) => {
                parsed.report(problems, &mut faults);
                None
            }
        }
    });
    let code: Vec<Option<TokenStream>> = code.collect();
    if faults.count() == 0 {
        out.extend(scenes.iter().map(|scene| warnings(scene, &table)));
    }
    for fault in faults.finalize() {
        out.extend(compile_error(&fault.text(&table), fault.ends(&table)));
    }
    let error = first_error(&out);
    for ((parsed, _), code) in scenes.iter().zip(code) {
        out.extend(code.unwrap_or_else(|| emit::stub(&parsed.header, &error)));
    }
    out
}

/// Returns the first of the compiler's errors: its tokens up to the braces.
fn first_error(errors: &TokenStream) -> TokenStream {
    let is_end = |tree: &TokenTree| matches!(tree, TokenTree::Group(_));
    let trees: Vec<TokenTree> = errors.clone().into_iter().collect();
    let length = trees.iter().position(is_end).map_or(0, |end| end + 1);
    trees.into_iter().take(length).collect()
}

/// Returns the compiler's warnings of a scene.
fn warnings((parsed, valid): &Read, table: &Table) -> TokenStream {
    let mut warnings = Faults::default();
    if let Some(valid) = valid {
        parsed.warnings(valid, &mut warnings);
    }
    let conditions = parsed.header.conditions();
    let shown = warnings.finalize().into_iter().map(|warning| {
        let shown = compile_warning(
            &warning.text(table),
            &parsed.header.name,
            warning.ends(table),
        );
        quote!(#conditions #shown)
    });
    shown.collect()
}

/// Returns a scene's circuit as Rust.
fn generated(parsed: &Parsed, valid: &ValidScene) -> Result<TokenStream, Vec<Problem>> {
    let header = &parsed.header;
    let labels = parsed.primitives.iter();
    let labels: Vec<Option<String>> = labels.map(|origin| origin.label.clone()).collect();
    crate::generate::scene(
        &header.name.to_string(),
        &header.visibility.to_token_stream().to_string(),
        &header.conditions().to_string(),
        (&labels, valid),
    )
}

/// Reads the scenes of `input`.
pub(crate) fn read(
    input: TokenStream,
    root: &Path,
    table: &mut Table,
    faults: &mut Faults,
) -> Vec<Read> {
    let mut trees = Vec::new();
    flatten(input, &mut trees);
    let tokens = trees
        .iter()
        .flat_map(|tree| table.read(tree.clone().into()));
    let tokens: Vec<Token> = tokens.collect();
    let mut input = Input {
        trees: &trees,
        tokens: &tokens,
        at: 0,
        faults,
        names: Vec::new(),
    };
    let mut scenes = Vec::new();
    while input.at < tokens.len() || scenes.is_empty() {
        match input.scene(root) {
            Some(scene) => scenes.push(scene),
            None if input.at >= tokens.len() => break,
            None => {}
        }
    }
    scenes
}

/// Collects token trees without the invisible brackets of other macros' variables.
fn flatten(stream: TokenStream, out: &mut Vec<TokenTree>) {
    for tree in stream {
        match tree {
            TokenTree::Group(group) if group.delimiter() == Delimiter::None => {
                flatten(group.stream(), out);
            }
            tree => out.push(tree),
        }
    }
}

/// The tokens after a scene's name: its entries, or a file.
enum Rest<'t> {
    Body(&'t [Token]),
    Path(&'t str, Span),
}

/// The macro's input, read from one scene to the next.
struct Input<'t> {
    trees: &'t [TokenTree],
    tokens: &'t [Token],
    at: usize,
    faults: &'t mut Faults,
    /// The scenes so far: their names, the conditions that they are compiled under, and their
    /// places.
    names: Vec<(String, String, Span)>,
}

impl<'t> Input<'t> {
    fn peek(&self) -> Option<&'t Token> {
        self.tokens.get(self.at)
    }

    /// Returns the trees from `start` to here, as they were written.
    fn since(&self, start: usize) -> TokenStream {
        self.trees[start..self.at].iter().cloned().collect()
    }

    /// Reports the token here in place of `expected`, and continues after the next braces.
    #[cfg_attr(test, track_caller)]
    fn fail<T>(&mut self, code: &'static str, expected: &str) -> Option<T> {
        let last = self.tokens.last().map(Token::place).unwrap_or_default();
        let (place, found) = match self.peek() {
            // For a block, its opening bracket is enough.
            Some(token) => (tokens::place(token.first, token.first), token.found()),
            None => (last, "the end".to_owned()),
        };
        let help = match code {
            codes::MACRO_FILE => {
                "write `from \"scene.yaml\"`, relative to the folder of Cargo.toml"
            }
            _ => "write `pub scene Name { ... }` or `pub scene Name from \"scene.yaml\"`",
        };
        self.faults
            .add(code, place, format!("expected {expected}, found {found}"))
            .help(help);
        let rest = self.tokens.get(self.at..).unwrap_or_default();
        let next = rest
            .iter()
            .position(|token| token.group(Delimiter::Brace).is_some());
        self.at += next.map_or(rest.len(), |length| length + 1);
        None
    }

    fn scene(&mut self, root: &Path) -> Option<Read> {
        let start = self.at;
        while self.peek().is_some_and(|token| token.is_sign('#')) {
            self.at += 1;
            let body = self
                .peek()
                .and_then(|token| token.group(Delimiter::Bracket));
            if body.is_none() {
                return self.fail(codes::MACRO_SCENE, "`[ ... ]` after `#`");
            }
            self.at += 1;
        }
        let attributes = self.since(start);
        let start = self.at;
        if self.peek().is_some_and(|token| token.is_word("pub")) {
            self.at += 1;
            let within = self.peek().and_then(|t| t.group(Delimiter::Parenthesis));
            self.at += usize::from(within.is_some());
        }
        let visibility = self.since(start);
        if !self.peek().is_some_and(|token| token.is_word("scene")) {
            return self.fail(codes::MACRO_SCENE, "`scene`");
        }
        self.at += 1;
        let name = self.trees.get(self.at).cloned().map(TokenStream::from);
        let Some(Ok(name)) = name.map(syn::parse2::<Ident>) else {
            return self.fail(codes::MACRO_SCENE, "the name of the scene");
        };
        let place = self.peek().map(Token::place).unwrap_or_default();
        self.at += 1;
        let precision = self.format();
        let known = self.faults.count();
        let rest = self.rest();
        let header = Header {
            attributes,
            visibility,
            name,
            path: match rest {
                Some(Rest::Path(_, place)) => Some(place),
                _ => None,
            },
        };
        if self.is_taken(&header, place) {
            return None;
        }
        let (parsed, valid) = match rest {
            None => (Parsed::nothing(header), None),
            Some(Rest::Body(tokens)) => {
                let mut body = Body::default();
                body.reader.later = constants(tokens);
                body.entries(tokens, false);
                if let Some(precision) = precision {
                    add_precision(&mut body, precision);
                }
                check(header, body, place, root, self.faults)
            }
            Some(Rest::Path(path, _)) => {
                if let Some(precision) = precision {
                    let what = "the number format of a scene in a file stands in the file";
                    self.faults
                        .add(codes::MACRO_FORMAT, precision.key_span, what)
                        .help("write `precision: { fraction: 14 }` there");
                }
                self.file(header, Path::new(path), root)
            }
        };
        let is_sound = self.faults.count() == known;
        self.faults.merge_undefined(known);
        Some((parsed, valid.filter(|_| is_sound)))
    }

    /// Reports a name that an earlier scene of the same scope has under the same conditions.
    fn is_taken(&mut self, header: &Header, place: Span) -> bool {
        let name = header.name.to_string();
        let conditions = header.conditions().to_string();
        let mut known = self.names.iter();
        let known = known.find(|(known, under, _)| *known == name && *under == conditions);
        let known = known.map(|(.., first)| *first);
        let before = earlier::line(&header.name).filter(|_| conditions.is_empty());
        if known.is_none() && before.is_none() {
            self.names.push((name, conditions, place));
            return false;
        }
        let message = format!("a scene is called `{name}` already");
        let fault = self.faults.add(codes::MACRO_SCENE_TWICE, place, message);
        match (known, before) {
            (Some(first), _) => fault.also(first, "the first is"),
            (None, line) => {
                fault.note(format!("the first is on line {}", line.unwrap_or_default()))
            }
        };
        fault.help("rename one of the two");
        true
    }

    /// Reads the scene of a file.
    fn file(&mut self, header: Header, path: &Path, root: &Path) -> Read {
        match load_below(root, path, &[]) {
            Ok(loaded) => {
                let valid = loaded.valid.clone();
                (Parsed::of_file(header, loaded), Some(valid))
            }
            Err(report) => {
                header.report(REFUSED, &report, self.faults);
                (Parsed::nothing(header), None)
            }
        }
    }

    /// Reads `<Fixed<2, 14>>` as a precision.
    fn format(&mut self) -> Option<Entry> {
        if !self.peek()?.is_sign('<') {
            return None;
        }
        let start = self.at;
        while self
            .peek()
            .is_some_and(|token| token.group(Delimiter::Brace).is_none() && !token.is_word("from"))
        {
            self.at += 1;
        }
        let own = &self.tokens[start..self.at];
        let place = place_of(own)?;
        let help = "write `<Fixed<2, 14>>` for 14 fraction bits, or leave it out";
        if let [_, fixed, open, first, comma, second, close, _] = own
            && fixed.is_word("Fixed")
            && open.is_sign('<')
            && comma.is_sign(',')
            && close.is_sign('>')
            && let (Kind::Number(whole, a), Kind::Number(fraction, b)) = (&first.kind, &second.kind)
            && a.is_empty()
            && b.is_empty()
        {
            if whole != "2" {
                let message = format!("the first number of `Fixed` is 2, not {whole}");
                self.faults
                    .add(codes::MACRO_FORMAT, first.place(), message)
                    .note(
                        "unit numbers lie in [-1, 1]; \
                     other registers get the integer bits that their ranges need",
                    )
                    .help(format!("write `<Fixed<2, {fraction}>>`"));
                return None;
            }
            let at = second.place();
            let fraction = entry("fraction", at, scalar(fraction.clone(), false, at));
            let value = Value::Map(Arc::new(vec![fraction]));
            return Some(entry("precision", place, Node { span: place, value }));
        }
        self.faults
            .add(codes::MACRO_FORMAT, place, "this is not a number format")
            .help(help);
        None
    }

    /// Reads the tokens after the name: braces, or `from` and a path.
    fn rest(&mut self) -> Option<Rest<'t>> {
        let token = self.peek();
        if let Some(inner) = token.and_then(|token| token.group(Delimiter::Brace)) {
            self.at += 1;
            return Some(Rest::Body(inner));
        }
        if !token.is_some_and(|token| token.is_word("from")) {
            return self.fail(codes::MACRO_SCENE, "`{ ... }` or `from`");
        }
        self.at += 1;
        let Some(token) = self.peek() else {
            return self.fail(codes::MACRO_FILE, "a path in quotes");
        };
        let Kind::Text(path) = &token.kind else {
            return self.fail(codes::MACRO_FILE, "a path in quotes");
        };
        self.at += 1;
        if self
            .peek()
            .is_some_and(|token| token.is_sign(';') || token.is_sign(','))
        {
            self.at += 1;
        }
        Some(Rest::Path(path, token.place()))
    }
}

/// Returns the names of all constants of a scene.
fn constants(tokens: &[Token]) -> Vec<String> {
    let pairs = tokens.windows(2).filter(|pair| pair[0].is_word("const"));
    pairs
        .filter_map(|pair| pair[1].word().map(str::to_owned))
        .collect()
}

/// Adds the precision of a number format; reports it if the scene has its own.
fn add_precision(body: &mut Body, precision: Entry) {
    let own = body.blocks.iter().find(|entry| entry.key == "precision");
    let Some(own) = own else {
        body.blocks.push(precision);
        return;
    };
    let what = "the precision is given twice";
    body.reader
        .faults
        .add(codes::MACRO_PRECISION, own.key_span, what)
        .also(precision.key_span, "the number format is")
        .help("keep one of the two");
}
