//! The shapes of a scene's values. A shape defines once how a value is read, its range, how it is
//! written, and its JSON Schema.

mod collections;
mod described;

pub(crate) use collections::{
    Array, AutoOr, Channels, Colour, List, Maybe, Named, Omitted, is_auto, point,
};
pub(crate) use described::{FieldSchema, one_of, record_schema, variant_schema};

use crate::scene::decode;
use crate::scene::text::Data;
use qrt_syntax::tree::{Kind, Node, Value};
use qrt_syntax::{Datum, Expected, Place, Problems, Range};
use std::marker::PhantomData;

/// The definition of how a value is read, checked, written and described.
pub(crate) trait Shape {
    /// The value's type.
    type Value;
    /// Reads a value. Reports a faulty one and replaces it.
    fn decode(&self, node: &Node, at: &Place<'_>, problems: &mut Problems) -> Self::Value;
    /// Returns a value in range, which replaces a faulty one.
    fn fallback(&self) -> Self::Value;
    /// Reports values that are out of range.
    fn check(&self, value: &Self::Value, at: &Place<'_>, problems: &mut Problems);
    /// Writes a value; `None` leaves the key out.
    fn encode(&self, value: &Self::Value) -> Option<Data>;
    /// The shape's JSON Schema, draft-07.
    fn schema(&self) -> Data;
}

/// A type that `record!` or `variant!` defines: its shape follows from the type alone.
pub(crate) trait Part: Sized {
    fn decode(node: &Node, at: &Place<'_>, problems: &mut Problems) -> Self;
    fn fallback() -> Self;
    fn check(&self, at: &Place<'_>, problems: &mut Problems);
    fn encode(&self) -> Data;
    fn schema() -> Data;
}

/// A type that `keyword!` defines.
pub(crate) trait Keyword: Copy + PartialEq + 'static {
    const NOUN: &'static str;
    const NAMES: &'static [&'static str];
    /// The meaning of each name, in the same order.
    const DOCS: &'static [&'static str];
    const VALUES: &'static [Self];
}

/// The shape of a [`Part`].
pub(crate) struct PartShape<T>(PhantomData<T>);

pub(crate) const fn part<T>() -> PartShape<T> {
    PartShape(PhantomData)
}

impl<T: Part> Shape for PartShape<T> {
    type Value = T;
    fn decode(&self, node: &Node, at: &Place<'_>, problems: &mut Problems) -> T {
        T::decode(node, at, problems)
    }
    fn fallback(&self) -> T {
        T::fallback()
    }
    fn check(&self, value: &T, at: &Place<'_>, problems: &mut Problems) {
        value.check(at, problems);
    }
    fn encode(&self, value: &T) -> Option<Data> {
        Some(value.encode())
    }
    fn schema(&self) -> Data {
        T::schema()
    }
}

/// The shape of a [`Keyword`].
pub(crate) struct WordShape<T>(PhantomData<T>);

pub(crate) const fn word<T>() -> WordShape<T> {
    WordShape(PhantomData)
}

impl<T: Keyword> Shape for WordShape<T> {
    type Value = T;
    fn decode(&self, node: &Node, at: &Place<'_>, problems: &mut Problems) -> T {
        let index = decode::word(problems, node, at, T::NOUN, T::NAMES);
        index.map_or(T::VALUES[0], |index| T::VALUES[index])
    }
    fn fallback(&self) -> T {
        T::VALUES[0]
    }
    fn check(&self, _: &T, _: &Place<'_>, _: &mut Problems) {}
    fn encode(&self, value: &T) -> Option<Data> {
        let index = T::VALUES.iter().position(|other| other == value)?;
        Some(Data::text(T::NAMES[index]))
    }
    fn schema(&self) -> Data {
        let texts =
            |texts: &[&str]| Data::List(texts.iter().map(|text| Data::text(text.trim())).collect());
        // `enumDescriptions` is not part of JSON Schema, but editors show it beside each word.
        Data::map([
            ("enum", texts(T::NAMES)),
            ("enumDescriptions", texts(T::DOCS)),
        ])
    }
}

/// A number in an interval.
#[derive(Clone, Copy)]
pub(crate) struct Number {
    range: Range,
    /// The problem of a number that is out of range.
    fault: fn(f64, Range) -> Datum,
}

/// Maximum magnitude of lengths, coordinates and radiances: their products and squares stay within
/// the range of 64-bit floating point.
pub(crate) const LARGEST: f64 = 1e30;

/// A number from `low` to `high`, both included.
pub(crate) const fn number(low: f64, high: f64) -> Number {
    Number {
        range: Range {
            low,
            low_open: false,
            high,
            high_open: false,
        },
        fault: |value, range| Datum::OutOfRange { value, range },
    }
}

impl Number {
    /// Returns the same interval without its lowest number.
    pub(crate) const fn above(mut self) -> Self {
        self.range.low_open = true;
        self
    }
    /// Returns the same interval without its highest number.
    pub(crate) const fn below(mut self) -> Self {
        self.range.high_open = true;
        self
    }
    /// Returns the same interval with `fault` as the problem of a number that is out of range.
    pub(crate) const fn or(self, fault: fn(f64, Range) -> Datum) -> Self {
        Self { fault, ..self }
    }

    fn holds(&self, value: f64) -> bool {
        let Range {
            low,
            low_open,
            high,
            high_open,
        } = self.range;
        let open = low_open && value == low || high_open && value == high;
        (low..=high).contains(&value) && !open
    }
}

/// Reads a number from its text; reports anything else.
fn read_number(
    node: &Node,
    at: &Place<'_>,
    problems: &mut Problems,
    expected: Expected,
) -> Option<f64> {
    if let Value::Scalar(scalar) = &node.value
        && let Kind::Number(value) = scalar.kind()
    {
        let is_small = value == 0.0;
        if !(scalar.has_digits() && (value.is_infinite() || is_small)) {
            return Some(value);
        }
        let text = scalar.text.clone();
        problems.refuse(at, Datum::Unrepresentable { text, is_small });
        return None;
    }
    decode::wrong_type(problems, node, at, expected);
    None
}

impl Shape for Number {
    type Value = f64;
    fn decode(&self, node: &Node, at: &Place<'_>, problems: &mut Problems) -> f64 {
        read_number(node, at, problems, Expected::Number).unwrap_or_else(|| self.fallback())
    }
    fn fallback(&self) -> f64 {
        if self.holds(1.0) {
            1.0
        } else {
            f64::midpoint(self.range.low, self.range.high)
        }
    }
    fn check(&self, value: &f64, at: &Place<'_>, problems: &mut Problems) {
        let value = *value;
        if !value.is_finite() {
            problems.refuse(at, Datum::NotFinite { value });
        } else if !self.holds(value) {
            problems.refuse(at, (self.fault)(value, self.range));
        }
    }
    fn encode(&self, value: &f64) -> Option<Data> {
        Some(Data::Number(*value))
    }
    fn schema(&self) -> Data {
        let low = if self.range.low_open {
            "exclusiveMinimum"
        } else {
            "minimum"
        };
        let high = if self.range.high_open {
            "exclusiveMaximum"
        } else {
            "maximum"
        };
        Data::map([
            ("type", Data::text("number")),
            (low, Data::Number(self.range.low)),
            (high, Data::Number(self.range.high)),
        ])
    }
}

/// A whole number in a range.
#[derive(Clone, Copy)]
pub(crate) struct Whole<T> {
    low: T,
    high: T,
}

/// A whole number from `low` to `high`, both included, at most 2^53: up to there, each is exact in
/// `f64`.
pub(crate) const fn whole<T>(low: T, high: T) -> Whole<T> {
    Whole { low, high }
}

impl<T: Copy + Into<u64>> Whole<T> {
    fn out_of_range(&self, value: f64) -> Datum {
        let (low, high) = (self.low.into(), self.high.into());
        Datum::WholeOutOfRange { value, low, high }
    }
}

impl<T: Copy + PartialOrd + Into<u64> + TryFrom<u64>> Shape for Whole<T> {
    type Value = T;
    fn decode(&self, node: &Node, at: &Place<'_>, problems: &mut Problems) -> T {
        let Some(value) = read_number(node, at, problems, Expected::Whole) else {
            return self.low;
        };
        if value.fract() != 0.0 && value.is_finite() {
            decode::wrong_type(problems, node, at, Expected::Whole);
            return self.low;
        }
        let whole = (value >= 0.0).then_some(value as u64);
        let whole = whole.and_then(|whole| T::try_from(whole).ok());
        let whole = whole.filter(|whole| (self.low..=self.high).contains(whole));
        whole.unwrap_or_else(|| {
            problems.refuse(at, self.out_of_range(value));
            self.low
        })
    }
    fn fallback(&self) -> T {
        self.low
    }
    fn check(&self, value: &T, at: &Place<'_>, problems: &mut Problems) {
        if !(self.low..=self.high).contains(value) {
            let value: u64 = (*value).into();
            problems.refuse(at, self.out_of_range(value as f64));
        }
    }
    fn encode(&self, value: &T) -> Option<Data> {
        let value: u64 = (*value).into();
        Some(Data::Number(value as f64))
    }
    fn schema(&self) -> Data {
        let (low, high): (u64, u64) = (self.low.into(), self.high.into());
        Data::map([
            ("type", Data::text("integer")),
            ("minimum", Data::Number(low as f64)),
            ("maximum", Data::Number(high as f64)),
        ])
    }
}

/// A text that is not empty.
pub(crate) struct Text;

impl Shape for Text {
    type Value = String;
    fn decode(&self, node: &Node, at: &Place<'_>, problems: &mut Problems) -> String {
        match &node.value {
            Value::Scalar(scalar) if scalar.kind() == Kind::Text => scalar.text.clone(),
            _ => {
                decode::wrong_type(problems, node, at, Expected::Text);
                self.fallback()
            }
        }
    }
    fn fallback(&self) -> String {
        "unnamed".into()
    }
    fn check(&self, value: &String, at: &Place<'_>, problems: &mut Problems) {
        if value.is_empty() {
            problems.refuse(at, Datum::EmptyText);
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
    fn decode(&self, node: &Node, at: &Place<'_>, problems: &mut Problems) -> String {
        if let Value::Scalar(scalar) = &node.value
            && !matches!(scalar.kind(), Kind::Bool(_))
        {
            return scalar.text.clone();
        }
        decode::wrong_type(problems, node, at, Expected::Expression);
        self.fallback()
    }
    fn fallback(&self) -> String {
        "0".into()
    }
    fn check(&self, value: &String, at: &Place<'_>, problems: &mut Problems) {
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
