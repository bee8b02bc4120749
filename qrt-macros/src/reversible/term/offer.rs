//! What `#[reversible]` writes beside a function that could be a BSDF's term.

use proc_macro2::{Span, TokenStream};
use qrt_core::expr::Variable;
use quote::{format_ident, quote};
use syn::{FnArg, Ident, ItemFn, Pat, Type, Visibility};

/// A macro of the function's name, which hands the function's tokens to `qrt!`; nothing, if none of
/// the function's parameters is a BSDF's variable.
pub(crate) fn offer(item: &TokenStream) -> TokenStream {
    let Ok(function) = syn::parse2::<ItemFn>(item.clone()) else {
        return TokenStream::new();
    };
    if !function.sig.inputs.iter().any(is_variable) {
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

/// Whether a parameter is called like a variable, and is a number with a point that is only read.
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

/// The variable that has this name, if there is one.
pub(super) fn variable(name: &Ident) -> Option<Variable> {
    let mut all = Variable::ALL.into_iter();
    all.find(|variable| name == variable.name())
}
