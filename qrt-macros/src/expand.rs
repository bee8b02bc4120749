//! What the macros expand to, as pure functions.

use proc_macro2::TokenStream;
use std::path::PathBuf;

/// What `qrt!` expands to. Files are relative to the folder of the author's Cargo.toml.
pub(crate) fn expand(input: TokenStream) -> TokenStream {
    // Without cargo, the compiler's own folder.
    let manifest = std::env::var_os("CARGO_MANIFEST_DIR").map(PathBuf::from);
    let root = manifest.or_else(|| std::env::current_dir().ok());
    crate::scene::expand(input, &root.unwrap_or_default())
}
