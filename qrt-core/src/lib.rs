//! Path tracer and compiler: from a checked scene to the oracle that the machines run.

#![forbid(unsafe_code)]

pub mod compile;
pub mod inspect;
pub mod oracle;
pub mod tracer;
