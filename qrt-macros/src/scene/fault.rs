//! Errors in a macro's input, and their reports to the compiler.

use super::tokens::Table;
use proc_macro2::{Delimiter, Group, Ident, Literal, Punct, Spacing, Span, TokenStream, TokenTree};
use qrt_syntax::{codes, tree};
use quote::{quote, quote_spanned};
use std::collections::HashSet;
use std::fmt::Write as _;

/// The codes of names that the scene does not define.
const UNDEFINED: [&str; 3] = [
    codes::MACRO_NUMBER_NAME,
    codes::UNKNOWN_MATERIAL,
    codes::EXPR_NAME,
];

/// One error, at a place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Fault {
    /// The stable code of the fault: `QRT0700`.
    pub(crate) code: &'static str,
    place: tree::Span,
    message: String,
    notes: Vec<String>,
    /// Another place, and the words before it: "the first is".
    also: Option<(tree::Span, String)>,
    /// The right thing to write.
    pub(crate) help: Option<String>,
    /// The text of another report, codes included.
    body: Option<String>,
    /// True if it was found in a loop, of which every pass may find it again.
    repeats: bool,
}

impl Fault {
    /// States the pass of a loop in which the fault was found.
    pub(crate) fn in_pass(&mut self, pass: &str) -> &mut Self {
        self.repeats = true;
        self.note(format!("where {pass}"))
    }

    /// Adds a note on a line of its own after the message.
    pub(crate) fn note(&mut self, note: impl Into<String>) -> &mut Self {
        self.notes.push(note.into());
        self
    }

    /// Adds another place that matters, and the reason.
    pub(crate) fn also(&mut self, place: tree::Span, why: impl Into<String>) -> &mut Self {
        self.also = Some((place, why.into()));
        self
    }

    /// Adds the right thing to write.
    pub(crate) fn help(&mut self, help: impl Into<String>) -> &mut Self {
        self.help = Some(help.into());
        self
    }

    /// Adds the text of another report, which has its own codes.
    pub(crate) fn body(&mut self, body: String) -> &mut Self {
        self.body = Some(body);
        self
    }

    /// Returns the compiler's spans of the two ends of its place.
    pub(crate) fn ends(&self, table: &Table) -> (Span, Span) {
        table.ends(self.place)
    }

    /// Returns the text that the compiler shows.
    pub(crate) fn text(&self, table: &Table) -> String {
        if let Some(body) = &self.body {
            return format!("{}\n\n{}", self.message, body.trim_end());
        }
        let mut text = format!("{} [{}]", self.message, self.code);
        for note in &self.notes {
            text += "\nnote: ";
            text += note;
        }
        if let Some((place, why)) = &self.also {
            let (here, _) = table.ends(self.place);
            let there = table.ends(*place).0.start();
            // Writing to a string cannot fail.
            let _ = write!(text, "\nnote: {why} on line {}", there.line);
            if there.line == here.start().line {
                let _ = write!(text, ", column {}", there.column + 1);
            }
        }
        if let Some(help) = &self.help {
            text += "\nhelp: ";
            text += help;
        }
        text
    }
}

/// All faults of the macro's input.
#[derive(Debug, Default)]
pub(crate) struct Faults(Vec<Fault>);

impl Faults {
    /// Adds a fault, and returns it for further description.
    #[cfg_attr(test, track_caller)]
    pub(crate) fn add(
        &mut self,
        code: &'static str,
        place: tree::Span,
        message: impl Into<String>,
    ) -> &mut Fault {
        let message = message.into();
        #[cfg(test)]
        crate::tests::checks::reached(std::panic::Location::caller(), code, &message);
        let index = self.0.len();
        self.0.push(Fault {
            code,
            place,
            message,
            notes: Vec::new(),
            also: None,
            help: None,
            body: None,
            repeats: false,
        });
        &mut self.0[index]
    }

    /// Number of faults.
    pub(crate) fn count(&self) -> usize {
        self.0.len()
    }

    /// Returns the faults in the order of their places; of those that loops repeat, the first.
    pub(crate) fn finalize(mut self) -> Vec<Fault> {
        self.0
            .sort_by_key(|fault| (fault.place.start, fault.place.end, fault.code));
        self.0.dedup_by(|next, kept| {
            let same = kept.repeats || kept.message == next.message;
            same && (next.code, next.place) == (kept.code, kept.place)
        });
        self.0
    }

    /// Reduces the faults from number `from` on, those of one scene: a name that it does not define
    /// is one fault, at the name's first place.
    pub(crate) fn merge_undefined(&mut self, from: usize) {
        let mut own = self.0.split_off(from);
        own.sort_by_key(|fault| fault.place.start);
        let mut undefined = HashSet::new();
        own.retain(|fault| {
            let name = (fault.code, fault.message.clone());
            !UNDEFINED.contains(&fault.code) || undefined.insert(name)
        });
        self.0.append(&mut own);
    }

    /// Adds the faults of another scene of the same input.
    pub(crate) fn append(&mut self, mut other: Self) {
        self.0.append(&mut other.0);
    }
}

/// Returns the compiler's warning `text` about the scene `name` at a span. A macro cannot warn on
/// stable Rust. But the compiler warns about the use of a deprecated item, and shows its name and
/// its note.
pub(crate) fn compile_warning(text: &str, name: &Ident, (first, _): (Span, Span)) -> TokenStream {
    let note = Literal::string(text);
    let mut used = name.clone();
    used.set_span(first);
    quote! {
        const _: () = {
            #[allow(non_upper_case_globals)]
            #[deprecated(note = #note)]
            const #used: () = ();
            #used
        };
    }
}

/// Returns the compiler's error `text` from one span to another.
pub(crate) fn compile_error(text: &str, (first, last): (Span, Span)) -> TokenStream {
    let mut words: TokenStream = quote_spanned!(first=> ::core::compile_error);
    let mut bang = Punct::new('!', Spacing::Alone);
    bang.set_span(first);
    let mut literal = Literal::string(text);
    literal.set_span(last);
    let mut braces = Group::new(Delimiter::Brace, TokenTree::from(literal).into());
    braces.set_span(last);
    words.extend([TokenTree::from(bang), TokenTree::from(braces)]);
    words
}
