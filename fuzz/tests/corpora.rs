//! The targets on their corpora, as `cargo test --test scenes fuzz` runs them; here under a sanitizer.

#[path = "../targets.rs"]
mod targets;

#[path = "../../tests/scenes/fuzz_targets.rs"]
mod fuzz_targets;
