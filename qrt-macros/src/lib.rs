//! The macro front end of qrt: scenes in Rust's tokens.
//!
//! Authors use it through the crate `qrt`, whose documentation holds the grammar. `scene/` reads the
//! tokens into the tree that YAML becomes too, and hands it to the one checker; `generate/` writes
//! the circuit. All of it are functions on token streams of `proc_macro2`, which tests call.

mod expand;
mod generate;
mod scene;
#[cfg(test)]
mod tests;

/// One scene or more; see the crate `qrt` for the grammar.
#[proc_macro]
pub fn qrt(input: proc_macro::TokenStream) -> proc_macro::TokenStream {
    expand::expand(input.into()).into()
}
