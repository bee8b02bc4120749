//! Blocks that restate an equation of the paper, as the book's tool reads them.

use super::source::Reference;
use crate::book::page::{FOLDER, Fence, Page};
use crate::equation::{Equation, Place};

/// The equation of a fence.
///
/// # Errors
/// What keeps it from being one, each with its place.
pub(crate) fn read(page: &Page, fence: &Fence) -> Result<Equation, Vec<String>> {
    let body: Vec<&str> = fence.body.lines().collect();
    let file = format!("{FOLDER}/{}", page.name);
    Equation::parse(&fence.info, &body, &file, fence.line + 1)
        .map_err(|complaints| complaints.iter().map(ToString::to_string).collect())
}

/// What is wrong with the places that an equation names.
pub(crate) fn failures(equation: &Equation) -> Vec<String> {
    fn reference(place: &Place) -> Reference<'_> {
        Reference {
            path: &place.path,
            symbol: Some(&place.symbol),
        }
    }
    let code = equation.code.iter();
    let code = code.filter_map(|place| Some(format!("code: {}", reference(place).check().err()?)));
    let test = equation.test.iter();
    let test =
        test.filter_map(|place| Some(format!("test: {}", reference(place).check_test().err()?)));
    code.chain(test).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const RIGHT: &str = "\
```equation 17
P(y \\mid \\theta) = 1
---
what: the distribution of outcomes
code: tests/book/pages/equations.rs#read, tests/book/pages/equations.rs#failures
test: tests/book/pages/equations.rs#a_faulty_equation_is_told
erratum: f
```
";

    fn told(text: &str) -> Vec<String> {
        let page = Page::new("page.md", text);
        match read(&page, &page.fences()[0]) {
            Ok(equation) => failures(&equation),
            Err(told) => told,
        }
    }

    #[test]
    fn a_faulty_equation_is_told() {
        assert_eq!(told(RIGHT), [""; 0]);
        for (from, to, expected) in [
            ("equation 17", "equation", "page.md:1: `equation`"),
            ("equation 17", "equation 29", "numbered 1 to 28"),
            ("equation 17", "equation 0", "numbered 1 to 28"),
            ("---\n", "", "no line `---`"),
            ("P(y \\mid \\theta) = 1", "", "the equation is empty"),
            ("what: the distribution of outcomes", "what:", "say `what:`"),
            (
                "#read,",
                "#reed,",
                "code: `tests/book/pages/equations.rs` defines no `reed`",
            ),
            (
                "#read,",
                ",",
                "page.md:5: `tests/book/pages/equations.rs` is not PATH#SYMBOL",
            ),
            ("#a_faulty", "#another", "defines no"),
            ("#a_faulty_equation_is_told", "#failures", "is not a test"),
            ("test:", "tests:", "page.md:6: unknown key `tests`"),
            ("erratum: f", "what: f", "page.md:7: a second `what:`"),
            ("erratum: f", "erratum: k", "no erratum"),
        ] {
            let told = told(&RIGHT.replacen(from, to, 1)).join("\n");
            assert!(told.contains(expected), "{from} -> {to}: {told}");
        }
    }
}
