//! Expressions: from tokens to the text that the scene's expression language reads, with the
//! author's constants put in, and back from the text's bytes to the tokens.

use super::fault::Faults;
use super::names::{Meaning, Names};
use super::tokens::{Kind, Token, join, place_of, written};
use proc_macro2::Delimiter;
use qrt_syntax::expr::{Expr, Variables};
use qrt_syntax::tree::Span;
use qrt_syntax::{Expression as Fault, Problem, What, codes, number as number_text};
use std::ops::Range;

/// An expression's text, and the places of its parts.
#[derive(Debug, Default)]
pub(crate) struct Expression {
    pub(crate) text: String,
    pieces: Vec<(Range<usize>, Span)>,
}

impl Expression {
    /// Returns the text of `tokens`. A name of the author's becomes its value.
    pub(crate) fn from_tokens(
        tokens: &[Token],
        names: &Names,
        faults: &mut Faults,
    ) -> Option<Self> {
        let mut expression = Self::default();
        expression.add(tokens, names, faults).then_some(expression)
    }

    fn add(&mut self, tokens: &[Token], names: &Names, faults: &mut Faults) -> bool {
        let mut ok = true;
        if let Some((place, help)) = method(tokens) {
            let message = "an expression has functions, and no methods";
            faults.add(codes::MACRO_VALUE, place, message).help(help);
            return false;
        }
        for token in tokens {
            match &token.kind {
                Kind::Word(word) => match names.value(word) {
                    None => self.piece(word, token.place()),
                    // The fault has been reported; 1 stands for the value.
                    Some(Meaning::Faulty) => self.piece("1", token.place()),
                    Some(Meaning::Number(value)) => {
                        let text = number_text(value);
                        if value < 0.0 {
                            self.piece(&format!("({text})"), token.place());
                        } else {
                            self.piece(&text, token.place());
                        }
                    }
                },
                Kind::Number(digits, suffix) => {
                    ok &= is_bare(token, digits, suffix, faults);
                    self.piece(digits, token.place());
                }
                Kind::Sign(sign, _) => self.piece(&sign.to_string(), token.place()),
                Kind::Group(Delimiter::Parenthesis, inner) => {
                    let (first, last) = (token.first, token.last);
                    self.piece("(", super::tokens::place(first, first));
                    ok &= self.add(inner, names, faults);
                    self.piece(")", super::tokens::place(last, last));
                }
                Kind::Text(_) | Kind::Other(_) | Kind::Group(..) => {
                    ok = false;
                    let message = format!("{} cannot be part of an expression", token.found());
                    let fault = faults.add(codes::MACRO_VALUE, token.place(), message);
                    if matches!(token.kind, Kind::Text(_)) {
                        fault.help("write the expression without quotes");
                    } else {
                        fault.help(
                            "write numbers, names, `+ - * / ^` and functions such as `sqrt(u)`",
                        );
                    }
                }
            }
        }
        ok
    }

    fn piece(&mut self, text: &str, place: Span) {
        let is_name = |c: char| c.is_alphanumeric() || matches!(c, '_' | '.');
        if self.text.ends_with(is_name) && text.starts_with(is_name) {
            self.text.push(' ');
        }
        let start = self.text.len();
        self.text.push_str(text);
        self.pieces.push((start..self.text.len(), place));
    }

    /// Returns the place of the tokens of these bytes; beyond the end, that of the last token.
    pub(crate) fn place(&self, bytes: &Range<usize>) -> Option<Span> {
        let touched = |range: &Range<usize>| range.start < bytes.end && bytes.start < range.end;
        let mut touched = self.pieces.iter().filter(|(range, _)| touched(range));
        match (touched.next(), touched.next_back()) {
            (Some((_, first)), Some((_, last))) => Some(join(*first, *last)),
            (Some((_, only)), None) => Some(*only),
            _ => self.pieces.last().map(|(_, place)| *place),
        }
    }

    /// Adds a problem of this expression.
    pub(crate) fn report(&self, problem: &Problem, names: &Names, faults: &mut Faults) {
        let bytes = problem.within.clone().unwrap_or(0..self.text.len());
        let Some(place) = self.place(&bytes) else {
            return;
        };
        let near = match &problem.what {
            What::Expression(
                Fault::UnknownName { name, .. } | Fault::UnknownFunction { name, .. },
            ) => names.nearest(name),
            _ => None,
        };
        let words = super::advice::description(&problem.what);
        let near = near.map(|near| format!("did you mean `{near}`?"));
        faults.add(words.code, place, words.message).help = near.or(words.help);
    }
}

/// Returns the place of a call of a method, and the advice to call a function.
fn method(tokens: &[Token]) -> Option<(Span, String)> {
    let at = tokens.windows(4).position(|four| {
        let named = four[2].word().is_some();
        four[1].is_sign('.') && named && four[3].group(Delimiter::Parenthesis).is_some()
    })?;
    let four = &tokens[at..at + 4];
    let given = four[3].group(Delimiter::Parenthesis).unwrap_or_default();
    let (receiver, name) = (written(&four[..1]), four[2].word().unwrap_or_default());
    let receiver = match receiver
        .strip_prefix('(')
        .and_then(|inner| inner.strip_suffix(')'))
    {
        Some(inner) if !name.starts_with("pow") => inner,
        _ => receiver.as_str(),
    };
    let help = match (name, given) {
        ("powi" | "powf" | "pow", [_]) => format!("write `{receiver}^{}`", written(given)),
        (_, []) => format!("write `{name}({receiver})`"),
        _ => format!("write `{name}({receiver}, {})`", written(given)),
    };
    Some((join(four[0].place(), four[3].place()), help))
}

/// True if a number has no suffix; reports a suffix.
#[cfg_attr(test, track_caller)]
fn is_bare(token: &Token, digits: &str, suffix: &str, faults: &mut Faults) -> bool {
    if suffix.is_empty() {
        return true;
    }
    let message = format!("the number `{digits}{suffix}` has the suffix `{suffix}`");
    faults
        .add(codes::MACRO_SUFFIX, token.place(), message)
        .help(format!("write `{digits}`"));
    false
}

/// Returns the text of a number: as written if it is a literal, otherwise its value.
///
/// A number whose names are faulty is `None`, without a further report.
pub(crate) fn number(
    tokens: &[Token],
    names: &Names,
    later: &[String],
    faults: &mut Faults,
) -> Option<String> {
    let literal = |token: &Token, sign: &str, faults: &mut Faults| match &token.kind {
        Kind::Number(digits, suffix) => {
            is_bare(token, digits, suffix, faults).then(|| format!("{sign}{digits}"))
        }
        _ => None,
    };
    match tokens {
        [only] if matches!(only.kind, Kind::Number(..)) => return literal(only, "", faults),
        [sign, only] if sign.is_sign('-') && matches!(only.kind, Kind::Number(..)) => {
            return literal(only, "-", faults);
        }
        _ => {}
    }
    if !names.check(tokens, later, faults) {
        return None;
    }
    let expression = Expression::from_tokens(tokens, names, faults)?;
    if names.are_faulty(tokens) {
        return None;
    }
    match Expr::parse(&expression.text, &[]) {
        Ok(expr) => Some(number_text(expr.eval(&Variables::default()))),
        Err(problems) => {
            for problem in problems {
                expression.report(&problem, names, faults);
            }
            None
        }
    }
}

/// Returns the value of the number that [`number`] reads.
pub(crate) fn value(
    tokens: &[Token],
    names: &Names,
    later: &[String],
    faults: &mut Faults,
) -> Option<f64> {
    let text = number(tokens, names, later, faults)?;
    let value = match text.as_str() {
        ".nan" => f64::NAN,
        ".inf" => f64::INFINITY,
        "-.inf" => f64::NEG_INFINITY,
        text => text.parse().ok()?,
    };
    if value.is_finite() {
        return Some(value);
    }
    let place = place_of(tokens).unwrap_or_default();
    let message = format!("this is {value}, which is not a finite number");
    faults
        .add(codes::NOT_FINITE, place, message)
        .help("write a finite number");
    None
}
