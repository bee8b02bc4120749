//! Functions that scenes name: `value: fn my_term`.
//!
//! A macro sees its own tokens only. `#[reversible]` leaves a macro of the function's name, which
//! appends the function's tokens to its input, and calls the macro that its input names:
//!
//! ```text
//! qrt! { ..fn f..fn g.. }  ->  f! { [qrt_with_terms] {..fn f..fn g..} {f} }
//! qrt_with_terms! { {..fn f..fn g..} {f} {fn f(..) {..}} }
//!                          ->  g! { [qrt_with_terms] {..fn f..fn g..} {f} {fn f(..) {..}} {g} }
//! qrt_with_terms! { {..fn f..fn g..} {f} {fn f(..) {..}} {g} {fn g(..) {..}} }  ->  the scenes
//! ```

use crate::reversible::term;
use proc_macro2::{Spacing, Span, TokenStream, TokenTree};
use quote::quote;
use std::collections::BTreeMap;

/// A macro's input, and the functions that it names, as far as they are known.
#[derive(Debug)]
pub(crate) struct Asked {
    /// The tokens that the author has written.
    pub(super) input: TokenStream,
    functions: Vec<(TokenStream, TokenStream)>,
}

/// The expressions of a scene's terms, by name; `None` for a term with errors.
pub(crate) type Terms = BTreeMap<String, Option<term::Channels>>;

impl Asked {
    /// Creates the state of the author's input, without any function.
    pub(crate) fn new(input: TokenStream) -> Self {
        Self {
            input,
            functions: Vec::new(),
        }
    }

    /// Reads the tokens that a function's macro passes on.
    pub(crate) fn resumed(tokens: TokenStream) -> Self {
        let mut groups = tokens.into_iter().filter_map(|token| match token {
            TokenTree::Group(group) => Some(group.stream()),
            _ => None,
        });
        let mut asked = Self::new(groups.next().unwrap_or_default());
        while let (Some(path), Some(function)) = (groups.next(), groups.next()) {
            asked.functions.push((path, function));
        }
        asked
    }

    /// Returns the request for the next function that is not known yet.
    pub(super) fn next(&self) -> Option<TokenStream> {
        let mut wanted = Vec::new();
        paths(self.input.clone(), &mut wanted);
        let known = |path: &TokenStream| {
            let mut functions = self.functions.iter();
            functions.any(|(known, _)| name(known) == name(path))
        };
        let path = wanted.into_iter().find(|path| !known(path))?;
        let input = &self.input;
        let functions = self.functions.iter();
        let functions = functions.map(|(path, function)| quote!({ #path } { #function }));
        Some(quote! {
            #path! { [::qrt::__qrt_with_terms] { #input } #(#functions)* { #path } }
        })
    }

    /// Returns the mathematics of all functions, and the compiler's errors.
    pub(super) fn terms(&self) -> (Terms, TokenStream) {
        let mut terms = Terms::new();
        let mut errors = TokenStream::new();
        for (path, function) in &self.functions {
            let first = path.clone().into_iter().next();
            let site = first.map_or_else(Span::call_site, |first| first.span());
            let read = term::read(function.clone(), site);
            let channels = read.map_err(|found| errors.extend(found)).ok();
            terms.insert(name(path), channels);
        }
        (terms, errors)
    }
}

/// Returns a path without spaces, as the scene's tokens spell it.
fn name(path: &TokenStream) -> String {
    let text = path.to_string().replace("r#", "");
    text.chars().filter(|letter| *letter != ' ').collect()
}

/// Finds the paths that stand after `value: fn`.
fn paths(tokens: TokenStream, found: &mut Vec<TokenStream>) {
    let mut trees = Vec::new();
    super::input::flatten(tokens, &mut trees);
    for (at, tree) in trees.iter().enumerate() {
        if let TokenTree::Group(group) = tree {
            paths(group.stream(), found);
        }
        let Some((before, [keyword, path @ ..])) = trees.split_at_checked(at) else {
            continue;
        };
        if let [.., key, colon] = before
            && is_word(key, "value")
            && is_colon(colon)
            && is_word(keyword, "fn")
            && let Some(length) = path_length(path)
        {
            found.push(path[..length].iter().cloned().collect());
        }
    }
}

/// Returns the number of tokens of the path that `tokens` begin with, up to the end of the value.
fn path_length(tokens: &[TokenTree]) -> Option<usize> {
    let separated = |at: usize| {
        let signs = tokens.get(at..at + 2);
        signs.is_some_and(|signs| {
            let joint = matches!(&signs[0], TokenTree::Punct(p) if p.spacing() == Spacing::Joint);
            joint && signs.iter().all(is_colon)
        })
    };
    let mut at = if separated(0) { 2 } else { 0 };
    loop {
        let TokenTree::Ident(_) = tokens.get(at)? else {
            return None;
        };
        at += 1;
        if !separated(at) {
            break;
        }
        at += 2;
    }
    let ends = match tokens.get(at) {
        None => true,
        Some(TokenTree::Punct(sign)) => sign.as_char() == ',',
        Some(_) => false,
    };
    ends.then_some(at)
}

fn is_word(tree: &TokenTree, word: &str) -> bool {
    matches!(tree, TokenTree::Ident(own) if own == word)
}

fn is_colon(tree: &TokenTree) -> bool {
    matches!(tree, TokenTree::Punct(sign) if sign.as_char() == ':')
}
