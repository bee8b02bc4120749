//! The untyped syntax tree with source positions, and error reporting: paths, problems, error codes
//! and reports.
//!
//! All front ends and checks report through this module. It imports nothing from the scene modules:
//! a [`Problem`] is an enum variant with arguments, which each front end words in its own way.

mod called;
pub mod codes;
mod invalid;
mod kinds;
mod line;
mod name;
mod number;
mod path;
mod problem;
mod report;
pub mod tree;

pub use called::{called, meant_by};
pub use invalid::InvalidScene;
pub use kinds::*;
pub(crate) use line::{line_after, line_starts};
pub use name::{listed, nearest};
pub use number::{grouped, number};
pub(crate) use path::Place;
pub use path::{Path, Step};
pub use problem::{At, Problem, Problems};
pub use report::{Location, MOST, Report, Reported, Source};
