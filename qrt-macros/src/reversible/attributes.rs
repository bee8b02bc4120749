//! Attributes. Those in front of a function belong to what it expands to; any other would be passed
//! over, and is refused.

use super::problem::Problems;
use proc_macro2::{Delimiter, TokenStream, TokenTree};
use qrt_syntax::codes;
use quote::{ToTokens, quote};
use syn::{AttrStyle, Attribute, ItemFn};

/// Reports the attributes within a function. False if a condition is among them, so that no more
/// can be said about the function.
pub(super) fn check(function: &ItemFn, problems: &mut Problems) -> bool {
    let mut found = Vec::new();
    let inner = function.attrs.iter().filter(|own| !is_outer(own));
    found.extend(inner.map(|own| (own.path().to_token_stream(), own.to_token_stream())));
    collect(function.sig.to_token_stream(), &mut found);
    collect(function.block.to_token_stream(), &mut found);
    let mut is_certain = true;
    for (path, attribute) in found {
        let (name, message) = (
            path.to_string(),
            "an attribute within a reversible function",
        );
        is_certain &= name != "cfg" && name != "cfg_attr";
        let help = match name.as_str() {
            "cfg" | "cfg_attr" => "write a function for each case, with `#[cfg(..)]` before each",
            "doc" => "write `//`, or describe it before the function",
            _ => "write it before the function",
        };
        problems.add(codes::REV_STATEMENT, attribute, message, help);
    }
    is_certain
}

/// True if an attribute stands in front of its item: `#[..]` and not `#![..]`.
pub(super) fn is_outer(attribute: &Attribute) -> bool {
    matches!(attribute.style, AttrStyle::Outer)
}

/// Collects the attributes in these tokens: their names, and all of their tokens. No other part of
/// Rust has a `#`.
fn collect(tokens: TokenStream, found: &mut Vec<(TokenStream, TokenStream)>) {
    let mut sign: Option<TokenTree> = None;
    for token in tokens {
        match (&token, &sign) {
            (TokenTree::Punct(punct), None) if punct.as_char() == '#' => sign = Some(token),
            (TokenTree::Punct(punct), Some(_)) if punct.as_char() == '!' => {}
            (TokenTree::Group(body), Some(begin)) if body.delimiter() == Delimiter::Bracket => {
                let name = body.stream().into_iter().next();
                found.push((quote!(#name), quote!(#begin #body)));
                sign = None;
            }
            (TokenTree::Group(group), _) => {
                collect(group.stream(), found);
                sign = None;
            }
            _ => sign = None,
        }
    }
}
