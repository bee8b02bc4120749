//! From a checked scene to the Rust that runs its circuit.

use crate::scene::Parsed;
use proc_macro2::TokenStream;
use qrt_core::report::Problem;
use qrt_core::valid::ValidScene;

/// What the scene's circuit is in Rust.
///
/// # Errors
/// What keeps the scene from having one.
#[expect(
    clippy::unnecessary_wraps,
    reason = "a circuit may cost more than its budget"
)]
pub(crate) fn scene(_: &Parsed, _: &ValidScene) -> Result<TokenStream, Vec<Problem>> {
    Ok(TokenStream::new())
}
