//! The shapes that values of a scene have. A shape is one definition of how a value is read, what
//! range it has, how it is written and what the JSON Schema says of it.

mod collections;
mod described;

pub(crate) use collections::{Array, AutoOr, Channels, List, Maybe, Named, is_auto, point};
pub(crate) use described::{record_schema, variant_schema};

use crate::codes;
use crate::front::tree::{Kind, Node, Value};
use crate::report::Problem;
use crate::scene::decode::{Decoder, Place};
use crate::scene::text::{Data, number as number_text};
use std::marker::PhantomData;

/// How a value is read, checked, written and described.
pub(crate) trait Shape {
    /// The value's type.
    type Value;
    /// Reads it; a faulty one is reported and replaced.
    fn decode(&self, node: &Node, at: &Place<'_>, decoder: &mut Decoder) -> Self::Value;
    /// Stands for a faulty value; within its range.
    fn fallback(&self) -> Self::Value;
    /// Reports what is out of range.
    fn check(&self, value: &Self::Value, at: &Place<'_>, problems: &mut Vec<Problem>);
    /// Writes it; `None` leaves the key out.
    fn encode(&self, value: &Self::Value) -> Option<Data>;
    /// Draft-07.
    fn schema(&self) -> Data;
}

/// What is defined by `record!` or `variant!`: a shape that its type alone determines.
pub(crate) trait Part: Sized {
    fn decode(node: &Node, at: &Place<'_>, decoder: &mut Decoder) -> Self;
    fn fallback() -> Self;
    fn check(&self, at: &Place<'_>, problems: &mut Vec<Problem>);
    fn encode(&self) -> Data;
    fn schema() -> Data;
}

/// What is defined by `keyword!`.
pub(crate) trait Keyword: Copy + PartialEq + 'static {
    const NOUN: &'static str;
    const NAMES: &'static [&'static str];
    /// What each of them means, in the same order.
    const DOCS: &'static [&'static str];
    const VALUES: &'static [Self];
}

/// Of a [`Part`].
pub(crate) struct PartShape<T>(PhantomData<T>);

pub(crate) const fn part<T>() -> PartShape<T> {
    PartShape(PhantomData)
}

impl<T: Part> Shape for PartShape<T> {
    type Value = T;
    fn decode(&self, node: &Node, at: &Place<'_>, decoder: &mut Decoder) -> T {
        T::decode(node, at, decoder)
    }
    fn fallback(&self) -> T {
        T::fallback()
    }
    fn check(&self, value: &T, at: &Place<'_>, problems: &mut Vec<Problem>) {
        value.check(at, problems);
    }
    fn encode(&self, value: &T) -> Option<Data> {
        Some(value.encode())
    }
    fn schema(&self) -> Data {
        T::schema()
    }
}

/// Of a [`Keyword`].
pub(crate) struct WordShape<T>(PhantomData<T>);

pub(crate) const fn word<T>() -> WordShape<T> {
    WordShape(PhantomData)
}

impl<T: Keyword> Shape for WordShape<T> {
    type Value = T;
    fn decode(&self, node: &Node, at: &Place<'_>, decoder: &mut Decoder) -> T {
        let index = decoder.word(node, at, T::NOUN, T::NAMES);
        index.map_or(T::VALUES[0], |index| T::VALUES[index])
    }
    fn fallback(&self) -> T {
        T::VALUES[0]
    }
    fn check(&self, _: &T, _: &Place<'_>, _: &mut Vec<Problem>) {}
    fn encode(&self, value: &T) -> Option<Data> {
        let index = T::VALUES.iter().position(|other| other == value)?;
        Some(Data::text(T::NAMES[index]))
    }
    fn schema(&self) -> Data {
        let texts =
            |texts: &[&str]| Data::List(texts.iter().map(|text| Data::text(text.trim())).collect());
        // Not JSON Schema's own, but what editors show beside each word.
        Data::map([
            ("enum", texts(T::NAMES)),
            ("enumDescriptions", texts(T::DOCS)),
        ])
    }
}

/// A number in an interval.
#[derive(Clone, Copy)]
pub(crate) struct Number {
    low: f64,
    low_open: bool,
    high: f64,
    high_open: bool,
    code: &'static str,
}

/// The size that lengths, coordinates and radiances may have: their products and squares stay
/// within the range of 64-bit floating point.
pub(crate) const LARGEST: f64 = 1e30;

/// A number from `low` to `high`, both included.
pub(crate) const fn number(low: f64, high: f64) -> Number {
    Number {
        low,
        low_open: false,
        high,
        high_open: false,
        code: codes::OUT_OF_RANGE,
    }
}

impl Number {
    /// Without `low` itself.
    pub(crate) const fn above(self) -> Self {
        Self {
            low_open: true,
            ..self
        }
    }
    /// Without `high` itself.
    pub(crate) const fn below(self) -> Self {
        Self {
            high_open: true,
            ..self
        }
    }
    /// With a code of its own for what is out of range.
    pub(crate) const fn coded(self, code: &'static str) -> Self {
        Self { code, ..self }
    }

    fn holds(&self, value: f64) -> bool {
        let low = if self.low_open {
            value > self.low
        } else {
            value >= self.low
        };
        let high = if self.high_open {
            value < self.high
        } else {
            value <= self.high
        };
        low && high
    }

    fn interval(&self) -> String {
        let low = if self.low_open { "above" } else { "from" };
        let high = if self.high_open { "below" } else { "to" };
        let joint = if self.low_open || self.high_open {
            " and "
        } else {
            " "
        };
        let (a, b) = (number_text(self.low), number_text(self.high));
        if self.low_open && !self.high_open {
            return format!("above {a} and at most {b}");
        }
        if self.high_open && !self.low_open {
            return format!("at least {a} and below {b}");
        }
        format!("{low} {a}{joint}{high} {b}")
    }
}

/// A number's text as its value; reports anything else.
fn read_number(node: &Node, at: &Place<'_>, decoder: &mut Decoder, expected: &str) -> Option<f64> {
    if let Value::Scalar(scalar) = &node.value {
        match scalar.kind() {
            Kind::Number(value) => {
                let lost = value.is_infinite() && scalar.has_digits()
                    || value == 0.0 && scalar.has_digits();
                if !lost {
                    return Some(value);
                }
                let size = if value == 0.0 { "small" } else { "large" };
                let message = format!("{} is too {size} for 64 bits", scalar.text);
                let problem = Problem::new(codes::UNREPRESENTABLE, at.path(), message);
                decoder.replace(at, problem);
                return None;
            }
            Kind::Text if scalar.quoted => {
                let bare = crate::front::tree::Scalar {
                    quoted: false,
                    ..scalar.clone()
                };
                if matches!(bare.kind(), Kind::Number(_)) {
                    let help = Some("remove the quotes".to_owned());
                    decoder.wrong_type(node, at, expected, help);
                    return None;
                }
            }
            _ => {}
        }
    }
    decoder.wrong_type(node, at, expected, None);
    None
}

impl Shape for Number {
    type Value = f64;
    fn decode(&self, node: &Node, at: &Place<'_>, decoder: &mut Decoder) -> f64 {
        read_number(node, at, decoder, "a number").unwrap_or_else(|| self.fallback())
    }
    fn fallback(&self) -> f64 {
        if self.holds(1.0) {
            1.0
        } else {
            f64::midpoint(self.low, self.high)
        }
    }
    fn check(&self, value: &f64, at: &Place<'_>, problems: &mut Vec<Problem>) {
        if !value.is_finite() {
            let message = format!("{} is not a finite number", number_text(*value));
            problems.push(Problem::new(codes::NOT_FINITE, at.path(), message));
        } else if !self.holds(*value) {
            let value = number_text(*value);
            let what = match self.code {
                codes::ALBEDO => format!("{value} is not an albedo or reflectance"),
                codes::RADIANCE => format!("{value} is not a radiance"),
                _ => format!("{value} is out of range"),
            };
            let problem = Problem::new(self.code, at.path(), what);
            problems.push(problem.label(format!("must be {}", self.interval())));
        }
    }
    fn encode(&self, value: &f64) -> Option<Data> {
        Some(Data::Number(*value))
    }
    fn schema(&self) -> Data {
        let low = if self.low_open {
            "exclusiveMinimum"
        } else {
            "minimum"
        };
        let high = if self.high_open {
            "exclusiveMaximum"
        } else {
            "maximum"
        };
        Data::map([
            ("type", Data::text("number")),
            (low, Data::Number(self.low)),
            (high, Data::Number(self.high)),
        ])
    }
}

/// Types of whole numbers in scenes.
pub(crate) trait Natural: Copy {
    fn from_u64(value: u64) -> Self;
    fn to_u64(self) -> u64;
}

impl Natural for u32 {
    fn from_u64(value: u64) -> Self {
        Self::try_from(value).unwrap_or(Self::MAX)
    }
    fn to_u64(self) -> u64 {
        u64::from(self)
    }
}

impl Natural for u64 {
    fn from_u64(value: u64) -> Self {
        value
    }
    fn to_u64(self) -> u64 {
        self
    }
}

/// A whole number in a range.
#[derive(Clone, Copy)]
pub(crate) struct Whole<T> {
    low: u64,
    high: u64,
    kind: PhantomData<T>,
}

/// A whole number from `low` to `high`, both included; at most 2^53, where every f64 is one.
pub(crate) const fn whole<T>(low: u64, high: u64) -> Whole<T> {
    Whole {
        low,
        high,
        kind: PhantomData,
    }
}

impl<T: Natural> Whole<T> {
    fn range_problem(&self, value: &str, at: &Place<'_>) -> Problem {
        Problem::new(
            codes::OUT_OF_RANGE,
            at.path(),
            format!("{value} is out of range"),
        )
        .label(format!(
            "must be a whole number from {} to {}",
            self.low, self.high
        ))
    }
}

impl<T: Natural> Shape for Whole<T> {
    type Value = T;
    fn decode(&self, node: &Node, at: &Place<'_>, decoder: &mut Decoder) -> T {
        let Some(value) = read_number(node, at, decoder, "a whole number") else {
            return self.fallback();
        };
        if value.fract() != 0.0 && value.is_finite() {
            decoder.wrong_type(node, at, "a whole number", None);
            return self.fallback();
        }
        if !(self.low as f64..=self.high as f64).contains(&value) {
            decoder.replace(at, self.range_problem(&number_text(value), at));
            return self.fallback();
        }
        T::from_u64(value as u64)
    }
    fn fallback(&self) -> T {
        T::from_u64(self.low)
    }
    fn check(&self, value: &T, at: &Place<'_>, problems: &mut Vec<Problem>) {
        let value = value.to_u64();
        if !(self.low..=self.high).contains(&value) {
            problems.push(self.range_problem(&value.to_string(), at));
        }
    }
    fn encode(&self, value: &T) -> Option<Data> {
        Some(Data::Number(value.to_u64() as f64))
    }
    fn schema(&self) -> Data {
        Data::map([
            ("type", Data::text("integer")),
            ("minimum", Data::Number(self.low as f64)),
            ("maximum", Data::Number(self.high as f64)),
        ])
    }
}

/// A text that is not empty.
pub(crate) struct Text;

impl Shape for Text {
    type Value = String;
    fn decode(&self, node: &Node, at: &Place<'_>, decoder: &mut Decoder) -> String {
        if let Value::Scalar(scalar) = &node.value {
            if scalar.kind() == Kind::Text {
                return scalar.text.clone();
            }
            let help = format!("put it in quotes: \"{}\"", scalar.text);
            decoder.wrong_type(node, at, "a text", Some(help));
        } else {
            decoder.wrong_type(node, at, "a text", None);
        }
        self.fallback()
    }
    fn fallback(&self) -> String {
        "unnamed".into()
    }
    fn check(&self, value: &String, at: &Place<'_>, problems: &mut Vec<Problem>) {
        if value.is_empty() {
            problems.push(Problem::new(
                codes::EMPTY_NAME,
                at.path(),
                "this text is empty",
            ));
        }
    }
    fn encode(&self, value: &String) -> Option<Data> {
        Some(Data::text(value.as_str()))
    }
    fn schema(&self) -> Data {
        Data::map([
            ("type", Data::text("string")),
            ("minLength", Data::Number(1.0)),
        ])
    }
}

/// An expression: a text, or a number, which is an expression as it stands.
pub(crate) struct Expression;

impl Shape for Expression {
    type Value = String;
    fn decode(&self, node: &Node, at: &Place<'_>, decoder: &mut Decoder) -> String {
        if let Value::Scalar(scalar) = &node.value
            && !matches!(scalar.kind(), Kind::Bool(_))
        {
            return scalar.text.clone();
        }
        decoder.wrong_type(node, at, "an expression", None);
        self.fallback()
    }
    fn fallback(&self) -> String {
        "0".into()
    }
    fn check(&self, value: &String, at: &Place<'_>, problems: &mut Vec<Problem>) {
        Text.check(value, at, problems);
    }
    fn encode(&self, value: &String) -> Option<Data> {
        Text.encode(value)
    }
    fn schema(&self) -> Data {
        let types = Data::List(vec![Data::text("string"), Data::text("number")]);
        Data::map([("type", types), ("minLength", Data::Number(1.0))])
    }
}
