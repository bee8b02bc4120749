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
