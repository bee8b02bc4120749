//! Problems of a routine: a code, a place, and the right thing to write. All problems are reported
//! at once.

use super::source::as_written;
use proc_macro2::{Ident, TokenStream};
use qrt_syntax::codes;
use quote::ToTokens;

/// All problems found so far.
#[derive(Default)]
pub(super) struct Problems {
    found: Vec<Problem>,
}

/// A problem, with the tokens that the compiler underlines.
pub(super) struct Problem {
    pub(super) code: &'static str,
    pub(super) message: String,
    pub(super) help: String,
    place: TokenStream,
}

impl Problem {
    fn error(&self) -> syn::Error {
        let Self {
            code,
            message,
            help,
            place,
        } = self;
        let text = as_written(format!("{message} [{code}]\n  = help: {help}"));
        syn::Error::new_spanned(place, text)
    }
}

impl Problems {
    /// Adds a problem. The tokens of `place` are underlined.
    #[cfg_attr(test, track_caller)]
    pub(super) fn add(
        &mut self,
        code: &'static str,
        place: impl ToTokens,
        message: &str,
        help: &str,
    ) {
        #[cfg(test)]
        crate::tests::checks::reached(std::panic::Location::caller(), code, message);
        self.found.push(Problem {
            code,
            message: message.to_owned(),
            help: help.to_owned(),
            place: place.into_token_stream(),
        });
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
            .map(|problem| problem.error().to_compile_error())
            .collect()
    }

    /// Returns all problems, in the order in which they were found.
    #[cfg(test)]
    pub(super) fn found(&self) -> &[Problem] {
        &self.found
    }

    /// Returns the messages of all problems.
    #[cfg(test)]
    pub(super) fn messages(&self) -> Vec<String> {
        let errors = self.found.iter().map(Problem::error);
        errors.map(|error| error.to_string()).collect()
    }
}
