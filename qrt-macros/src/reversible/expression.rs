//! A routine, read as a formula of the scene's expression language.
//!
//! Registers stand for real numbers here, so that nothing is rounded and nothing wraps. What a
//! `within!` computes is known in its `apply!` and forgotten after it; where a branch decides, the
//! formula is `if_less`.

use super::dim::Linear;
use super::ir::{Bit, Number, NumberKind, Routine, Statement, StatementKind as K, Term, Update};
use super::problem::Problems;
use proc_macro2::TokenStream;
use qrt_core::codes;
use std::collections::BTreeMap;
use syn::Ident;

/// By register: the formula of what it holds.
type Held = BTreeMap<String, String>;

/// What the routine adds to its one register that changes.
pub(super) fn read(routine: &Routine, problems: &mut Problems) -> Option<String> {
    let parameters = &routine.signature.parameters;
    let results: Vec<_> = parameters
        .iter()
        .filter(|register| register.mutable)
        .collect();
    let [result] = results.as_slice() else {
        let message = "a term has one result";
        let help = "take one register by `&mut`, and all others by `&`";
        problems.add(codes::REV_PARAMETER, &routine.signature.name, message, help);
        return None;
    };
    let inputs = parameters.iter().filter(|register| !register.mutable);
    let inputs = inputs.map(|register| (register.name.to_string(), register.name.to_string()));
    let mut held: Held = inputs.collect();
    let result = result.name.to_string();
    held.insert(result.clone(), "0".to_owned());
    let mut reader = Reader {
        problems,
        loops: Vec::new(),
    };
    reader.block(&routine.body, &mut held)?;
    held.remove(&result)
}

struct Reader<'a> {
    problems: &'a mut Problems,
    /// Variables of the loops around, and what they are in this turn.
    loops: Vec<(Ident, i64)>,
}

impl Reader<'_> {
    fn block(&mut self, statements: &[Statement], held: &mut Held) -> Option<()> {
        statements
            .iter()
            .try_for_each(|statement| self.statement(statement, held))
    }

    fn no_formula<T>(&mut self, source: &TokenStream) -> Option<T> {
        let message = "this has no formula in real numbers";
        let help = "a scene's term adds and multiplies whole registers, and compares them";
        self.problems
            .add(codes::REV_EXPRESSION, source, message, help);
        None
    }

    fn statement(&mut self, statement: &Statement, held: &mut Held) -> Option<()> {
        let source = &statement.source;
        match &statement.kind {
            K::Update(place, terms) => {
                let name = place.register.name.to_string();
                for (update, term) in terms {
                    let sign = match update {
                        Update::Add => '+',
                        Update::Subtract => '-',
                        Update::Xor => return self.no_formula(source),
                    };
                    let Term::Number(number) = term else {
                        return self.no_formula(source);
                    };
                    let term = self.number(number, held)?;
                    let sum = match (held.get(&name).map(String::as_str), sign) {
                        (None | Some("0"), '+') => term,
                        (before, _) => format!("({} {sign} {term})", before.unwrap_or("0")),
                    };
                    held.insert(name.clone(), sum);
                }
            }
            K::Swap(a, b) => {
                let [a, b] = [a, b].map(|register| register.name.to_string());
                let (was_a, was_b) = (held.remove(&a), held.remove(&b));
                held.extend(was_b.map(|formula| (a, formula)));
                held.extend(was_a.map(|formula| (b, formula)));
            }
            K::Call { .. } => return self.no_formula(source),
            K::If(condition, holds, fails) => {
                let (mut yes, mut no) = (held.clone(), held.clone());
                self.block(holds, &mut yes)?;
                self.block(fails, &mut no)?;
                for (name, yes) in yes {
                    let no = no.remove(&name).unwrap_or_else(|| "0".to_owned());
                    let chosen = if yes == no {
                        yes
                    } else {
                        self.choice(condition, &yes, &no, held, source)?
                    };
                    held.insert(name, chosen);
                }
            }
            K::For {
                variable,
                bounds,
                reversed,
                body,
            } => {
                let [first, end] = bounds.clone().map(|bound| self.known(&bound));
                let (Some(first), Some(end)) = (first, end) else {
                    return self.no_formula(source);
                };
                let mut turns: Vec<i64> = (first..end).collect();
                if *reversed {
                    turns.reverse();
                }
                for turn in turns {
                    self.loops.push((variable.clone(), turn));
                    let done = self.block(body, held);
                    self.loops.pop();
                    done?;
                }
            }
            K::Within(within, apply) => {
                let before = held.clone();
                self.block(within, held)?;
                let between = held.clone();
                self.block(apply, held)?;
                // What the first part changed is undone.
                for (name, formula) in between {
                    match before.get(&name) {
                        Some(was) if *was != formula => held.insert(name, was.clone()),
                        _ => None,
                    };
                }
            }
            K::Scratch(register, body) => {
                let name = register.name.to_string();
                held.insert(name.clone(), "0".to_owned());
                self.block(body, held)?;
                held.remove(&name);
            }
            K::Block(body) => self.block(body, held)?,
        }
        Some(())
    }

    fn known(&self, number: &Linear) -> Option<i64> {
        let mut number = number.clone();
        for (variable, turn) in &self.loops {
            number = number.with(variable, &(*turn).into());
        }
        number.known()
    }

    /// `yes` where the condition holds, and `no` elsewhere.
    fn choice(
        &mut self,
        condition: &Bit,
        yes: &str,
        no: &str,
        held: &Held,
        source: &TokenStream,
    ) -> Option<String> {
        match condition {
            Bit::Less(a, b) => {
                let (a, b) = (self.number(a, held)?, self.number(b, held)?);
                Some(format!("if_less({a}, {b}, {yes}, {no})"))
            }
            Bit::Equal(a, b) => {
                let (a, b) = (self.number(a, held)?, self.number(b, held)?);
                let not_less = format!("if_less({b}, {a}, {no}, {yes})");
                Some(format!("if_less({a}, {b}, {no}, {not_less})"))
            }
            Bit::Not(inner) => self.choice(inner, no, yes, held, source),
            Bit::And(a, b) => {
                let both = self.choice(b, yes, no, held, source)?;
                self.choice(a, &both, no, held, source)
            }
            Bit::Constant(_) | Bit::At(..) | Bit::Xor(..) => self.no_formula(source),
        }
    }

    fn number(&mut self, number: &Number, held: &Held) -> Option<String> {
        let scaled = |formula: String, by: i64| match by {
            0 => formula,
            1.. => format!("{formula} * {}", 1_u64.checked_shl(by as u32).unwrap_or(0)),
            _ => format!("{formula} / {}", 1_u64.checked_shl(-by as u32).unwrap_or(0)),
        };
        let source = &number.source;
        let fraction = |number: &Number| number.size.fraction.clone();
        match &number.kind {
            NumberKind::Constant(units) => {
                let by = fraction(number).known().unwrap_or(0);
                Some(format!("{}", *units as f64 / 2_f64.powi(by as i32)))
            }
            NumberKind::Word(register, first) => {
                let whole = first.is_zero()
                    && number.size.width == register.format.width.clone().into()
                    && number.size.fraction == register.format.fraction;
                match held.get(&register.name.to_string()) {
                    Some(formula) if whole => Some(formula.clone()),
                    _ => self.no_formula(source),
                }
            }
            NumberKind::Truth(_) => self.no_formula(source),
            // Shifts that only align leave the number as it is.
            NumberKind::Shifted(inner, by) | NumberKind::Dropped(inner, by) => {
                let down = matches!(number.kind, NumberKind::Dropped(..));
                let by = if down { by.times(-1) } else { by.clone() };
                let moved = by.minus(&fraction(number).minus(&fraction(inner)));
                match self.known(&moved) {
                    Some(by) => Some(scaled(self.number(inner, held)?, by)),
                    None => self.no_formula(source),
                }
            }
            NumberKind::Pointed(inner) => {
                let moved = fraction(inner).minus(&fraction(number));
                match self.known(&moved) {
                    Some(by) => Some(scaled(self.number(inner, held)?, by)),
                    None => self.no_formula(source),
                }
            }
            NumberKind::Product(a, b) => Some(format!(
                "{} * {}",
                self.number(a, held)?,
                self.number(b, held)?
            )),
            NumberKind::Square(a) => Some(format!("({})^2", self.number(a, held)?)),
            NumberKind::Sum(terms) => {
                let mut sum = String::new();
                for (subtract, term) in terms {
                    let term = self.number(term, held)?;
                    let sign = if *subtract { " - " } else { " + " };
                    if !sum.is_empty() || *subtract {
                        sum += sign;
                    }
                    sum += &term;
                }
                Some(format!("({})", sum.trim_start()))
            }
        }
    }
}
