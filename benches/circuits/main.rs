//! Costs of the circuits: of a path tracer's oracle, of meshes in it, and of the search for primary hits.
//!
//! Parts: `oracle`, `meshes`, `nearest`.

// A bench that cannot run has nothing to report.
#![allow(clippy::unwrap_used, clippy::expect_used)]

#[path = "../common/mod.rs"]
mod common;
mod meshes;
mod nearest;
mod oracle;

use std::process::ExitCode;

fn main() -> ExitCode {
    common::run(&[
        ("oracle", oracle::run),
        ("meshes", meshes::run),
        ("nearest", nearest::run),
    ])
}
