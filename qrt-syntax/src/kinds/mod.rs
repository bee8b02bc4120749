//! The kinds of problems, by concept: each has a code, arguments and a message to the author of a
//! scene's text. The macro `qrt!` matches the variants to word some of them differently.

#![allow(
    missing_docs,
    reason = "a variant is documented by its words, an argument by its name"
)]

use super::name::{listed, nearest};
use super::number::{grouped, number, rounded};
use super::other_names::called;
use super::tree::shorten;
use std::fmt;

/// A problem in words.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Description {
    /// The stable code of the problem: `QRT0101`.
    pub code: &'static str,
    /// The problem in one sentence, without a full stop.
    pub message: String,
    /// The label beside the caret; may be empty.
    pub label: String,
    /// The suggested fix; `None` if there is none.
    pub help: Option<String>,
    /// The label of the second place, such as "first written here"; may be empty.
    pub also: &'static str,
}

/// Expands to a text: the formatted literal `"a {text}"`, or the expression in `{ .. }`.
macro_rules! text {
    () => { String::new() };
    ($text:literal) => { format!($text) };
    ({ $($text:tt)* }) => { { $($text)* } };
}

/// Expands to an optional help: none, a formatted literal, or the expression in `{ .. }`.
macro_rules! help {
    () => { None };
    ($text:literal) => { Some(format!($text)) };
    ({ $($text:tt)* }) => { { $($text)* } };
}

/// Expands to a code: the one of that name, or the result of the block in `{ .. }`.
macro_rules! code {
    ({ $($code:tt)* }) => { { $($code)* } };
    ($code:ident) => { $crate::codes::$code };
}

/// Defines an enum per concept, with a variant for each of its problems.
macro_rules! problems {
    ($(
        $(#[$doc:meta])*
        $concept:ident {
            $(
                $problem:ident $({ $($argument:ident: $type:ty),* $(,)? })? = $code:tt $message:tt
                $(label $label:tt)? $(help $help:tt)? $(also $also:literal)?;
            )*
        }
    )*) => { $(
        $(#[$doc])*
        #[derive(Clone, Debug, PartialEq)]
        pub enum $concept {
            $( $problem $({ $($argument: $type),* })?, )*
        }

        impl $concept {
            /// Returns the problem in words, for the author of a scene's text.
            #[allow(
                unused_variables,
                clippy::useless_format,
                reason = "a problem may have no fields, or a message that shows none"
            )]
            pub fn description(&self) -> super::Description {
                match self {
                    $( Self::$problem $({ $($argument),* })? => super::Description {
                        code: code!($code),
                        message: text!($message),
                        label: text!($($label)?),
                        help: help!($($help)?),
                        also: concat!($($also)?),
                    }, )*
                }
            }
        }
    )* };
}

macro_rules! what {
    ($($concept:ident)*) => {
        /// A problem by concept, with its arguments.
        #[derive(Clone, Debug, PartialEq)]
        pub enum What {
            $( $concept($concept), )*
            /// A problem of another file, at a place there.
            OfFile { what: Box<What>, place: String },
            /// A problem with a value that may also be `auto`.
            OrAuto(Box<What>),
        }

        impl What {
            /// Returns the problem in words, for the author of a scene's text.
            pub fn description(&self) -> Description {
                match self {
                    $( Self::$concept(what) => what.description(), )*
                    Self::OfFile { what, place } => Description {
                        label: place.clone(),
                        ..what.description()
                    },
                    Self::OrAuto(what) => {
                        let mut words = what.description();
                        words.help.get_or_insert_with(|| "or write `auto`".to_owned());
                        words
                    }
                }
            }
        }

        $( impl From<$concept> for What {
            fn from(what: $concept) -> Self {
                Self::$concept(what)
            }
        } )*
    };
}

mod circuit;
mod expressions;
mod mesh_file;
mod objects;
mod text;
mod values;

pub use circuit::{Circuit, Sampling};
pub use expressions::{Bsdf, Expression, Mistake};
pub use mesh_file::MeshFile;
pub use objects::{Camera, Glass, Material, Mesh, Renderer, Shape, Sky, Triangles, Unlit};
pub use text::{File, Override, Yaml};
pub use values::{Datum, Expected, Range, Structure};

what! {
    File Yaml Override Structure Datum Material Renderer Unlit Camera Sky Shape Glass Mesh MeshFile
    Expression Bsdf Sampling Circuit
}

/// Writes the problem and the suggested fix in one line.
impl fmt::Display for Description {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)?;
        let mut help = self.help.iter();
        help.try_for_each(|help| write!(f, "; {help}"))
    }
}

/// Writes the problem and the suggested fix in one line.
impl fmt::Display for What {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.description().fmt(f)
    }
}

/// Names of the scene language, in order.
type Names = &'static [&'static str];

fn meant(name: &str, names: &[&'static str]) -> Option<String> {
    let near = nearest(name, names.iter().copied())?;
    Some(format!("did you mean `{near}`?"))
}

fn without_article(noun: &str) -> &str {
    let bare = noun.strip_prefix("a ").or_else(|| noun.strip_prefix("an "));
    bare.unwrap_or(noun)
}
