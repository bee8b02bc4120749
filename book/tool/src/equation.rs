//! Equations of the paper: the fenced blocks that restate them, and their index.
//!
//! It needs only complaints from the tool: the book's tests include this file.

use crate::complaint::Complaint;
use std::collections::BTreeSet;
use std::ops::RangeInclusive;

/// Number of the paper's equations, from 1.
pub(crate) const COUNT: u32 = 28;

/// Letters of the paper's errata.
pub(crate) const ERRATA: RangeInclusive<char> = 'a'..='k';

/// A place in the repository's sources: a file, and a symbol that it defines.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Place {
    /// The file, as seen from the repository's root.
    pub(crate) path: String,
    /// An identifier that the file defines.
    pub(crate) symbol: String,
}

/// One equation of the paper, as a chapter restates it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Equation {
    /// Its number in the paper.
    pub(crate) number: u32,
    /// The formula, in LaTeX.
    pub(crate) tex: String,
    /// A description, as Markdown of one line.
    pub(crate) what: String,
    /// Places of its code.
    pub(crate) code: Vec<Place>,
    /// Places of its tests.
    pub(crate) test: Vec<Place>,
    /// The letter of the erratum about it.
    pub(crate) erratum: Option<char>,
    /// Formula that the paper prints in its place, in LaTeX; empty if it is the same.
    pub(crate) printed: String,
}

impl Equation {
    /// Parses a block: `info` is the text after the fence, `body` the lines within, of which the first is
    /// line `line` of `file`.
    pub(crate) fn parse(
        info: &str,
        body: &[&str],
        file: &str,
        line: usize,
    ) -> Result<Self, Vec<Complaint>> {
        let mut complaints = Vec::new();
        let number = info
            .strip_prefix("equation")
            .and_then(|number| number.trim().parse().ok())
            .filter(|number| (1..=COUNT).contains(number));
        if number.is_none() {
            complaints.push(Complaint::at(
                file,
                line - 1,
                format!("`{info}`: equations are numbered 1 to {COUNT}, as in ```equation 17"),
            ));
        }
        let rule = body.iter().position(|text| text.trim() == "---");
        let (tex, keys) = body.split_at(rule.unwrap_or(body.len()));
        if rule.is_none() {
            complaints.push(Complaint::at(
                file,
                line - 1,
                "no line `---` between the equation's LaTeX and its keys",
            ));
        }
        if tex.iter().all(|text| text.trim().is_empty()) {
            complaints.push(Complaint::at(file, line - 1, "the equation is empty"));
        }
        let mut equation = Self {
            number: number.unwrap_or_default(),
            tex: tex.join("\n"),
            what: String::new(),
            code: Vec::new(),
            test: Vec::new(),
            erratum: None,
            printed: String::new(),
        };
        let keys = keys.get(1..).unwrap_or_default();
        complaints.extend(equation.read(keys, file, line + tex.len() + 1));
        for (key, missing) in [
            ("what", equation.what.is_empty()),
            ("code", equation.code.is_empty()),
            ("test", equation.test.is_empty()),
        ] {
            if missing {
                complaints.push(Complaint::at(
                    file,
                    line - 1,
                    format!("`{info}` does not say `{key}:`"),
                ));
            }
        }
        if !equation.printed.is_empty() && equation.erratum.is_none() {
            complaints.push(Complaint::at(
                file,
                line - 1,
                format!("`{info}` has `printed:`, and no `erratum:` says what is wrong with it"),
            ));
        }
        if complaints.is_empty() {
            Ok(equation)
        } else {
            Err(complaints)
        }
    }

    /// Reads the lines below the rule, of which the first is line `line` of `file`.
    fn read(&mut self, keys: &[&str], file: &str, line: usize) -> Vec<Complaint> {
        let mut complaints = Vec::new();
        let mut said = BTreeSet::new();
        for (text, line) in keys.iter().zip(line..) {
            if text.trim().is_empty() {
                continue;
            }
            let read = match text.split_once(':') {
                Some((key, value)) => self.set(key.trim(), value.trim(), &mut said),
                None => Err(format!("`{text}` is not `key: value`")),
            };
            if let Err(message) = read {
                complaints.push(Complaint::at(file, line, message));
            }
        }
        complaints
    }

    /// Sets the value of a key, unless the key is in `said`, the keys before it.
    fn set<'a>(
        &mut self,
        key: &'a str,
        value: &str,
        said: &mut BTreeSet<&'a str>,
    ) -> Result<(), String> {
        if !said.insert(key) {
            return Err(format!("a second `{key}:`"));
        }
        match key {
            "what" => value.clone_into(&mut self.what),
            "code" => self.code = places(value)?,
            "test" => self.test = places(value)?,
            "printed" => value.clone_into(&mut self.printed),
            "erratum" => {
                let mut letters = value.chars();
                self.erratum = match (letters.next(), letters.next()) {
                    (Some(letter), None) if ERRATA.contains(&letter) => Some(letter),
                    _ => {
                        let (first, last) = (ERRATA.start(), ERRATA.end());
                        return Err(format!(
                            "`{value}` is no erratum: they are called {first} to {last}"
                        ));
                    }
                };
            }
            _ => {
                return Err(format!(
                    "unknown key `{key}`: there are what, code, test, printed and erratum"
                ));
            }
        }
        Ok(())
    }
}

/// Parses `PATH#SYMBOL`, or several separated by commas.
fn places(value: &str) -> Result<Vec<Place>, String> {
    value
        .split(',')
        .map(|place| match place.trim().split_once('#') {
            Some((path, symbol)) if !path.is_empty() && !symbol.is_empty() => Ok(Place {
                path: path.to_owned(),
                symbol: symbol.to_owned(),
            }),
            _ => Err(format!("`{}` is not PATH#SYMBOL", place.trim())),
        })
        .collect()
}

/// Returns the missing numbers, in the words of a complaint.
pub(crate) fn missing(present: impl Iterator<Item = u32>) -> Option<String> {
    let present: Vec<u32> = present.collect();
    let missing: Vec<String> = (1..=COUNT)
        .filter(|number| !present.contains(number))
        .map(|number| number.to_string())
        .collect();
    (!missing.is_empty()).then(|| missing.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;

    const BODY: [&str; 6] = [
        r"P(y \mid \theta)",
        "= 1",
        "---",
        "what: the distribution of counting's outcomes: all of it",
        "code: a/b.rs#one, a/c.rs#two",
        "test: a/tests.rs#it_holds",
    ];

    #[test]
    fn a_block_is_read() {
        let mut body = BODY.to_vec();
        body.push("erratum: f");
        let equation = Equation::parse("equation 17", &body, "x.md", 5).unwrap();
        assert_eq!(equation.number, 17);
        assert_eq!(equation.tex, "P(y \\mid \\theta)\n= 1");
        assert_eq!(
            equation.what,
            "the distribution of counting's outcomes: all of it"
        );
        assert_eq!(equation.code.len(), 2);
        assert_eq!(equation.code[1].path, "a/c.rs");
        assert_eq!(equation.code[1].symbol, "two");
        assert_eq!(equation.test[0].symbol, "it_holds");
        assert_eq!(equation.erratum, Some('f'));
    }

    #[test]
    fn what_is_wrong_is_said_at_its_line() {
        let mut body = BODY.to_vec();
        body[5] = "tset: a/tests.rs#it_holds";
        body.push("erratum: z");
        let complaints = Equation::parse("equation 29", &body, "x.md", 5).unwrap_err();
        let said: Vec<String> = complaints.iter().map(ToString::to_string).collect();
        assert_eq!(
            said,
            [
                "x.md:4: `equation 29`: equations are numbered 1 to 28, as in ```equation 17",
                "x.md:10: unknown key `tset`: there are what, code, test, printed and erratum",
                "x.md:11: `z` is no erratum: they are called a to k",
                "x.md:4: `equation 29` does not say `test:`",
            ]
        );
        assert!(Equation::parse("equation 3", &["a = b"], "x.md", 5).is_err());
        assert!(Equation::parse("equation", &BODY, "x.md", 5).is_err());
    }

    #[test]
    fn what_is_printed_stands_beside_an_erratum_alone() {
        let mut body = BODY.to_vec();
        body.push("printed: P(y) = 2");
        let complaints = Equation::parse("equation 17", &body, "x.md", 5).unwrap_err();
        assert_eq!(
            complaints[0].to_string(),
            "x.md:4: `equation 17` has `printed:`, and no `erratum:` says what is wrong with it"
        );
        body.push("erratum: f");
        let equation = Equation::parse("equation 17", &body, "x.md", 5).unwrap();
        assert_eq!(equation.printed, "P(y) = 2");
    }

    #[test]
    fn nothing_is_said_twice() {
        for key in [
            "what: a",
            "code: a/b.rs#one",
            "test: a/b.rs#two",
            "erratum: b",
        ] {
            let mut body = BODY.to_vec();
            body.extend(["erratum: f", "", key]);
            let complaints = Equation::parse("equation 17", &body, "x.md", 5).unwrap_err();
            let said: Vec<String> = complaints.iter().map(ToString::to_string).collect();
            let (key, _) = key.split_once(':').unwrap();
            assert_eq!(said, [format!("x.md:13: a second `{key}:`")]);
        }
    }

    #[test]
    fn missing_numbers_are_named() {
        assert_eq!(missing(1..=COUNT), None);
        assert_eq!(
            missing((1..=26).filter(|&n| n != 4)).as_deref(),
            Some("4, 27, 28")
        );
    }
}
