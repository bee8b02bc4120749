//! `#[reversible]`: from a function's tokens to it and its inverse.
//!
//! ```text
//! tokens --signature, statement, number, bit, fit--> Routine --track--> checked --emit--> Rust
//! ```

mod bit;
mod call;
mod constant;
mod dim;
mod emit;
mod fit;
mod ir;
mod number;
mod problem;
mod scope;
mod signature;
mod statement;
pub(crate) mod term;
#[cfg(test)]
mod tests;
mod track;
mod value;

use ir::{Routine, Signature};
use problem::Problems;
use proc_macro2::TokenStream;
use qrt_core::codes;
use scope::Scope;
use track::Tracker;

/// What the attribute turns an item into.
pub(crate) fn expand(arguments: &TokenStream, item: TokenStream) -> TokenStream {
    let offer = term::offer(&item);
    let (tokens, problems) = expanded(arguments, item);
    let errors = problems.tokens();
    quote::quote!(#errors #tokens #offer)
}

fn expanded(arguments: &TokenStream, item: TokenStream) -> (TokenStream, Problems) {
    let mut problems = Problems::default();
    if !arguments.is_empty() {
        let message = "`#[reversible]` takes no arguments";
        problems.add(codes::REV_ITEM, arguments, message, "write `#[reversible]`");
    }
    let function = match syn::parse2::<syn::Item>(item.clone()) {
        Ok(syn::Item::Fn(function)) => function,
        Ok(other) => {
            let message = "only a function can be reversible";
            let help = "put `#[reversible]` on a `fn` whose parameters are registers";
            problems.add(codes::REV_ITEM, first(&other), message, help);
            return (item, problems);
        }
        Err(error) => {
            problems.raw(error);
            return (item, problems);
        }
    };
    match understood(&function, problems) {
        (Ok(routine), problems) => (emit::routine(&routine), problems),
        (Err(signature), problems) => (emit::unfinished(&signature), problems),
    }
}

/// The routine that a function is, or its signature alone if something is wrong with it.
fn understood(
    function: &syn::ItemFn,
    mut problems: Problems,
) -> (Result<Routine, Signature>, Problems) {
    let signature = signature::read(function, &mut problems);
    let mut scope = Scope {
        routine: signature.name.clone(),
        registers: signature.parameters.clone(),
        constants: signature.constants.clone(),
        loops: Vec::new(),
        demands: Vec::new(),
        problems,
        writes: Vec::new(),
        fraction: None,
    };
    let body = scope.block(&function.block);
    let Scope {
        demands,
        mut problems,
        ..
    } = scope;
    if problems.count() == 0 {
        Tracker::new(&mut problems).body(&body);
    }
    if problems.count() > 0 {
        return (Err(signature), problems);
    }
    let routine = Routine {
        signature,
        body,
        demands,
    };
    (Ok(routine), problems)
}

/// The keyword that an item begins with, which is enough to be underlined.
fn first(item: &syn::Item) -> TokenStream {
    let tokens = quote::quote!(#item).into_iter();
    let keyword = tokens.skip_while(|token| !matches!(token, proc_macro2::TokenTree::Ident(_)));
    keyword.take(1).collect()
}
