//! The book keeps its promises to the reader: every equation of the paper has its code and its test,
//! every link leads somewhere, every error code and erratum has its place.

#![allow(clippy::unwrap_used, clippy::expect_used)]

#[path = "../book/mod.rs"]
mod book;
// What the book's tool reads, its tests read in the same way.
#[allow(dead_code)]
#[path = "../../book/tool/src/complaint.rs"]
mod complaint;
#[allow(dead_code)]
#[path = "../../book/tool/src/equation.rs"]
mod equation;
#[path = "../../book/tool/src/symbol.rs"]
mod symbol;

mod equations;
mod errata;
mod fences;
mod lines;
mod reading;
mod source;

use book::{FOLDER, Link, Page, anchors, listed, pages, report};
use source::Reference;
use std::collections::{BTreeMap, BTreeSet};
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

#[test]
fn every_equation_of_the_paper_is_restated_once_with_its_code_and_its_test() {
    let mut failures = Vec::new();
    let mut seen: BTreeMap<u32, String> = BTreeMap::new();
    for page in pages() {
        for fence in page.fences() {
            if fence.language() != "equation" {
                continue;
            }
            match equations::read(&page, &fence) {
                Ok(equation) => {
                    let place = page.at(fence.line);
                    let told = equations::failures(&equation).into_iter();
                    failures.extend(told.map(|what| format!("{place}: {what}")));
                    let number = equation.number;
                    if let Some(other) = seen.insert(number, place.clone()) {
                        failures.push(format!("{place}: equation {number} is at {other} already"));
                    }
                }
                Err(told) => failures.extend(told),
            }
        }
    }
    let missing = equation::missing(seen.into_keys());
    failures.extend(missing.map(|numbers| format!("no page has equations {numbers}")));
    report(&failures);
}

/// A link to an equation or an erratum names it.
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

#[test]
fn every_link_leads_somewhere() {
    let pages = pages();
    let anchors: BTreeMap<&str, Vec<String>> = pages
        .iter()
        .map(|page| (&*page.name, anchors(page)))
        .collect();
    let check = |page: &Page, target: &str| -> Result<(), String> {
        if let Some(reference) = target.strip_prefix("source:") {
            return Reference::of(reference).check();
        }
        if target.starts_with("https://") || target.starts_with("http://") {
            return Ok(());
        }
        let (file, anchor) = target.split_once('#').unwrap_or((target, ""));
        let file = if file.is_empty() { &page.name } else { file };
        if file.starts_with("figures/") {
            let there = fs::exists(format!("{FOLDER}/{file}")).unwrap_or(false);
            return if there {
                Ok(())
            } else {
                Err(format!("there is no `{file}`"))
            };
        }
        match anchors.get(file) {
            None => Err(format!("there is no page `{file}`")),
            Some(all) if !anchor.is_empty() && !all.iter().any(|other| other == anchor) => {
                Err(format!("`{file}` has no place `#{anchor}`"))
            }
            Some(_) => Ok(()),
        }
    };
    let mut failures = Vec::new();
    for page in &pages {
        for link in page.links() {
            let told = check(page, &link.target).and_then(|()| says_where(&link));
            failures.extend(
                told.err()
                    .map(|what| format!("{}: {what}", page.at(link.line))),
            );
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
    for row in qrt::core::syntax::codes::TABLE {
        let anchor = format!("<a id=\"{}\"></a>", row.code);
        let count = page.text.matches(&anchor).count();
        if count != 1 {
            failures.push(format!("{} has {count} places, not one", row.code));
        }
    }
    let all = page.text.matches("<a id=\"QRT").count();
    if all != qrt::core::syntax::codes::TABLE.len() {
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

#[test]
fn every_formula_ends() {
    let mut failures = Vec::new();
    for page in pages() {
        for (number, line) in page.prose().lines().enumerate() {
            if line.replace("\\$", "").contains('$') {
                failures.push(format!(
                    "{}: a formula that never ends",
                    page.at(number + 1)
                ));
            }
        }
    }
    report(&failures);
}
