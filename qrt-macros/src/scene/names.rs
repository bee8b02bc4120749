//! The author's constants and loop variables.

use super::fault::Faults;
use super::tokens::{Kind, Token, place_of};
use qrt_syntax::expr::{Variable, function_names};
use qrt_syntax::tree::Span;
use qrt_syntax::{codes, nearest};

/// The meaning of an author's name.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Meaning {
    /// The number that the name stands for.
    Number(f64),
    /// A value that could not be read. Nothing that depends on it is reported.
    Faulty,
}

/// The names that stand for numbers at one place of a scene.
#[derive(Debug, Default)]
pub(crate) struct Names(Vec<Name>);

#[derive(Debug)]
struct Name {
    text: String,
    meaning: Meaning,
    place: Span,
    is_variable: bool,
}

impl Names {
    /// Returns the meaning of `text`, if it is a name.
    pub(crate) fn value(&self, text: &str) -> Option<Meaning> {
        let found = self.0.iter().rev().find(|name| name.text == text);
        found.map(|name| name.meaning)
    }

    /// Returns the name that `text` was probably meant to be.
    pub(crate) fn nearest(&self, text: &str) -> Option<&str> {
        nearest(text, self.0.iter().map(|name| name.text.as_str()))
    }

    /// Number of names, for a later [`Names::truncate`].
    pub(crate) fn count(&self) -> usize {
        self.0.len()
    }

    /// Forgets all names but the first `count`.
    pub(crate) fn truncate(&mut self, count: usize) {
        self.0.truncate(count);
    }

    /// Returns the loop variables and their values: `i = 3`.
    pub(crate) fn passes(&self) -> String {
        let variables = self.0.iter().filter(|name| name.is_variable);
        let shown = variables.filter_map(|name| match name.meaning {
            Meaning::Number(value) => {
                let value = qrt_syntax::number(value);
                Some(format!("{} = {value}", name.text))
            }
            Meaning::Faulty => None,
        });
        shown.collect::<Vec<_>>().join(", ")
    }

    /// Adds a name for `value`, which is `None` if it is faulty. `_` is no name.
    pub(crate) fn define(
        &mut self,
        token: &Token,
        value: Option<f64>,
        is_variable: bool,
        faults: &mut Faults,
    ) {
        let Some(text) = token.word().filter(|text| *text != "_") else {
            return;
        };
        let place = token.place();
        let noun = if is_variable {
            "a loop variable"
        } else {
            "a constant"
        };
        // `y` and `z` may be names of an author: in a value they then stand for the author's number.
        let variables = Variable::ALL
            .iter()
            .filter(|v| !Variable::POINT.contains(v));
        let reserved = variables.map(|v| v.name()).any(|name| name == text)
            || function_names().any(|name| name == text)
            || matches!(text, "pi" | "rgb" | "auto" | "x");
        if let Some(first) = self.0.iter().find(|name| name.text == text) {
            let message = format!("the name `{text}` is given twice");
            faults
                .add(codes::MACRO_NAME_TAKEN, place, message)
                .also(first.place, "the first is")
                .help("choose another name for one of them");
        } else if reserved {
            let message = format!("{noun} cannot be called `{text}`");
            faults
                .add(codes::MACRO_NAME_TAKEN, place, message)
                .note("expressions, colours and films use this name themselves")
                .help(format!("choose another one, such as `{}`", other(text)));
        }
        self.0.push(Name {
            text: text.to_owned(),
            meaning: value.map_or(Meaning::Faulty, Meaning::Number),
            place,
            is_variable,
        });
    }

    /// True if any name in `tokens` has a faulty value.
    pub(crate) fn are_faulty(&self, tokens: &[Token]) -> bool {
        tokens.iter().any(|token| match &token.kind {
            Kind::Word(text) => self.value(text) == Some(Meaning::Faulty),
            Kind::Group(_, inner) => self.are_faulty(inner),
            _ => false,
        })
    }

    /// Reports the unknown names in `tokens`, which are a number.
    pub(crate) fn check(&self, tokens: &[Token], later: &[String], faults: &mut Faults) -> bool {
        let mut ok = true;
        for token in tokens {
            let text = match &token.kind {
                Kind::Word(text) => text,
                Kind::Group(_, inner) => {
                    ok &= self.check(inner, later, faults);
                    continue;
                }
                _ => continue,
            };
            let known = text == "pi" || function_names().any(|name| name == text);
            if known || self.value(text).is_some() {
                continue;
            }
            ok = false;
            let variable = Variable::ALL.iter().any(|variable| variable.name() == text);
            let message = format!("no constant is called `{text}`");
            let functions = || nearest(text, function_names().chain(["pi"]));
            let near = self.nearest(text).or_else(functions);
            let help = if later.contains(text) {
                format!("`{text}` is defined further down: move it up")
            } else if variable {
                format!("`{text}` has a value only in the expressions of a `bsdf`")
            } else if let Some(near) = near {
                format!("did you mean `{near}`?")
            } else {
                format!("define it before: `const {text}: f64 = 1.0;`")
            };
            let place = place_of(std::slice::from_ref(token)).unwrap_or_default();
            faults
                .add(codes::MACRO_NUMBER_NAME, place, message)
                .help(help);
        }
        ok
    }
}

/// Returns a name that differs from `text`, spelled as constants usually are.
fn other(text: &str) -> String {
    let upper = text.to_uppercase();
    if upper == text {
        format!("{text}0")
    } else {
        upper
    }
}
