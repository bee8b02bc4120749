//! The code that `#[reversible]` writes beside a function that could be a BSDF's term.

use proc_macro2::{Delimiter, Span, TokenStream, TokenTree};
use qrt_scene::expr::Variable;
use quote::{format_ident, quote};
use syn::{FnArg, Ident, ItemFn, Pat, Type, Visibility};

/// Returns a macro of the function's name, which passes the function's tokens to `qrt!`. Empty if
/// none of the function's parameters is a BSDF's variable, or if the function stands in an `impl`.
pub(crate) fn offer(item: &TokenStream) -> TokenStream {
    let Ok(function) = syn::parse2::<ItemFn>(item.clone()) else {
        return TokenStream::new();
    };
    if !function.sig.inputs.iter().any(is_variable) || stands_in_impl(&function) {
        return TokenStream::new();
    }
    let name = &function.sig.ident;
    let mut hidden = format_ident!("__qrt_term_{name}");
    hidden.set_span(Span::call_site());
    // A macro is known in its own crate only.
    let visibility = match &function.vis {
        Visibility::Public(_) => quote!(pub(crate)),
        other => quote!(#other),
    };
    let function = ItemFn {
        attrs: Vec::new(),
        ..function.clone()
    };
    quote! {
        #[doc(hidden)]
        #[allow(unused_macros)]
        macro_rules! #hidden {
            ([$($callback:tt)*] $($asked:tt)*) => {
                $($callback)*! { $($asked)* { #function } }
            };
        }

        #[doc(hidden)]
        #[allow(unused_imports)]
        #visibility use #hidden as #name;
    }
}

/// True if the function stands in an `impl`. No macro can stand beside it there, and `qrt!` would
/// not find one. An attribute does not see the code around its function, so this reads the
/// function's file.
fn stands_in_impl(function: &ItemFn) -> bool {
    let name = &function.sig.ident;
    let text = name
        .span()
        .local_file()
        .and_then(|file| std::fs::read_to_string(file).ok());
    let tokens = text.and_then(|text| text.parse::<TokenStream>().ok());
    let parameters = &function.sig.inputs;
    let begin = unspaced(&quote!(fn #name(#parameters)));
    tokens.is_some_and(|tokens| an_impl_has(&begin, tokens, false))
}

/// True if an `impl` within these tokens, or around them, has a function that begins with `begin`.
fn an_impl_has(begin: &str, tokens: TokenStream, within: bool) -> bool {
    let trees: Vec<TokenTree> = tokens.into_iter().collect();
    let begins = |three: &[TokenTree]| unspaced(&three.iter().cloned().collect()) == begin;
    if within && trees.windows(3).any(begins) {
        return true;
    }
    // The words before a block determine its kind.
    let mut header: Vec<String> = Vec::new();
    trees.into_iter().any(|tree| match tree {
        TokenTree::Group(group) if group.delimiter() == Delimiter::Brace => {
            let words = std::mem::take(&mut header);
            let is = |word: &str| words.iter().any(|own| own == word);
            an_impl_has(begin, group.stream(), is("impl") && !is("fn"))
        }
        TokenTree::Punct(punct) if punct.as_char() == ';' => {
            header.clear();
            false
        }
        tree => {
            header.push(tree.to_string());
            false
        }
    })
}

/// Returns tokens as text without the spaces between them, which vary.
fn unspaced(tokens: &TokenStream) -> String {
    tokens.to_string().split_whitespace().collect()
}

/// True if a parameter has the name of a variable, and is a number with a point that is only read.
fn is_variable(input: &FnArg) -> bool {
    let FnArg::Typed(input) = input else {
        return false;
    };
    let (Pat::Ident(name), Type::Reference(reference)) = (&*input.pat, &*input.ty) else {
        return false;
    };
    let Type::Path(format) = &*reference.elem else {
        return false;
    };
    let fixed = |last: &syn::PathSegment| last.ident == "Fixed" || last.ident == "UFixed";
    reference.mutability.is_none()
        && variable(&name.ident).is_some()
        && format.path.segments.last().is_some_and(fixed)
}

/// Returns the variable that has this name, if there is one.
pub(super) fn variable(name: &Ident) -> Option<Variable> {
    let mut all = Variable::ALL.into_iter();
    all.find(|variable| name == variable.name())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn functions_of_an_impl_are_found_where_they_are_written() {
        let file = "
            use a::{b, c};
            fn one(v: &UFixed<0, 6>) -> impl Copy { fn two(v: &UFixed<0, 6>) {} }
            mod inner {
                pub struct Map;
                impl Map {
                    #[reversible]
                    pub(super) fn three(
                        v: &UFixed<0, 6>, // a comment
                        out: &mut UFixed<2, 6>,
                    ) {
                    }
                }
                fn four(v: &UFixed<0, 6>) {}
            }";
        let found =
            |begin: TokenStream| an_impl_has(&unspaced(&begin), file.parse().unwrap(), false);
        let parameters = quote!(v: &UFixed<0, 6>, out: &mut UFixed<2, 6>,);
        assert!(found(quote!(fn three(#parameters))));
        assert!(!found(quote!(fn three(v: &UFixed<0, 6>))));
        for other in [quote!(one), quote!(two), quote!(four)] {
            assert!(!found(quote!(fn #other(v: &UFixed<0, 6>))), "{other}");
        }
    }
}
