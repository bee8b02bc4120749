//! Calls of reversible functions, and swaps.

use super::ir::{Place, Register, Statement, StatementKind as K};
use super::scope::Scope;
use super::signature;
use super::source::{begin, text, type_text};
use proc_macro2::TokenStream;
use qrt_syntax::codes;
use quote::{ToTokens, quote};
use std::rc::Rc;
use syn::{Expr, ExprCall, ExprMethodCall, ExprPath, GenericArgument, Ident, PathArguments, QSelf};

impl Scope {
    pub(super) fn call(&mut self, call: &ExprCall, source: TokenStream) -> Option<Statement> {
        let Expr::Path(function) = &*call.func else {
            let message = "what is called here is not the name of a function";
            let help = "call functions marked `#[reversible]` by name";
            self.problems
                .add(codes::REV_CALL, &call.func, message, help);
            return None;
        };
        if function.path.is_ident("swap") {
            return self.swap(call, source);
        }
        self.called(function, &call.args.iter().collect::<Vec<_>>(), source)
    }

    /// Reads `x.method(..)`, which takes `x` by `&mut` if it may be changed, and `(&x).method(..)`.
    /// Both call a function of the format of `x`.
    pub(super) fn method(
        &mut self,
        call: &ExprMethodCall,
        source: TokenStream,
    ) -> Option<Statement> {
        let mut receiver = &*call.receiver;
        while let Expr::Paren(inner) = receiver {
            receiver = &inner.expr;
        }
        let place = match receiver {
            Expr::Reference(reference) => self.place(&reference.expr)?,
            own => self.place(own)?,
        };
        let receiver = match receiver {
            Expr::Reference(_) => receiver.clone(),
            own if place.register.mutable => {
                syn::parse_quote_spanned!(begin(&quote!(#own))=> &mut #own)
            }
            own => syn::parse_quote_spanned!(begin(&quote!(#own))=> &#own),
        };
        if place.part.is_some() || place.register.computed.is_some() {
            let message = match place.part {
                Some(_) => "bits of a register have no methods",
                None => "a register whose width is computed has no methods",
            };
            let help = "call a function: `add(&x, &mut y)`";
            self.problems
                .add(codes::REV_CALL, &call.receiver, message, help);
            return None;
        }
        let (ty, method) = (&place.register.ty, &call.method);
        let mut function: ExprPath = syn::parse_quote!(#method);
        function.qself = Some(QSelf {
            lt_token: syn::token::Lt(method.span()),
            ty: Box::new(ty.clone()),
            position: 0,
            as_token: None,
            gt_token: syn::token::Gt(method.span()),
        });
        function.path.leading_colon = Some(syn::token::PathSep(method.span()));
        if let (Some(last), Some(given)) = (function.path.segments.last_mut(), &call.turbofish) {
            last.arguments = PathArguments::AngleBracketed(given.clone());
        }
        let arguments: Vec<&Expr> = std::iter::once(&receiver).chain(&call.args).collect();
        self.called(&function, &arguments, source)
    }

    fn called(
        &mut self,
        function: &ExprPath,
        given: &[&Expr],
        source: TokenStream,
    ) -> Option<Statement> {
        let (path, inverse) = forward(function);
        if self.is_routine(&path) {
            let message = "a reversible function cannot call itself";
            let help = "write `for` over constants";
            self.problems
                .add(codes::REV_CALL, &function.path, message, help);
            return None;
        }
        self.generics(&path)?;
        let mut arguments: Vec<(Rc<Register>, bool, Ident)> = Vec::new();
        let mut complete = true;
        for argument in given {
            match self.argument(argument) {
                Some((register, change, name)) => {
                    self.handed_twice(&arguments, &register, change, argument);
                    arguments.push((register, change, name));
                }
                None => complete = false,
            }
        }
        for (register, change, _) in &arguments {
            if *change {
                let place = Place {
                    register: register.clone(),
                    part: None,
                };
                self.writes.push((place, source.clone()));
            }
        }
        let kind = K::Call {
            path,
            inverse,
            arguments,
        };
        complete.then_some(Statement { kind, source })
    }

    /// Reports constants of a call that Rust does not compute.
    fn generics(&mut self, function: &ExprPath) -> Option<()> {
        let last = function.path.segments.last()?;
        let PathArguments::AngleBracketed(given) = &last.arguments else {
            return Some(());
        };
        let mut known = self.constants.to_vec();
        known.extend(self.loops.iter().map(|(variable, _)| variable.clone()));
        for given in &given.args {
            let alone = match given {
                GenericArgument::Type(syn::Type::Path(path)) => path.path.get_ident(),
                _ => None,
            };
            let is_own = alone.is_some_and(|name| self.constants.contains(name));
            if !is_own && signature::names_any(given.to_token_stream(), &known) {
                let message =
                    "Rust computes no constant of a call from a function's own, or a loop's";
                let help = "leave it out where registers tell it, or take it as a constant of the \
                            function: `const V: u32`";
                self.problems.add(codes::REV_CALL, given, message, help);
                return None;
            }
        }
        Some(())
    }

    /// True if a path names the function that is being read.
    fn is_routine(&self, path: &ExprPath) -> bool {
        if path.qself.is_some() {
            return false;
        }
        let path = &path.path;
        let names: Vec<String> = path.segments.iter().map(|s| s.ident.to_string()).collect();
        let routine = self.routine.to_string();
        names == [routine.as_str()] || names == ["Self", routine.as_str()]
    }

    /// Reads an argument: a register, whether it may be changed, and its name.
    fn argument(&mut self, argument: &Expr) -> Option<(Rc<Register>, bool, Ident)> {
        let Expr::Reference(reference) = argument else {
            let shown = text(argument);
            let (message, help) = if matches!(argument, Expr::Path(_)) {
                let help = format!(
                    "write `&{shown}` to let it be read, `&mut {shown}` to let it be changed"
                );
                ("a register is handed over by reference", help)
            } else {
                let help = "compute it into a scratch register in `within!`, and call in `apply!`";
                ("an argument is a register", help.to_owned())
            };
            self.problems
                .add(codes::REV_ARGUMENT, argument, message, &help);
            return None;
        };
        let name = match &*reference.expr {
            Expr::Path(path) => path.path.get_ident().cloned(),
            Expr::Index(index) => match &*index.expr {
                Expr::Path(path) => path.path.get_ident().cloned(),
                _ => None,
            },
            _ => None,
        };
        let place = match &*reference.expr {
            _ if name.is_none() => None,
            whole @ Expr::Path(_) => Some(self.any_place(whole)?),
            element => Some(self.place(element)?),
        };
        let (Some(name), Some(place @ Place { part: None, .. })) = (name, place) else {
            let message = "an argument is a whole register";
            let help = "compute it into a scratch register in `within!`, and call in `apply!`";
            self.problems
                .add(codes::REV_ARGUMENT, &reference.expr, message, help);
            return None;
        };
        let change = reference.mutability.is_some();
        if change {
            self.may_change(&place, argument);
        }
        Some((place.register, change, name))
    }

    fn handed_twice(
        &mut self,
        earlier: &[(Rc<Register>, bool, Ident)],
        register: &Register,
        change: bool,
        place: impl ToTokens,
    ) {
        let mut earlier = earlier.iter();
        let twice = |other: &Register| !other.is_apart(register, &self.loops);
        if earlier.any(|(other, changed, _)| (change || *changed) && twice(other)) {
            let message = format!("`{register}` is handed over twice, and may be changed");
            let help = "hand over another register, such as a copy in a scratch register";
            self.problems
                .add(codes::REV_CHANGE_TWICE, place, &message, help);
        }
    }

    fn swap(&mut self, call: &ExprCall, source: TokenStream) -> Option<Statement> {
        let arguments: Vec<&Expr> = call.args.iter().collect();
        let [a, b] = arguments.as_slice() else {
            let message = "`swap` exchanges two registers";
            self.problems
                .add(codes::REV_ARGUMENT, call, message, "write `swap(a, b)`");
            return None;
        };
        let mut places = Vec::new();
        for argument in [a, b] {
            let place = self.place(argument)?;
            if place.part.is_some() {
                let message = "`swap` exchanges whole registers";
                let help = "exchange bits by three `^=`: a ^= b, b ^= a, a ^= b";
                self.problems
                    .add(codes::REV_ARGUMENT, argument, message, help);
                return None;
            }
            self.may_change(&place, argument);
            self.writes.push((place.clone(), source.clone()));
            places.push(place.register);
        }
        let [first, second] = [places[0].clone(), places[1].clone()];
        if !first.is_apart(&second, &self.loops) {
            let message = format!("`{first}` is swapped with itself");
            let help = "name another register, or remove the statement";
            self.problems
                .add(codes::REV_CHANGE_TWICE, b, &message, help);
            return None;
        }
        if first.format != second.format {
            let [one, other] = [&first.ty, &second.ty].map(type_text);
            let known = [&first, &second].map(|r| {
                (
                    r.format.kind,
                    r.format.width.known(),
                    r.format.fraction.known(),
                )
            });
            let message = format!("`{one}` is swapped with `{other}`");
            let help = "swap registers of one format";
            if known[0].0 == known[1].0 && known.iter().any(|(_, width, _)| width.is_none()) {
                let widths = [&first, &second].map(|register| register.format.width.clone());
                let fractions = [&first, &second].map(|r| r.format.fraction.clone());
                let equal = "QRT0807: registers of different formats are swapped";
                for [a, b] in [widths, fractions] {
                    self.holds(&a.minus(&b), equal);
                    self.holds(&b.minus(&a), equal);
                }
            } else {
                self.problems.add(codes::REV_FORMAT, b, &message, help);
                return None;
            }
        }
        let kind = K::Swap(first, second);
        Some(Statement { kind, source })
    }
}

/// Returns the function that a path names, and whether the call undoes it.
fn forward(path: &ExprPath) -> (ExprPath, bool) {
    let mut path = path.clone();
    let Some(last) = path.path.segments.last_mut() else {
        return (path, false);
    };
    let name = last.ident.to_string();
    let Some(forward) = name
        .strip_suffix("_inverse")
        .filter(|name| !name.is_empty())
    else {
        return (path, false);
    };
    last.ident = Ident::new(forward, last.ident.span());
    (path, true)
}
