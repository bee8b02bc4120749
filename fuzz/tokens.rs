//! What holds for the tokens of any text: the fuzzer looks for some for which it does not, and
//! `cargo test -p qrt-macros tokens` tries those of `tests/ui`, and changes of them.

use proc_macro2::{TokenStream, TokenTree};

/// Expands the calls of `qrt!` in a text, and its functions with `#[reversible]`; a text with neither is given to
/// both as it is. What they expand to can be read as items, and if something is wrong it is an error of the compiler.
pub(crate) fn tokens(data: &[u8]) {
    let Some(stream) = std::str::from_utf8(data)
        .ok()
        .and_then(|text| text.parse::<TokenStream>().ok())
    else {
        return;
    };
    let trees: Vec<TokenTree> = stream.clone().into_iter().collect();
    let mut found = false;
    for at in 0..trees.len() {
        match &trees[at..] {
            [
                TokenTree::Ident(name),
                TokenTree::Punct(mark),
                TokenTree::Group(scene),
                ..,
            ] if name == "qrt" && mark.as_char() == '!' => {
                found = true;
                items(crate::expand::expand(scene.stream()));
            }
            [
                TokenTree::Punct(mark),
                TokenTree::Group(attribute),
                function @ ..,
            ] if mark.as_char() == '#' => {
                let mut words = attribute.stream().into_iter();
                if !matches!(words.next(), Some(TokenTree::Ident(name)) if name == "reversible") {
                    continue;
                }
                found = true;
                let arguments = match words.next() {
                    Some(TokenTree::Group(arguments)) => arguments.stream(),
                    _ => TokenStream::new(),
                };
                // Up to its body.
                let body = |tree: &TokenTree| matches!(tree, TokenTree::Group(group) if group.delimiter() == proc_macro2::Delimiter::Brace);
                let end = function.iter().position(body);
                let function = &function[..end.map_or(function.len(), |end| end + 1)];
                let function = function.iter().cloned().collect();
                items(crate::reversible::expand(&arguments, function));
            }
            _ => {}
        }
    }
    if !found {
        items(crate::expand::expand(stream.clone()));
        items(crate::reversible::expand(&TokenStream::new(), stream));
    }
}

fn items(expanded: TokenStream) {
    let shown = expanded.to_string();
    let read = syn::parse2::<syn::File>(expanded);
    assert!(read.is_ok(), "{:?}: {shown}", read.err());
}
