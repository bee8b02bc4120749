//! The author's source text, as messages and declarations show it.

use proc_macro2::{Span, TokenStream};
use quote::{ToTokens, quote};
use syn::{Expr, Ident, Type, UnOp};

/// The name of `self` in the generated code, where it is a parameter like others.
pub(super) const SELF: &str = "__self";

/// Returns a text in which `self` has the author's name again.
pub(super) fn as_written(text: String) -> String {
    if text.contains(SELF) {
        return text.replace(SELF, "self");
    }
    text
}

/// Returns source text, with the usual spaces.
pub(super) fn text(source: impl ToTokens) -> String {
    let mut text = as_written(quote!(#source).to_string());
    for (from, to) in [
        (" [", "["),
        ("[ ", "["),
        (" ]", "]"),
        (" (", "("),
        ("( ", "("),
        (" )", ")"),
        (" ..", ".."),
        (".. ", ".."),
        ("! ", "!"),
        (" ,", ","),
        (" ;", ";"),
        (" :: ", "::"),
        ("(& ", "(&"),
        (", & ", ", &"),
        ("- (", "-("),
        ("* - ", "* -"),
        ("(- ", "(-"),
        ("*(", "* ("),
        ("+(", "+ ("),
        ("-(", "- ("),
    ] {
        text = text.replace(from, to);
    }
    for sign in ["-", "&"] {
        if let Some(rest) = text
            .strip_prefix(sign)
            .and_then(|rest| rest.strip_prefix(' '))
        {
            return format!("{sign}{rest}");
        }
    }
    text
}

/// Returns a type, as it is usually written.
pub(super) fn type_text(ty: &Type) -> String {
    text(ty)
        .replace(" <", "<")
        .replace("< ", "<")
        .replace(" >", ">")
}

/// Returns the text of an expression without the `*` that other Rust would need: a register has its
/// plain name.
pub(super) fn bare(expression: &Expr) -> String {
    match expression {
        Expr::Unary(unary) if matches!(unary.op, UnOp::Deref(_)) => bare(&unary.expr),
        Expr::Paren(inner) => match bare(&inner.expr) {
            inside if syn::parse_str::<Ident>(&inside).is_ok() => inside,
            _ => text(expression),
        },
        _ => text(expression),
    }
}

/// Returns the span where source text begins.
pub(super) fn begin(source: &TokenStream) -> Span {
    let first = source.clone().into_iter().next();
    first.map_or_else(Span::call_site, |token| token.span())
}
