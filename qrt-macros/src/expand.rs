//! Expansions of the macros, as pure functions.

use crate::dependency;
use proc_macro2::TokenStream;
use std::path::PathBuf;

/// Returns the expansion of `qrt!`. Files are relative to the folder of the author's Cargo.toml.
pub(crate) fn expand(input: TokenStream) -> TokenStream {
    let folder = folder();
    let (path, input) = dependency::given(input);
    dependency::named(crate::scene::expand(input, &folder), &folder, path)
}

/// Returns the expansion of `#[reversible]` on an item.
pub(crate) fn reversible(arguments: TokenStream, item: TokenStream) -> TokenStream {
    let (path, arguments) = dependency::given(arguments);
    dependency::named(crate::reversible::expand(&arguments, item), &folder(), path)
}

/// Returns the folder of the author's Cargo.toml; without cargo, the compiler's own.
fn folder() -> PathBuf {
    let manifest = std::env::var_os("CARGO_MANIFEST_DIR").map(PathBuf::from);
    let root = manifest.or_else(|| std::env::current_dir().ok());
    root.unwrap_or_default()
}
