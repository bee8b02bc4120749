//! Expansions of the macros, as pure functions.

use crate::dependency;
use crate::scene::Asked;
use proc_macro2::TokenStream;
use std::path::PathBuf;

/// Returns the expansion of `qrt!`. Files are relative to the folder of the author's Cargo.toml.
pub(crate) fn expand(input: TokenStream) -> TokenStream {
    proceed(Asked::new(input))
}

/// Continues the expansion of `qrt!`, with another function that its scenes name.
pub(crate) fn resume(input: TokenStream) -> TokenStream {
    proceed(Asked::resumed(input))
}

fn proceed(asked: Asked) -> TokenStream {
    let folder = folder();
    dependency::named(crate::scene::expand(asked, &folder), &folder)
}

/// Returns the expansion of `#[reversible]` on an item.
pub(crate) fn reversible(arguments: &TokenStream, item: TokenStream) -> TokenStream {
    dependency::named(crate::reversible::expand(arguments, item), &folder())
}

/// Returns the folder of the author's Cargo.toml; without cargo, the compiler's own.
fn folder() -> PathBuf {
    let manifest = std::env::var_os("CARGO_MANIFEST_DIR").map(PathBuf::from);
    let root = manifest.or_else(|| std::env::current_dir().ok());
    root.unwrap_or_default()
}
