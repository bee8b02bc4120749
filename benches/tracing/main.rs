//! Throughput of the tracer in floating point, its start, and the gain of light sampling.
//!
//! Parts: `speed`, `light`, `start`.

// A bench that cannot run has nothing to report.
#![allow(clippy::unwrap_used, clippy::expect_used)]

#[path = "../common/mod.rs"]
mod common;
mod light;
mod speed;
mod start;

use std::process::ExitCode;

fn main() -> ExitCode {
    common::run(&[
        ("speed", speed::run),
        ("light", light::run),
        ("start", start::run),
    ])
}
