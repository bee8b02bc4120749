//! Front end, checks, path tracer and compiler: from a scene to the oracle that the machines run.

#![forbid(unsafe_code)]

pub mod compile;
pub mod expr;
pub mod front;
pub mod inspect;
pub mod lights;
pub mod oracle;
mod polygons;
pub mod sampling;
pub mod scene;
pub mod schema;
pub mod syntax;
pub mod tracer;
pub mod valid;
