//! Blocks that restate an equation of the paper.

use crate::book::Fence;
use crate::source::Reference;

/// The numbered equations of the paper.
pub(crate) const COUNT: usize = 28;

/// A restated equation.
#[derive(Debug)]
pub(crate) struct Equation<'a> {
    /// As printed in the paper.
    pub(crate) number: usize,
    what: Option<&'a str>,
    code: Option<&'a str>,
    test: Option<&'a str>,
    erratum: Option<&'a str>,
    has_formula: bool,
}

/// The equation of a fence.
///
/// # Errors
/// What keeps it from being one.
pub(crate) fn read(fence: &Fence) -> Result<Equation<'_>, String> {
    let number = fence
        .info
        .strip_prefix("equation ")
        .unwrap_or_default()
        .trim();
    let number = number
        .parse()
        .map_err(|_| format!("`{}` has no number", fence.info))?;
    let (formula, keys) = fence
        .body
        .split_once("\n---\n")
        .ok_or("no line `---` between the formula and its keys")?;
    let mut equation = Equation {
        number,
        what: None,
        code: None,
        test: None,
        erratum: None,
        has_formula: !formula.trim().is_empty(),
    };
    for line in keys.lines().filter(|line| !line.trim().is_empty()) {
        let (key, value) = line
            .split_once(':')
            .ok_or_else(|| format!("`{line}` is no key"))?;
        let place = match key {
            "what" => &mut equation.what,
            "code" => &mut equation.code,
            "test" => &mut equation.test,
            "erratum" => &mut equation.erratum,
            _ => return Err(format!("an equation has no key `{key}`")),
        };
        if place.replace(value.trim()).is_some() {
            return Err(format!("two keys `{key}`"));
        }
    }
    Ok(equation)
}

type Check = fn(Reference<'_>) -> Result<(), String>;

impl Equation<'_> {
    /// What is wrong with it.
    pub(crate) fn failures(&self) -> Vec<String> {
        let mut failures = Vec::new();
        if !(1..=COUNT).contains(&self.number) {
            failures.push(format!("the paper has no equation {}", self.number));
        }
        if !self.has_formula {
            failures.push("no formula".to_owned());
        }
        if self.what.is_none_or(str::is_empty) {
            failures.push("no `what`".to_owned());
        }
        let checks: [(&str, Option<&str>, Check); 2] = [
            ("code", self.code, |reference| {
                reference.symbol.ok_or("code needs a symbol")?;
                reference.check()
            }),
            ("test", self.test, |reference| reference.check_test()),
        ];
        for (key, value, check) in checks {
            let references: Vec<_> = value.unwrap_or_default().split(", ").collect();
            for reference in references {
                let told = check(Reference::of(reference));
                failures.extend(told.err().map(|what| format!("{key}: {what}")));
            }
        }
        let letter =
            |text: &str| text.len() == 1 && ('a'..='j').contains(&(text.as_bytes()[0] as char));
        if let Some(erratum) = self.erratum.filter(|erratum| !letter(erratum)) {
            failures.push(format!("`{erratum}` is no erratum from a to j"));
        }
        failures
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::book::Page;

    const RIGHT: &str = "\
```equation 17
P(y \\mid \\theta) = 1
---
what: the distribution of outcomes
code: tests/book_pages/equations.rs#read, tests/book_pages/equations.rs#COUNT
test: tests/book_pages/equations.rs#a_faulty_equation_is_told
erratum: f
```
";

    fn failures(text: &str) -> Vec<String> {
        let fences = Page::new("page.md", text).fences();
        match read(&fences[0]) {
            Ok(equation) => equation.failures(),
            Err(what) => vec![what],
        }
    }

    #[test]
    fn a_faulty_equation_is_told() {
        assert_eq!(failures(RIGHT), [""; 0]);
        for (from, to, expected) in [
            ("equation 17", "equation", "no number"),
            ("equation 17", "equation 29", "no equation 29"),
            ("equation 17", "equation 0", "no equation 0"),
            ("---\n", "", "no line `---`"),
            ("P(y \\mid \\theta) = 1", "", "no formula"),
            ("what: the distribution of outcomes", "what:", "no `what`"),
            ("#read,", "#reed,", "defines no `reed`"),
            ("#read,", ",", "needs a symbol"),
            ("#a_faulty", "#another", "defines no"),
            ("#a_faulty_equation_is_told", "#failures", "is not a test"),
            ("test:", "tests:", "no key `tests`"),
            ("erratum: f", "what: f", "two keys `what`"),
            ("erratum: f", "erratum: k", "no erratum"),
        ] {
            let told = failures(&RIGHT.replacen(from, to, 1)).join("\n");
            assert!(told.contains(expected), "{from} -> {to}: {told}");
        }
        let without_test = RIGHT
            .replace("test: tests/book_pages", "\n")
            .replace("/equations.rs#a_faulty", "");
        assert!(!failures(&without_test).is_empty());
    }
}
