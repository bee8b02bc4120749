//! Reads an [`Expr`] from text, or reports all problems of the text.

use super::arena::Arena;
use super::{Expr, ExprNode, Function, Id, Variable};
use crate::{Expression as Fault, Path, Problem, nearest};
use std::ops::Range;

/// The longest expression, in bytes.
pub(crate) const MAX_LENGTH: usize = 4096;

/// Maximum depth of nested parentheses, signs and powers.
pub(crate) const MAX_DEPTH: usize = 128;

impl Expr {
    /// Reads an expression that may use the variables `allowed`.
    ///
    /// Problems have their bytes in `text` (`within`) and an empty path, which the caller
    /// completes. Codes: `QRT0400` not an expression, `QRT0401` unknown name, `QRT0402` a variable
    /// that has no value here, `QRT0403` wrong number of operands, `QRT0404` not a number,
    /// `QRT0405` too long or too deep, `QRT0406` empty.
    ///
    /// ```
    /// use qrt_syntax::expr::{Expr, Variable};
    /// let problems = Expr::parse("2*cosi", &Variable::ALL).unwrap_err();
    /// assert_eq!(problems[0].description().message, "unknown name `cosi`");
    /// assert_eq!(problems[0].description().help.as_deref(), Some("did you mean `cos_i`?"));
    /// assert_eq!(problems[0].within, Some(2..6));
    /// ```
    pub fn parse(text: &str, allowed: &[Variable]) -> Result<Self, Vec<Problem>> {
        if text.len() > MAX_LENGTH {
            let (bytes, most) = (text.len(), MAX_LENGTH);
            let what = Fault::TooLong { bytes, most };
            return Err(vec![Problem::new(Path::root(), what)]);
        }
        let mut parser = Parser {
            text,
            at: 0,
            token: Token::End,
            range: 0..0,
            depth: 0,
            allowed,
            arena: Arena::default(),
            problems: Vec::new(),
        };
        let root = parser.whole();
        match root {
            Ok(root) if parser.problems.is_empty() => Ok(parser.arena.finish(root)),
            Ok(_) => Err(parser.problems),
            Err(problem) => {
                parser.problems.push(*problem);
                Err(parser.problems)
            }
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Token<'a> {
    Number(f64),
    Name(&'a str),
    Symbol(char),
    End,
}

/// A result whose error ends the reading. Unknown names do not end it, so that all are reported.
type Fallible<T> = Result<T, Box<Problem>>;

struct Parser<'a> {
    text: &'a str,
    at: usize,
    token: Token<'a>,
    range: Range<usize>,
    depth: usize,
    allowed: &'a [Variable],
    arena: Arena,
    problems: Vec<Problem>,
}

fn problem(range: Range<usize>, what: Fault) -> Problem {
    Problem {
        within: Some(range),
        ..Problem::new(Path::root(), what)
    }
}

/// Returns an error that ends the reading.
fn stop<T>(range: Range<usize>, what: Fault) -> Fallible<T> {
    Err(Box::new(problem(range, what)))
}

impl Parser<'_> {
    fn whole(&mut self) -> Fallible<Id> {
        self.advance()?;
        if self.token == Token::End {
            return stop(0..self.text.len(), Fault::Empty);
        }
        let root = self.sum()?;
        if self.token == Token::End {
            return Ok(root);
        }
        let found = self.found();
        stop(self.range.clone(), Fault::Unexpected { found })
    }

    fn sum(&mut self) -> Fallible<Id> {
        let mut left = self.product()?;
        while let Token::Symbol(symbol @ ('+' | '-')) = self.token {
            self.advance()?;
            let right = self.product()?;
            left = self.arena.push(match symbol {
                '+' => ExprNode::Add(left, right),
                _ => ExprNode::Sub(left, right),
            });
        }
        Ok(left)
    }

    fn product(&mut self) -> Fallible<Id> {
        let mut left = self.signed()?;
        while let Token::Symbol(symbol @ ('*' | '/')) = self.token {
            let start = self.range.start;
            self.advance()?;
            if self.token == Token::Symbol('*') {
                let found = "**".to_owned();
                return stop(start..self.range.end, Fault::Unexpected { found });
            }
            let right = self.signed()?;
            left = self.arena.push(match symbol {
                '*' => ExprNode::Mul(left, right),
                _ => ExprNode::Div(left, right),
            });
        }
        Ok(left)
    }

    fn signed(&mut self) -> Fallible<Id> {
        match self.token {
            Token::Symbol('-') => {
                self.enter()?;
                let operand = self.signed()?;
                self.depth -= 1;
                Ok(match self.arena.node(operand) {
                    ExprNode::Number(value) => self.arena.number(-value),
                    _ => self.arena.push(ExprNode::Neg(operand)),
                })
            }
            Token::Symbol('+') => {
                self.enter()?;
                let operand = self.signed()?;
                self.depth -= 1;
                Ok(operand)
            }
            _ => self.power(),
        }
    }

    fn power(&mut self) -> Fallible<Id> {
        let base = self.atom()?;
        if self.token != Token::Symbol('^') {
            return Ok(base);
        }
        self.enter()?;
        let exponent = self.signed()?;
        self.depth -= 1;
        Ok(self.raise(base, exponent))
    }

    fn raise(&mut self, base: Id, exponent: Id) -> Id {
        match self.arena.node(exponent) {
            ExprNode::Number(n) if n == n.trunc() && n.abs() <= i32::MAX.into() => {
                self.arena.push(ExprNode::Powi(base, n as i32))
            }
            _ => self.arena.push(ExprNode::Pow(base, exponent)),
        }
    }

    fn atom(&mut self) -> Fallible<Id> {
        match self.token {
            Token::Number(value) => {
                self.advance()?;
                Ok(self.arena.number(value))
            }
            Token::Name(name) => {
                let range = self.range.clone();
                self.advance()?;
                if self.token == Token::Symbol('(') {
                    self.call(name, range)
                } else {
                    Ok(self.name(name, range))
                }
            }
            Token::Symbol('(') => {
                let open = self.range.clone();
                self.enter()?;
                let inner = self.sum()?;
                self.close(open)?;
                Ok(inner)
            }
            _ => {
                let found = (self.token != Token::End).then(|| self.found());
                stop(self.range.clone(), Fault::NoValue { found })
            }
        }
    }

    fn name(&mut self, name: &str, range: Range<usize>) -> Id {
        if name == "pi" {
            return self.arena.number(std::f64::consts::PI);
        }
        let variable = Variable::ALL.into_iter().find(|v| v.name() == name);
        if let Some(variable) = variable.filter(|variable| self.allowed.contains(variable)) {
            return self.arena.push(ExprNode::Variable(variable));
        }
        let allowed: Vec<_> = self.allowed.iter().map(|v| v.name()).collect();
        let owned = name.to_owned();
        let what = if variable.is_some() {
            let name = owned;
            Fault::NoValueHere { name, allowed }
        } else if is_function(name) {
            let (name, wanted) = (owned, operand_count(name));
            Fault::NoOperands { name, wanted }
        } else {
            let names = allowed.iter().copied().chain(["pi"]);
            Fault::UnknownName {
                name: owned,
                near: nearest(name, names.chain(function_names())),
                allowed,
            }
        };
        self.problems.push(problem(range, what));
        self.arena.number(1.0)
    }

    fn call(&mut self, name: &str, range: Range<usize>) -> Fallible<Id> {
        let open = self.range.clone();
        self.enter()?;
        let mut operands = Vec::new();
        if self.token != Token::Symbol(')') {
            operands.push(self.sum()?);
            while self.token == Token::Symbol(',') {
                self.advance()?;
                operands.push(self.sum()?);
            }
        }
        let end = self.range.end;
        self.close(open)?;
        if !is_function(name) {
            let is_value = name == "pi" || Variable::ALL.iter().any(|v| v.name() == name);
            let (name, functions) = (name.to_owned(), function_names().collect());
            let what = if is_value {
                Fault::NotAFunction { name }
            } else {
                Fault::UnknownFunction { name, functions }
            };
            self.problems.push(problem(range, what));
            return Ok(self.arena.number(1.0));
        }
        if let Some(f) = Function::ALL.into_iter().find(|f| f.name() == name)
            && let [a] = operands[..]
        {
            return Ok(self.arena.push(ExprNode::Function(f, a)));
        }
        Ok(match (name, &operands[..]) {
            ("sqrt", [a]) => self.arena.push(ExprNode::Sqrt(*a)),
            ("abs", [a]) => self.arena.push(ExprNode::Abs(*a)),
            ("atan2", [a, b]) => self.arena.push(ExprNode::Atan2(*a, *b)),
            ("min", [a, b]) => self.arena.push(ExprNode::Min(*a, *b)),
            ("max", [a, b]) => self.arena.push(ExprNode::Max(*a, *b)),
            ("pow", [a, b]) => self.raise(*a, *b),
            ("if_less", [a, b, x, y]) => self.arena.push(ExprNode::IfLess(*a, *b, *x, *y)),
            _ => {
                let what = Fault::Operands {
                    name: name.to_owned(),
                    wanted: operand_count(name),
                    given: operands.len(),
                };
                self.problems.push(problem(range.start..end, what));
                self.arena.number(1.0)
            }
        })
    }

    /// Steps over the current symbol, one level down.
    fn enter(&mut self) -> Fallible<()> {
        if self.depth == MAX_DEPTH {
            return stop(self.range.clone(), Fault::TooDeep { most: MAX_DEPTH });
        }
        self.depth += 1;
        self.advance()
    }

    /// Steps over the parenthesis that closes the one at `open`, one level up.
    fn close(&mut self, open: Range<usize>) -> Fallible<()> {
        if self.token != Token::Symbol(')') {
            if self.token == Token::End {
                return stop(open, Fault::NeverClosed);
            }
            let found = self.found();
            return stop(self.range.clone(), Fault::NotClosed { found });
        }
        self.depth -= 1;
        self.advance()
    }

    /// The text of the current token.
    fn found(&self) -> String {
        self.text[self.range.clone()].to_owned()
    }

    fn advance(&mut self) -> Fallible<()> {
        let rest = &self.text[self.at..];
        let trimmed = rest.trim_start();
        let start = self.at + rest.len() - trimmed.len();
        let Some(first) = trimmed.chars().next() else {
            self.token = Token::End;
            self.at = self.text.len();
            self.range = self.at..self.at;
            return Ok(());
        };
        let (token, length) = if first.is_ascii_digit() || first == '.' {
            let length = number_length(trimmed.as_bytes());
            (Token::Number(number(&trimmed[..length], start)?), length)
        } else if first.is_alphabetic() || first == '_' {
            let ends = |c: char| !(c.is_alphanumeric() || c == '_');
            let length = trimmed.find(ends).unwrap_or(trimmed.len());
            (Token::Name(&trimmed[..length]), length)
        } else {
            (Token::Symbol(first), first.len_utf8())
        };
        self.token = token;
        self.range = start..start + length;
        self.at = start + length;
        Ok(())
    }
}

/// Number of bytes of the number, valid or not, at the start of `text`: `1.2.3` is one number.
fn number_length(text: &[u8]) -> usize {
    let mut length = 0;
    while let Some(byte) = text.get(length) {
        let sign_of_exponent = matches!(byte, b'+' | b'-')
            && matches!(text[length - 1], b'e' | b'E')
            && text.get(length + 1).is_some_and(u8::is_ascii_digit);
        let exponent = matches!(byte, b'e' | b'E')
            && match text.get(length + 1) {
                Some(b'+' | b'-') => text.get(length + 2).is_some_and(u8::is_ascii_digit),
                next => next.is_some_and(u8::is_ascii_digit),
            };
        if !(byte.is_ascii_digit() || *byte == b'.' || exponent || sign_of_exponent) {
            break;
        }
        length += 1;
    }
    length
}

fn number(text: &str, start: usize) -> Fallible<f64> {
    let owned = || text.to_owned();
    let what = match text.parse::<f64>() {
        Ok(value) if value.is_finite() => return Ok(value),
        Ok(_) => Fault::TooLarge { text: owned() },
        Err(_) => Fault::NotANumber { text: owned() },
    };
    stop(start..start + text.len(), what)
}

const OTHERS: [(&str, usize); 7] = [
    ("sqrt", 1),
    ("abs", 1),
    ("atan2", 2),
    ("pow", 2),
    ("min", 2),
    ("max", 2),
    ("if_less", 4),
];

/// The names of all functions of expressions.
pub fn function_names() -> impl Iterator<Item = &'static str> {
    OTHERS
        .iter()
        .map(|(name, _)| *name)
        .chain(Function::ALL.iter().map(|f| f.name()))
}

fn is_function(name: &str) -> bool {
    function_names().any(|f| f == name)
}

/// Number of operands of the function.
fn operand_count(name: &str) -> usize {
    OTHERS
        .iter()
        .find(|(other, _)| *other == name)
        .map_or(1, |(_, count)| *count)
}
