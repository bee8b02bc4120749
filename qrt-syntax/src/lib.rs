//! The untyped syntax tree with source positions, and error reporting: paths, problems, error codes
//! and reports.
//!
//! All front ends and checks report through this crate. It knows no scene: a [`Problem`] is an enum
//! variant with arguments, which each front end words in its own way.
//!
//! ```
//! use qrt_syntax::tree::Found;
//! use qrt_syntax::{Path, Problems, Structure};
//!
//! let mut problems = Problems::default();
//! let radiance = Path::root().key("materials").key("lamp").key("radiance");
//! problems.add(radiance, Structure::WrongChannels { found: Found::List(2) });
//! let problem = &problems.all()[0];
//! assert_eq!(problem.path().unwrap().to_string(), "materials.lamp.radiance");
//! assert_eq!(problem.description().message, "expected one expression or three, found a list of 2");
//! ```
//!
//! # Where to go from here
//!
//! * [`tree`]: the syntax tree that every front end builds from its text;
//! * [`Problems`] and [`What`]: problems as they are found, and their kinds;
//! * [`Report`]: problems at their places in a text, in words;
//! * [`codes`]: the stable codes of all problems;
//! * [`expr`]: the expressions of user-defined maps and BSDFs.

#![forbid(unsafe_code)]

pub mod codes;
pub mod expr;
mod kinds;
mod line;
mod name;
mod number;
mod other_names;
mod path;
mod problem;
mod report;
pub mod tree;

pub use kinds::*;
pub use line::{line_after, line_starts};
pub use name::{listed, nearest};
pub use number::{grouped, number};
pub use other_names::{called, meant_by};
pub use path::{Path, Place, Step};
pub use problem::{At, Problem, Problems};
pub use report::{Location, MOST, Report, Reported, Source};
