//! The shapes that values of a scene have. A shape is one definition of how a value is read, what
//! range it has, how it is written and what the JSON Schema says of it.

use crate::codes;
use crate::front::tree::{Kind, Node, Value};
use crate::report::Problem;
use crate::scene::decode::{Decoder, Place};
use crate::scene::text::{Data, number as number_text};
use glam::DVec3;
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
        Data::map([(
            "enum",
            Data::List(T::NAMES.iter().map(|name| Data::text(*name)).collect()),
        )])
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

/// A list of exactly N.
pub(crate) struct Array<S, const N: usize>(pub(crate) S);

impl<S: Shape, const N: usize> Array<S, N> {
    fn items(&self, node: &Node, at: &Place<'_>, decoder: &mut Decoder) -> Option<[S::Value; N]> {
        let Value::List(items) = &node.value else {
            decoder.wrong_type(node, at, &format!("a list of {N}"), None);
            return None;
        };
        if items.len() != N {
            let message = format!("expected a list of {N}, found {}", node.found());
            let problem = Problem::new(codes::WRONG_LENGTH, at.path(), message)
                .label(format!("must have {N} elements"));
            decoder.replace(at, problem);
        }
        Some(std::array::from_fn(|i| match items.get(i) {
            Some(item) => self.0.decode(item, &at.item(i), decoder),
            None => self.0.fallback(),
        }))
    }
}

impl<S: Shape, const N: usize> Shape for Array<S, N> {
    type Value = [S::Value; N];
    fn decode(&self, node: &Node, at: &Place<'_>, decoder: &mut Decoder) -> Self::Value {
        self.items(node, at, decoder)
            .unwrap_or_else(|| self.fallback())
    }
    fn fallback(&self) -> Self::Value {
        std::array::from_fn(|_| self.0.fallback())
    }
    fn check(&self, value: &Self::Value, at: &Place<'_>, problems: &mut Vec<Problem>) {
        for (i, item) in value.iter().enumerate() {
            self.0.check(item, &at.item(i), problems);
        }
    }
    fn encode(&self, value: &Self::Value) -> Option<Data> {
        Some(Data::List(
            value
                .iter()
                .filter_map(|item| self.0.encode(item))
                .collect(),
        ))
    }
    fn schema(&self) -> Data {
        list_schema(self.0.schema(), N, Some(N))
    }
}

fn list_schema(items: Data, least: usize, most: Option<usize>) -> Data {
    let mut schema = Data::map([
        ("type", Data::text("array")),
        ("items", items),
        ("minItems", Data::Number(least as f64)),
    ]);
    if let Some(most) = most {
        schema = schema.with("maxItems", Data::Number(most as f64));
    }
    schema
}

/// Three numbers as a vector.
pub(crate) struct Vector(pub(crate) Number);

/// A point or an extent in scene units.
pub(crate) const fn point() -> Vector {
    Vector(number(-LARGEST, LARGEST))
}

impl Shape for Vector {
    type Value = DVec3;
    fn decode(&self, node: &Node, at: &Place<'_>, decoder: &mut Decoder) -> DVec3 {
        Array::<_, 3>(self.0).decode(node, at, decoder).into()
    }
    fn fallback(&self) -> DVec3 {
        DVec3::splat(self.0.fallback())
    }
    fn check(&self, value: &DVec3, at: &Place<'_>, problems: &mut Vec<Problem>) {
        Array::<_, 3>(self.0).check(&value.to_array(), at, problems);
    }
    fn encode(&self, value: &DVec3) -> Option<Data> {
        Array::<_, 3>(self.0).encode(&value.to_array())
    }
    fn schema(&self) -> Data {
        Array::<_, 3>(self.0).schema()
    }
}

/// A list of any length from a least one.
pub(crate) struct List<S> {
    pub(crate) item: S,
    pub(crate) least: usize,
    /// The code and the words for fewer.
    pub(crate) fewer: (&'static str, &'static str),
}

impl<S: Shape> Shape for List<S> {
    type Value = Vec<S::Value>;
    fn decode(&self, node: &Node, at: &Place<'_>, decoder: &mut Decoder) -> Self::Value {
        let Value::List(items) = &node.value else {
            let help = (node.value == Value::Null && self.least == 0)
                .then(|| "write `[]` for an empty list".to_owned());
            decoder.wrong_type(node, at, "a list", help);
            return self.fallback();
        };
        let decode = |(i, item)| self.item.decode(item, &at.item(i), decoder);
        items.iter().enumerate().map(decode).collect()
    }
    fn fallback(&self) -> Self::Value {
        (0..self.least).map(|_| self.item.fallback()).collect()
    }
    fn check(&self, value: &Self::Value, at: &Place<'_>, problems: &mut Vec<Problem>) {
        if value.len() < self.least {
            let (code, message) = self.fewer;
            problems.push(Problem::new(code, at.path(), message));
        }
        for (i, item) in value.iter().enumerate() {
            self.item.check(item, &at.item(i), problems);
        }
    }
    fn encode(&self, value: &Self::Value) -> Option<Data> {
        Some(Data::List(
            value
                .iter()
                .filter_map(|item| self.item.encode(item))
                .collect(),
        ))
    }
    fn schema(&self) -> Data {
        list_schema(self.item.schema(), self.least, None)
    }
}

/// A map from names to values, in the order written.
pub(crate) struct Named<S>(pub(crate) S);

impl<S: Shape> Shape for Named<S> {
    type Value = Vec<(String, S::Value)>;
    fn decode(&self, node: &Node, at: &Place<'_>, decoder: &mut Decoder) -> Self::Value {
        let Value::Map(entries) = &node.value else {
            let help = (node.value == Value::Null).then(|| "write `{}` for none".to_owned());
            decoder.wrong_type(node, at, "a map from names", help);
            return Vec::new();
        };
        let decode = |entry: &crate::front::tree::Entry| {
            let value = self.0.decode(&entry.value, &at.key(&entry.key), decoder);
            (entry.key.clone(), value)
        };
        entries.iter().map(decode).collect()
    }
    fn fallback(&self) -> Self::Value {
        Vec::new()
    }
    fn check(&self, value: &Self::Value, at: &Place<'_>, problems: &mut Vec<Problem>) {
        let mut seen = std::collections::HashSet::new();
        for (name, item) in value {
            if name.is_empty() {
                let what = "this name is empty";
                problems.push(Problem::new(codes::EMPTY_NAME, at.path().name(""), what));
            }
            if !seen.insert(name) {
                let message = format!("the name `{name}` is given twice");
                let path = at.path().name(name.as_str());
                problems.push(Problem::new(codes::DUPLICATE_NAME, path, message));
            }
            self.0.check(item, &at.key(name), problems);
        }
    }
    fn encode(&self, value: &Self::Value) -> Option<Data> {
        let encode = |(name, item): &(String, S::Value)| Some((name.clone(), self.0.encode(item)?));
        Some(Data::Map(value.iter().filter_map(encode).collect()))
    }
    fn schema(&self) -> Data {
        let names = Data::map([("minLength", Data::Number(1.0))]);
        Data::map([
            ("type", Data::text("object")),
            ("propertyNames", names),
            ("additionalProperties", self.0.schema()),
        ])
    }
}

/// A value that may be left out.
pub(crate) struct Maybe<S>(pub(crate) S);

impl<S: Shape> Shape for Maybe<S> {
    type Value = Option<S::Value>;
    fn decode(&self, node: &Node, at: &Place<'_>, decoder: &mut Decoder) -> Self::Value {
        Some(self.0.decode(node, at, decoder))
    }
    fn fallback(&self) -> Self::Value {
        None
    }
    fn check(&self, value: &Self::Value, at: &Place<'_>, problems: &mut Vec<Problem>) {
        if let Some(value) = value {
            self.0.check(value, at, problems);
        }
    }
    fn encode(&self, value: &Self::Value) -> Option<Data> {
        value.as_ref().and_then(|value| self.0.encode(value))
    }
    fn schema(&self) -> Data {
        self.0.schema()
    }
}

/// `auto`, or a value.
pub(crate) struct AutoOr<S>(pub(crate) S);

/// Whether `node` is the word `auto`.
pub(crate) fn is_auto(node: &Node) -> bool {
    matches!(&node.value, Value::Scalar(scalar) if scalar.text == "auto")
}

impl<S: Shape> Shape for AutoOr<S> {
    type Value = Option<S::Value>;
    fn decode(&self, node: &Node, at: &Place<'_>, decoder: &mut Decoder) -> Self::Value {
        if is_auto(node) {
            return None;
        }
        let problems = decoder.problems.len();
        let value = self.0.decode(node, at, decoder);
        for problem in &mut decoder.problems[problems..] {
            problem
                .help
                .get_or_insert_with(|| "or write `auto`".to_owned());
        }
        Some(value)
    }
    fn fallback(&self) -> Self::Value {
        None
    }
    fn check(&self, value: &Self::Value, at: &Place<'_>, problems: &mut Vec<Problem>) {
        if let Some(value) = value {
            self.0.check(value, at, problems);
        }
    }
    fn encode(&self, value: &Self::Value) -> Option<Data> {
        match value {
            Some(value) => self.0.encode(value),
            None => Some(Data::text("auto")),
        }
    }
    fn schema(&self) -> Data {
        let auto = Data::map([("const", Data::text("auto"))]);
        Data::map([("anyOf", Data::List(vec![auto, self.0.schema()]))])
    }
}

/// One expression, or a list of one or of three.
pub(crate) struct Channels;

impl Shape for Channels {
    type Value = Vec<String>;
    fn decode(&self, node: &Node, at: &Place<'_>, decoder: &mut Decoder) -> Vec<String> {
        match &node.value {
            Value::List(items) => {
                if !matches!(items.len(), 1 | 3) {
                    let message =
                        format!("expected one expression or three, found {}", node.found());
                    let problem = Problem::new(codes::WRONG_LENGTH, at.path(), message)
                        .help("one expression means grey; three are red, green and blue");
                    decoder.replace(at, problem);
                    return self.fallback();
                }
                let decode = |(i, item)| Expression.decode(item, &at.item(i), decoder);
                items.iter().enumerate().map(decode).collect()
            }
            _ => vec![Expression.decode(node, at, decoder)],
        }
    }
    fn fallback(&self) -> Vec<String> {
        vec![Expression.fallback()]
    }
    fn check(&self, value: &Vec<String>, at: &Place<'_>, problems: &mut Vec<Problem>) {
        if !matches!(value.len(), 1 | 3) {
            let message = format!("expected one expression or three, found {}", value.len());
            problems.push(Problem::new(codes::WRONG_LENGTH, at.path(), message));
        }
        for (i, item) in value.iter().enumerate() {
            Expression.check(item, &at.item(i), problems);
        }
    }
    fn encode(&self, value: &Vec<String>) -> Option<Data> {
        Some(Data::List(
            value
                .iter()
                .filter_map(|item| Expression.encode(item))
                .collect(),
        ))
    }
    fn schema(&self) -> Data {
        let expression = Expression.schema();
        let lists = [1, 3].map(|n| list_schema(expression.clone(), n, Some(n)));
        let [one, three] = lists;
        Data::map([("anyOf", Data::List(vec![expression, one, three]))])
    }
}

/// The schema of a record: its keys, those that must be there, and no others.
pub(crate) fn record_schema(
    doc: &str,
    fields: Vec<(&str, &str, bool, Data, Option<Data>)>,
) -> Data {
    let mut properties = Vec::new();
    let mut required = Vec::new();
    for (name, doc, is_required, shape, default) in fields {
        let mut schema = described(doc, shape);
        if let Some(default) = default {
            schema = schema.with("default", default);
        }
        properties.push((name.to_owned(), schema));
        if is_required {
            required.push(Data::text(name));
        }
    }
    let schema = Data::map([
        ("description", Data::text(doc.trim())),
        ("type", Data::text("object")),
        ("properties", Data::Map(properties)),
    ]);
    let schema = if required.is_empty() {
        schema
    } else {
        schema.with("required", Data::List(required))
    };
    schema.with("additionalProperties", Data::Bool(false))
}

/// The schema of a variant: a map with exactly one of the keys.
pub(crate) fn variant_schema(doc: &str, kinds: Vec<(&str, &str, Data)>) -> Data {
    let properties = kinds.into_iter();
    let properties = properties.map(|(name, doc, part)| (name.to_owned(), described(doc, part)));
    Data::map([
        ("description", Data::text(doc.trim())),
        ("type", Data::text("object")),
        ("properties", Data::Map(properties.collect())),
        ("additionalProperties", Data::Bool(false)),
        ("minProperties", Data::Number(1.0)),
        ("maxProperties", Data::Number(1.0)),
    ])
}

/// `schema` with `doc` as its description, in place of its own.
fn described(doc: &str, schema: Data) -> Data {
    let mut entries = vec![("description".to_owned(), Data::text(doc.trim()))];
    if let Data::Map(own) = schema {
        entries.extend(own.into_iter().filter(|(key, _)| key != "description"));
    }
    Data::Map(entries)
}
