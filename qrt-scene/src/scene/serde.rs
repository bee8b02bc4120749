//! Serde support for scenes and their parts, with the keys and shapes that they have in YAML.
//!
//! Serialization uses the encoder of YAML, and deserialization its decoder, so the two formats
//! cannot differ. An error has a scene's code and the path to the problem. It has no place in the
//! text: serde does not know it, unlike the front end of YAML.

use super::shape::Part;
use super::text::Data;
use crate::scene::invalid::InvalidScene;
use qrt_syntax::tree::{Entry, Node, Scalar, Span, Value};
use qrt_syntax::{Place, Problems, number};
use serde_core::de::{Deserializer, Error as _, MapAccess, SeqAccess, Visitor};
use serde_core::ser::{SerializeMap as _, SerializeSeq as _, Serializer};
use serde_core::{Deserialize, Serialize};
use std::fmt;
use std::sync::Arc;

impl Serialize for Data {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        /// Largest magnitude up to which every whole number is exact in `f64`.
        const MOST: f64 = (1_u64 << 53) as f64;
        match self {
            // The comparison of bits excludes -0.
            Self::Number(value)
                if value.abs() <= MOST && (*value as i64 as f64).to_bits() == value.to_bits() =>
            {
                serializer.serialize_i64(*value as i64)
            }
            Self::Number(value) => serializer.serialize_f64(*value),
            Self::Bool(value) => serializer.serialize_bool(*value),
            Self::Text(text) => serializer.serialize_str(text),
            Self::List(items) => {
                let mut list = serializer.serialize_seq(Some(items.len()))?;
                for item in items {
                    list.serialize_element(item)?;
                }
                list.end()
            }
            Self::Map(entries) => {
                let mut map = serializer.serialize_map(Some(entries.len()))?;
                for (key, value) in entries {
                    map.serialize_entry(key, value)?;
                }
                map.end()
            }
        }
    }
}

/// A deserialized value, as the tree that all front ends build.
struct Read(Value);

impl From<Read> for Node {
    fn from(Read(value): Read) -> Self {
        Self {
            span: Span::default(),
            value,
        }
    }
}

impl<'de> Deserialize<'de> for Read {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(Reader).map(Self)
    }
}

struct Reader;

fn scalar(text: String, quoted: bool) -> Value {
    Value::Scalar(Scalar { text, quoted })
}

impl<'de> Visitor<'de> for Reader {
    type Value = Value;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a part of a scene")
    }

    fn visit_bool<E>(self, value: bool) -> Result<Value, E> {
        Ok(scalar(value.to_string(), false))
    }
    fn visit_i64<E>(self, value: i64) -> Result<Value, E> {
        Ok(scalar(value.to_string(), false))
    }
    fn visit_u64<E>(self, value: u64) -> Result<Value, E> {
        Ok(scalar(value.to_string(), false))
    }
    fn visit_f64<E>(self, value: f64) -> Result<Value, E> {
        Ok(scalar(number(value), false))
    }
    fn visit_str<E>(self, text: &str) -> Result<Value, E> {
        Ok(scalar(text.to_owned(), true))
    }
    fn visit_unit<E>(self) -> Result<Value, E> {
        Ok(Value::Null)
    }
    fn visit_none<E>(self) -> Result<Value, E> {
        Ok(Value::Null)
    }
    fn visit_some<D: Deserializer<'de>>(self, deserializer: D) -> Result<Value, D::Error> {
        deserializer.deserialize_any(self)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Value, A::Error> {
        let mut items = Vec::new();
        while let Some(item) = list.next_element::<Read>()? {
            items.push(item.into());
        }
        Ok(Value::List(Arc::new(items)))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Value, A::Error> {
        let mut entries: Vec<Entry> = Vec::new();
        while let Some((key, value)) = map.next_entry::<String, Read>()? {
            if entries.iter().any(|entry| entry.key == key) {
                return Err(A::Error::custom(format_args!(
                    "the key `{key}` is there twice"
                )));
            }
            entries.push(Entry {
                key,
                key_span: Span::default(),
                value: value.into(),
            });
        }
        Ok(Value::Map(Arc::new(entries)))
    }
}

/// Reads a part, and checks the range of each of its values.
///
/// # Errors
/// Data of a type that scenes do not have, or all problems of the part, as [`InvalidScene`] shows
/// them.
pub(super) fn read<'de, T: Part, D: Deserializer<'de>>(deserializer: D) -> Result<T, D::Error> {
    let node: Node = Read::deserialize(deserializer)?.into();
    let mut problems = Problems::default();
    let part = T::decode(&node, &Place::ROOT, &mut problems);
    part.check(&Place::ROOT, &mut problems);
    let refused = |problems| D::Error::custom(InvalidScene::new(problems));
    problems.result(part).map_err(refused)
}

/// Implements both directions for a part.
macro_rules! part {
    ($name:ident) => {
        impl serde_core::Serialize for $name {
            fn serialize<S: serde_core::Serializer>(
                &self,
                serializer: S,
            ) -> Result<S::Ok, S::Error> {
                #[allow(unused_imports, reason = "a scene has an encoding of its own")]
                use $crate::scene::shape::Part as _;
                serde_core::Serialize::serialize(&self.encode(), serializer)
            }
        }

        impl<'de> serde_core::Deserialize<'de> for $name {
            fn deserialize<D: serde_core::Deserializer<'de>>(
                deserializer: D,
            ) -> Result<Self, D::Error> {
                $crate::scene::serde::read(deserializer)
            }
        }
    };
}

pub(crate) use part;
