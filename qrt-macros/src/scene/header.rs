//! The beginning of a scene: docs, attributes, visibility and its name.

use super::fault::Faults;
use proc_macro2::{Ident, TokenStream};
use qrt_scene::syntax::tree::Span;
use qrt_scene::syntax::{Report, codes};
use syn::parse::Parser as _;

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
        let attributes = attributes.unwrap_or_default().into_iter();
        let conditions = attributes.filter(|attribute| attribute.path().is_ident("cfg"));
        conditions.map(quote::ToTokens::into_token_stream).collect()
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

#[cfg(test)]
mod tests {
    use super::*;
    use proc_macro2::Span;

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
