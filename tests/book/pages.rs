//! Checks the completeness of the book: every equation of the paper has its test, every error code and
//! erratum has its place. The book's tool checks, when the book is built, that links have targets and
//! that blocks of equations are valid.

mod errata;
mod fences;
mod lines;
mod reading;
mod source;

use super::page::{FOLDER, Link, Page, listed, pages, report};
use crate::equation::{COUNT, Equation};
use source::check_test;
use std::collections::BTreeSet;
use std::fs;

fn names(folder: &str) -> BTreeSet<String> {
    let entries = fs::read_dir(folder).unwrap();
    entries
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect()
}

#[test]
fn every_page_is_listed_and_every_listed_page_is_there() {
    let listed = listed();
    let mut failures = Vec::new();
    let set: BTreeSet<String> = listed.iter().cloned().collect();
    assert_eq!(
        set.len(),
        listed.len(),
        "a page is listed twice: {listed:?}"
    );
    let found: BTreeSet<String> = names(FOLDER)
        .into_iter()
        .filter(|name| {
            name.strip_suffix(".md")
                .is_some_and(|page| page != "SUMMARY")
        })
        .collect();
    failures.extend(
        set.difference(&found)
            .map(|name| format!("{name} is listed, but not there")),
    );
    failures.extend(
        found
            .difference(&set)
            .map(|name| format!("{name} is there, but not listed")),
    );
    report(&failures);
}

/// The book's tool checks that each equation is restated once, and that its code exists.
#[test]
fn every_equation_of_the_paper_names_a_test_of_it() {
    let mut failures = Vec::new();
    let mut count = 0;
    for page in pages() {
        let fences = page.fences();
        for fence in fences.iter().filter(|fence| fence.language() == "equation") {
            let body: Vec<&str> = fence.body.lines().collect();
            let equation = Equation::parse(&fence.info, &body, &page.name, fence.line).unwrap();
            let untested = equation
                .test
                .iter()
                .filter_map(|place| check_test(place).err());
            failures.extend(untested.map(|what| format!("{}: {what}", page.at(fence.line))));
            count += 1;
        }
    }
    report(&failures);
    assert_eq!(count, COUNT);
}

/// Checks that a link to an equation or an erratum names it.
fn says_where(link: &Link) -> Result<(), String> {
    let (_, anchor) = link.target.split_once('#').unwrap_or_default();
    let digits = |text: &&str| !text.is_empty() && text.bytes().all(|b| b.is_ascii_digit());
    let named = if let Some(rest) = link.text.strip_prefix('(') {
        let number = rest.strip_suffix(')').filter(digits);
        number.map_or(!anchor.starts_with("eq-"), |number| {
            anchor == format!("eq-{number}")
        })
    } else {
        let letter = link.text.strip_prefix("erratum ");
        letter.is_none_or(|letter| anchor == letter)
    };
    if named {
        Ok(())
    } else {
        Err(format!("`{}` leads to `{}`", link.text, link.target))
    }
}

#[test]
fn a_link_that_names_a_number_leads_to_it() {
    let says = |text: &str| says_where(&Page::new("page.md", text).links()[0]).is_ok();
    for right in [
        "[(17)](counting.md#eq-17)",
        "[(17)](#eq-17)",
        "[erratum f](errata.md#f)",
        "[the distribution](counting.md#eq-17)",
        "[(here)](counting.md)",
    ] {
        assert!(says(right), "{right}");
    }
    for wrong in [
        "[(17)](counting.md#eq-18)",
        "[(17)](counting.md#what-the-tail-does)",
        "[(17)](counting.md)",
        "[(17](counting.md#eq-17)",
        "[(17a)](counting.md#eq-17)",
        "[erratum f](errata.md#g)",
        "[erratum f](errata.md)",
    ] {
        assert!(!says(wrong), "{wrong}");
    }
}

/// The book's tool checks that every link has a target.
#[test]
fn every_link_that_names_a_number_leads_to_it() {
    let mut failures = Vec::new();
    for page in pages() {
        for link in page.links() {
            let told = says_where(&link).err();
            failures.extend(told.map(|what| format!("{}: {what}", page.at(link.line))));
        }
    }
    report(&failures);
}

#[test]
fn every_figure_is_shown_and_says_what_is_seen() {
    let mut failures = Vec::new();
    let mut shown = BTreeSet::new();
    for page in pages() {
        for link in page.links() {
            if let Some(name) = link.target.strip_prefix("figures/") {
                shown.insert(name.to_owned());
            }
            if link.is_picture && link.text.trim().is_empty() {
                failures.push(format!("{}: a picture without words", page.at(link.line)));
            }
        }
    }
    let unseen = names(&format!("{FOLDER}/figures"))
        .into_iter()
        .filter(|name| !shown.contains(name));
    failures.extend(unseen.map(|name| format!("no page shows figures/{name}")));
    report(&failures);
}

#[test]
fn every_error_code_has_its_place() {
    let page = Page::load("error-codes.md").expect("there is a page of error codes");
    let mut failures = Vec::new();
    for row in qrt::syntax::codes::TABLE {
        let anchor = format!("<a id=\"{}\"></a>", row.code);
        let count = page.text.matches(&anchor).count();
        if count != 1 {
            failures.push(format!("{} has {count} places, not one", row.code));
        }
    }
    let all = page.text.matches("<a id=\"QRT").count();
    if all != qrt::syntax::codes::TABLE.len() {
        failures.push(format!("the page has {all} codes"));
    }
    report(&failures);
}

#[test]
fn every_block_is_of_a_kind_that_is_tested_or_only_shown() {
    report(
        &pages()
            .iter()
            .flat_map(fences::failures)
            .collect::<Vec<_>>(),
    );
}

#[test]
fn pages_have_one_title_and_lines_that_fit() {
    let mut failures = Vec::new();
    for page in pages() {
        let prose = page.prose();
        let titles = prose.lines().filter(|line| line.starts_with("# ")).count();
        if titles != 1 {
            failures.push(format!("{}: {titles} titles", page.at(1)));
        }
        let long = lines::long(&page).into_iter();
        failures
            .extend(long.map(|(line, length)| format!("{}: {length} characters", page.at(line))));
    }
    report(&failures);
}
