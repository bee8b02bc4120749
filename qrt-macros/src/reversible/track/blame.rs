//! The statement that is at fault for a wrong content of a register.

use crate::reversible::problem::Problems;
use crate::reversible::source::{begin, text};
use proc_macro2::TokenStream;
use qrt_syntax::codes;
use quote::ToTokens;
use std::collections::BTreeSet;
use std::rc::Rc;
use syn::Ident;

/// A change of a register.
pub(super) struct Change {
    pub(super) register: String,
    /// The change: equal for equal effects.
    pub(super) done: String,
    /// The change that would undo this one.
    pub(super) undone_by: String,
    pub(super) texts: Rc<Texts>,
    pub(super) source: TokenStream,
}

/// All changes so far.
#[derive(Default)]
pub(super) struct Log {
    changes: Vec<Change>,
    /// The places that have been reported, which another pass of a loop does not report again.
    said: BTreeSet<String>,
    /// Claims that a register is 0, with the number of changes before each.
    claims: Vec<(String, usize)>,
    /// True while statements are looked through for a second time.
    pub(super) again: bool,
}

impl Log {
    pub(super) fn len(&self) -> usize {
        self.changes.len()
    }

    pub(super) fn push(&mut self, change: Change) {
        self.changes.push(change);
    }

    /// Records a claim that a register is 0 here.
    pub(super) fn claim(&mut self, register: String) {
        self.claims.push((register, self.changes.len()));
    }

    /// Returns the changes since `begin` that no later one undoes; if all are undone, all changes.
    fn left(&self, begin: usize, registers: &[String]) -> Vec<&Change> {
        let all = self.changes[begin..].iter();
        let all: Vec<&Change> = all
            .filter(|change| registers.contains(&change.register))
            .collect();
        let mut left: Vec<&Change> = Vec::new();
        for change in &all {
            match left
                .iter()
                .rposition(|earlier| earlier.undone_by == change.done)
            {
                Some(place) => drop(left.remove(place)),
                None => left.push(change),
            }
        }
        if left.is_empty() { all } else { left }
    }

    /// Reports a scratch register at its end, or an array of them, which exist since `begin`, if it
    /// is dirty or unused. The names are those of all registers, and those of the dirty ones.
    pub(super) fn check(
        &mut self,
        begin: usize,
        name: &Ident,
        [all, dirty]: [&[String]; 2],
        problems: &mut Problems,
    ) {
        if dirty.is_empty() && !self.left(begin, all).is_empty() {
            return;
        }
        let claims = self
            .claims
            .iter()
            .filter(|(register, _)| dirty.contains(register));
        let begin = claims.map(|(_, place)| *place).fold(begin, usize::max);
        let left = self.left(begin, dirty);
        let left: Vec<(Texts, TokenStream)> = left
            .iter()
            .map(|change| (Texts::clone(&change.texts), change.source.clone()))
            .collect();
        let place = left
            .first()
            .map_or(name.to_token_stream(), |(_, source)| source.clone());
        if !first_time(&mut self.said, self.again, &place) {
            return;
        }
        if left.is_empty() {
            nothing_computed(name, problems);
        } else {
            never_uncomputed(name, &left, problems);
        }
    }

    /// Reports an `apply!` that has changed an operand or a result of its `within!`.
    pub(super) fn changed_in_apply(
        &mut self,
        begin: usize,
        register: &str,
        problems: &mut Problems,
    ) {
        let left = self.left(begin, &[register.to_owned()]);
        let source = left.first().map(|first| first.source.clone());
        if let Some(source) = source
            && first_time(&mut self.said, self.again, &source)
        {
            within_changed(register, &source, problems);
        }
    }
}

/// True if a place is at fault for the first time: other passes of a loop report the same.
fn first_time(said: &mut BTreeSet<String>, again: bool, source: &TokenStream) -> bool {
    !again && said.insert(format!("{:?} {source}", begin(source)))
}

/// A statement and its inverse as texts, independent of the values that they read.
pub(super) type Texts = [String; 2];

/// Reports a scratch register that nothing is computed into.
pub(super) fn nothing_computed(name: &Ident, problems: &mut Problems) {
    let message = format!("nothing is computed into `{name}`");
    problems.add(codes::REV_UNUSED, name, &message, "remove it");
}

/// Reports a scratch register that is not 0 at its end, after these changes of it.
pub(super) fn never_uncomputed(
    name: &Ident,
    left: &[(Texts, TokenStream)],
    problems: &mut Problems,
) {
    let Some(((texts, source), later)) = left.split_first() else {
        return;
    };
    let message = format!("computed here, never uncomputed: `{name}` is not 0 at its end");
    let late = later.iter().find(|(later, _)| later[0] == texts[1]);
    let help = match late {
        Some((_, late)) => format!(
            "`{}` does not undo it: what it reads has changed in between",
            text(late)
        ),
        None if !later.is_empty() => {
            "compute it in `within! { .. }` and use it in `apply! { .. }`".to_owned()
        }
        None => format!(
            "write `within! {{ {}; }} apply! {{ .. }}` around what uses it",
            text(source)
        ),
    };
    problems.add(codes::REV_DIRTY, source, &message, &help);
}

/// Reports a register that an `apply!` changes under its `within!`.
pub(super) fn within_changed(name: &str, source: &TokenStream, problems: &mut Problems) {
    let message = format!("`{name}` is what the `within!` before was computed from or into");
    let help = "change it before or after the two, so that what was computed can be undone";
    problems.add(codes::REV_WITHIN, source, &message, help);
}
