//! Problems of a routine: a code, a place, and the right thing to write. All problems are reported
//! at once.

use super::source::as_written;
use proc_macro2::{Ident, TokenStream};
use qrt_scene::syntax::codes;
use quote::ToTokens;

/// All problems found so far.
#[derive(Default)]
pub(super) struct Problems {
    found: Vec<syn::Error>,
}

impl Problems {
    /// Adds a problem. The tokens of `place` are underlined.
    #[cfg_attr(test, track_caller)]
    pub(super) fn add(&mut self, code: &str, place: impl ToTokens, message: &str, help: &str) {
        #[cfg(test)]
        crate::tests::checks::reached(std::panic::Location::caller(), code, message);
        let message = as_written(format!("{message} [{code}]\n  = help: {help}"));
        self.found.push(syn::Error::new_spanned(place, message));
    }

    /// Adds an error of the parser's.
    #[cfg_attr(test, track_caller)]
    pub(super) fn raw(&mut self, error: &syn::Error) {
        let place = Ident::new("_", error.span());
        let message = format!("this is not read as Rust: {error}");
        let help = "write updates such as `a += b;`, `if`, `for`, calls and blocks";
        self.add(codes::REV_STATEMENT, place, &message, help);
    }

    /// Adds problems that were found elsewhere.
    pub(super) fn append(&mut self, other: Self) {
        self.found.extend(other.found);
    }

    pub(super) fn count(&self) -> usize {
        self.found.len()
    }

    /// Returns the problems as errors of the compiler, in the order of the text.
    pub(super) fn tokens(&self) -> TokenStream {
        self.found
            .iter()
            .map(syn::Error::to_compile_error)
            .collect()
    }

    /// Returns the messages of all problems.
    #[cfg(test)]
    pub(super) fn messages(&self) -> Vec<String> {
        self.found.iter().map(ToString::to_string).collect()
    }
}
