//! Methods: the functions of an `impl`, whose `self` is a register of the `impl`'s format, and the
//! functions that a trait declares.
//!
//! The format of `self` is written at the `impl` and not at the function, so the attribute stands
//! at the `impl`. Every function of the `impl` is read with `self` and `Self` written out.

use super::ir::OfTrait;
use super::problem::Problems;
use super::source::{SELF, text};
use super::{Around, attributes, emit, signature, understood};
use proc_macro2::{Group, Ident, TokenStream, TokenTree};
use qrt_syntax::codes;
use quote::{ToTokens, quote};
use syn::{
    FnArg, ImplItem, ItemFn, ItemImpl, ItemTrait, ReceiverKind, TraitItem, Type, Visibility,
};

/// Returns all Rust that an `impl` expands to.
pub(super) fn of_block(mut block: ItemImpl, problems: &mut Problems) -> TokenStream {
    let before = problems.count();
    let constants = signature::constants(
        &block.generics,
        "an `impl` of reversible functions",
        problems,
    );
    let around = Around {
        constants,
        of: (block.trait_.as_ref()).map_or(OfTrait::None, |(path, ..)| {
            OfTrait::Implemented(path.clone())
        }),
        complete: problems.count() == before,
    };
    let mut others = Vec::new();
    let mut functions = TokenStream::new();
    for item in std::mem::take(&mut block.items) {
        let ImplItem::Fn(function) = item else {
            others.push(item);
            continue;
        };
        let mut function = ItemFn {
            attrs: function.attrs,
            vis: function.vis,
            modifiers: function.modifiers,
            sig: function.sig,
            block: Box::new(function.block),
        };
        if let (None, Some(receiver)) = (&block.trait_, function.sig.receiver()) {
            let (ty, name) = (text(&block.self_ty), &function.sig.ident);
            let message = format!(
                "`self` is a register in the `impl` of a trait for a format, and `{ty}` is none"
            );
            let help = format!(
                "leave it out, and call `{ty}::{name}(..)`; or write a trait, and `impl` it for `UInt<8>`"
            );
            problems.add(codes::REV_SIGNATURE, receiver, &message, &help);
            function.sig.inputs = function.sig.inputs.into_iter().skip(1).collect();
            let unread = &mut Problems::default();
            functions.extend(emit::unfinished(&signature::read(
                &function, &around, unread,
            )));
            continue;
        }
        let mut own = Problems::default();
        let function = written_out(function, Some(&block.self_ty), &mut own);
        let routine = understood(&function, &around, &mut own);
        let written = routine.map(|routine| emit::routine(&routine));
        functions.extend(written.unwrap_or_else(|| {
            let unread = &mut Problems::default();
            emit::unfinished(&signature::read(&function, &around, unread))
        }));
        problems.append(own);
    }
    block.items = others;
    within_braces(block.to_token_stream(), functions)
}

/// Returns all Rust that a trait expands to.
pub(super) fn of_trait(mut declared: ItemTrait, problems: &mut Problems) -> TokenStream {
    let around = Around {
        constants: signature::constants(
            &declared.generics,
            "a trait of reversible functions",
            problems,
        ),
        of: OfTrait::Declared,
        complete: true,
    };
    let mut others = Vec::new();
    let mut functions = TokenStream::new();
    for item in std::mem::take(&mut declared.items) {
        let TraitItem::Fn(function) = item else {
            others.push(item);
            continue;
        };
        if let Some(body) = &function.default {
            let message = "a trait's function has no body: the format of `self` is not known here";
            let help = "write it in the `impl` for each format";
            problems.add(codes::REV_ITEM, body, message, help);
        }
        let function = ItemFn {
            attrs: function.attrs,
            vis: Visibility::Inherited,
            modifiers: function.modifiers,
            sig: function.sig,
            block: syn::parse_quote!({}),
        };
        attributes::check(&function, problems);
        let function = written_out(function, None, problems);
        functions.extend(emit::declared(&signature::read(
            &function, &around, problems,
        )));
    }
    declared.items = others;
    within_braces(declared.to_token_stream(), functions)
}

/// Returns the function with a parameter for `self`, and with the type that `Self` stands for.
fn written_out(mut function: ItemFn, own: Option<&Type>, problems: &mut Problems) -> ItemFn {
    let ty = own.map_or_else(|| quote!(Self), ToTokens::to_token_stream);
    if let Some(FnArg::Receiver(receiver)) = function.sig.inputs.first() {
        let reference = if let ReceiverKind::Reference(and, None, mutability) = &receiver.kind {
            quote!(#and #mutability)
        } else {
            let message = "a register is taken by reference: it can neither be copied nor dropped";
            let help = "write `&self`, or `&mut self` if it is changed";
            problems.add(codes::REV_PARAMETER, receiver, message, help);
            quote!(&mut)
        };
        let name = Ident::new(SELF, receiver.self_token.span);
        let attributes = &receiver.attrs;
        function.sig.inputs[0] = syn::parse_quote!(#(#attributes)* #name: #reference #ty);
    }
    let written = syn::parse2(replaced(function.to_token_stream(), &ty));
    written.unwrap_or(function)
}

/// Replaces `self` by another name, and a `Self` that stands alone by a type.
fn replaced(tokens: TokenStream, ty: &TokenStream) -> TokenStream {
    let trees: Vec<TokenTree> = tokens.into_iter().collect();
    let mut written = TokenStream::new();
    for (at, tree) in trees.iter().enumerate() {
        let begins_a_path = || {
            trees
                .get(at + 1)
                .is_some_and(|next| next.to_string() == ":")
        };
        match tree {
            TokenTree::Group(group) => {
                let mut inner = Group::new(group.delimiter(), replaced(group.stream(), ty));
                inner.set_span(group.span());
                written.extend([TokenTree::from(inner)]);
            }
            TokenTree::Ident(name) if name == "self" && !begins_a_path() => {
                written.extend([TokenTree::from(Ident::new(SELF, name.span()))]);
            }
            TokenTree::Ident(name) if name == "Self" && !begins_a_path() => {
                written.extend(ty.clone().into_iter().map(|mut token| {
                    token.set_span(name.span());
                    token
                }));
            }
            other => written.extend([other.clone()]),
        }
    }
    written
}

/// Returns an item with more tokens between the braces that it ends with.
fn within_braces(item: TokenStream, more: TokenStream) -> TokenStream {
    let mut trees: Vec<TokenTree> = item.into_iter().collect();
    if let Some(TokenTree::Group(body)) = trees.last_mut() {
        let mut all = body.stream();
        all.extend(more);
        let mut longer = Group::new(body.delimiter(), all);
        longer.set_span(body.span());
        *body = longer;
    }
    trees.into_iter().collect()
}
