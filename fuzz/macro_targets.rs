//! Properties that the macros have for all tokens: the fuzzer searches for a counterexample, and the macros' own
//! tests try some inputs.

use proc_macro2::TokenStream;

/// Expands text as `qrt!` and as `#[reversible]` would: each expansion parses as items, if only errors.
pub(crate) fn tokens(data: &[u8]) {
    let Ok(text) = std::str::from_utf8(data) else {
        return;
    };
    let Ok(tokens) = text.parse::<TokenStream>() else {
        return;
    };
    let mut expanded = vec![crate::expand::expand(tokens.clone())];
    // The compiler accepts an attribute only on an item.
    if syn::parse2::<syn::Item>(tokens.clone()).is_ok() {
        expanded.push(crate::reversible::expand(&TokenStream::new(), tokens));
    }
    for expanded in expanded {
        if let Err(error) = syn::parse2::<syn::File>(expanded.clone()) {
            panic!("{error}: {expanded}");
        }
    }
}
