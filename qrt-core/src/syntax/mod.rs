//! What a text says before anybody knows what it means, and how its faults are told: a tree of values
//! with places, the paths through it, problems, their codes and their reports.
//!
//! Every front end and every check speaks to an author through this module, and it imports nothing of
//! scenes: a [`Problem`] is a variant with arguments, which each front end puts into its own words.

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

pub use invalid::InvalidScene;
pub use kinds::*;
pub(crate) use line::{line_after, line_starts};
pub use name::{listed, nearest};
pub use number::{grouped, number};
pub(crate) use path::Place;
pub use path::{Path, Step};
pub use problem::{At, Problem, Problems};
pub use report::{Location, MOST, Report, Reported, Source};
