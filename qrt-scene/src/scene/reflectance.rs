//! The reflectance of a surface: one colour, or a pattern of colours.

use super::record::{record, variant};
use super::shape::{Array, Colour, Part, Shape, number, part};
use super::text::Data;
use super::{LENGTH, Rgb};
use glam::DVec3;
use qrt_syntax::tree::{Node, Value};
use qrt_syntax::{Datum, Place, Problems};

/// The shape of one reflected colour.
pub(super) const REFLECTED: Colour =
    Colour(number(0.0, 1.0).or(|value, range| Datum::NotAlbedo { value, range }));

/// The shape of the two colours of a [`Checker`].
pub(super) const PAIR: Array<Colour, 2> = Array(REFLECTED);

variant! {
    /// Colours by the place on a surface.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub enum Pattern = "a pattern";
    /// Two colours in turn, in cubic cells.
    Checker(Checker) = "checker";
}

record! {
    /// Two colours in turn, in cubic cells along the scene's axes. One cell has a corner at the
    /// scene's origin, lies on the positive side of all axes, and has the first colour. A face that
    /// lies between two layers of cells has the colours of the layer with the greater coordinates.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct Checker = "a checker";
    /// The two colours, in linear RGB.
    pub of: [Rgb; 2] = PAIR;
    /// The length of a cell's edges, in scene units.
    pub scale: f64 = LENGTH;
}

/// The fraction of light that a surface reflects, in linear RGB, each in [0, 1].
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reflectance {
    /// The same everywhere.
    Uniform(Rgb),
    /// By the place on the surface.
    Patterned(Pattern),
}

impl Reflectance {
    /// The colours that it takes: one, or both of a checker.
    pub fn colours(&self) -> &[Rgb] {
        match self {
            Self::Uniform(colour) => std::slice::from_ref(colour),
            Self::Patterned(Pattern::Checker(checker)) => &checker.of,
        }
    }

    /// The checker, if it is one.
    pub fn checker(&self) -> Option<&Checker> {
        match self {
            Self::Uniform(_) => None,
            Self::Patterned(Pattern::Checker(checker)) => Some(checker),
        }
    }

    /// True if nothing is reflected anywhere.
    pub(crate) fn is_black(&self) -> bool {
        self.colours().iter().all(|colour| *colour == [0.0; 3])
    }
}

/// Greatest difference, in cells, of coordinates that count as equal.
const FLAT: f64 = 1e-6;

impl Checker {
    /// True if `floor(coordinate)` is odd, for a coordinate in cells.
    pub fn is_odd(coordinate: f64) -> bool {
        coordinate.floor().rem_euclid(2.0) == 1.0
    }

    /// By axis: the layer of cells of a face with these corners, if all of the face is in one. A face
    /// between two layers is in the one with the greater number.
    pub fn layers(&self, corners: &[DVec3]) -> [Option<f64>; 3] {
        std::array::from_fn(|axis| {
            let along = corners.iter().map(|corner| corner[axis] / self.scale);
            let low = along.clone().fold(f64::INFINITY, f64::min);
            let high = along.fold(f64::NEG_INFINITY, f64::max);
            let near = low.round();
            if high - low > FLAT {
                None
            } else if (low - near).abs() < FLAT {
                Some(near)
            } else {
                Some(low.floor())
            }
        })
    }
}

impl From<Rgb> for Reflectance {
    fn from(colour: Rgb) -> Self {
        Self::Uniform(colour)
    }
}

impl From<Checker> for Reflectance {
    fn from(checker: Checker) -> Self {
        Self::Patterned(checker.into())
    }
}

/// The shape of a [`Reflectance`]: a colour, or a map with the name of a pattern.
pub(super) struct ReflectanceShape;

impl Shape for ReflectanceShape {
    type Value = Reflectance;
    fn decode(&self, node: &Node, at: &Place<'_>, problems: &mut Problems) -> Reflectance {
        match &node.value {
            Value::Map(_) => Reflectance::Patterned(Pattern::decode(node, at, problems)),
            _ => REFLECTED.decode(node, at, problems).into(),
        }
    }
    fn fallback(&self) -> Reflectance {
        REFLECTED.fallback().into()
    }
    fn check(&self, value: &Reflectance, at: &Place<'_>, problems: &mut Problems) {
        match value {
            Reflectance::Uniform(colour) => REFLECTED.check(colour, at, problems),
            Reflectance::Patterned(pattern) => pattern.check(at, problems),
        }
    }
    fn encode(&self, value: &Reflectance) -> Option<Data> {
        match value {
            Reflectance::Uniform(colour) => REFLECTED.encode(colour),
            Reflectance::Patterned(pattern) => Some(pattern.encode()),
        }
    }
    fn schema(&self) -> Data {
        let mut shapes = REFLECTED.shapes();
        shapes.push(part::<Pattern>().schema());
        Data::map([("anyOf", Data::List(shapes))])
    }
}
