//! Texts of statements: equal for statements with the same effect.

use crate::reversible::dim::Linear;
use crate::reversible::ir::{Bit, Statement, StatementKind as K, Term};
use crate::reversible::source::text;

/// Returns a text that is equal for statements with the same effect.
pub(super) fn key(kind: &K) -> String {
    key_of(kind, true)
}

/// Returns the text of [`key`]. Unless `ordered`, the parts of a statement have no order.
pub(super) fn key_of(kind: &K, ordered: bool) -> String {
    let keys = |statements: &[Statement]| {
        let keys = statements.iter();
        let mut keys: Vec<String> = keys.map(|one| key_of(&one.kind, ordered)).collect();
        if !ordered {
            keys.sort_unstable();
        }
        keys.join("; ")
    };
    match kind {
        K::Update(place, terms) => {
            let part = |[first, width]: &[Linear; 2]| format!("[{first}; {width}]");
            let part = place.part.as_ref().map_or_else(String::new, part);
            let mut terms: Vec<String> = terms
                .iter()
                .map(|(u, t)| format!("{u:?} {}", term(t)))
                .collect();
            terms.sort_unstable();
            format!("{}{part} {}", place.register, terms.join(", "))
        }
        K::Swap(a, b) => {
            let [a, b] = [a.to_string(), b.to_string()];
            format!("swap {} {}", (&a).min(&b), (&a).max(&b))
        }
        K::Zero(register) => format!("zero {register}"),
        K::Call {
            path,
            inverse,
            arguments,
        } => {
            let function = crate::reversible::emit::function(path, *inverse);
            let arguments: Vec<String> = arguments
                .iter()
                .map(|(register, change, _)| format!("{register} {change}"))
                .collect();
            format!("{}({})", text(function), arguments.join(", "))
        }
        K::If(condition, holds, fails) => {
            format!(
                "if {} {{{}}} {{{}}}",
                bit(condition),
                keys(holds),
                keys(fails)
            )
        }
        K::For {
            variable,
            bounds: [first, end],
            reversed,
            body,
        } => format!(
            "for {variable} {first}..{end} {} {{{}}}",
            *reversed && ordered,
            keys(body)
        ),
        K::Within(within, apply) => format!("within {{{}}} {{{}}}", keys(within), keys(apply)),
        K::Scratch(register, body) => {
            format!(
                "let {}: {} {{{}}}",
                register.name,
                register.type_text(),
                keys(body)
            )
        }
        K::Block(body) => keys(body),
    }
}

fn term(term: &Term) -> String {
    match term {
        Term::Number(number) => text(&number.source),
        Term::Bit(Bit::Constant(value), _) => value.to_string(),
        Term::Bit(value, _) => bit(value),
    }
}

fn bit(value: &Bit) -> String {
    match value {
        Bit::Constant(value) => value.to_string(),
        Bit::At(register, index) => format!("{register}[{index}]"),
        Bit::Not(inner) => format!("!{}", bit(inner)),
        Bit::And(a, b) => format!("({} & {})", bit(a), bit(b)),
        Bit::Xor(a, b) => format!("({} ^ {})", bit(a), bit(b)),
        Bit::Less(a, b) => format!("({} < {})", text(&a.source), text(&b.source)),
        Bit::Equal(a, b) => format!("({} == {})", text(&a.source), text(&b.source)),
    }
}
