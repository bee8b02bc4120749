//! Tests of scenes as text: valid scenes with their meaning, and faulty ones with their errors.
#![allow(clippy::unwrap_used, clippy::expect_used)]

mod common;
#[path = "../fuzz/numbers.rs"]
mod numbers;
#[path = "../fuzz/targets.rs"]
mod targets;

mod scenes {
    use proptest::prelude::ProptestConfig;

    mod bad_scenes;
    mod example_scenes;
    mod fuzz_targets;
    mod good_scenes;
    mod mutated_scenes_never_panic;
    mod schema_agrees_with_types;
    #[cfg(feature = "serde")]
    mod serde_agrees_with_yaml;
    mod yaml_agrees_with_serde_yaml;

    /// Returns a configuration of `usual` cases, or of the number in `PROPTEST_CASES`.
    fn cases(usual: u32) -> ProptestConfig {
        let asked = std::env::var("PROPTEST_CASES");
        let asked = asked.ok().and_then(|text| text.parse().ok());
        ProptestConfig::with_cases(asked.unwrap_or(usual))
    }
}
