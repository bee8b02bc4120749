//! A function's signature: registers by reference, constants as its only generics.

use super::dim::Linear;
use super::ir::{Format, Kind, Register, Signature};
use super::problem::Problems;
use super::scope::type_text;
use qrt_core::syntax::codes;
use std::rc::Rc;
use syn::{FnArg, GenericArgument, GenericParam, Ident, ItemFn, Pat, PathArguments, Type};

/// Reads the signature. What is wrong with it is left out of the result.
pub(super) fn read(function: &ItemFn, problems: &mut Problems) -> Signature {
    let signature = &function.sig;
    let plain = "write a plain `fn`: a routine runs at once, wherever it is called from";
    let kinds = [
        signature
            .asyncness
            .as_ref()
            .map(|t| (t.span, "an `async` function")),
        signature
            .constness
            .as_ref()
            .map(|t| (t.span, "a `const` function")),
        signature
            .abi
            .as_ref()
            .map(|abi| (abi.extern_token.span, "an `extern` function")),
    ];
    for (span, kind) in kinds.into_iter().flatten() {
        let place = Ident::new("_", span);
        problems.add(
            codes::REV_SIGNATURE,
            place,
            &format!("{kind} cannot be reversible"),
            plain,
        );
    }
    if !matches!(signature.safety, syn::Safety::Default) {
        let message = "an `unsafe` function cannot be reversible";
        problems.add(codes::REV_SIGNATURE, &signature.safety, message, plain);
    }
    if let Some(variadic) = &signature.variadic {
        let message = "a function with any number of parameters cannot be reversible";
        problems.add(codes::REV_SIGNATURE, variadic, message, plain);
    }
    if let syn::ReturnType::Type(_, ty) = &signature.output {
        problems.add(
            codes::REV_RESULT,
            ty,
            "a reversible function returns nothing: its result must go where it can be undone",
            "take `out: &mut ..` and write `out += ..`",
        );
    }
    let constants = constants(function, problems);
    let mut parameters: Vec<Rc<Register>> = Vec::new();
    let mut unusable = Vec::new();
    for input in &signature.inputs {
        let Some(register) = parameter(input, &constants, problems) else {
            if let FnArg::Typed(input) = input
                && let Pat::Ident(name) = &*input.pat
            {
                unusable.push(name.ident.clone());
            }
            continue;
        };
        if constants.contains(&register.name) {
            let message = format!("`{}` is a constant already", register.name);
            problems.add(
                codes::REV_TAKEN,
                &register.name,
                &message,
                "choose another name",
            );
            unusable.push(register.name);
            continue;
        }
        // Two parameters of one name are rustc's to report.
        parameters.push(Rc::new(register));
    }
    Signature {
        attributes: function.attrs.clone(),
        visibility: function.vis.clone(),
        name: signature.ident.clone(),
        constants,
        parameters,
        unusable,
    }
}

fn constants(function: &ItemFn, problems: &mut Problems) -> Vec<Ident> {
    let mut constants = Vec::new();
    for parameter in &function.sig.generics.params {
        match parameter {
            GenericParam::Const(constant) => {
                let ty = &constant.ty;
                if !matches!(ty, Type::Path(path) if path.path.is_ident("u32")) {
                    let message = format!("`{}` counts bits, and must be a `u32`", constant.ident);
                    let help = format!("write `const {}: u32`", constant.ident);
                    problems.add(codes::REV_GENERIC, ty, &message, &help);
                }
                constants.push(constant.ident.clone());
            }
            GenericParam::Type(_) | GenericParam::Lifetime(_) => problems.add(
                codes::REV_GENERIC,
                parameter,
                "a reversible function is generic over constants only",
                "name the registers' formats, with a width such as `const W: u32`",
            ),
        }
    }
    if let Some(clause) = &function.sig.generics.where_clause {
        problems.add(
            codes::REV_GENERIC,
            clause,
            "a reversible function has no `where` clause",
            "remove it: what must hold of the widths follows from the statements",
        );
    }
    constants
}

fn parameter(input: &FnArg, constants: &[Ident], problems: &mut Problems) -> Option<Register> {
    let input = match input {
        FnArg::Receiver(receiver) => {
            problems.add(
                codes::REV_SIGNATURE,
                receiver,
                "a method cannot be reversible: there is no register in `self`",
                "write a function of registers",
            );
            return None;
        }
        FnArg::Typed(input) => input,
    };
    let name = match &*input.pat {
        Pat::Ident(name) if name.by_ref.is_none() && name.subpat.is_none() => &name.ident,
        pattern => {
            let message = "a register needs a name";
            problems.add(
                codes::REV_PARAMETER,
                pattern,
                message,
                "write `x: &UInt<8>`",
            );
            return None;
        }
    };
    if let Pat::Ident(pattern) = &*input.pat
        && let Some(mutability) = &pattern.mutability
    {
        let message = "whether a register may be changed is said in its type";
        let shown = match &*input.ty {
            Type::Reference(reference) => register_text(&reference.elem),
            ty => register_text(ty),
        };
        let help = format!("write `{name}: &mut {shown}`");
        problems.add(codes::REV_PARAMETER, mutability, message, &help);
    }
    let Type::Reference(reference) = &*input.ty else {
        let ty = &input.ty;
        let shown = register_text(ty);
        let mut help = format!("write `{name}: &{shown}`, or `&mut {shown}` if it is changed");
        if matches!(&**ty, Type::Path(path) if path.path.is_ident("u32")) {
            let constant = name.to_string().to_uppercase();
            help = format!("{help}; a constant stands in the generics, as `const {constant}: u32`");
        }
        let message = "a register is taken by reference: it can neither be copied nor dropped";
        problems.add(codes::REV_PARAMETER, ty, message, &help);
        return None;
    };
    if let Some(lifetime) = &reference.lifetime {
        let message = "a register's lifetime has no name";
        problems.add(codes::REV_PARAMETER, lifetime, message, "remove it");
    }
    let format = format(&reference.elem, constants, problems)?;
    Some(Register {
        name: name.clone(),
        ty: (*reference.elem).clone(),
        format,
        parameter: true,
        mutable: reference.mutability.is_some(),
    })
}

/// A type as a register's: another format for what is none.
fn register_text(ty: &Type) -> String {
    let formats = ["Bool", "UInt", "Int", "UFixed", "Fixed"];
    let last = match ty {
        Type::Path(path) => path.path.segments.last(),
        _ => None,
    };
    match last {
        Some(last) if formats.iter().any(|format| last.ident == format) => type_text(ty),
        _ => "UInt<8>".to_owned(),
    }
}

/// The format that a type is.
pub(super) fn format(ty: &Type, constants: &[Ident], problems: &mut Problems) -> Option<Format> {
    let last = match ty {
        Type::Path(path) => path.path.segments.last(),
        _ => None,
    };
    let Some(last) = last else {
        return no_format(ty, problems);
    };
    let sizes: Vec<&GenericArgument> = match &last.arguments {
        PathArguments::AngleBracketed(arguments) => arguments.args.iter().collect(),
        _ => Vec::new(),
    };
    let read: Option<Vec<Linear>> = sizes.iter().map(|size| bits(size, constants)).collect();
    let Some(read) = read else {
        problems.add(
            codes::REV_FORMAT_NAME,
            ty,
            "the widths of registers are numbers, or constants of this function",
            "write `UInt<8>`, or `UInt<W>` with `const W: u32` among the function's generics",
        );
        return None;
    };
    let (kind, width, fraction) = match (last.ident.to_string().as_str(), read.as_slice()) {
        ("Bool", []) => (Kind::Bool, 1.into(), 0.into()),
        ("UInt", [width]) => (Kind::UInt, width.clone(), 0.into()),
        ("Int", [width]) => (Kind::Int, width.clone(), 0.into()),
        ("UFixed", [whole, part]) => (Kind::UFixed, whole.plus(part), part.clone()),
        ("Fixed", [whole, part]) => (Kind::Fixed, whole.plus(part), part.clone()),
        _ => return no_format(ty, problems),
    };
    if width
        .known()
        .is_some_and(|width| !(1..=63).contains(&width))
    {
        let message = format!("a register of {width} bits; it can have 1 to 63");
        problems.add(codes::REV_TOO_WIDE, ty, &message, "choose another width");
        return None;
    }
    Some(Format {
        kind,
        width,
        fraction,
    })
}

/// Reports a type that is not the format of a register.
#[cfg_attr(test, track_caller)]
fn no_format<T>(ty: &Type, problems: &mut Problems) -> Option<T> {
    let shown = type_text(ty);
    problems.add(
        codes::REV_FORMAT_NAME,
        ty,
        &format!("`{shown}` is not the format of a register"),
        "choose `UInt<W>`, `Int<W>`, `Fixed<I, F>`, `UFixed<I, F>` or `Bool`",
    );
    None
}

fn bits(size: &GenericArgument, constants: &[Ident]) -> Option<Linear> {
    match size {
        GenericArgument::Const(expression) => {
            super::scope::integer(expression).map(|n| i64::try_from(n).map(Linear::from).ok())?
        }
        GenericArgument::Type(Type::Path(path)) => {
            let name = path.path.get_ident()?;
            constants.contains(name).then(|| Linear::name(name))
        }
        _ => None,
    }
}
