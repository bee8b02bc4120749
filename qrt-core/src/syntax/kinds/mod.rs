//! What can be wrong, concept by concept: each problem with its code, its arguments and the words that
//! the author of a scene's text reads. The macro words some of them otherwise, by their variants.

#![allow(
    missing_docs,
    reason = "a variant is documented by its words, an argument by its name"
)]

use super::name::{listed, nearest};
use super::number::{grouped, number, rounded};
use super::tree::shorten;
use std::fmt;

/// A problem in words.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Words {
    /// The stable code of the problem: `QRT0101`.
    pub code: &'static str,
    /// What is wrong, in one sentence without a full stop.
    pub message: String,
    /// What stands beside the caret; may be empty.
    pub label: String,
    /// The right thing to write; none if nothing can be advised.
    pub help: Option<String>,
    /// What the other place is that matters: "first written here"; may be empty.
    pub also: &'static str,
}

/// `"a {text}"` with the arguments put in, or `{ an expression }`.
macro_rules! text {
    () => { String::new() };
    ($text:literal) => { format!($text) };
    ({ $($text:tt)* }) => { { $($text)* } };
}

/// A help, or the expression of an optional one.
macro_rules! help {
    () => { None };
    ($text:literal) => { Some(format!($text)) };
    ({ $($text:tt)* }) => { { $($text)* } };
}

/// A code's name, or the block that chooses among them.
macro_rules! code {
    ({ $($code:tt)* }) => { { $($code)* } };
    ($code:ident) => { $crate::syntax::codes::$code };
}

/// Concepts, each with its problems.
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
            /// How a scene's text is told of it.
            #[allow(unused_variables, clippy::useless_format)]
            pub fn words(&self) -> super::Words {
                match self {
                    $( Self::$problem $({ $($argument),* })? => super::Words {
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
        /// What is wrong, by concept and with its arguments.
        #[derive(Clone, Debug, PartialEq)]
        pub enum What {
            $( $concept($concept), )*
            /// A problem of another file, at a place there.
            OfFile { what: Box<What>, place: String },
            /// A problem where `auto` would do.
            OrAuto(Box<What>),
        }

        impl What {
            /// How a scene's text is told of it.
            pub fn words(&self) -> Words {
                match self {
                    $( Self::$concept(what) => what.words(), )*
                    Self::OfFile { what, place } => Words {
                        label: place.clone(),
                        ..what.words()
                    },
                    Self::OrAuto(what) => {
                        let mut words = what.words();
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
pub use objects::{Camera, Glass, Material, Mesh, Renderer, Shape, Triangles, Unlit};
pub use text::{File, Override, Yaml};
pub use values::{Datum, Expected, Range, Structure};

what! {
    File Yaml Override Structure Datum Material Renderer Unlit Camera Shape Glass Mesh MeshFile
    Expression Bsdf Sampling Circuit
}

/// What is wrong, and what to do, in one line.
impl fmt::Display for Words {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)?;
        let mut help = self.help.iter();
        help.try_for_each(|help| write!(f, "; {help}"))
    }
}

/// What is wrong, and what to do, in one line.
impl fmt::Display for What {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.words().fmt(f)
    }
}

/// Names of a scene's language, in their order.
type Names = &'static [&'static str];

fn meant(name: &str, names: &[&'static str]) -> Option<String> {
    let near = nearest(name, names.iter().copied())?;
    Some(format!("did you mean `{near}`?"))
}

fn without_article(noun: &str) -> &str {
    let bare = noun.strip_prefix("a ").or_else(|| noun.strip_prefix("an "));
    bare.unwrap_or(noun)
}
