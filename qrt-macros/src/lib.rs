//! The macro front end of qrt.

mod expand;
mod generate;
mod scene;
#[cfg(test)]
mod tests;

/// A scene.
#[proc_macro]
pub fn qrt(input: proc_macro::TokenStream) -> proc_macro::TokenStream {
    expand::expand(input.into()).into()
}
