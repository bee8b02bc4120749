//! What the macros expand to, as pure functions.

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
    // Without cargo, the compiler's own folder.
    let manifest = std::env::var_os("CARGO_MANIFEST_DIR").map(PathBuf::from);
    let root = manifest.or_else(|| std::env::current_dir().ok());
    crate::scene::expand(asked, &root.unwrap_or_default())
}
