//! Programs whose macros run here, without a compiler around them.

use proc_macro2::{Delimiter, Group, TokenStream, TokenTree};
use std::path::Path;

/// A program of `tests/compile_fail/ui`, whose macros run in the order of the text.
pub(super) struct Program<'a> {
    /// The folder of the files that it names.
    pub(super) folder: &'a Path,
}

impl Program<'_> {
    /// Runs the macros in these tokens.
    pub(super) fn run(&self, tokens: TokenStream) {
        let trees: Vec<TokenTree> = tokens.into_iter().collect();
        for (at, tree) in trees.iter().enumerate() {
            let TokenTree::Group(group) = tree else {
                continue;
            };
            let before = trees[..at].iter().rev().take(2).map(ToString::to_string);
            let before: Vec<String> = before.collect();
            if before == ["!", "qrt"] {
                crate::scene::expand(group.stream(), self.folder);
            } else if before.first().is_some_and(|sign| sign == "#") {
                attribute(group, &trees[at + 1..]);
            }
            self.run(group.stream());
        }
    }
}

/// Runs an attribute in front of these tokens.
fn attribute(attribute: &Group, behind: &[TokenTree]) {
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
    crate::reversible::expand(&arguments, item);
}
