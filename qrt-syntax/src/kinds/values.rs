//! Problems with the structure of a scene, and with single values.

use super::{Names, called, listed, meant, nearest, number, shorten, without_article};
use crate::tree::{Found, Kind, Scalar};
use std::fmt;

problems! {
    /// Problems with a scene's structure: keys, and the kinds of their values.
    Structure {
        WrongType { expected: Expected, found: Found } = WRONG_TYPE
            "expected {expected}, found {found}"
            label { format!("not {}", expected.kind()) } help { expected.help(found) };
        WrongLength { expected: usize, found: Found } = WRONG_LENGTH
            "expected a list of {expected}, found {found}" label "must have {expected} elements";
        WrongChannels { found: Found } = WRONG_LENGTH "expected one expression or three, found {found}"
            help "one expression means grey; three are red, green and blue";
        UnknownKey { key: String, noun: &'static str, keys: Vec<&'static str> } = UNKNOWN_KEY
            { format!("unknown key `{}` in {noun}", shorten(key)) }
            help { called(noun, key, keys).or_else(|| meant(key, keys)).or_else(|| {
                Some(format!("the keys of {noun} are {}", listed(keys, "and")))
            }) };
        MissingKeys { noun: &'static str, keys: Vec<&'static str> } = MISSING_KEY
            { format!("{noun} lacks {}", listed(keys, "and")) }
            label { format!("{} missing here", listed(keys, "and")) };
        NoFile = MISSING_KEY "a mesh lacks its file" label "`obj`, `ply` or `gltf` missing here"
            help "write `obj: mesh.obj`, `ply: mesh.ply` or `gltf: mesh.glb`";
        SecondFile { first: &'static str, second: &'static str } = ONE_VARIANT
            "a mesh has one file, found `{first}` and `{second}`"
            help "write a mesh for each file" also "the other file";
        NotOneKind { noun: &'static str, count: usize, known: Option<String>, kinds: Names }
            = ONE_VARIANT "{noun} is of exactly one kind, found {count} keys"
            help { Some(match known {
                Some(known) => format!("keep one key; what describes the `{known}` goes inside its map"),
                None => format!("write one of the keys {}", listed(kinds, "or")),
            }) };
        UnknownKind { name: String, noun: &'static str, kinds: Names } = UNKNOWN_VARIANT
            { format!("no kind of {} is called `{}`", without_article(noun), shorten(name)) }
            help { called(noun, name, kinds).or_else(|| meant(name, kinds)).or_else(|| Some(format!("there are {}", listed(kinds, "and")))) };
        UnknownWord { word: String, noun: &'static str, words: Names } = UNKNOWN_WORD
            { format!("no {} is called `{}`", without_article(noun), shorten(word)) }
            help { called(noun, word, words).or_else(|| meant(word, words)).or_else(|| Some(format!("write {}", listed(words, "or")))) };
    }

    /// Problems with a single value.
    Datum {
        Unrepresentable { text: String, is_small: bool } = UNREPRESENTABLE
            { format!("{text} is too {} for 64 bits", if *is_small { "small" } else { "large" }) };
        NotFinite { value: f64 } = NOT_FINITE { format!("{} is not a finite number", number(*value)) };
        OutOfRange { value: f64, range: Range } = OUT_OF_RANGE
            { format!("{} is out of range", number(*value)) } label "must be {range}";
        NotAlbedo { value: f64, range: Range } = ALBEDO
            { format!("{} is not an albedo or reflectance", number(*value)) } label "must be {range}";
        NotRadiance { value: f64, range: Range } = RADIANCE
            { format!("{} is not a radiance", number(*value)) } label "must be {range}";
        WholeOutOfRange { value: f64, low: u64, high: u64 } = OUT_OF_RANGE
            { format!("{} is out of range", number(*value)) }
            label "must be a whole number from {low} to {high}";
        EmptyText = EMPTY_NAME "this text is empty";
        EmptyName = EMPTY_NAME "this name is empty";
        NoRay = NO_DEPTH "a path has at least one ray";
    }
}

/// The kind of value that is expected at a place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Expected {
    Number,
    Whole,
    Text,
    Expression,
    Elements(usize),
    List {
        may_be_empty: bool,
    },
    Named,
    Record {
        noun: &'static str,
        keys: Vec<&'static str>,
    },
    Variant {
        noun: &'static str,
        kinds: Names,
    },
    Word {
        noun: &'static str,
        words: Names,
    },
}

impl fmt::Display for Expected {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Record { noun, .. } | Self::Variant { noun, .. } => write!(f, "{noun} (a map)"),
            Self::Word { noun, .. } => write!(f, "{noun} (a word)"),
            _ => f.write_str(&self.kind()),
        }
    }
}

impl Expected {
    /// Returns the expected kind of value in words.
    fn kind(&self) -> String {
        match self {
            Self::Number => "a number",
            Self::Whole => "a whole number",
            Self::Text => "a text",
            Self::Expression => "an expression",
            Self::Elements(count) => return format!("a list of {count}"),
            Self::List { .. } => "a list",
            Self::Named => "a map from names",
            Self::Record { .. } | Self::Variant { .. } => "a map",
            Self::Word { .. } => "a word",
        }
        .to_owned()
    }

    fn help(&self, found: &Found) -> Option<String> {
        let bare = |scalar: &Scalar| Scalar {
            quoted: false,
            ..scalar.clone()
        };
        match (self, found) {
            (Self::Number | Self::Whole, Found::Scalar(scalar))
                if scalar.quoted && matches!(bare(scalar).kind(), Kind::Number(_)) =>
            {
                Some("remove the quotes".to_owned())
            }
            (Self::Text, Found::Scalar(scalar)) => {
                Some(format!("put it in quotes: \"{}\"", scalar.text))
            }
            (Self::List { may_be_empty: true }, Found::Nothing) => {
                Some("write `[]` for an empty list".to_owned())
            }
            (Self::Named, Found::Nothing) => Some("write `{}` for none".to_owned()),
            (Self::Record { keys, .. }, _) => {
                Some(format!("write a map with {}", listed(keys, "and")))
            }
            (Self::Variant { kinds, .. }, found) => Some(match found {
                Found::Scalar(scalar)
                    if let Some(kind) = nearest(&scalar.text, kinds.iter().copied()) =>
                {
                    format!("write a map: `{{ {kind}: {{ ... }} }}`")
                }
                _ => format!("write a map with one of the keys {}", listed(kinds, "or")),
            }),
            (Self::Word { words, .. }, _) => Some(format!("write {}", listed(words, "or"))),
            _ => None,
        }
    }
}

/// A range of numbers, of which each end may be excluded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Range {
    pub low: f64,
    pub low_open: bool,
    pub high: f64,
    pub high_open: bool,
}

impl fmt::Display for Range {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (low, high) = (number(self.low), number(self.high));
        match (self.low_open, self.high_open) {
            (false, false) => write!(f, "from {low} to {high}"),
            (true, false) => write!(f, "above {low} and at most {high}"),
            (false, true) => write!(f, "at least {low} and below {high}"),
            (true, true) => write!(f, "above {low} and below {high}"),
        }
    }
}
