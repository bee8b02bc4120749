//! Throughput of the machines that run circuits and programs.
//!
//! Parts: `fixed`, `gates`, `statevector`.

// A bench that cannot run has nothing to report.
#![allow(clippy::unwrap_used, clippy::expect_used)]

#[path = "../common/mod.rs"]
mod common;
mod fixed;
mod gates;
mod statevector;

use std::process::ExitCode;

fn main() -> ExitCode {
    common::run(&[
        ("fixed", fixed::run),
        ("gates", gates::run),
        ("statevector", statevector::run),
    ])
}
