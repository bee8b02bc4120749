//! Registers that calls receive. Those of arrays are borrowed first.

use super::reference;
use crate::reversible::ir::Register;
use crate::reversible::value::own;
use proc_macro2::TokenStream;
use quote::quote;
use std::rc::Rc;
use syn::Ident;

/// Borrows registers of one array, all at once. Returns the statement and the names of the borrows.
pub(super) fn from_array(array: &Ident, registers: &[&Register]) -> (TokenStream, Vec<Ident>) {
    let names: Vec<Ident> = (0..registers.len())
        .map(|place| own(&format!("{array}_{place}")))
        .collect();
    let places = registers.iter().filter_map(|register| {
        let place = register.element.as_ref()?.grouped();
        Some(quote!(#place as ::core::primitive::usize))
    });
    let message = format!("two of these registers of `{array}` are one [QRT0831]");
    let taken = quote! {
        let [#(#names),*] = #array.get_disjoint_mut([#(#places),*]).expect(#message);
    };
    (taken, names)
}

/// Returns the arguments of a call, and the statements that borrow from arrays before it.
pub(super) fn handed(arguments: &[(Rc<Register>, bool, Ident)]) -> (TokenStream, Vec<TokenStream>) {
    let mut taken = TokenStream::new();
    let mut borrowed: Vec<(&Register, Ident)> = Vec::new();
    for (register, ..) in arguments {
        let known = |(other, _): &(&Register, Ident)| other.name == register.name;
        if register.element.is_none() || borrowed.iter().any(known) {
            continue;
        }
        let mut same: Vec<(&Register, bool)> = Vec::new();
        for (other, change, _) in arguments.iter().filter(|(r, ..)| r.name == register.name) {
            if same.iter().all(|(known, _)| known.element != other.element) {
                same.push((other, *change));
            }
        }
        // Registers that are only read are borrowed one by one.
        if same.len() > 1 && same.iter().any(|(_, change)| *change) {
            let registers: Vec<&Register> = same.iter().map(|(register, _)| *register).collect();
            let (all, names) = from_array(&register.name, &registers);
            taken.extend(all);
            borrowed.extend(registers.into_iter().zip(names));
        }
    }
    let arguments = arguments.iter().map(|(register, change, name)| {
        let same = |(other, _): &&(&Register, Ident)| {
            other.name == register.name && other.element == register.element
        };
        let reference = reference(*change);
        if let Some((_, name)) = borrowed.iter().find(same) {
            return quote!(#reference *#name);
        }
        let place = register.tokens_at(name);
        // A parameter is a reference itself.
        let through = (register.parameter && register.element.is_none()).then(|| quote!(*));
        quote!(#reference #through #place)
    });
    (taken, arguments.collect())
}
