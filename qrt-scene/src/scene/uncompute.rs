//! Strategies of uncomputing work registers, and their names.
//!
//! A name other than `keep`, `scoped`, `auto` and `pebbled` lists parts of the work, such as `plane-products`.
//! `compile/strategy.rs` defines what each part uncomputes.

use super::shape::Shape;
use super::text::Data;
use crate::scene::decode;
use qrt_syntax::tree::{Node, Value};
use qrt_syntax::{Place, Problems, Structure};
use std::fmt;
use std::sync::LazyLock;

/// A strategy that decides when work registers are uncomputed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Uncompute {
    /// All at the end: fewest gates, most qubits.
    Keep,
    /// After each part of the tracer: fewer qubits, more gates.
    Scoped,
    /// Chooses the strategy with the fewest gates within `budget.qubits`.
    Auto,
    /// In the order with the fewest qubits that a search finds.
    Pebbled,
    /// Some of the parts early, and the others at the end.
    Parts(UncomputedParts),
}

/// A set of parts of the work that are uncomputed early, other than the sets of `keep` and
/// `scoped`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct UncomputedParts {
    /// A bit for each of [`UNCOMPUTE_PARTS`].
    parts: u16,
    again: Recomputed,
}

/// Values that are recomputed rather than kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Recomputed {
    /// Nothing.
    Nothing,
    /// Cheap values.
    Cheap,
    /// Cheap values, and the values from which they are computed.
    Sources,
    /// Any values, where that saves qubits.
    Any,
}

/// Names that stand alone, with their meanings.
const WORDS: [(Uncompute, &str, &str); 4] = [
    (
        Uncompute::Keep,
        "keep",
        "All at the end: fewest gates, most qubits.",
    ),
    (
        Uncompute::Scoped,
        "scoped",
        "After each part of the tracer: fewer qubits, more gates.",
    ),
    (
        Uncompute::Auto,
        "auto",
        "As much as `budget.qubits` asks for, at the fewest gates.",
    ),
    (
        Uncompute::Pebbled,
        "pebbled",
        "In the order with the fewest qubits that a search finds, for circuits of up to 64 operations.",
    ),
];

/// Names of the parts that may be uncomputed early, by bit.
pub const UNCOMPUTE_PARTS: [&str; 9] = [
    "plane",
    "products",
    "ray",
    "search",
    "tables",
    "quotients",
    "body",
    "shading",
    "component",
];
const ALL_PARTS: u16 = (1 << UNCOMPUTE_PARTS.len()) - 1;
/// The parts that leave garbage. Strategies that recompute values always include them.
const GARBAGE: u16 = 1 << 1 | 1 << 4 | 1 << 5;
/// The parts of `scoped`: all but convex bodies.
const SCOPED: u16 = ALL_PARTS & !(1 << 6);
const RECOMPUTE: &str = "recompute";
const RERUN: &str = "rerun";

/// All words of names: those of [`WORDS`], which stand alone, the parts, and the two for
/// recomputation.
const NAMES: &[&str] = &{
    let mut names = [RERUN; WORDS.len() + UNCOMPUTE_PARTS.len() + 2];
    let (alone, rest) = names.split_at_mut(WORDS.len());
    let (parts, again) = rest.split_at_mut(UNCOMPUTE_PARTS.len());
    let mut word = 0;
    while word < WORDS.len() {
        alone[word] = WORDS[word].1;
        word += 1;
    }
    parts.copy_from_slice(&UNCOMPUTE_PARTS);
    again[0] = RECOMPUTE;
    names
};
const NOUN: &str = "a strategy";

impl Uncompute {
    /// Returns the strategy that uncomputes `parts`, by bit, and recomputes `again`.
    pub fn of_parts(parts: u16, again: Recomputed) -> Self {
        match (parts, again) {
            (0, Recomputed::Nothing) => Self::Keep,
            (SCOPED, Recomputed::Nothing) => Self::Scoped,
            (_, Recomputed::Any) => Self::Pebbled,
            (parts, Recomputed::Nothing) => Self::Parts(UncomputedParts { parts, again }),
            (parts, again) => Self::Parts(UncomputedParts {
                parts: parts | GARBAGE,
                again,
            }),
        }
    }

    /// Returns the parts, by bit, and the values to recompute; `None` for `auto`.
    pub fn parts(self) -> Option<(u16, Recomputed)> {
        match self {
            Self::Keep => Some((0, Recomputed::Nothing)),
            Self::Scoped => Some((SCOPED, Recomputed::Nothing)),
            Self::Auto => None,
            Self::Pebbled => Some((SCOPED, Recomputed::Any)),
            Self::Parts(UncomputedParts { parts, again }) => Some((parts, again)),
        }
    }

    /// Returns the strategy's name in a scene, such as `keep`, or `plane-products` for listed
    /// parts.
    pub fn name(self) -> &'static str {
        static LISTED: LazyLock<Vec<String>> = LazyLock::new(|| {
            let parts = 0..=ALL_PARTS;
            let again = [Recomputed::Nothing, Recomputed::Cheap, Recomputed::Sources];
            parts
                .flat_map(|parts| again.map(|again| listed(parts, again)))
                .collect()
        });
        let word = WORDS.iter().find(|(value, ..)| *value == self);
        match (word, self) {
            (Some((_, name, _)), _) => name,
            (None, Self::Parts(UncomputedParts { parts, again })) => LISTED
                .get(3 * usize::from(parts) + again as usize)
                .map_or("", String::as_str),
            (None, _) => "",
        }
    }

    /// Returns the strategy called `name`, with its parts in any order; `None` if there is none.
    ///
    /// ```
    /// use qrt_scene::Uncompute;
    /// let named = Uncompute::from_name("products-plane").unwrap();
    /// assert_eq!(named.name(), "plane-products");
    /// assert_eq!(Uncompute::from_name("plane-floor"), None);
    /// ```
    pub fn from_name(name: &str) -> Option<Self> {
        if let Some((value, ..)) = WORDS.iter().find(|(_, word, _)| *word == name) {
            return Some(*value);
        }
        let (mut parts, mut again) = (0, Recomputed::Nothing);
        for word in name.split('-') {
            match UNCOMPUTE_PARTS.iter().position(|part| *part == word) {
                Some(bit) => parts |= 1 << bit,
                None if word == RECOMPUTE => again = again.max(Recomputed::Cheap),
                None if word == RERUN => again = Recomputed::Sources,
                None => return None,
            }
        }
        Some(Self::of_parts(parts, again))
    }
}

/// Returns the name of `parts` and `again`. Recomputation implies the parts of [`GARBAGE`], so the
/// name omits them.
fn listed(parts: u16, again: Recomputed) -> String {
    let (shown, last) = match again {
        Recomputed::Nothing => (parts, None),
        Recomputed::Cheap => (parts & !GARBAGE, Some(RECOMPUTE)),
        Recomputed::Sources | Recomputed::Any => (parts & !GARBAGE, Some(RERUN)),
    };
    let names = UNCOMPUTE_PARTS.iter().enumerate();
    let names = names.filter(|(bit, _)| shown >> bit & 1 == 1);
    let names: Vec<&str> = names.map(|(_, name)| *name).chain(last).collect();
    names.join("-")
}

impl fmt::Display for Uncompute {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// The shape of an [`Uncompute`].
pub(super) struct UncomputeShape;

impl Shape for UncomputeShape {
    type Value = Uncompute;

    fn decode(&self, node: &Node, at: &Place<'_>, problems: &mut Problems) -> Uncompute {
        let found = match &node.value {
            Value::Scalar(scalar) => Uncompute::from_name(&scalar.text),
            _ => None,
        };
        found.unwrap_or_else(|| {
            match &node.value {
                // Report the unknown one of several words.
                Value::Scalar(scalar) if scalar.text.contains('-') => {
                    let mut words = scalar.text.split('-');
                    let unknown = words.find(|word| !NAMES[WORDS.len()..].contains(word));
                    problems.refuse(
                        at,
                        Structure::UnknownWord {
                            word: unknown.unwrap_or_default().to_owned(),
                            noun: "a part of a strategy",
                            words: &NAMES[WORDS.len()..],
                        },
                    );
                }
                _ => {
                    decode::word(problems, node, at, NOUN, NAMES);
                }
            }
            self.fallback()
        })
    }

    fn fallback(&self) -> Uncompute {
        Uncompute::Keep
    }

    fn check(&self, _: &Uncompute, _: &Place<'_>, _: &mut Problems) {}

    fn encode(&self, value: &Uncompute) -> Option<Data> {
        Some(Data::text(value.name()))
    }

    fn schema(&self) -> Data {
        let texts = |texts: [&str; WORDS.len()]| Data::List(texts.map(Data::text).to_vec());
        let words = Data::map([
            ("enum", texts(WORDS.map(|(_, word, _)| word))),
            (
                "enumDescriptions",
                texts(WORDS.map(|(.., meaning)| meaning)),
            ),
        ]);
        let part = NAMES[WORDS.len()..].join("|");
        let listed = Data::map([
            ("type", Data::text("string")),
            ("pattern", Data::text(format!("^({part})(-({part}))*$"))),
        ]);
        Data::map([("anyOf", Data::List(vec![words, listed]))])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn every_strategy_has_a_name_of_its_own_that_names_it() {
        let mut names = BTreeSet::new();
        for parts in 0..=ALL_PARTS {
            for again in [Recomputed::Nothing, Recomputed::Cheap, Recomputed::Sources] {
                let strategy = Uncompute::of_parts(parts, again);
                assert_eq!(Uncompute::from_name(strategy.name()), Some(strategy));
                names.insert(strategy.name());
            }
        }
        // 512 sets of parts, and two for each choice of the six parts that leave no garbage.
        assert_eq!(names.len(), 512 + 2 * 64);
        assert!(names.contains("keep") && names.contains("scoped"));
        assert!(names.contains("plane-ray-recompute") && names.contains("rerun"));
    }

    #[test]
    fn other_words_name_none() {
        for name in [
            "",
            "-",
            "plane-",
            "-plane",
            "keep-plane",
            "auto-plane",
            "Plane",
            "plane products",
            "plane--ray",
            "planes",
            "recompute-keep",
        ] {
            assert_eq!(Uncompute::from_name(name), None, "{name}");
        }
        assert_eq!(
            Uncompute::from_name("plane-plane"),
            Uncompute::from_name("plane")
        );
        assert_eq!(
            Uncompute::from_name("rerun-recompute"),
            Uncompute::from_name("rerun")
        );
    }
}
