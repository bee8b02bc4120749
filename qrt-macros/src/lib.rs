//! The macro front end of qrt: scenes in Rust's tokens, and reversible functions.
//!
//! Authors use it through the crate `qrt`, whose documentation holds the grammar. `scene/` reads
//! the tokens into the same tree that YAML becomes, and passes it to the one checker. `generate/`
//! writes the circuit. `reversible/` reads functions. All of these are functions on token streams
//! of `proc_macro2`, which tests call.

#![forbid(unsafe_code)]

mod dependency;
mod expand;
mod generate;
mod reversible;
mod scene;
mod surroundings;
#[cfg(test)]
mod tests;

/// Expands one scene or more; see the crate `qrt` for the grammar.
#[proc_macro]
pub fn qrt(input: proc_macro::TokenStream) -> proc_macro::TokenStream {
    expand::expand(input.into()).into()
}

/// Makes a function of registers reversible: generates it, its inverse and its program. The facade
/// `qrt` documents the whole language at this macro, with examples.
#[proc_macro_attribute]
pub fn reversible(
    arguments: proc_macro::TokenStream,
    item: proc_macro::TokenStream,
) -> proc_macro::TokenStream {
    expand::reversible(arguments.into(), item.into()).into()
}
