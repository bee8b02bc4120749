//! The meaning of a routine's statements: each register's number after each statement.

use super::bounds;
use super::content::{Content, Path, Value};
use super::signature;
use crate::reversible::ir::{
    Place, Register, Signature, Statement, StatementKind as K, Term, Update, inverse,
};
use crate::reversible::problem::Problems;
use crate::reversible::source::{text, type_text};
use proc_macro2::TokenStream;
use qrt_scene::expr::{Domain, Expr, Interval, MAX_LENGTH, Variable};
use qrt_scene::syntax::codes;
use quote::ToTokens;
use std::collections::{BTreeMap, BTreeSet};
use syn::Ident;

/// The most statements that are read, those of every pass of a loop included.
const MAX_STEPS: usize = 2000;

/// The most numbers that are added to one register.
const MAX_PARTS: usize = 200;

/// The registers at one place of the routine, and that place.
pub(super) struct Meaning<'a> {
    pub(super) registers: BTreeMap<String, Content>,
    pub(super) domain: Domain,
    /// The branches around the statement that is being read.
    pub(super) path: Path,
    /// The loops around, and their passes.
    pub(super) loops: Vec<(Ident, i64)>,
    name: Ident,
    steps: usize,
    /// True if an expression is too long, so that the rest would be too long, too.
    ended: bool,
    problems: &'a mut Problems,
    /// Problems that have been reported, by text and place.
    said: BTreeSet<String>,
}

impl<'a> Meaning<'a> {
    /// Begins a routine: its outputs are 0.
    pub(super) fn new(signature: &Signature, problems: &'a mut Problems) -> Option<Self> {
        let domain = signature::domain(signature, problems)?;
        let parameters = signature.parameters.iter().map(|register| {
            let name = register.name.to_string();
            let variable = Variable::ALL.into_iter().find(|v| name == v.name());
            let content = variable.map_or_else(Content::default, |variable| {
                Content::from_value(Value {
                    expr: Expr::variable(variable),
                    error: Interval::point(0.0),
                    run: domain.get(variable),
                })
            });
            (name, content)
        });
        Some(Self {
            registers: parameters.collect(),
            domain,
            path: Path::new(),
            loops: Vec::new(),
            name: signature.name.clone(),
            steps: 0,
            ended: false,
            problems,
            said: BTreeSet::new(),
        })
    }

    /// Returns the outputs as the text of expressions, unless there are problems.
    pub(super) fn texts(self, outputs: &[Ident]) -> Option<Vec<String>> {
        if self.problems.count() > 0 {
            return None;
        }
        let mut texts = Vec::new();
        for output in outputs {
            let content = self.registers.get(&output.to_string())?;
            let mut text = content.value(&Path::new()).expr.to_string();
            text.retain(|letter| letter != ' ');
            if Expr::parse(&text, &Variable::ALL).is_err() {
                let message = format!("`{output}` becomes too long an expression");
                let help = "compute it from shorter sums, or in fewer branches";
                self.problems
                    .add(codes::TERM_LENGTH, output, &message, help);
                return None;
            }
            texts.push(text);
        }
        Some(texts)
    }

    pub(super) fn statements(&mut self, statements: &[Statement]) {
        for statement in statements {
            if !self.step() {
                return;
            }
            // A statement without a meaning is skipped, so that the rest is read too.
            let _: Option<()> = self.statement(statement);
        }
    }

    /// Counts a statement or a pass. False if there are too many, or if an expression is too long.
    fn step(&mut self) -> bool {
        if self.ended {
            return false;
        }
        self.steps += 1;
        if self.steps == MAX_STEPS + 1 {
            let message =
                format!("this term has more than {MAX_STEPS} statements, loops written out");
            let help = "write fewer passes";
            self.problems
                .add(codes::TERM_LENGTH, &self.name, &message, help);
        }
        self.steps <= MAX_STEPS
    }

    fn statement(&mut self, statement: &Statement) -> Option<()> {
        // Branches that no value of the variables leads to do nothing.
        bounds::narrowed(&self.domain, &self.path)?;
        let source = &statement.source;
        match &statement.kind {
            K::Update(place, terms) => self.update(place, terms, source)?,
            K::Swap(a, b) => self.swap(a, b)?,
            K::Call { path, .. } => {
                let shown = text(path);
                let message = format!("what `{shown}` does is not known in a term");
                let help = format!("write the statements of `{shown}` here");
                return self.meaningless(source, &message, &help);
            }
            K::If(bit, holds, fails) => {
                // Errors underline the condition alone.
                let condition = syn::parse2::<syn::ExprIf>(source.clone());
                let condition =
                    condition.map_or_else(|_| source.clone(), |own| own.cond.to_token_stream());
                let around = self.path.clone();
                for (value, body) in [(true, holds), (false, fails)] {
                    for path in self.paths(bit, value, &condition)? {
                        self.path = path;
                        self.statements(body);
                    }
                    self.path.clone_from(&around);
                }
            }
            K::For {
                variable,
                bounds: [first, end],
                reversed,
                body,
            } => {
                let (first, end) = (self.known(first)?, self.known(end)?);
                let passes: Box<dyn Iterator<Item = i64>> = if *reversed {
                    Box::new((first..end).rev())
                } else {
                    Box::new(first..end)
                };
                for pass in passes {
                    if !self.step() {
                        break;
                    }
                    self.loops.push((variable.clone(), pass));
                    self.statements(body);
                    self.loops.pop();
                }
            }
            K::Within(within, apply) => {
                self.statements(within);
                self.statements(apply);
                if self.problems.count() == 0 {
                    self.statements(&inverse(within));
                }
            }
            K::Scratch(register, body) => {
                let name = register.name.to_string();
                self.registers.insert(name.clone(), Content::default());
                self.statements(body);
                self.registers.remove(&name);
            }
            K::Block(body) => self.statements(body),
        }
        Some(())
    }

    fn update(
        &mut self,
        place: &Place,
        terms: &[(Update, Term)],
        source: &TokenStream,
    ) -> Option<()> {
        let register = &place.register;
        let numbers = terms.iter().map(|(update, term)| match term {
            Term::Number(number) => Some((update, number)),
            Term::Bit(..) => None,
        });
        let (None, Some(numbers)) = (&place.part, numbers.collect::<Option<Vec<_>>>()) else {
            return self.no_number(source);
        };
        let mut values = Vec::new();
        for (update, number) in numbers {
            if *update == Update::Xor {
                let shown = text(source);
                let message = format!("`{shown}`: exclusive or has no meaning for numbers");
                let help = format!("write `{} += ..`", register.name);
                return self.meaningless(source, &message, &help);
            }
            let value = self.number(number)?;
            if value.error != Interval::point(0.0) && !register.format.fixed() {
                let shown = text(&number.source);
                let ty = type_text(&register.ty);
                let message = format!("`{shown}` is rounded to a whole number, which is a step");
                let help = format!("use a target with fraction bits, not `{ty}`");
                return self.meaningless(&number.source, &message, &help);
            }
            values.push((*update == Update::Subtract, value));
        }
        let content = self.registers.get_mut(&register.name.to_string())?;
        for (subtracted, value) in values {
            content.add(value, subtracted, &self.path);
        }
        if content.parts() > MAX_PARTS {
            return self.too_long(&register.name, source);
        }
        let value = content.value(&self.path);
        self.check(register, &value, source)
    }

    /// Checks that a register holds its number, for all values of the variables.
    fn check(&mut self, register: &Register, value: &Value, source: &TokenStream) -> Option<()> {
        if self.problems.count() > 0 {
            return None;
        }
        let name = &register.name;
        if value.expr.written_nodes() > MAX_LENGTH as u64 {
            return self.too_long(name, source);
        }
        let room = bounds::of_format(&register.format)?;
        let domain = bounds::narrowed(&self.domain, &self.path)?;
        if bounds::fits(value, room, &domain, &self.path) {
            return Some(());
        }
        let range = value.expr.range(&domain).unwrap_or(Interval::ALL);
        let range = range.plus(value.error);
        let ty = type_text(&register.ty);
        let (reached, help) = if range.lo < room.lo && !register.format.signed() {
            (range.lo, format!("use a signed format for `{name}`"))
        } else if range.lo < room.lo {
            (range.lo, format!("use a wider format for `{name}`"))
        } else {
            (range.hi, format!("use a wider format for `{name}`"))
        };
        let message = format!(
            "`{name}` may get {}, and `{ty}` holds {} to {}",
            rounded(reached),
            rounded(room.lo),
            rounded(room.hi)
        );
        self.say(codes::TERM_RANGE, source, &message, &help);
        None
    }

    #[cfg_attr(test, track_caller)]
    fn too_long(&mut self, name: &Ident, source: &TokenStream) -> Option<()> {
        let message = format!("`{name}` becomes too long an expression");
        let help = "compute it from shorter sums, or in fewer branches";
        self.say(codes::TERM_LENGTH, source, &message, help);
        self.ended = true;
        None
    }

    fn swap(&mut self, a: &Register, b: &Register) -> Option<()> {
        let (a, b) = (a.name.to_string(), b.name.to_string());
        let (was_a, was_b) = (self.registers.remove(&a)?, self.registers.remove(&b)?);
        if self.path.is_empty() {
            self.registers.extend([(a, was_b), (b, was_a)]);
            return Some(());
        }
        self.registers.extend([
            (a, was_a.replaced(&was_b, &self.path)),
            (b, was_b.replaced(&was_a, &self.path)),
        ]);
        Some(())
    }

    /// Reports a statement that has no meaning for numbers.
    #[cfg_attr(test, track_caller)]
    pub(super) fn meaningless<T>(
        &mut self,
        source: &TokenStream,
        message: &str,
        help: &str,
    ) -> Option<T> {
        self.say(codes::TERM_READING, source, message, help);
        None
    }

    /// Adds a problem, unless another pass or branch has added it.
    #[cfg_attr(test, track_caller)]
    fn say(&mut self, code: &str, source: &TokenStream, message: &str, help: &str) {
        if self.said.insert(format!("{code} {source} {message}")) {
            self.problems.add(code, source, message, help);
        }
    }
}

/// Formats a bound for a message.
fn rounded(bound: f64) -> String {
    let text = format!("{bound:.6}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    text.to_owned()
}
