//! Front end, checks, path tracer and compiler: from a scene to the oracle that the machines run.

#![forbid(unsafe_code)]

pub mod compile;
pub mod inspect;
pub mod oracle;
pub mod tracer;
