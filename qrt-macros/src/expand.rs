//! What the macros expand to, as pure functions.

use crate::dependency;
use crate::scene::Asked;
use proc_macro2::TokenStream;
use std::path::PathBuf;

/// What `qrt!` expands to. Files are relative to the folder of the author's Cargo.toml.
pub(crate) fn expand(input: TokenStream) -> TokenStream {
    proceed(Asked::new(input))
}

/// The same, once another function that its scenes name has been handed over.
pub(crate) fn resume(input: TokenStream) -> TokenStream {
    proceed(Asked::resumed(input))
}

fn proceed(asked: Asked) -> TokenStream {
    let folder = folder();
    dependency::named(crate::scene::expand(asked, &folder), &folder)
}

/// What `#[reversible]` expands a function to.
pub(crate) fn reversible(arguments: &TokenStream, item: TokenStream) -> TokenStream {
    dependency::named(crate::reversible::expand(arguments, item), &folder())
}

/// The folder of the author's Cargo.toml; without cargo, the compiler's own.
fn folder() -> PathBuf {
    let manifest = std::env::var_os("CARGO_MANIFEST_DIR").map(PathBuf::from);
    let root = manifest.or_else(|| std::env::current_dir().ok());
    root.unwrap_or_default()
}
