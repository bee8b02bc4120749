//! The beginning of a scene: docs, attributes, visibility and its name.

use super::fault::Faults;
use proc_macro2::{Ident, TokenStream};
use qrt_syntax::tree::Span;
use qrt_syntax::{Report, codes};
use quote::quote;
use syn::Token;
use syn::parse::Parser as _;
use syn::punctuated::Punctuated;

/// A scene's name, and the tokens before it.
#[derive(Debug)]
pub(crate) struct Header {
    /// The attributes and doc comments in front of the scene.
    pub(crate) attributes: TokenStream,
    /// The visibility of the scene's type: `pub` and the like.
    pub(crate) visibility: TokenStream,
    /// The name of the scene's type.
    pub(crate) name: Ident,
    /// The place of the path of the scene's file, if it has one.
    pub(super) path: Option<Span>,
}

impl Header {
    /// Returns the attributes that all of the scene's expansion must have: its `cfg`s.
    pub(crate) fn conditions(&self) -> TokenStream {
        let attributes = syn::Attribute::parse_outer.parse2(self.attributes.clone());
        let conditions = attributes.unwrap_or_default().into_iter();
        conditions.filter_map(|own| condition(&own)).collect()
    }

    /// Returns the scene's name unless its entries give another: `cornell-box` for `CornellBox`.
    pub(crate) fn scene_name(&self) -> String {
        let text = self.name.to_string();
        let text = text.strip_prefix("r#").unwrap_or(&text).replace('_', "-");
        let letters: Vec<char> = text.chars().collect();
        let mut name = String::new();
        for (at, letter) in letters.iter().enumerate() {
            let before = at.checked_sub(1).map(|before| letters[before]);
            let after = letters.get(at + 1);
            let begins = letter.is_uppercase()
                && before.is_some_and(|before| {
                    let ends = before.is_uppercase() && after.is_some_and(|c| c.is_lowercase());
                    before.is_lowercase() || before.is_ascii_digit() || ends
                });
            if begins {
                name.push('-');
            }
            name.extend(letter.to_lowercase());
        }
        name
    }

    /// Adds the errors of the file, after the words `what`.
    pub(crate) fn report(&self, what: &str, report: &Report, faults: &mut Faults) {
        let place = self.path.unwrap_or_default();
        let code = report.codes().first().copied().unwrap_or(codes::UNREADABLE);
        faults.add(code, place, what).body(report.render(false));
    }
}

/// Returns an attribute as far as it is a condition: `#[cfg(a)]`, and `#[cfg_attr(a, cfg(b))]` of an
/// attribute that may have others behind `a`.
fn condition(attribute: &syn::Attribute) -> Option<TokenStream> {
    if attribute.path().is_ident("cfg") {
        return Some(quote!(#attribute));
    }
    let syn::Meta::List(list) = &attribute.meta else {
        return None;
    };
    if !list.path.is_ident("cfg_attr") {
        return None;
    }
    let parts = Punctuated::<syn::Meta, Token![,]>::parse_terminated.parse2(list.tokens.clone());
    let mut parts = parts.ok()?.into_iter();
    let when = parts.next()?;
    let conditions = parts.filter(|part| part.path().is_ident("cfg"));
    let conditions: Vec<syn::Meta> = conditions.collect();
    (!conditions.is_empty()).then(|| quote!(#[cfg_attr(#when, #(#conditions),*)]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proc_macro2::Span;

    fn conditions(attributes: TokenStream) -> String {
        let header = Header {
            attributes,
            visibility: TokenStream::new(),
            name: Ident::new("Room", Span::call_site()),
            path: None,
        };
        header.conditions().to_string()
    }

    #[test]
    fn all_of_a_scene_is_under_its_conditions() {
        let found = conditions(quote! {
            /// A room.
            #[cfg(unix)]
            #[cfg_attr(test, derive(Debug), cfg(feature = "rooms"))]
            #[cfg_attr(test, derive(Debug))]
        });
        let expected = quote!(#[cfg(unix)] #[cfg_attr(test, cfg(feature = "rooms"))]);
        assert_eq!(found, expected.to_string());
    }

    #[test]
    fn types_name_their_scenes() {
        for (name, text) in [
            ("CornellBox", "cornell-box"),
            ("RGBCube", "rgb-cube"),
            ("Box2", "box2"),
            ("Box2D", "box2-d"),
            ("lit_floor", "lit-floor"),
            ("Knot", "knot"),
        ] {
            let header = Header {
                attributes: TokenStream::new(),
                visibility: TokenStream::new(),
                name: Ident::new(name, Span::call_site()),
                path: None,
            };
            assert_eq!(header.scene_name(), text);
        }
    }
}
