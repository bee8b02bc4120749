//! Shapes made of other shapes: lists, maps from names, values that may be left out.

use super::{Expression, LARGEST, Number, Shape, number};
use crate::scene::decode;
use crate::scene::text::Data;
use glam::DVec3;
use qrt_syntax::tree::{Entry, Found, Kind, Node, Value};
use qrt_syntax::{Datum, Expected, Material, Place, Problems, Structure, What};

/// A list of exactly `N` elements.
pub(crate) struct Array<S, const N: usize>(pub(crate) S);

impl<S: Shape, const N: usize> Array<S, N> {
    fn items(&self, node: &Node, at: &Place<'_>, problems: &mut Problems) -> Option<[S::Value; N]> {
        let Value::List(items) = &node.value else {
            decode::wrong_type(problems, node, at, Expected::Elements(N));
            return None;
        };
        let is_whole = items.iter().all(|item| item.value != Value::Unread);
        if items.len() != N && is_whole {
            let (expected, found) = (N, node.found());
            problems.refuse(at, Structure::WrongLength { expected, found });
        }
        Some(std::array::from_fn(|i| match items.get(i) {
            Some(item) => self.0.decode(item, &at.item(i), problems),
            None => self.0.fallback(),
        }))
    }
}

impl<S: Shape, const N: usize> Shape for Array<S, N> {
    type Value = [S::Value; N];
    fn decode(&self, node: &Node, at: &Place<'_>, problems: &mut Problems) -> Self::Value {
        self.items(node, at, problems)
            .unwrap_or_else(|| self.fallback())
    }
    fn fallback(&self) -> Self::Value {
        std::array::from_fn(|_| self.0.fallback())
    }
    fn check(&self, value: &Self::Value, at: &Place<'_>, problems: &mut Problems) {
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

/// A colour: red, green and blue, or one number, which is grey.
pub(crate) struct Colour(pub(crate) Number);

impl Colour {
    /// The schemas of a list and of a number.
    pub(crate) fn shapes(&self) -> Vec<Data> {
        vec![Array::<_, 3>(self.0).schema(), self.0.schema()]
    }
}

impl Shape for Colour {
    type Value = [f64; 3];
    fn decode(&self, node: &Node, at: &Place<'_>, problems: &mut Problems) -> [f64; 3] {
        if !matches!(&node.value, Value::Scalar(scalar) if matches!(scalar.kind(), Kind::Number(_)))
        {
            return Array::<_, 3>(self.0).decode(node, at, problems);
        }
        let value = self.0.decode(node, at, problems);
        let before = problems.count();
        // One number out of range is one problem, not one of each channel.
        self.0.check(&value, at, problems);
        if problems.count() > before {
            return self.fallback();
        }
        [value; 3]
    }
    fn fallback(&self) -> [f64; 3] {
        [self.0.fallback(); 3]
    }
    fn check(&self, value: &[f64; 3], at: &Place<'_>, problems: &mut Problems) {
        Array::<_, 3>(self.0).check(value, at, problems);
    }
    fn encode(&self, value: &[f64; 3]) -> Option<Data> {
        Array::<_, 3>(self.0).encode(value)
    }
    fn schema(&self) -> Data {
        Data::map([("anyOf", Data::List(self.shapes()))])
    }
}

/// Three numbers as a vector.
pub(crate) struct Vector(pub(crate) Number);

/// A point or an extent in scene units.
pub(crate) const fn point() -> Vector {
    Vector(number(-LARGEST, LARGEST))
}

impl Shape for Vector {
    type Value = DVec3;
    fn decode(&self, node: &Node, at: &Place<'_>, problems: &mut Problems) -> DVec3 {
        Array::<_, 3>(self.0).decode(node, at, problems).into()
    }
    fn fallback(&self) -> DVec3 {
        DVec3::splat(self.0.fallback())
    }
    fn check(&self, value: &DVec3, at: &Place<'_>, problems: &mut Problems) {
        Array::<_, 3>(self.0).check(&value.to_array(), at, problems);
    }
    fn encode(&self, value: &DVec3) -> Option<Data> {
        Array::<_, 3>(self.0).encode(&value.to_array())
    }
    fn schema(&self) -> Data {
        Array::<_, 3>(self.0).schema()
    }
}

/// A list of at least `least` elements.
pub(crate) struct List<S> {
    pub(crate) item: S,
    pub(crate) least: usize,
}

impl<S: Shape> Shape for List<S> {
    type Value = Vec<S::Value>;
    fn decode(&self, node: &Node, at: &Place<'_>, problems: &mut Problems) -> Self::Value {
        let Value::List(items) = &node.value else {
            let may_be_empty = self.least == 0;
            decode::wrong_type(problems, node, at, Expected::List { may_be_empty });
            return self.fallback();
        };
        let decode = |(i, item)| self.item.decode(item, &at.item(i), problems);
        items.iter().enumerate().map(decode).collect()
    }
    fn fallback(&self) -> Self::Value {
        (0..self.least).map(|_| self.item.fallback()).collect()
    }
    fn check(&self, value: &Self::Value, at: &Place<'_>, problems: &mut Problems) {
        if value.len() < self.least {
            problems.refuse(at, Datum::NoRay);
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
    fn decode(&self, node: &Node, at: &Place<'_>, problems: &mut Problems) -> Self::Value {
        let Value::Map(entries) = &node.value else {
            decode::wrong_type(problems, node, at, Expected::Named);
            return Vec::new();
        };
        let decode = |entry: &Entry| {
            let value = self.0.decode(&entry.value, &at.key(&entry.key), problems);
            (entry.key.clone(), value)
        };
        entries.iter().map(decode).collect()
    }
    fn fallback(&self) -> Self::Value {
        Vec::new()
    }
    fn check(&self, value: &Self::Value, at: &Place<'_>, problems: &mut Problems) {
        let mut seen = std::collections::HashSet::new();
        for (name, item) in value {
            if name.is_empty() {
                problems.refuse(at.path().name(""), Datum::EmptyName);
            }
            if !seen.insert(name) {
                let path = at.path().name(name.as_str());
                let name = name.clone();
                problems.refuse(path, Material::GivenTwice { name });
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
    fn decode(&self, node: &Node, at: &Place<'_>, problems: &mut Problems) -> Self::Value {
        Some(self.0.decode(node, at, problems))
    }
    fn fallback(&self) -> Self::Value {
        None
    }
    fn check(&self, value: &Self::Value, at: &Place<'_>, problems: &mut Problems) {
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

/// A value that an encoder leaves out if it is this one, its default.
pub(crate) struct Omitted<S: Shape>(pub(crate) S, pub(crate) S::Value);

impl<S: Shape> Shape for Omitted<S>
where
    S::Value: PartialEq,
{
    type Value = S::Value;
    fn decode(&self, node: &Node, at: &Place<'_>, problems: &mut Problems) -> Self::Value {
        self.0.decode(node, at, problems)
    }
    fn fallback(&self) -> Self::Value {
        self.0.fallback()
    }
    fn check(&self, value: &Self::Value, at: &Place<'_>, problems: &mut Problems) {
        self.0.check(value, at, problems);
    }
    fn encode(&self, value: &Self::Value) -> Option<Data> {
        self.0.encode(value).filter(|_| *value != self.1)
    }
    fn schema(&self) -> Data {
        self.0.schema()
    }
}

/// True if `node` is the word `auto`.
pub(crate) fn is_auto(node: &Node) -> bool {
    matches!(&node.value, Value::Scalar(scalar) if scalar.text == "auto")
}

impl<S: Shape> Shape for AutoOr<S> {
    type Value = Option<S::Value>;
    fn decode(&self, node: &Node, at: &Place<'_>, problems: &mut Problems) -> Self::Value {
        if is_auto(node) {
            return None;
        }
        let known = problems.count();
        let value = self.0.decode(node, at, problems);
        for problem in problems.since(known) {
            problem.what = What::OrAuto(Box::new(problem.what.clone()));
        }
        Some(value)
    }
    fn fallback(&self) -> Self::Value {
        None
    }
    fn check(&self, value: &Self::Value, at: &Place<'_>, problems: &mut Problems) {
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
    fn decode(&self, node: &Node, at: &Place<'_>, problems: &mut Problems) -> Vec<String> {
        match &node.value {
            Value::List(items) => {
                if !matches!(items.len(), 1 | 3) {
                    let found = node.found();
                    problems.refuse(at, Structure::WrongChannels { found });
                    return self.fallback();
                }
                let decode = |(i, item)| Expression.decode(item, &at.item(i), problems);
                items.iter().enumerate().map(decode).collect()
            }
            _ => vec![Expression.decode(node, at, problems)],
        }
    }
    fn fallback(&self) -> Vec<String> {
        vec![Expression.fallback()]
    }
    fn check(&self, value: &Vec<String>, at: &Place<'_>, problems: &mut Problems) {
        if !matches!(value.len(), 1 | 3) {
            let found = Found::List(value.len());
            problems.refuse(at, Structure::WrongChannels { found });
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
