//! A function's signature: registers by reference, constants as its only generics.

use super::constants::Constants;
use super::dim::Linear;
use super::ir::{Array, Demand, Format, Kind, Register, Signature};
use super::problem::Problems;
use super::source::{text, type_text};
use super::{Around, attributes, outside};
use proc_macro2::{TokenStream, TokenTree};
use qrt_syntax::codes;
use quote::{ToTokens, format_ident, quote};
use std::rc::Rc;
use syn::punctuated::Punctuated;
use syn::{
    BinOp, Expr, FnArg, GenericArgument, GenericParam, Ident, ItemFn, Pat, PathArguments, Stmt,
    Token, Type, TypeArray, TypeReference,
};

/// Reads the signature. Its faulty parts are left out of the result.
pub(super) fn read(function: &ItemFn, around: &Around, problems: &mut Problems) -> Signature {
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
    let mut own = constants(&function.sig.generics, "a reversible function", problems);
    for parameter in &function.sig.generics.params {
        if let GenericParam::Const(constant) = parameter
            && is_named(&constant.ty, "u32")
            && is_before_points(&constant.ident, &signature.inputs)
            // The body may have registers of this width, which take a `u32`.
            && !mentions(function.block.to_token_stream(), &constant.ident)
        {
            let name = &constant.ident;
            let message = format!("`{name}` counts the bits before a point, and must be an `i32`");
            let help = format!("write `const {name}: i32`, which a call finds by its registers");
            problems.add(codes::REV_GENERIC, &constant.ty, &message, &help);
            own.sign(name);
        }
    }
    let constants = around.constants.followed_by(&own);
    let mut demands = Vec::new();
    for name in constants.signed() {
        let condition = quote!(#name >= 0);
        let message = format!("QRT0823: `{name}` is negative");
        let span = name.span();
        let demand = Demand {
            condition,
            message,
            span,
        };
        outside::demand(&mut demands, demand);
    }
    let mut parameters: Vec<Rc<Register>> = Vec::new();
    let mut unusable = Vec::new();
    for input in &signature.inputs {
        let Some(register) = parameter(input, &constants, &mut demands, problems) else {
            match input {
                FnArg::Typed(input) => {
                    if let Pat::Ident(name) = &*input.pat {
                        unusable.push(name.ident.clone());
                    }
                }
                FnArg::Receiver(receiver) => {
                    unusable.push(Ident::new("self", receiver.self_token.span));
                }
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
        // rustc reports two parameters of the same name.
        parameters.push(Rc::new(register));
    }
    let own_attributes = function
        .attrs
        .iter()
        .filter(|own| attributes::is_outer(own));
    Signature {
        attributes: own_attributes.cloned().collect(),
        visibility: function.vis.clone(),
        name: signature.ident.clone(),
        of: around.of.clone(),
        complete: around.complete,
        machine: machine_name(function, &constants),
        own,
        constants,
        parameters,
        unusable,
        demands,
    }
}

/// Returns a name for the machine's type that neither the function nor the item around it mentions.
fn machine_name(function: &ItemFn, constants: &[Ident]) -> Ident {
    let names = ["M", "Machine", "AnyMachine"].map(|name| format_ident!("{name}"));
    let is_free = |name: &Ident| {
        let name = std::slice::from_ref(name);
        !constants.contains(&name[0]) && !names_any(function.to_token_stream(), name)
    };
    let free = names.into_iter().find(is_free);
    free.unwrap_or_else(|| format_ident!("__Machine"))
}

/// Returns the constants that a function, or the item around it, is generic over.
pub(super) fn constants(
    generics: &syn::Generics,
    what: &str,
    problems: &mut Problems,
) -> Constants {
    let mut constants = Constants::default();
    for parameter in &generics.params {
        match parameter {
            GenericParam::Const(constant) => {
                let ty = &constant.ty;
                let is_signed = is_named(ty, "i32");
                if !is_signed && !is_named(ty, "u32") {
                    let message = format!("`{}` counts bits, and must be a `u32`", constant.ident);
                    let help = format!("write `const {}: u32`", constant.ident);
                    problems.add(codes::REV_GENERIC, ty, &message, &help);
                }
                constants.push(&constant.ident, is_signed);
            }
            GenericParam::Type(_) | GenericParam::Lifetime(_) => problems.add(
                codes::REV_GENERIC,
                parameter,
                &format!("{what} is generic over constants only"),
                "name the registers' formats, with a width such as `const W: u32`",
            ),
        }
    }
    if let Some(clause) = &generics.where_clause {
        problems.add(
            codes::REV_GENERIC,
            clause,
            &format!("{what} has no `where` clause"),
            "remove it: what must hold of the widths follows from the statements",
        );
    }
    constants
}

/// True if these tokens contain the name.
fn mentions(tokens: TokenStream, name: &Ident) -> bool {
    outside::dependence(tokens, std::slice::from_ref(name)).is_some_and(|word| word == *name)
}

/// True if parameters have a constant in their formats alone, and only as the bits before a point. Rust's
/// type of these bits is `i32`, and no call finds a constant of another type.
fn is_before_points(name: &Ident, inputs: &Punctuated<FnArg, Token![,]>) -> bool {
    let mut found = false;
    for input in inputs {
        let FnArg::Typed(input) = input else {
            continue;
        };
        let mut ty = &*input.ty;
        while let Type::Reference(TypeReference { elem, .. })
        | Type::Array(TypeArray { elem, .. }) = ty
        {
            ty = elem;
        }
        let Type::Path(path) = ty else {
            continue;
        };
        let Some(last) = path.path.segments.last() else {
            continue;
        };
        let PathArguments::AngleBracketed(sizes) = &last.arguments else {
            continue;
        };
        for (place, size) in sizes.args.iter().enumerate() {
            if matches!(size, GenericArgument::Type(Type::Path(size)) if size.path.is_ident(name)) {
                found = place == 0 && (last.ident == "Fixed" || last.ident == "UFixed");
                if !found {
                    return false;
                }
            }
        }
    }
    found
}

fn parameter(
    input: &FnArg,
    constants: &Constants,
    demands: &mut Vec<Demand>,
    problems: &mut Problems,
) -> Option<Register> {
    let input = match input {
        FnArg::Receiver(receiver) => {
            problems.add(
                codes::REV_SIGNATURE,
                receiver,
                "which register `self` is cannot be seen here",
                "put `#[reversible]` on the `impl` of a trait for a format: `impl Count for UInt<4>`",
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
        if is_named(ty, "u32") {
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
    let (array, ty) = array(&reference.elem, constants, demands, problems)?;
    let format = format(ty, constants, demands, problems)?;
    Some(Register {
        name: name.clone(),
        ty: ty.clone(),
        array,
        element: None,
        computed: computed(ty, &format, constants),
        format,
        parameter: true,
        mutable: reference.mutability.is_some(),
    })
}

/// Returns the number of registers, if a type is an array's, and the type of one register.
pub(super) fn array<'a>(
    ty: &'a Type,
    constants: &Constants,
    demands: &mut Vec<Demand>,
    problems: &mut Problems,
) -> Option<(Option<Array>, &'a Type)> {
    let Type::Array(array) = ty else {
        return Some((None, ty));
    };
    let length = &array.len;
    let known = width(length, constants, demands);
    let Some(known) = known.filter(|_| !names_any(quote!(#length), constants)) else {
        let message = "how many registers an array has is a number or a constant of a module";
        let help = "write `[UInt<8>; 4]`, or `[UInt<8>; N]` with `const N: usize` in the module";
        problems.add(codes::REV_FORMAT_NAME, length, message, help);
        return None;
    };
    let written = quote!(#length);
    let length = known;
    Some((Some(Array { length, written }), &array.elem))
}

/// True if a type has this name, by whatever path.
fn is_named(ty: &Type, name: &str) -> bool {
    let Type::Path(path) = ty else {
        return false;
    };
    path.path
        .segments
        .last()
        .is_some_and(|last| last.ident == name)
}

/// Returns the text of a type as a register's. A type that is no format becomes another format.
fn register_text(ty: &Type) -> String {
    if let Type::Array(array) = ty {
        let length = &array.len;
        return format!("[{}; {}]", register_text(&array.elem), text(length));
    }
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

/// Returns the format of a type.
pub(super) fn format(
    ty: &Type,
    constants: &Constants,
    demands: &mut Vec<Demand>,
    problems: &mut Problems,
) -> Option<Format> {
    let path = match ty {
        Type::Path(path) => path.path.segments.last().map(|last| (&path.path, last)),
        _ => None,
    };
    let Some((path, last)) = path else {
        return no_format(ty, problems);
    };
    let sizes: Vec<&GenericArgument> = match &last.arguments {
        PathArguments::AngleBracketed(arguments) => arguments.args.iter().collect(),
        _ => Vec::new(),
    };
    let read: Option<Vec<Linear>> = sizes
        .iter()
        .map(|size| bits(size, constants, demands))
        .collect();
    let Some(read) = read else {
        let dependent = |size| outside::dependence(quote!(#size), constants).is_some();
        let help = if sizes.iter().any(dependent) {
            "write a sum of constants and their multiples, such as `UInt<{ 2 * W + 1 }>`, or take the \
             width as a constant of its own, `const V: u32`"
        } else {
            "write `UInt<8>`, or `UInt<W>` with `const W: u32` among the function's generics or in \
             its module"
        };
        let message = "the widths of registers are numbers or constants";
        problems.add(codes::REV_FORMAT_NAME, ty, message, help);
        return None;
    };
    let (kind, width, fraction) = match (last.ident.to_string().as_str(), read.as_slice()) {
        ("Bool", []) => (Kind::Bool, 1.into(), 0.into()),
        ("UInt", [width]) => (Kind::UInt, width.clone(), 0.into()),
        ("Int", [width]) => (Kind::Int, width.clone(), 0.into()),
        ("UFixed", [whole, part]) => (Kind::UFixed, whole.plus(part), part.clone()),
        ("Fixed", [whole, part]) => (Kind::Fixed, whole.plus(part), part.clone()),
        (_, []) if is_alias(ty) => (Kind::UInt, outside::width(path, demands), 0.into()),
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

/// True if a type may be another name of a format.
fn is_alias(ty: &Type) -> bool {
    let Type::Path(path) = ty else {
        return false;
    };
    let formats = ["Bool", "UInt", "Int", "UFixed", "Fixed"];
    let last = path.path.segments.last();
    let named = |last: &syn::PathSegment| {
        outside::is_type(&last.ident) && formats.iter().all(|format| last.ident != format)
    };
    path.qself.is_none() && last.is_some_and(named)
}

fn bits(
    size: &GenericArgument,
    constants: &Constants,
    demands: &mut Vec<Demand>,
) -> Option<Linear> {
    match size {
        GenericArgument::Const(expression) => width(expression, constants, demands),
        GenericArgument::Type(Type::Path(path)) => match path.path.get_ident() {
            Some(name) if constants.contains(name) => Some(constants.linear(name)),
            _ => outside::constant(&path.path, demands),
        },
        _ => None,
    }
}

/// Reads a width: a sum of numbers, the module's constants and those of the function.
fn width(expression: &Expr, constants: &Constants, demands: &mut Vec<Demand>) -> Option<Linear> {
    if let Some(number) = super::scope::integer(expression) {
        return i64::try_from(number).map(Linear::from).ok();
    }
    match expression {
        Expr::Paren(inner) => width(&inner.expr, constants, demands),
        Expr::Block(block) => match block.block.stmts.as_slice() {
            [Stmt::Expr(inner, None)] => width(inner, constants, demands),
            _ => None,
        },
        Expr::Path(path) => match path.path.get_ident() {
            Some(name) if constants.contains(name) => Some(constants.linear(name)),
            // A type of Rust's cannot have it as a width.
            _ if outside::dependence(quote!(#path), constants)
                .is_some_and(|word| word != "Self" || constants.has_generic_self()) =>
            {
                None
            }
            _ => outside::constant(&path.path, demands),
        },
        Expr::Binary(binary) => {
            let a = width(&binary.left, constants, demands)?;
            let b = width(&binary.right, constants, demands)?;
            match (binary.op, a.known(), b.known()) {
                (BinOp::Add(_), ..) => Some(a.plus(&b)),
                (BinOp::Sub(_), ..) => Some(a.minus(&b)),
                (BinOp::Mul(_), Some(factor), _) => Some(b.times(factor)),
                (BinOp::Mul(_), _, Some(factor)) => Some(a.times(factor)),
                _ => None,
            }
        }
        _ => None,
    }
}

/// Returns the generated name of a format that Rust's types cannot express. Its width is computed
/// from the function's constants, or one of these constants has another type than the format's.
pub(super) fn computed(ty: &Type, format: &Format, constants: &Constants) -> Option<Ident> {
    let Type::Path(path) = ty else {
        return None;
    };
    let last = path.path.segments.last()?;
    let PathArguments::AngleBracketed(sizes) = &last.arguments else {
        return None;
    };
    let mut sizes = sizes.args.iter().enumerate();
    let computed = sizes.any(|(place, size)| {
        let alone = match size {
            GenericArgument::Type(_) => true,
            GenericArgument::Const(Expr::Block(block)) => {
                matches!(
                    block.block.stmts.as_slice(),
                    [Stmt::Expr(Expr::Path(_), None)]
                )
            }
            _ => false,
        };
        // A constant of the other type, alone, is converted.
        let before_the_point = format.fixed() && place == 0;
        let is_signed = names_any(quote!(#size), constants.signed());
        names_any(quote!(#size), constants) && (!alone || before_the_point != is_signed)
    });
    let written = format!("{:?} {} {}", format.kind, format.width, format.fraction);
    let words = [('+', "plus"), ('-', "minus"), ('*', "times")];
    let name = words
        .iter()
        .fold(written, |name, (sign, word)| name.replace(*sign, word));
    let name = name.replace(|letter: char| !letter.is_alphanumeric(), "_");
    computed.then(|| Ident::new(name.trim_end_matches("_0"), last.ident.span()))
}

/// True if tokens name any of `names`.
pub(super) fn names_any(tokens: TokenStream, names: &[Ident]) -> bool {
    tokens.into_iter().any(|token| match token {
        TokenTree::Ident(name) => names.contains(&name),
        TokenTree::Group(group) => names_any(group.stream(), names),
        _ => false,
    })
}
