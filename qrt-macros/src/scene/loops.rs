//! The author's constants and loops.

use super::body::{Body, ENTRIES};
use super::expression::value;
use super::tokens::{Kind, Token, place_of};
use proc_macro2::Delimiter;
use qrt_syntax::codes;
use qrt_syntax::tree::Span;

/// The most passes that all loops of a scene take together.
pub(crate) const MAX_PASSES: usize = 100_000;

impl Body {
    /// Reads `const NAME: f64 = value;`.
    pub(super) fn constant(&mut self, tokens: &[Token], at: usize) -> usize {
        let stop = |token: &Token| token.is_sign(';') || token.is_sign(',');
        let end = (at + 1..tokens.len())
            .find(|&next| {
                let begins = tokens[next]
                    .word()
                    .is_some_and(|word| ENTRIES.contains(&word));
                stop(&tokens[next]) || begins && next > at + 1
            })
            .unwrap_or(tokens.len());
        let own = &tokens[at..end];
        let place = place_of(own).unwrap_or_default();
        let ender = tokens.get(end);
        let name = own.get(1).filter(|token| token.word().is_some());
        let mut number = None;
        match own {
            [_, name, colon, kind, equals, tokens @ ..]
                if name.word().is_some()
                    && colon.is_sign(':')
                    && kind.is_word("f64")
                    && equals.is_sign('=')
                    && !tokens.is_empty() =>
            {
                if ender.is_none_or(|ender| !ender.is_sign(';')) {
                    let last = ender.filter(|token| stop(token)).or(tokens.last());
                    let last = last.map_or(place, Token::place);
                    self.not_a_constant(last, "a constant ends in `;`", "write `;` here");
                }
                let reader = &mut self.reader;
                number = value(tokens, &reader.names, &reader.later, &mut reader.faults);
            }
            [_, name, colon, kind, ..]
                if name.word().is_some() && colon.is_sign(':') && !kind.is_word("f64") =>
            {
                let message = format!("a constant is an `f64`, not {}", kind.found());
                self.not_a_constant(kind.place(), message, "all numbers of a scene are `f64`");
            }
            [_, name, equals, ..] if name.word().is_some() && equals.is_sign('=') => {
                let text = name.word().unwrap_or_default();
                let message = format!("the constant `{text}` has no type");
                self.not_a_constant(
                    name.place(),
                    message,
                    &format!("write `const {text}: f64 = ...;`"),
                );
            }
            _ => self.not_a_constant(
                place,
                "this is not a constant",
                "write `const NAME: f64 = 1.0;`",
            ),
        }
        if let Some(name) = name {
            let reader = &mut self.reader;
            reader.names.define(name, number, false, &mut reader.faults);
        }
        end + usize::from(ender.is_some_and(stop))
    }

    #[cfg_attr(test, track_caller)]
    fn not_a_constant(&mut self, place: Span, message: impl Into<String>, help: &str) {
        self.reader
            .faults
            .add(codes::MACRO_CONSTANT, place, message)
            .help(help);
    }

    /// Reads `for i in 0..4 { ... }` from the token `at`, and returns its end.
    pub(super) fn repeat(&mut self, tokens: &[Token], at: usize) -> usize {
        let brace = |token: &Token| token.group(Delimiter::Brace).is_some();
        let end = tokens[at..].iter().position(|t| brace(t) || t.is_sign(','));
        let end = end.map_or(tokens.len(), |length| at + length);
        let header = &tokens[at..end];
        let Some(body) = tokens.get(end).and_then(|t| t.group(Delimiter::Brace)) else {
            self.not_a_loop(header, "a loop has a body in braces");
            return tokens.len().min(end + 1);
        };
        let [_, variable, word, range @ ..] = header else {
            self.not_a_loop(header, "a loop has a variable and a range");
            return end + 1;
        };
        if variable.word().is_none() || !word.is_word("in") {
            self.not_a_loop(header, "a loop begins with a variable and `in`");
            return end + 1;
        }
        if let Some(passes) = self.range(header, range) {
            self.unroll(variable, range, &passes, body);
        }
        end + 1
    }

    #[cfg_attr(test, track_caller)]
    fn not_a_loop(&mut self, header: &[Token], message: &str) {
        let place = place_of(header).unwrap_or_default();
        self.reader
            .faults
            .add(codes::MACRO_LOOP, place, message)
            .help("write `for i in 0..4 { ... }`");
    }

    /// Returns the values of a loop's variable.
    fn range(&mut self, header: &[Token], range: &[Token]) -> Option<Passes> {
        if let [list] = range
            && let Some(inner) = list.group(Delimiter::Bracket)
        {
            let reader = &mut self.reader;
            let mut values = Vec::new();
            for item in super::tokens::between_commas(inner) {
                let names = &reader.names;
                values.push(value(item, names, &reader.later, &mut reader.faults)?);
            }
            return Some(Passes::Listed(values));
        }
        let dots = range
            .windows(2)
            .position(|pair| matches!(pair[0].kind, Kind::Sign('.', true)) && pair[1].is_sign('.'));
        let Some(dots) = dots else {
            self.not_a_loop(header, "a loop runs over a range or a list");
            return None;
        };
        let inclusive = range.get(dots + 2).is_some_and(|token| token.is_sign('='));
        let (from, to) = (&range[..dots], &range[dots + 2 + usize::from(inclusive)..]);
        if from.is_empty() || to.is_empty() {
            self.not_a_loop(header, "a range has two ends");
            return None;
        }
        let (from, to) = (self.whole(from), self.whole(to));
        let (from, to) = (from?, to?);
        Some(Passes::Counted(from, to + f64::from(u8::from(inclusive))))
    }

    /// Reads one end of a range, which must be a whole number.
    fn whole(&mut self, tokens: &[Token]) -> Option<f64> {
        let reader = &mut self.reader;
        let end = value(tokens, &reader.names, &reader.later, &mut reader.faults)?;
        if end.fract() == 0.0 && end.abs() <= f64::from(u32::MAX) {
            return Some(end);
        }
        let message = format!("a loop cannot begin or end at {end}");
        self.reader
            .faults
            .add(
                codes::MACRO_LOOP_ENDS,
                place_of(tokens).unwrap_or_default(),
                message,
            )
            .help("write whole numbers, or list the values: `for i in [0, 0.5, 1] { ... }`");
        None
    }

    fn unroll(&mut self, variable: &Token, range: &[Token], passes: &Passes, body: &[Token]) {
        let count = passes.count();
        if self.passes + count > MAX_PASSES {
            let message = format!("the loops take more than {MAX_PASSES} passes by here");
            let place = place_of(range).unwrap_or_default();
            self.reader
                .faults
                .add(codes::MACRO_LOOP_SIZE, place, message)
                .help("put large geometry into mesh files (OBJ, PLY, glTF)");
            return;
        }
        self.passes += count;
        let known = self.reader.names.count();
        for pass in 0..count {
            let faults = self.reader.faults.count();
            let value = passes.value(pass);
            let names = &mut self.reader.names;
            names.define(variable, Some(value), true, &mut self.reader.faults);
            self.entries(body, true);
            self.reader.names.truncate(known);
            if self.reader.faults.count() > faults {
                // The next pass would report the same.
                break;
            }
        }
    }
}

/// The values of a loop's variable.
enum Passes {
    /// Numbers from the first up to the second, without it.
    Counted(f64, f64),
    Listed(Vec<f64>),
}

impl Passes {
    fn count(&self) -> usize {
        match self {
            Self::Counted(from, to) => (to - from).max(0.0) as usize,
            Self::Listed(values) => values.len(),
        }
    }

    fn value(&self, pass: usize) -> f64 {
        match self {
            Self::Counted(from, _) => from + pass as f64,
            Self::Listed(values) => values.get(pass).copied().unwrap_or_default(),
        }
    }
}
