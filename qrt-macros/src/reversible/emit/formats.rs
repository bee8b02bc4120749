//! Formats whose widths are computed from a routine's constants. No type in Rust has a computed
//! width, but a type can have a constant with a computed value. Each of these formats is a type of
//! the routine's, and a parameter may be of any type that has the same format.

use crate::reversible::constants::Constants;
use crate::reversible::ir::{Kind, Register, Routine, Signature, Statement, StatementKind as K};
use proc_macro2::TokenStream;
use quote::quote;
use std::collections::BTreeMap;
use std::rc::Rc;
use syn::Ident;

/// Returns the types of a routine's computed formats.
pub(super) fn declared(routine: &Routine) -> TokenStream {
    let mut registers: Vec<&Rc<Register>> = routine.signature.parameters.iter().collect();
    scratch(&routine.body, &mut registers);
    let constants = &routine.signature.constants;
    let named = |register: &&Rc<Register>| Some((register.computed.clone()?, (*register).clone()));
    let all: BTreeMap<Ident, Rc<Register>> = registers.iter().filter_map(named).collect();
    let declared = all
        .iter()
        .map(|(name, register)| one(name, register, constants));
    declared.collect()
}

fn one(name: &Ident, register: &Register, constants: &Constants) -> TokenStream {
    let (declared, names) = (constants.declared(), &constants[..]);
    let format = &register.format;
    let (width, fraction) = (format.width.signed_tokens(), format.fraction.tokens());
    let ty = match format.kind {
        Kind::Bool => quote!(Bool),
        Kind::UInt => quote!(UInt),
        Kind::Int => quote!(Int),
        Kind::UFixed => quote!(UFixed { fraction: #fraction }),
        Kind::Fixed => quote!(Fixed { fraction: #fraction }),
    };
    quote! {
        #[allow(non_camel_case_types, dead_code, reason = "it is called like its width")]
        struct #name<#(#declared),*>;
        impl<#(#declared),*> ::qrt::circuit::format::Format
            for #name<#(#names),*>
        {
            const TYPE: ::qrt::circuit::Type = ::qrt::circuit::Type::#ty;
            const WIDTH: ::core::primitive::u32 = ::qrt::circuit::format::width(#width);
        }
    }
}

/// Returns code that checks that the registers of a call have the computed formats of its
/// parameters.
pub(super) fn agree(signature: &Signature) -> TokenStream {
    let Signature {
        name: routine,
        constants,
        parameters,
        ..
    } = signature;
    let (declared, names) = (constants.declared(), &constants[..]);
    let computed = parameters.iter().filter_map(|parameter| {
        let name = &parameter.name;
        let format = parameter.computed.as_ref()?;
        let message = format!(
            "QRT0813: `{name}` of `{routine}` is a register of another format than `{}`",
            parameter.type_text()
        );
        let one = if parameter.is_array() {
            quote!(#name.first())
        } else {
            quote!(::core::option::Option::Some(&*#name))
        };
        Some(quote! {
            {
                struct __Expected<#(#declared),*>;
                impl<#(#declared),*> ::qrt::circuit::format::ExpectedFormat
                    for __Expected<#(#names),*>
                {
                    type Format = #format<#(#names),*>;
                    const OTHERWISE: &'static ::core::primitive::str = #message;
                }
                ::qrt::circuit::format::agree::<__Expected<#(#names),*>, _, _>(#one);
            }
        })
    });
    computed.collect()
}

fn scratch<'a>(statements: &'a [Statement], found: &mut Vec<&'a Rc<Register>>) {
    for statement in statements {
        let (first, second): (&[Statement], &[Statement]) = match &statement.kind {
            K::Scratch(register, body) => {
                found.push(register);
                (body, &[])
            }
            K::If(_, a, b) | K::Within(a, b) => (a, b),
            K::For { body, .. } | K::Block(body) => (body, &[]),
            K::Update(..) | K::Swap(..) | K::Zero(_) | K::Call { .. } => continue,
        };
        scratch(first, found);
        scratch(second, found);
    }
}
