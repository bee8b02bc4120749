//! A routine as a BSDF's term: the mathematics of a function's statements.
//!
//! A macro sees its own tokens only. So `#[reversible]` writes, beside a function that could be a
//! term, a macro of the function's name which hands the function's tokens on ([`offer`]); `qrt!`
//! asks that macro for them, and reads them here ([`read`]):
//!
//! ```text
//! tokens --understood--> Routine --signature--> outputs, variables --meaning--> expressions
//! ```
//!
//! Every register is an expression in the BSDF's variables. An update adds to it or subtracts from
//! it, exactly: the rounding to a register's last bit is left out. So is what leaves its first bit,
//! which must therefore be impossible: whatever the variables are, each register's number stays one
//! of its format.

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

/// What the function of these tokens means, or the compiler's errors; none of those for what
/// `#[reversible]` has reported already. Errors belong to where `site` belongs to.
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
    meaning.run(&routine.body);
    meaning.texts(&outputs)
}

/// Tokens that a macro has handed on, as if they had stood where they were written.
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
