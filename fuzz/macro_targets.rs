//! What holds of the macros for any tokens: the fuzzer looks for some for which it does not, and the macros' own tests
//! try some.

use proc_macro2::TokenStream;

/// Expands text as `qrt!` and as `#[reversible]` would: what comes out are items, if only errors.
pub(crate) fn tokens(data: &[u8]) {
    let Ok(text) = std::str::from_utf8(data) else {
        return;
    };
    let Ok(tokens) = text.parse::<TokenStream>() else {
        return;
    };
    let mut expanded = vec![crate::expand::expand(tokens.clone())];
    // An attribute is on an item, or the compiler has said so.
    if syn::parse2::<syn::Item>(tokens.clone()).is_ok() {
        expanded.push(crate::reversible::expand(&TokenStream::new(), tokens));
    }
    for expanded in expanded {
        if let Err(error) = syn::parse2::<syn::File>(expanded.clone()) {
            panic!("{error}: {expanded}");
        }
    }
}
