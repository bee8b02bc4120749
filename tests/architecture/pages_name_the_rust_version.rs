//! Checks that the pages for newcomers name the oldest Rust that builds qrt: `rust-version` of Cargo.toml.

use std::path::Path;

#[test]
fn pages_name_the_rust_version() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let text = |file: &str| std::fs::read_to_string(root.join(file)).unwrap();
    let manifest = text("Cargo.toml");
    let version = manifest
        .lines()
        .find_map(|line| line.strip_prefix("rust-version = "))
        .unwrap()
        .trim_matches('"');
    for (page, before) in [
        ("README.md", "[Rust](https://rustup.rs) "),
        ("book/src/macros.md", "qrt needs Rust "),
    ] {
        let named = format!("{before}{version} or later");
        assert!(text(page).contains(&named), "{page} does not say `{named}`");
    }
}
