//! Accuracy of pictures: of plans, by the number of paths, and of their colours.
//!
//! Parts: `plans`, `one_percent`, `truncation`, `colour`.

// A bench that cannot run has nothing to report.
#![allow(clippy::unwrap_used, clippy::expect_used)]

mod colour;
#[path = "../common/mod.rs"]
mod common;
mod one_percent;
mod plans;
mod truncation;

use std::process::ExitCode;

fn main() -> ExitCode {
    common::run(&[
        ("plans", plans::run),
        ("one_percent", one_percent::run),
        ("truncation", truncation::run),
        ("colour", colour::run),
    ])
}
