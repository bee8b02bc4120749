//! `#[reversible]`: from a function's tokens to the function and its inverse.
//!
//! ```text
//! tokens --signature, statement, number, bit, fit--> Routine --track--> checked --emit--> Rust
//! ```

mod advice;
mod attributes;
mod bit;
mod bitwise;
mod call;
mod constant;
mod constants;
mod dim;
mod emit;
mod fit;
mod ir;
mod methods;
mod number;
mod outside;
mod problem;
mod scope;
mod signature;
mod source;
mod statement;
mod table;
#[cfg(test)]
mod tests;
mod track;
mod value;

use constants::Constants;
use ir::{OfTrait, Routine};
use problem::Problems;
use proc_macro2::{Delimiter, Group, Span, TokenStream, TokenTree};
use qrt_syntax::codes;
use scope::Scope;

/// Returns the expansion of an item with the attribute.
pub(crate) fn expand(arguments: &TokenStream, item: TokenStream) -> TokenStream {
    let (tokens, problems) = expanded(arguments, item);
    let errors = problems.tokens();
    quote::quote!(#errors #tokens)
}

fn expanded(arguments: &TokenStream, item: TokenStream) -> (TokenStream, Problems) {
    let mut problems = Problems::default();
    if !arguments.is_empty() {
        let message = "`#[reversible]` takes only the path of qrt";
        let help = "write `#[reversible]`, or `#[reversible(crate = library::qrt)]`";
        problems.add(codes::REV_ITEM, arguments, message, help);
    }
    let function = match syn::parse2::<syn::Item>(item.clone()) {
        Ok(syn::Item::Fn(function)) => function,
        Ok(syn::Item::Impl(block)) => return (methods::of_block(block, &mut problems), problems),
        Ok(syn::Item::Trait(declared)) => {
            return (methods::of_trait(declared, &mut problems), problems);
        }
        Ok(other) => {
            let message = "only functions can be reversible";
            let help = "put `#[reversible]` on a `fn` whose parameters are registers, or on an `impl` or \
                        a `trait` of such functions";
            problems.add(codes::REV_ITEM, first(&other), message, help);
            return (item, problems);
        }
        Err(error) => {
            problems.raw(&error);
            return (without_body(item), problems);
        }
    };
    let tokens = match understood(&function, &Around::default(), &mut problems) {
        Some(routine) => emit::routine(&routine),
        None if function.sig.receiver().is_some() => without_body(item),
        None => {
            let unread = &mut Problems::default();
            emit::unfinished(&signature::read(&function, &Around::default(), unread))
        }
    };
    (tokens, problems)
}

/// The surroundings of a function.
#[derive(Default)]
struct Around {
    /// The constants that an `impl` is generic over.
    constants: Constants,
    of: OfTrait,
    /// True if `constants` are all generics around the function.
    complete: bool,
}

/// Returns the routine of a function, if it has no errors.
fn understood(function: &syn::ItemFn, around: &Around, problems: &mut Problems) -> Option<Routine> {
    if !attributes::check(function, problems) {
        return None;
    }
    let signature = signature::read(function, around, problems);
    let mut scope = Scope {
        routine: signature.name.clone(),
        registers: signature.parameters.clone(),
        unusable: signature.unusable.clone(),
        constants: signature.constants.clone(),
        loops: Vec::new(),
        demands: signature.demands.clone(),
        problems: std::mem::take(problems),
        writes: Vec::new(),
        fraction: None,
        updated: None,
        tables: Vec::new(),
        block: 0,
        here: Span::call_site(),
    };
    let mut block = function.block.clone();
    if matches!(function.sig.output, syn::ReturnType::Type(..))
        && matches!(block.stmts.last(), Some(syn::Stmt::Expr(_, None)))
    {
        // The value that the function returns, which has been reported at its type.
        block.stmts.pop();
    }
    let body = scope.block(&block);
    *problems = scope.problems;
    if problems.count() == 0 {
        track::check(&signature.parameters, &body, problems);
    }
    (problems.count() == 0).then_some(Routine {
        signature,
        body,
        demands: scope.demands,
        tables: scope.tables,
    })
}

/// Returns a function as it was written, except for its body, so that calls of it cause no further
/// errors.
fn without_body(item: TokenStream) -> TokenStream {
    let mut trees: Vec<TokenTree> = item.into_iter().collect();
    if let Some(TokenTree::Group(body)) = trees.last_mut()
        && body.delimiter() == Delimiter::Brace
    {
        *body = Group::new(Delimiter::Brace, quote::quote!(::core::unreachable!()));
    }
    quote::quote!(#[allow(unused, reason = "its body is wrong")] #(#trees)*)
}

/// Returns the keyword that an item begins with, which errors underline.
fn first(item: &syn::Item) -> TokenStream {
    let tokens = quote::quote!(#item).into_iter();
    let keyword = tokens.skip_while(|token| !matches!(token, TokenTree::Ident(_)));
    keyword.take(1).collect()
}
