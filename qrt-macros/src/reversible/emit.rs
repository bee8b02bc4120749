//! The generated Rust: the function, its inverse, and its program.

mod arguments;
mod formats;

use super::constants::Constants;
use super::ir::{
    Array, Bit, Demand, NumberKind, OfTrait, Place, Register, Routine, Signature, Statement,
    StatementKind as K, Term, Update, inverse,
};
use super::outside;
use super::source::as_written;
use super::value::{Temporaries, own};
use crate::surroundings;
use arguments::{from_array, handed};
use proc_macro2::{Delimiter, LineColumn, Span, TokenStream, TokenTree};
use quote::{ToTokens, format_ident, quote, quote_spanned};
use std::cell::LazyCell;
use std::ops::Deref;
use std::rc::Rc;
use syn::{ExprPath, Ident, PathArguments};

/// Returns all Rust that a routine expands to.
///
/// The function itself contains both directions, so that other functions call it in either
/// direction by its own name. Its inverse and its program each repeat one direction. If the
/// function calls others, they call it instead, so that the compiler reports an error of a call
/// once. That takes the function's path, which depends on the code around it: see
/// [`surroundings::path`].
pub(super) fn routine(routine: &Routine) -> TokenStream {
    let signature = &routine.signature;
    // The path takes the text of the file.
    let is_free = LazyCell::new(|| {
        let path = surroundings::path(&signature.name);
        path.is_some_and(|path| signature.name == path.to_string())
    });
    let is_item = |demand: &&Demand| is_item(demand, signature, &is_free);
    let (certain, others): (Vec<_>, Vec<_>) = routine.demands.iter().partition(is_item);
    let others = others.into_iter().map(asserted);
    let demands = quote!(#(const { #others };)*);
    let formats = formats::declared(routine);
    let tables: TokenStream = routine
        .tables
        .iter()
        .map(|table| table.declared())
        .collect();
    let agree = formats::agree(&routine.signature);
    let constants = &routine.signature.constants;
    let frame = calls(&routine.body).then(|| frame(&routine.signature.name));
    let beside = frame.as_ref().and_then(|_| beside(&routine.signature));
    let emitted = |host: &TokenStream, statements: &[Statement], is_undone: bool| {
        let mut emitter = Emitter {
            temporaries: 0,
            host: host.clone(),
            // One type in all of the functions, so that the compiler shows equal errors once.
            by: if beside.is_some() {
                host.clone()
            } else {
                quote!(__qrt::Recorder)
            },
            is_undone,
            constants: constants.clone(),
        };
        emitter.block(statements)
    };
    let body = |host: &TokenStream, code: TokenStream| {
        let used = uses(&code).then(|| {
            quote!(
                use ::qrt::circuit as __qrt;
            )
        });
        let ends = frame.as_ref().map(|(frame, message)| {
            quote! {
                #frame
                const {
                    let __running = <__Frame<#host> as __qrt::CallFrame>::RUNNING;
                    __qrt::demand(!__running.repeats(), #message);
                }
            }
        });
        quote!(#used #formats #tables #demands #ends #code)
    };
    let kind = &routine.signature.machine;
    let kind = quote!(#kind);
    let (host, machine) = (own("host"), own("machine"));
    let undone = inverse(&routine.body);
    let both = {
        // The compiler evaluates an item without a call of the function.
        let certain = by_place(&certain);
        let forward = emitted(&kind, &routine.body, false);
        let backward = emitted(&kind, &undone, true);
        let code = quote! {
            #(const _: () = { #certain };)*
            #agree
            let #machine = ::qrt::circuit::Host::machine(#host);
            if #kind::UNDONE { #backward } else { #forward }
        };
        body(&kind, code)
    };
    let name = &routine.signature.name;
    let renamed =
        format!("QRT0812: `{name}_inverse` has another name here, by which it cannot be undone");
    let renamed = quote!(const { ::qrt::circuit::demand(!#kind::UNDONE, #renamed) };);
    let registers = routine
        .signature
        .parameters
        .iter()
        .map(|register| &register.name);
    let registers = quote!(#(#registers),*);
    if let Some(function) = beside {
        let backward = quote! {
            #renamed
            #function(&mut ::qrt::circuit::Undone(#host), #registers);
        };
        let forward = quote!(#formats #function(#host, #registers););
        return functions(&routine.signature, &both, &backward, &forward);
    }
    let backward = {
        let code = emitted(&kind, &undone, false);
        let code = quote! {
            #renamed
            #agree
            let #machine = ::qrt::circuit::Host::machine(#host);
            #code
        };
        body(&kind, code)
    };
    let forward = {
        let recorder = quote!(::qrt::circuit::Recorder);
        let code = emitted(&recorder, &routine.body, false);
        let code = quote! {
            let #machine = #host;
            #code
        };
        body(&recorder, code)
    };
    functions(&routine.signature, &both, &backward, &forward)
}

/// True if a demand can stand in an item of its own, which names no generics around it. Those of an `impl`
/// are not known where the attribute is the function's: there, any name like a constant's may be one.
fn is_item(demand: &Demand, signature: &Signature, is_free: &impl Deref<Target = bool>) -> bool {
    let condition = &demand.condition;
    outside::dependence(condition.clone(), &signature.constants).is_none()
        && (!outside::names_types(condition.clone()) || signature.complete || **is_free)
}

/// Returns the assertion of a demand, at the place that needs it.
fn asserted(demand: &Demand) -> TokenStream {
    let (condition, message) = (&demand.condition, &demand.message);
    quote_spanned!(demand.span=> ::qrt::circuit::demand(#condition, #message))
}

/// Returns the assertions of demands, those of one place together, so that the compiler reports the first of
/// them that does not hold.
fn by_place(demands: &[&Demand]) -> Vec<TokenStream> {
    let mut places: Vec<(LineColumn, TokenStream)> = Vec::new();
    for demand in demands {
        let assertion = asserted(demand);
        let assertion = quote!(#assertion;);
        let place = demand.span.start();
        match places.iter_mut().find(|(known, _)| *known == place) {
            Some((_, assertions)) => assertions.extend(assertion),
            None => places.push((place, assertion)),
        }
    }
    places
        .into_iter()
        .map(|(_, assertions)| assertions)
        .collect()
}

/// Returns the function, as functions beside it call it; `None` if its path is not known, or if one
/// of its parameters hides its name.
fn beside(signature: &Signature) -> Option<TokenStream> {
    let Signature { name, own, .. } = signature;
    match &signature.of {
        OfTrait::Implemented(of) => return Some(quote!(<Self as #of>::#name::<#(#own,)* _>)),
        OfTrait::Declared => return None,
        OfTrait::None => {}
    }
    let hides = |parameter: &Rc<Register>| parameter.name == *name;
    if signature.parameters.iter().any(hides) {
        return None;
    }
    let path = surroundings::path(name)?;
    Some(quote!(#path::<#(#own,)* _>))
}

/// Returns the frame by which its callees know the function, and the message if they call it.
fn frame(name: &Ident) -> (TokenStream, String) {
    let text = name.to_string();
    let message = format!(
        "QRT0812: `{name}` calls itself, by way of what it calls, and would never end: write `for` \
         over constants"
    );
    let frame = quote! {
        #[allow(dead_code, reason = "it is a type, and never a value")]
        struct __Frame<H>(::core::marker::PhantomData<H>);
        impl<H: __qrt::Host> __qrt::CallFrame for __Frame<H> {
            const RUNNING: &'static __qrt::Running = &__qrt::Running {
                function: ::core::concat!(::core::module_path!(), "::", #text),
                place: [::core::line!(), ::core::column!()],
                from: H::RUNNING,
            };
            const UNDONE: ::core::primitive::bool = H::UNDONE;
        }
    };
    (frame, message)
}

/// True if a routine calls another.
fn calls(statements: &[Statement]) -> bool {
    statements.iter().any(|statement| match &statement.kind {
        K::Call { .. } => true,
        K::Update(..) | K::Swap(..) | K::Zero(_) => false,
        K::If(_, a, b) | K::Within(a, b) => calls(a) || calls(b),
        K::For { body, .. } | K::Scratch(_, body) | K::Block(body) => calls(body),
    })
}

/// True if generated code names any item of the circuit crate.
fn uses(code: &TokenStream) -> bool {
    code.clone().into_iter().any(|token| match token {
        TokenTree::Ident(name) => name == "__qrt",
        TokenTree::Group(group) => uses(&group.stream()),
        TokenTree::Punct(_) | TokenTree::Literal(_) => false,
    })
}

/// Returns the functions of a routine with errors, so that calls of them cause no further errors.
pub(super) fn unfinished(signature: &Signature) -> TokenStream {
    let body = quote!(::core::unreachable!(););
    let functions = functions(signature, &body, &body, &body);
    let allowed = quote!(#[allow(unused, clippy::all, clippy::pedantic)]);
    let items = syn::parse2::<syn::File>(functions.clone());
    items.map_or(functions, |file| {
        let items = file.items;
        quote!(#(#allowed #items)*)
    })
}

/// Returns the functions of a routine that a trait declares.
pub(super) fn declared(signature: &Signature) -> TokenStream {
    let body = TokenStream::new();
    let functions = functions(signature, &body, &body, &body).into_iter();
    let without_body = functions.map(|token| match token {
        TokenTree::Group(body) if body.delimiter() == Delimiter::Brace => {
            quote!(where Self: ::core::marker::Sized;)
        }
        other => other.into(),
    });
    without_body.collect()
}

fn functions(
    signature: &Signature,
    both: &TokenStream,
    backward: &TokenStream,
    forward: &TokenStream,
) -> TokenStream {
    let Signature {
        attributes,
        visibility,
        name,
        of,
        own: own_constants,
        machine: kind,
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
    let (host, recorder) = (own("host"), own("recorder"));
    let reference = |parameter: &Register| reference(parameter.mutable);
    let named = parameters.iter().map(|parameter| {
        let Register {
            name,
            ty,
            array,
            computed,
            ..
        } = &**parameter;
        let reference = reference(parameter);
        let ty = if computed.is_some() {
            quote!(impl ::qrt::circuit::format::Format)
        } else {
            quote!(#ty)
        };
        let one = quote!(::qrt::circuit::format::Reg<#kind::Register, #ty>);
        let written = array.iter().map(|array| &array.written);
        let many = quote!(#([#one; #written])*);
        let ty = if many.is_empty() { one } else { many };
        quote!(#name: #reference #ty)
    });
    let named: Vec<TokenStream> = named.collect();
    // The machine is one argument more than those that the author has written.
    let many = (parameters.len() >= 7).then(|| quote!(#[allow(clippy::too_many_arguments)]));
    let inverse_doc = format!(" The inverse of [`{name}`]: undoes what it has done.");
    let program_doc =
        format!(" [`{name}`] as a program, whose inputs are its registers in their order.");
    let declared = own_constants.declared();
    let some = (!own_constants.is_empty()).then(|| quote!(<#(#declared),*>));
    // In a trait, the trait's own attributes apply.
    let must_use = matches!(of, OfTrait::None).then(|| quote!(#[must_use]));
    let style = own("style");
    let inputs = parameters.iter().map(|parameter| {
        let Register { name, array, .. } = &**parameter;
        let ty = parameter.format_tokens(constants);
        let (text, reference) = (shown(name), reference(parameter));
        if let Some(Array { written, .. }) = array {
            return quote! {
                let #name: #reference [::qrt::circuit::format::Reg<_, #ty>; #written] = #reference
                    ::core::array::from_fn(|_| {
                        ::qrt::circuit::format::Reg::input(&mut #recorder, #text)
                    });
            };
        }
        quote! {
            let #name: #reference ::qrt::circuit::format::Reg<_, #ty> =
                #reference ::qrt::circuit::format::Reg::input(&mut #recorder, #text);
        }
    });
    quote! {
        #(#attributes)*
        #many
        #visibility fn #name<
            #(#declared,)*
            #kind: ::qrt::circuit::Host,
        >(
            #host: &mut #kind,
            #(#named),*
        ) {
            #both
        }

        #[doc = #inverse_doc]
        #(#other)*
        #many
        #[allow(dead_code, reason = "not every author needs it")]
        #visibility fn #inverse_name<
            #(#declared,)*
            #kind: ::qrt::circuit::Host,
        >(
            #host: &mut #kind,
            #(#named),*
        ) {
            #backward
        }

        #[doc = #program_doc]
        #(#other)*
        #[allow(dead_code, reason = "not every author needs it")]
        #must_use
        #visibility fn #program_name #some (
            #style: ::qrt::circuit::Style,
        ) -> ::qrt::circuit::Program {
            let mut #recorder = ::qrt::circuit::Recorder::new(#style);
            #(#inputs)*
            let #host = &mut #recorder;
            #forward
            #recorder.finish()
        }
    }
}

/// Returns the function that a call names, or its inverse. Their names differ by the ending
/// `_inverse`.
pub(super) fn function(path: &ExprPath, inverse: bool) -> ExprPath {
    let mut path = path.clone();
    if let Some(last) = path.path.segments.last_mut()
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

/// The most registers that [`qrt_circuit::Handed`] compares.
const MOST_CHECKED: usize = 16;

struct Emitter {
    temporaries: usize,
    /// The type of the host that the function runs on.
    host: TokenStream,
    /// The type that implements the traits of a call. Errors name it, unless it is a type parameter.
    by: TokenStream,
    /// True if the host undoes the function where these statements run.
    is_undone: bool,
    /// The constants that the function is generic over.
    constants: Constants,
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
                if a.name == b.name {
                    let (both, names) = from_array(&a.name, &[a, b]);
                    let (a, b) = (&names[0], &names[1]);
                    let swap = swapped(&quote!(#a), &quote!(#b));
                    return quote!({ #both #swap });
                }
                swapped(&a.tokens(), &b.tokens())
            }
            // Freeing a register checks it.
            K::Zero(register) => {
                let (name, text) = (&register.name, shown(&register.name));
                quote! {
                    #name.free(#machine);
                    #name = __qrt::format::Reg::zero(#machine, #text);
                }
            }
            K::Call {
                path,
                inverse,
                arguments,
            } => {
                let mut function = path.clone();
                if let Some(last) = function.path.segments.last_mut()
                    && let PathArguments::AngleBracketed(given) = &mut last.arguments
                {
                    given.args.push(syn::parse_quote!(_));
                }
                let called = function.path.segments.last().map(|last| last.ident.span());
                let called = called.unwrap_or_else(Span::call_site);
                let [first, last] = [arguments.first(), arguments.last()]
                    .map(|argument| argument.map_or(called, |(_, _, name)| name.span()));
                let register_count = arguments.len();
                let (taken, arguments) = handed(arguments);
                let host = &self.host;
                // The same text in both directions: the compiler shows equal errors once.
                let inverse = *inverse != self.is_undone;
                let caller =
                    quote!(&mut __qrt::Caller::<_, __Frame<#host>, #inverse>::new(#machine));
                // The compiler alone checks a call of more registers.
                let call = if register_count > MOST_CHECKED {
                    quote!(#function(#caller, #(#arguments),*);)
                } else {
                    // Errors underline these types: the function, or its arguments.
                    let by = itself(&self.by, called, called);
                    let with = itself(&self.by, first, last);
                    quote! {
                        <#by as __qrt::Reversible<_, _, _>>::run(
                            #function,
                            <#by as __qrt::Is<_, _>>::is(#caller),
                            <#with as __qrt::Handed<_, _, _>>::handed::<
                                <#host as __qrt::Host>::Register, _, _,
                            >((#(#arguments,)*)),
                        );
                    }
                };
                if taken.is_empty() {
                    return call;
                }
                quote!({ #taken #call })
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
                    quote!(::core::iter::Iterator::rev(#first..#end))
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
                    __qrt::unconditional(#machine, |#machine| { #compute });
                    #apply
                    __qrt::unconditional(#machine, |#machine| { #undo });
                }
            }
            K::Scratch(register, body) => {
                let Register { name, array, .. } = &**register;
                let ty = register.format_tokens(&self.constants);
                let (text, one) = (shown(name), own("register"));
                let body = self.block(body);
                if let Some(Array { written, .. }) = array {
                    return quote! {
                        let mut #name: [__qrt::format::Reg<_, #ty>; #written] =
                            ::core::array::from_fn(|_| __qrt::format::Reg::zero(#machine, #text));
                        #body
                        for #one in #name {
                            #one.free(#machine);
                        }
                    };
                }
                quote! {
                    let mut #name: __qrt::format::Reg<_, #ty> =
                        __qrt::format::Reg::zero(#machine, #text);
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
        let target = place.register.tokens();
        let target = quote!(#target.register_mut());
        let first = place
            .part
            .as_ref()
            .map_or_else(|| 0.into(), |[first, _]| first.clone());
        let mut temporaries = self.temporaries();
        temporaries.copied.push(place.register.name.clone());
        let mut when = quote!(::core::option::Option::None);
        let operand = match term {
            Term::Number(number) => temporaries.operand_at(number, &first),
            Term::Bit(Bit::Constant(true), _) => {
                let one = super::number::units(1);
                temporaries.operand_at(&one, &first)
            }
            Term::Bit(Bit::Constant(false), _) => return TokenStream::new(),
            // That takes one Toffoli: one of the two bits is read, and the other one controls.
            Term::Bit(Bit::And(a, b), _) if !(a.is_negated() && b.is_negated()) => {
                let (read, control) = if a.is_negated() { (b, a) } else { (a, b) };
                let control = temporaries.bit(control);
                when = quote!(::core::option::Option::Some(#control));
                temporaries.bit_operand(read, &first)
            }
            Term::Bit(bit, source) => {
                let number = self::number(bit, source);
                match &number.kind {
                    NumberKind::Truth(bit) => {
                        let bit = temporaries.bit(bit);
                        let one = super::number::units(1);
                        when = quote!(::core::option::Option::Some(#bit));
                        temporaries.operand_at(&one, &first)
                    }
                    _ => temporaries.operand_at(&number, &first),
                }
            }
        };
        let used = match update {
            Update::Xor => quote!(__qrt::Machine::xor_into(#machine, #target, #operand, #when);),
            Update::Add | Update::Subtract => {
                let subtract = update == Update::Subtract;
                quote! {
                    __qrt::Machine::add_into(
                        #machine, #target, #operand, #subtract, __qrt::When::Always,
                    );
                }
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
                quote!(__qrt::controlled(#machine, #bit, |#machine| { #body });)
            })
        };
        let then = part(holds, bit.clone());
        let other = part(fails, quote!(#bit.inverted()));
        let (computed, undone) = (&temporaries.computed, temporaries.undone());
        quote!(#(#computed)* #then #other #undone)
    }
}

/// Returns a type that is `host`, written from the place `first` to the place `last`.
fn itself(host: &TokenStream, first: Span, last: Span) -> TokenStream {
    let begin = quote_spanned!(first=> __qrt::Itself<);
    let end = quote_spanned!(last=> >);
    quote!(#begin #host #end)
}

/// Returns the exchange of two registers.
fn swapped(a: &TokenStream, b: &TokenStream) -> TokenStream {
    let machine = own("machine");
    quote! {
        __qrt::Machine::swap(
            #machine, #a.register_mut(), #b.register_mut(), ::core::option::Option::None,
        );
    }
}

/// Returns a register's name, as the author has written it.
fn shown(name: &Ident) -> String {
    as_written(name.to_string())
}

fn reference(mutable: bool) -> TokenStream {
    if mutable { quote!(&mut) } else { quote!(&) }
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
        K::Zero(_) => return,
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
