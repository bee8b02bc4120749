//! The page of errata: each has its place, and a number at which the paper fails.

use crate::book::page::{Page, report};
use crate::equation::ERRATA;

#[test]
fn every_erratum_has_its_place_and_a_number_that_shows_it() {
    let page = Page::load("errata.md").expect("there is a page of errata");
    let mut failures = Vec::new();
    for letter in ERRATA {
        let anchor = format!("<a id=\"{letter}\"></a>\n## {letter}. ");
        let sections: Vec<&str> = page.text.split(&*anchor).skip(1).collect();
        let [section] = sections[..] else {
            let count = sections.len();
            failures.push(format!("erratum {letter} has {count} places, not one"));
            continue;
        };
        if !shows_a_number(section.split("\n## ").next().unwrap_or_default()) {
            failures.push(format!(
                "erratum {letter} has no number at which the paper fails"
            ));
        }
    }
    report(&failures);
}

/// True if a section has a number that shows how wrong the paper is: in the assertion of a listing,
/// in a table, in a displayed formula, or in the paragraph of that name.
///
/// Numbers of equations, pages and codes, which links have, do not count.
fn shows_a_number(section: &str) -> bool {
    let page = Page::new("errata.md", section);
    let asserted = page.fences().iter().any(|fence| {
        let asserted = fence.body.split_once("assert").unwrap_or_default().1;
        fence.info == "rust" && has_number(asserted)
    });
    let mut bare = section.to_owned();
    for fence in page.fences().iter().rev() {
        bare.replace_range(fence.range.clone(), "");
    }
    for link in page.links() {
        bare = bare.replace(&format!("[{}]({})", link.text, link.target), "");
    }
    let displayed = bare.split("$$").skip(1).step_by(2).any(has_number);
    let tabled = bare
        .lines()
        .any(|line| line.starts_with('|') && has_number(line));
    let said = bare.split("\n\n").any(|paragraph| {
        let said = paragraph.trim_start().strip_prefix("**The number.**");
        said.is_some_and(has_number)
    });
    asserted || displayed || tabled || said
}

/// True if a text has a number that is not part of a name, as in `f64`, an exponent or an index.
fn has_number(text: &str) -> bool {
    let mut before = ' ';
    text.chars().any(|c| {
        let inside = before.is_alphanumeric() || "_^{.,".contains(before);
        before = c;
        c.is_ascii_digit() && !inside
    })
}

#[test]
fn a_digit_anywhere_is_no_number_that_shows_anything() {
    for right in [
        "Wrong.\n\n```rust\nlet x = f();\nassert!(x > 0.5);\n```\n",
        "Wrong.\n\n$$\nx = 0.25\n$$\n",
        "| a | b |\n|---|---|\n| x | 17 % |\n",
        "Wrong.\n\n**The number.** As printed: $-2{,}000$.\n",
    ] {
        assert!(shows_a_number(right), "{right}");
    }
    for wrong in [
        "Wrong in 3 places, of which 2 count.\n",
        "See [(10)](sampling.md#eq-10).\n",
        "**The number.** See [(10)](sampling.md#eq-10) and [QRT0414](error-codes.md).\n",
        "| a | [(10)](sampling.md#eq-10) |\n",
        "```rust\nlet x: f64 = 3.0;\n```\n",
        "```rust\nlet x = 3;\nassert!(f64::is_finite(g));\n```\n",
        "```text\nassert 3\n```\n",
        "$$\nx^2 + \\sqrt{N} = y_1\n$$\n",
    ] {
        assert!(!shows_a_number(wrong), "{wrong}");
    }
}
