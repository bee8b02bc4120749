//! The constants that a function is generic over.

use super::dim::Linear;
use proc_macro2::TokenStream;
use quote::quote;
use std::ops::Deref;
use syn::Ident;

/// The constants of a function's generics, by name: each is a `u32`, or an `i32`, which is the type
/// of the bits before a point.
#[derive(Clone, Default)]
pub(super) struct Constants {
    names: Vec<Ident>,
    signed: Vec<Ident>,
    /// True if the item around the function is generic: then no type of Rust's has a width that depends on
    /// `Self`.
    has_generic_self: bool,
}

impl Deref for Constants {
    type Target = [Ident];

    fn deref(&self) -> &[Ident] {
        &self.names
    }
}

impl Constants {
    pub(super) fn push(&mut self, name: &Ident, is_signed: bool) {
        self.names.push(name.clone());
        if is_signed {
            self.signed.push(name.clone());
        }
    }

    /// Makes a constant an `i32`.
    pub(super) fn sign(&mut self, name: &Ident) {
        self.signed.push(name.clone());
    }

    /// Returns these constants, which are those of the item around the function, and its own after them.
    pub(super) fn followed_by(&self, others: &Self) -> Self {
        let mut all = self.clone();
        all.names.extend(others.names.iter().cloned());
        all.signed.extend(others.signed.iter().cloned());
        all.has_generic_self = !self.names.is_empty();
        all
    }

    /// True if the item around the function is generic.
    pub(super) fn has_generic_self(&self) -> bool {
        self.has_generic_self
    }

    /// Returns the constants that are an `i32`.
    pub(super) fn signed(&self) -> &[Ident] {
        &self.signed
    }

    /// Returns the number of a constant.
    pub(super) fn linear(&self, name: &Ident) -> Linear {
        if self.signed.contains(name) {
            let tokens = quote!((#name as ::core::primitive::u32));
            return Linear::named(name.to_string(), tokens);
        }
        Linear::name(name)
    }

    /// Returns the declaration of each constant in generics.
    pub(super) fn declared(&self) -> Vec<TokenStream> {
        let one = |name: &Ident| {
            if self.signed.contains(name) {
                quote!(const #name: ::core::primitive::i32)
            } else {
                quote!(const #name: ::core::primitive::u32)
            }
        };
        self.names.iter().map(one).collect()
    }
}
