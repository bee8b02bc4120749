//! Programs whose macros run here, without a compiler around them.

use crate::scene::Asked;
use proc_macro2::{Delimiter, Group, TokenStream, TokenTree};
use std::collections::BTreeMap;
use std::path::Path;

/// A program of `tests/ui`, whose macros run in the order of the text.
pub(super) struct Program<'a> {
    /// The folder of the files that it names.
    pub(super) folder: &'a Path,
    /// The functions with `#[reversible]` so far, by their names.
    pub(super) functions: BTreeMap<String, TokenStream>,
}

impl Program<'_> {
    /// Runs the macros in these tokens.
    pub(super) fn run(&mut self, tokens: TokenStream) {
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

    /// Runs an attribute in front of these tokens.
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

    /// Runs `qrt!`, and passes it the functions that it requests: `f! { [..] .. }`.
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
