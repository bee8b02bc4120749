//! What is wrong with a routine: a code, a place, the right thing to write. All of it is said at
//! once.

use proc_macro2::TokenStream;
use quote::ToTokens;

/// Everything that has been found wrong so far.
#[derive(Default)]
pub(super) struct Problems {
    found: Vec<syn::Error>,
}

impl Problems {
    /// Adds one. `place` is underlined.
    #[cfg_attr(test, track_caller)]
    pub(super) fn add(&mut self, code: &str, place: impl ToTokens, message: &str, help: &str) {
        #[cfg(test)]
        crate::tests::checks::reached(std::panic::Location::caller(), code, message);
        let message = format!("{message} [{code}]\n  = help: {help}");
        self.found.push(syn::Error::new_spanned(place, message));
    }

    /// Adds an error of the parser's.
    #[cfg_attr(test, track_caller)]
    pub(super) fn raw(&mut self, error: syn::Error) {
        #[cfg(test)]
        crate::tests::checks::reached(std::panic::Location::caller(), "", &error.to_string());
        self.found.push(error);
    }

    pub(super) fn count(&self) -> usize {
        self.found.len()
    }

    /// As errors of the compiler, in the order of the text.
    pub(super) fn tokens(&self) -> TokenStream {
        self.found
            .iter()
            .map(syn::Error::to_compile_error)
            .collect()
    }

    /// The messages.
    #[cfg(test)]
    pub(super) fn messages(&self) -> Vec<String> {
        self.found.iter().map(ToString::to_string).collect()
    }
}

/// Of `names`, the one that is nearest to `name`, if it is near at all.
pub(super) fn nearest<'a>(name: &str, names: impl Iterator<Item = &'a str>) -> Option<&'a str> {
    let far = (name.chars().count() + 1) / 3;
    let near = names.map(|other| (distance(name, other), other));
    let best = near.min_by_key(|(distance, _)| *distance)?;
    (best.0 <= far).then_some(best.1)
}

/// Letters to insert, remove or replace.
fn distance(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, from) in a.chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, to) in b.iter().enumerate() {
            let replaced = diagonal + usize::from(from != *to);
            diagonal = row[j + 1];
            row[j + 1] = replaced.min(row[j] + 1).min(diagonal + 1);
        }
    }
    row.last().copied().unwrap_or(0)
}
