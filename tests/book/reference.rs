//! Compares the book's reference pages with the program: the format of scenes with the types, and every
//! error code with a report that a user can get. `QRT_BLESS=1 cargo test --test book reference` writes
//! both pages again.

mod codes;
mod examples;
mod format;
mod kinds;
mod markdown;
mod reports;

use super::page::{FOLDER, Page, bless};
use serde_yaml::Value;
use std::collections::BTreeSet;

/// Compares a page with the expected text, or writes it.
fn compare(name: &str, text: &str) {
    if bless() {
        std::fs::write(format!("{FOLDER}/{name}"), text).unwrap();
    }
    let page = Page::load(name).map_or_else(String::new, |page| page.text);
    let line = page.lines().zip(text.lines()).position(|(a, b)| a != b);
    assert!(
        page == text,
        "{FOLDER}/{name} is out of date from line {}: `QRT_BLESS=1 cargo test --test book \
         reference` writes it anew",
        line.unwrap_or_else(|| page.lines().count().min(text.lines().count())) + 1
    );
}

#[test]
fn the_reference_of_the_format_is_that_of_the_types() {
    compare("format.md", &format::page());
}

#[test]
fn every_error_code_is_explained_with_a_report_that_somebody_gets() {
    compare("error-codes.md", &codes::page());
}

/// Collects the names of all keys of a schema.
fn keys(schema: &Value, all: &mut BTreeSet<String>) {
    if let Some(properties) = schema.get("properties").and_then(Value::as_mapping) {
        all.extend(
            properties
                .keys()
                .filter_map(Value::as_str)
                .map(str::to_owned),
        );
    }
    match schema {
        Value::Mapping(parts) => parts.values().for_each(|part| keys(part, all)),
        Value::Sequence(parts) => parts.iter().for_each(|part| keys(part, all)),
        _ => {}
    }
}

#[test]
fn every_key_of_the_schema_is_in_the_grammar_of_the_macro() {
    // Lists of entries and of points stand in place of these.
    const WITHOUT_A_KEY: [&str; 2] = ["geometry", "vertices"];
    let schema = serde_yaml::from_str(&qrt::scene::schema::text()).unwrap();
    let mut all = BTreeSet::new();
    keys(&schema, &mut all);
    assert!(all.len() > 60, "{all:?}");
    let page = std::fs::read_to_string("src/scene_macro.md").unwrap();
    let (_, grammar) = page.split_once("# Grammar").unwrap();
    let words = grammar.split(|c: char| !(c.is_alphanumeric() || c == '_'));
    let words: BTreeSet<&str> = words.chain(WITHOUT_A_KEY).collect();
    all.retain(|key| !words.contains(key.as_str()));
    assert!(all.is_empty(), "the grammar of `qrt!` lacks {all:?}");
}
