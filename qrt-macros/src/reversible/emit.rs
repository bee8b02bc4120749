//! The generated Rust: the function, its inverse, and the program that both are.

use super::ir::{
    Bit, NumberKind, Place, Register, Routine, Signature, Statement, StatementKind as K, Term,
    Update, inverse,
};
use super::value::{Temporaries, own};
use proc_macro2::{Span, TokenStream, TokenTree};
use quote::{ToTokens, format_ident, quote, quote_spanned};
use std::collections::BTreeSet;
use syn::{Ident, Path, PathArguments};

/// All Rust that a routine expands to.
pub(super) fn routine(routine: &Routine) -> TokenStream {
    let demands = routine.demands.iter().map(|demand| {
        let (condition, message) = (&demand.condition, &demand.message);
        let span = Span::mixed_site().located_at(demand.span);
        quote_spanned!(span=> const { ::core::assert!(#condition, #message) };)
    });
    let demands: TokenStream = demands.collect();
    let calls = calls(&routine.body);
    let body = |statements: &[Statement], name: String| {
        let mut emitter = Emitter::default();
        let body = emitter.block(statements);
        let used = used(&body);
        let (constants, running) = (&routine.signature.constants, own("routine"));
        let entered = calls.then(|| {
            quote! {
                let #running = ::qrt::circuit::Routine::enter(
                    ::core::concat!(::core::module_path!(), "::", #name),
                    [::core::line!(), ::core::column!()],
                    &[#(#constants),*],
                );
            }
        });
        quote!(#used #demands #entered #body)
    };
    let name = &routine.signature.name;
    functions(
        &routine.signature,
        &body(&routine.body, name.to_string()),
        &body(&inverse(&routine.body), format!("{name}_inverse")),
    )
}

/// Whether a routine calls another, which may call it.
fn calls(statements: &[Statement]) -> bool {
    statements.iter().any(|statement| match &statement.kind {
        K::Call { .. } => true,
        K::Update(..) | K::Swap(..) => false,
        K::If(_, a, b) | K::Within(a, b) => calls(a) || calls(b),
        K::For { body, .. } | K::Scratch(_, body) | K::Block(body) => calls(body),
    })
}

/// The functions of a routine that was not understood: whoever calls them sees no more errors.
pub(super) fn unfinished(signature: &Signature) -> TokenStream {
    let body = quote!(::core::unreachable!());
    let functions = functions(signature, &body, &body);
    let allowed = quote!(#[allow(unused, clippy::all, clippy::pedantic)]);
    let items = syn::parse2::<syn::File>(functions.clone());
    items.map_or(functions, |file| {
        let items = file.items;
        quote!(#(#allowed #items)*)
    })
}

fn functions(signature: &Signature, forward: &TokenStream, backward: &TokenStream) -> TokenStream {
    let Signature {
        attributes,
        visibility,
        name,
        constants,
        parameters,
        ..
    } = signature;
    let inverse_name = format_ident!("{name}_inverse");
    let program_name = format_ident!("{name}_program");
    let other = attributes
        .iter()
        .filter(|attribute| !attribute.path().is_ident("doc"));
    let other: Vec<_> = other.collect();
    let kind = machine_name(constants);
    let machine = own("machine");
    let generics = quote!(<#(const #constants: u32,)* #kind: ::qrt::circuit::Machine>);
    let named = parameters.iter().map(|parameter| {
        let Register { name, ty, .. } = &**parameter;
        let reference = if parameter.mutable {
            quote!(&mut)
        } else {
            quote!(&)
        };
        quote!(#name: #reference ::qrt::circuit::format::Reg<#kind::Register, #ty>)
    });
    let named: Vec<TokenStream> = named.collect();
    // The machine is one argument more than the author has written.
    let many = (parameters.len() >= 7).then(|| quote!(#[allow(clippy::too_many_arguments)]));
    let inverse_doc = format!(" The inverse of [`{name}`]: undoes what it has done.");
    let program_doc =
        format!(" [`{name}`] as a program, whose inputs are its registers in their order.");
    let some = (!constants.is_empty()).then(|| quote!(<#(const #constants: u32),*>));
    let given = (!constants.is_empty()).then(|| quote!(::<#(#constants,)* _>));
    let recorder = own("recorder");
    let style = own("style");
    let inputs = parameters.iter().map(|parameter| {
        let Register { name, ty, .. } = &**parameter;
        let text = name.to_string();
        let mutable = parameter.mutable.then(|| quote!(mut));
        quote! {
            let #mutable #name: Reg<_, #ty> = Reg::input(&mut #recorder, #text);
        }
    });
    let handed = parameters.iter().map(|parameter| {
        let name = &parameter.name;
        let reference = if parameter.mutable {
            quote!(&mut)
        } else {
            quote!(&)
        };
        quote!(#reference #name)
    });
    quote! {
        #(#attributes)*
        #many
        #visibility fn #name #generics (#machine: &mut #kind, #(#named),*) {
            #forward
        }

        #[doc = #inverse_doc]
        #(#other)*
        #many
        #[allow(dead_code, reason = "not every author needs it")]
        #visibility fn #inverse_name #generics (#machine: &mut #kind, #(#named),*) {
            #backward
        }

        #[doc = #program_doc]
        #(#other)*
        #[allow(dead_code, reason = "not every author needs it")]
        #[must_use]
        #visibility fn #program_name #some (
            #style: ::qrt::circuit::Style,
        ) -> ::qrt::circuit::Program {
            use ::qrt::circuit::format::Reg;
            let mut #recorder = ::qrt::circuit::Recorder::new(#style);
            #(#inputs)*
            #name #given (&mut #recorder, #(#handed),*);
            #recorder.finish()
        }
    }
}

/// What the machine's type is called.
fn machine_name(constants: &[Ident]) -> Ident {
    let names = ["M", "Machine", "AnyMachine"].map(|name| format_ident!("{name}"));
    let free = names.into_iter().find(|name| !constants.contains(name));
    free.unwrap_or_else(|| format_ident!("TheMachine"))
}

/// Imports of what a body names.
fn used(body: &TokenStream) -> TokenStream {
    let mut seen = BTreeSet::new();
    collect(body.clone(), &mut seen);
    let all = [
        "Bit",
        "Declaration",
        "Operand",
        "Type",
        "When",
        "Word",
        "controlled",
        "unconditional",
    ];
    let names = all.iter().filter(|name| seen.contains(**name));
    let names: Vec<Ident> = names.map(|name| format_ident!("{name}")).collect();
    let circuit = (!names.is_empty()).then(|| quote!(use ::qrt::circuit::{#(#names),*};));
    let reg = seen.contains("Reg").then(|| {
        quote!(
            use ::qrt::circuit::format::Reg;
        )
    });
    quote!(#reg #circuit)
}

fn collect(tokens: TokenStream, seen: &mut BTreeSet<String>) {
    for token in tokens {
        match token {
            TokenTree::Ident(name) => {
                seen.insert(name.to_string());
            }
            TokenTree::Group(group) => collect(group.stream(), seen),
            TokenTree::Punct(_) | TokenTree::Literal(_) => {}
        }
    }
}

/// The function that a call names, or its inverse, whose names differ by their ends.
pub(super) fn function(path: &Path, inverse: bool) -> Path {
    let mut path = path.clone();
    if let Some(last) = path.segments.last_mut()
        && inverse
    {
        let name = last.ident.to_string();
        let span = last.ident.span();
        last.ident = match name.strip_suffix("_inverse") {
            Some(forward) => Ident::new(forward, span),
            None => Ident::new(&format!("{name}_inverse"), span),
        };
    }
    path
}

#[derive(Default)]
struct Emitter {
    temporaries: usize,
}

impl Emitter {
    fn block(&mut self, statements: &[Statement]) -> TokenStream {
        let all = statements.iter().map(|statement| self.statement(statement));
        all.collect()
    }

    fn statement(&mut self, statement: &Statement) -> TokenStream {
        let machine = own("machine");
        match &statement.kind {
            K::Update(place, terms) => {
                let terms = terms
                    .iter()
                    .map(|(update, term)| self.update(place, *update, term));
                terms.collect()
            }
            K::Swap(a, b) => {
                let (a, b) = (&a.name, &b.name);
                quote!(#machine.swap(#a.register_mut(), #b.register_mut(), None);)
            }
            K::Call {
                path,
                inverse,
                arguments,
            } => {
                let mut function = function(path, *inverse);
                if let Some(last) = function.segments.last_mut()
                    && let PathArguments::AngleBracketed(given) = &mut last.arguments
                {
                    given.args.push(syn::parse_quote!(_));
                }
                let arguments = arguments.iter().map(|(register, change, name)| {
                    match (register.parameter, *change) {
                        (true, _) => quote!(#name),
                        (false, true) => quote!(&mut #name),
                        (false, false) => quote!(&#name),
                    }
                });
                quote!(#function(#machine, #(#arguments),*);)
            }
            K::If(condition, holds, fails) => self.branch(condition, holds, fails),
            K::For {
                variable,
                bounds: [first, end],
                reversed,
                body,
            } => {
                let (first, end) = (first.tokens(), end.tokens());
                let body = self.block(body);
                let range = if *reversed {
                    quote!((#first..#end).rev())
                } else {
                    quote!(#first..#end)
                };
                quote!(for #variable in #range { #body })
            }
            K::Within(within, apply) => {
                let compute = self.block(within);
                let apply = self.block(apply);
                let undo = self.block(&inverse(within));
                quote! {
                    unconditional(#machine, |#machine| { #compute });
                    #apply
                    unconditional(#machine, |#machine| { #undo });
                }
            }
            K::Scratch(register, body) => {
                let Register { name, ty, .. } = &**register;
                let text = name.to_string();
                let body = self.block(body);
                quote! {
                    let mut #name: Reg<_, #ty> = Reg::zero(#machine, #text);
                    #body
                    #name.free(#machine);
                }
            }
            K::Block(body) => {
                let body = self.block(body);
                quote!({ #body })
            }
        }
    }

    fn temporaries(&self) -> Temporaries {
        Temporaries::after(self.temporaries)
    }

    fn finish(&mut self, temporaries: &Temporaries, used: &TokenStream) -> TokenStream {
        self.temporaries += temporaries.count();
        let (computed, undone) = (&temporaries.computed, temporaries.undone());
        quote!(#(#computed)* #used #undone)
    }

    fn update(&mut self, place: &Place, update: Update, term: &Term) -> TokenStream {
        let machine = own("machine");
        let target = &place.register.name;
        let target = quote!(#target.register_mut());
        let first = place
            .part
            .as_ref()
            .map_or_else(|| 0.into(), |[first, _]| first.clone());
        let mut temporaries = self.temporaries();
        temporaries.copied.push(place.register.name.clone());
        let mut when = quote!(None);
        let operand = match term {
            Term::Number(number) => temporaries.operand_at(number, &first),
            Term::Bit(Bit::Constant(true), _) => {
                let one = super::number::units(1);
                temporaries.operand_at(&one, &first)
            }
            Term::Bit(Bit::Constant(false), _) => return TokenStream::new(),
            // A Toffoli, with nothing computed before.
            Term::Bit(Bit::And(a, b), source) if matches!(**a, Bit::At(..)) => {
                let control = temporaries.bit(b);
                when = quote!(Some(#control));
                let a = super::number::truth((**a).clone(), source.clone());
                temporaries.operand_at(&a, &first)
            }
            Term::Bit(bit, source) => {
                let number = self::number(bit, source);
                match &number.kind {
                    NumberKind::Truth(bit) => {
                        let bit = temporaries.bit(bit);
                        let one = super::number::units(1);
                        when = quote!(Some(#bit));
                        temporaries.operand_at(&one, &first)
                    }
                    _ => temporaries.operand_at(&number, &first),
                }
            }
        };
        let used = match update {
            Update::Xor => quote!(#machine.xor_into(#target, #operand, #when);),
            Update::Add | Update::Subtract => {
                let subtract = update == Update::Subtract;
                quote!(#machine.add_into(#target, #operand, #subtract, When::Always);)
            }
        };
        self.finish(&temporaries, &used)
    }

    fn branch(&mut self, condition: &Bit, holds: &[Statement], fails: &[Statement]) -> TokenStream {
        let machine = own("machine");
        let mut temporaries = self.temporaries();
        for statement in holds.iter().chain(fails) {
            written(statement, &mut temporaries.copied);
        }
        let bit = temporaries.bit(condition);
        self.temporaries += temporaries.count();
        let mut part = |statements: &[Statement], bit: TokenStream| {
            (!statements.is_empty()).then(|| {
                let body = self.block(statements);
                quote!(controlled(#machine, #bit, |#machine| { #body });)
            })
        };
        let then = part(holds, bit.clone());
        let other = part(fails, quote!(#bit.inverted()));
        let (computed, undone) = (&temporaries.computed, temporaries.undone());
        quote!(#(#computed)* #then #other #undone)
    }
}

fn number(bit: &Bit, source: &TokenStream) -> super::ir::Number {
    super::number::truth(bit.clone(), source.to_token_stream())
}

/// Collects the names of the registers that a statement writes.
fn written(statement: &Statement, names: &mut Vec<Ident>) {
    let (first, second): (&[Statement], &[Statement]) = match &statement.kind {
        K::Update(place, _) => {
            names.push(place.register.name.clone());
            return;
        }
        K::Swap(a, b) => {
            names.extend([a.name.clone(), b.name.clone()]);
            return;
        }
        K::Call { arguments, .. } => {
            let changed = arguments.iter().filter(|(_, change, _)| *change);
            names.extend(changed.map(|(register, ..)| register.name.clone()));
            return;
        }
        K::If(_, a, b) | K::Within(a, b) => (a, b),
        K::For { body, .. } | K::Scratch(_, body) | K::Block(body) => (body, &[]),
    };
    for inner in first.iter().chain(second) {
        written(inner, names);
    }
}
