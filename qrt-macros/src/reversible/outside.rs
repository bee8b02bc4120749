//! Constants and types of the author's module. A macro does not see their values. The compiler
//! computes them, and checks the demands on them.

use super::dim::Linear;
use super::ir::Demand;
use super::source::{as_written, begin, text};
use proc_macro2::{TokenStream, TokenTree};
use quote::quote;
use syn::{Ident, Path};

/// Returns a constant of the module, by its path, if it is written like one.
pub(super) fn constant(path: &Path, demands: &mut Vec<Demand>) -> Option<Linear> {
    let name = &path.segments.last()?.ident;
    if !is_constant(name) {
        return None;
    }
    let shown = text(path);
    let condition = quote! {
        (#path as ::core::primitive::u32) as ::core::primitive::f64
            == #path as ::core::primitive::f64
    };
    let message = format!("QRT0823: `{shown}` is not a whole number from 0 to 4294967295");
    let span = begin(&quote!(#path));
    demand(
        demands,
        Demand {
            condition,
            message,
            span,
        },
    );
    Some(Linear::named(
        shown,
        quote!((#path as ::core::primitive::u32)),
    ))
}

/// Returns the number of bits of an integer whose format has a name of its own.
pub(super) fn width(path: &Path, demands: &mut Vec<Demand>) -> Linear {
    let shown = text(path);
    let format = quote!(<#path as ::qrt::circuit::format::Format>);
    let condition = quote!(::core::matches!(#format::TYPE, ::qrt::circuit::Type::UInt));
    let message = format!("QRT0827: `{shown}` is not an alias of `UInt<W>`: write its format out");
    let span = begin(&quote!(#path));
    demand(
        demands,
        Demand {
            condition,
            message,
            span,
        },
    );
    Linear::named(format!("{shown}::WIDTH"), quote!(#format::WIDTH))
}

/// Adds a demand, unless it has been made already.
pub(super) fn demand(demands: &mut Vec<Demand>, mut new: Demand) {
    new.message = as_written(new.message);
    let condition = new.condition.to_string();
    if demands
        .iter()
        .all(|known| known.condition.to_string() != condition)
    {
        demands.push(new);
    }
}

/// Returns a name in these tokens that an item within the function cannot use: `Self`, or one of the
/// constants that the function is generic over.
pub(super) fn dependence(tokens: TokenStream, constants: &[Ident]) -> Option<Ident> {
    tokens.into_iter().find_map(|token| match token {
        TokenTree::Ident(name) => (name == "Self" || constants.contains(&name)).then_some(name),
        TokenTree::Group(group) => dependence(group.stream(), constants),
        TokenTree::Punct(_) | TokenTree::Literal(_) => None,
    })
}

/// True if a name is written like a constant's.
pub(super) fn is_constant(name: &Ident) -> bool {
    let name = name.to_string();
    name.contains(|letter: char| letter.is_uppercase()) && !name.contains(char::is_lowercase)
}

/// True if any name in these tokens is written like a type's or a constant's.
pub(super) fn names_types(tokens: TokenStream) -> bool {
    tokens.into_iter().any(|token| match token {
        TokenTree::Ident(name) => is_type(&name),
        TokenTree::Group(group) => names_types(group.stream()),
        TokenTree::Punct(_) | TokenTree::Literal(_) => false,
    })
}

/// True if a name is written like a type's.
pub(super) fn is_type(name: &Ident) -> bool {
    name.to_string().starts_with(char::is_uppercase)
}
