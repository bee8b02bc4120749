//! The macro front end of qrt.

mod reversible;

use proc_macro::TokenStream;

/// Makes a function of registers reversible: generates it, its inverse and its program. The whole
/// language, with examples, is described where the facade `qrt` shows this macro.
#[proc_macro_attribute]
pub fn reversible(arguments: TokenStream, item: TokenStream) -> TokenStream {
    reversible::expand(&arguments.into(), item.into()).into()
}
