//! From a scene to what the machines run.
pub mod expr;
pub mod front;
pub mod report;
pub mod sampling;
pub mod scene;
pub mod tracer;
pub mod valid;
