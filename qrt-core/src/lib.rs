//! From a scene to what the machines run.
pub mod codes;
pub mod compile;
pub mod diagnostics;
pub mod expr;
pub mod front;
pub mod inspect;
pub mod oracle;
pub mod report;
pub mod sampling;
pub mod scene;
pub mod schema;
pub mod tracer;
pub mod valid;
