//! A term's signature: the BSDF's variables, and the registers of its value.

use super::bounds;
use super::offer::variable;
use crate::reversible::ir::{Register, Signature};
use crate::reversible::problem::Problems;
use crate::reversible::source::type_text;
use proc_macro2::TokenStream;
use qrt_scene::expr::{Domain, Interval, Variable};
use qrt_scene::syntax::{codes, nearest};
use quote::ToTokens;
use syn::Ident;

/// Returns the values that the variables have in this function.
pub(super) fn domain(signature: &Signature, problems: &mut Problems) -> Option<Domain> {
    let mut domain = Domain::default();
    let before = problems.count();
    for constant in &signature.constants {
        let message = "a BSDF's term is one function, and not one for each of a constant's values";
        let help = "write the numbers of bits out";
        problems.add(codes::TERM_SIGNATURE, constant, message, help);
    }
    for register in &signature.parameters {
        let name = &register.name;
        if register.is_array() {
            let message = format!("`{name}` is an array of registers, and a BSDF's value is none");
            let help = "take registers of their own: `r`, `g` and `b`";
            problems.add(codes::TERM_SIGNATURE, name, &message, help);
            continue;
        }
        match variable(name) {
            None if !register.mutable => unknown(name, signature, problems),
            Some(known) if !register.format.fixed() => {
                let shown = type_text(&register.ty);
                let message = format!("`{name}` is a number with a point, and `{shown}` has none");
                let help = format!("write `{name}: &{}`", format_of(known));
                problems.add(codes::TERM_SIGNATURE, &register.ty, &message, &help);
            }
            Some(_) if register.mutable => {
                let message = format!("the BSDF's variable `{name}` can only be read");
                let help = format!("write `{name}: &{}`", type_text(&register.ty));
                problems.add(codes::TERM_SIGNATURE, name, &message, &help);
            }
            Some(known) => {
                if let Some(range) = held(known, register, problems) {
                    *domain.get_mut(known) = range;
                }
            }
            None => {}
        }
    }
    (problems.count() == before).then_some(domain)
}

fn unknown(name: &Ident, signature: &Signature, problems: &mut Problems) {
    let taken = |variable: &&str| signature.parameters.iter().any(|own| own.name == variable);
    let names = Variable::ALL.map(Variable::name).into_iter();
    let near = nearest(&name.to_string(), names.filter(|name| !taken(name)));
    let help = near.map_or_else(
        || "the variables are `cos_i`, `cos_o`, `cos_a`, `u` and `v`".to_owned(),
        |near| format!("did you mean `{near}`?"),
    );
    let message = format!("`{name}` is not a variable of a BSDF");
    problems.add(codes::TERM_SIGNATURE, name, &message, &help);
}

/// Returns the range of a variable in a register, which must hold all of its values.
fn held(variable: Variable, register: &Register, problems: &mut Problems) -> Option<Interval> {
    let all = Domain::default().get(variable);
    let room = bounds::of_format(&register.format)?;
    // Coordinates of the unit square stay below 1.
    let is_coordinate = Variable::SQUARE.contains(&variable);
    if room.lo <= all.lo && (room.hi >= all.hi || is_coordinate) {
        let hi = all.hi.min(room.hi);
        return Some(Interval { hi, ..all });
    }
    let (name, shown) = (variable.name(), type_text(&register.ty));
    let message = format!(
        "`{name}` reaches from {} to {}, and `{shown}` from {} to {}",
        all.lo, all.hi, room.lo, room.hi
    );
    let help = format!("write `{name}: &{}`", format_of(variable));
    problems.add(codes::TERM_SIGNATURE, &register.ty, &message, &help);
    None
}

/// Returns a format that holds a variable.
fn format_of(variable: Variable) -> &'static str {
    match variable {
        Variable::U | Variable::V => "UFixed<0, 14>",
        Variable::CosI | Variable::CosO => "UFixed<1, 14>",
        Variable::CosA => "Fixed<2, 14>",
    }
}

/// Returns the output for grey, or those for red, green and blue.
pub(super) fn outputs(signature: &Signature, problems: &mut Problems) -> Option<Vec<Ident>> {
    let parameters = signature.parameters.iter();
    let outputs: Vec<&Register> = parameters
        .map(|register| &**register)
        .filter(|register| register.mutable && variable(&register.name).is_none())
        .collect();
    let before = problems.count();
    for output in outputs.iter().filter(|output| !output.format.fixed()) {
        let shown = type_text(&output.ty);
        let message = format!("a BSDF's value is a number with a point, and `{shown}` has none");
        let help = format!("write `{}: &mut UFixed<2, 14>`", output.name);
        problems.add(codes::TERM_SIGNATURE, &output.ty, &message, &help);
    }
    let channels = ["r", "g", "b"].map(|name| outputs.iter().find(|output| output.name == name));
    let found = match (outputs.as_slice(), channels) {
        ([only], _) => Some(vec![only.name.clone()]),
        ([_, _, _], [Some(r), Some(g), Some(b)]) => {
            Some([r, g, b].map(|output| output.name.clone()).into())
        }
        _ => None,
    };
    if found.is_none() {
        let name = &signature.name;
        let (place, message): (TokenStream, String) = match outputs.get(1) {
            None => {
                let message = format!("`{name}` has no output for the BSDF's value");
                (name.to_token_stream(), message)
            }
            Some(second) => {
                let message = format!("`{name}` has {} outputs", outputs.len());
                (second.name.to_token_stream(), message)
            }
        };
        let help = "take one `out: &mut UFixed<2, 14>` for grey, or three: `r`, `g` and `b`";
        problems.add(codes::TERM_SIGNATURE, place, &message, help);
    }
    found.filter(|_| problems.count() == before)
}
