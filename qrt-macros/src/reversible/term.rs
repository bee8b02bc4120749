//! A routine as a BSDF's term: the mathematics of a function's statements.
//!
//! A macro sees its own tokens only. So, beside a function that could be a term, `#[reversible]`
//! writes a macro of the function's name, which passes the function's tokens on ([`offer`]). `qrt!`
//! calls that macro for the tokens, and reads them here ([`read`]):
//!
//! ```text
//! tokens --understood--> Routine --signature--> outputs, variables --meaning--> expressions
//! ```
//!
//! Every register is an expression in the BSDF's variables. An update adds to it or subtracts from
//! it, exactly: the rounding to a register's last bit is left out. So is an overflow beyond its
//! first bit, which must therefore be impossible: for all values of the variables, each register's
//! number stays a number of its format.

mod bounds;
mod content;
mod meaning;
mod number;
mod offer;
mod signature;
#[cfg(test)]
mod tests;

pub(crate) use offer::offer;

use super::problem::Problems;
use meaning::Meaning;
use proc_macro2::{Group, Span, TokenStream, TokenTree};

/// One expression for grey, or one for each of red, green and blue.
pub(crate) type Channels = Vec<String>;

/// Reads the function of these tokens as a term, or returns the compiler's errors. There are no
/// errors if `#[reversible]` has reported them already. Errors are resolved at `site`.
pub(crate) fn read(function: TokenStream, site: Span) -> Result<Channels, TokenStream> {
    let function = placed(function, site);
    let mut problems = Problems::default();
    let read = channels(function, &mut problems);
    read.ok_or_else(|| problems.tokens())
}

fn channels(function: TokenStream, problems: &mut Problems) -> Option<Channels> {
    let function = syn::parse2::<syn::ItemFn>(function).ok()?;
    let routine = super::understood(
        &function,
        &super::Around::default(),
        &mut Problems::default(),
    )?;
    let outputs = signature::outputs(&routine.signature, problems)?;
    let mut meaning = Meaning::new(&routine.signature, problems)?;
    meaning.statements(&routine.body);
    meaning.texts(&outputs)
}

/// Returns tokens that a macro has passed on: resolved at `site`, and located where they were
/// written.
fn placed(tokens: TokenStream, site: Span) -> TokenStream {
    let placed = tokens.into_iter().map(|mut token| {
        if let TokenTree::Group(group) = &token {
            let mut inner = Group::new(group.delimiter(), placed(group.stream(), site));
            inner.set_span(group.span());
            token = inner.into();
        }
        token.set_span(token.span().resolved_at(site));
        token
    });
    placed.collect()
}
