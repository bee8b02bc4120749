//! Names of values in the layout of registers.

use super::value::{BoolValue, Index, RealValue};
use super::{Affine, Builder};
use qrt_circuit::{Bit, RegisterId, Word};
use qrt_scene::sampling::Square;
use qrt_tracer::{Named, Quantity};
use std::fmt;

/// A value that the tracer has a name for.
#[derive(Clone, Copy, Debug)]
pub(super) enum Nameable {
    Real(RealValue),
    Bool(BoolValue),
    Index(Index),
}

/// A component of a value that the tracer has a name for.
#[derive(Clone, Copy, Debug)]
pub(super) struct NamedValue {
    pub(super) name: Named,
    /// The component of a vector: 0, 1 or 2.
    pub(super) component: usize,
    pub(super) value: Nameable,
}

/// A register, or a part of one, that the tracer has a name for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NamedPlace {
    /// The name of the value, and the ray that it belongs to.
    pub name: Named,
    /// The component of a vector: 0, 1 or 2.
    pub component: usize,
    /// The register that holds the value, and how it is read.
    pub place: ValuePlace,
}

impl NamedPlace {
    /// The component's name, if the value has several components.
    pub fn component_name(&self) -> Option<&'static str> {
        let names = match self.name.quantity {
            Quantity::Origin | Quantity::Direction => ["x", "y", "z"],
            Quantity::Throughput => ["r", "g", "b"],
            Quantity::Sample | Quantity::Lamp | Quantity::Lens => ["u", "v", ""],
            Quantity::Distance | Quantity::Face | Quantity::Found => return None,
        };
        names.get(self.component).copied()
    }
}

/// Writes a name like `ray1.direction.x`.
impl fmt::Display for NamedPlace {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Named { depth, quantity } = self.name;
        write!(f, "ray{depth}.{}", quantity.name())?;
        match self.component_name() {
            Some(component) => write!(f, ".{component}"),
            None => Ok(()),
        }
    }
}

/// The place of a named value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ValuePlace {
    /// `-1^negated word 2^-fraction + offset[0] + offset[1] column + offset[2] row`
    Number {
        /// The bits that are read.
        word: Word,
        /// True if the register holds the number's negative.
        negated: bool,
        /// The part outside the register, which is the same on all paths of a pixel: its constant,
        /// and its change per column and per row.
        offset: [f64; 3],
    },
    /// A truth value, by its bit.
    Truth(Bit),
    /// An unsigned integer, by its bits.
    Index(Word),
}

impl Builder<'_> {
    pub(super) fn name(&mut self, name: Named, values: impl IntoIterator<Item = Nameable>) {
        let values = values.into_iter().enumerate();
        self.names
            .extend(values.map(|(component, value)| NamedValue {
                name,
                component,
                value,
            }));
    }

    /// Named values that are in registers. A value is left out if it is in no register: a table
    /// replaces it, or it is the same on all paths.
    pub(super) fn named_places(&self) -> Vec<NamedPlace> {
        let samples = self.coordinates.iter().map(|(coordinate, &index)| {
            let quantity = match coordinate.square {
                Square::Ray => Quantity::Sample,
                Square::Light if coordinate.depth == 0 => Quantity::Lens,
                Square::Light => Quantity::Lamp,
            };
            let depth = coordinate.depth;
            let name = Named { depth, quantity };
            NamedValue {
                name,
                component: coordinate.axis as usize,
                value: Nameable::Index(index),
            }
        });
        let all = self.names.iter().copied().chain(samples);
        let placed = all.filter_map(|named| {
            Some(NamedPlace {
                name: named.name,
                component: named.component,
                place: self.place_of(named.value)?,
            })
        });
        let mut placed: Vec<_> = placed.collect();
        placed.sort_by_key(|named| (named.name, named.component));
        placed
    }

    fn place_of(&self, value: Nameable) -> Option<ValuePlace> {
        match value {
            Nameable::Real(real) => {
                let word = self.values[real.node? as usize].word?;
                let Affine { constant, along } = real.offset;
                Some(ValuePlace::Number {
                    word,
                    negated: real.negated,
                    offset: [constant, along[0], along[1]],
                })
            }
            Nameable::Bool(BoolValue::Node { node, inverted }) => {
                let bit = self.truths[node as usize].bit?;
                let inverted = bit.inverted != inverted;
                Some(ValuePlace::Truth(Bit { inverted, ..bit }))
            }
            Nameable::Index(Index::Node(node)) => {
                self.choices[node as usize].word.map(ValuePlace::Index)
            }
            Nameable::Bool(BoolValue::Constant(_)) | Nameable::Index(Index::Constant(_)) => None,
        }
    }
}

impl ValuePlace {
    /// The same place, with its register renamed by `rename`.
    pub(crate) fn renamed(self, rename: impl FnOnce(RegisterId) -> RegisterId) -> Self {
        match self {
            Self::Number {
                word,
                negated,
                offset,
            } => Self::Number {
                word: word.map_register(rename),
                negated,
                offset,
            },
            Self::Truth(bit) => Self::Truth(bit.map_register(rename)),
            Self::Index(word) => Self::Index(word.map_register(rename)),
        }
    }

    /// The register of which the place is a part.
    pub fn register(&self) -> RegisterId {
        match self {
            Self::Number { word, .. } | Self::Index(word) => word.register,
            Self::Truth(bit) => bit.register,
        }
    }
}
