//! Files of this repository that pages refer to.

use std::fs;

/// A reference such as `qrt-core/src/oracle.rs#Oracle`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Reference<'a> {
    /// The file, from the root of the repository.
    pub(crate) path: &'a str,
    /// What it defines.
    pub(crate) symbol: Option<&'a str>,
}

impl<'a> Reference<'a> {
    /// The parts of a reference.
    pub(crate) fn of(text: &'a str) -> Self {
        match text.split_once('#') {
            Some((path, symbol)) => Self {
                path,
                symbol: Some(symbol),
            },
            None => Self {
                path: text,
                symbol: None,
            },
        }
    }

    fn text(self) -> Result<String, String> {
        let outside = self.path.starts_with('/') || self.path.split('/').any(|part| part == "..");
        if outside {
            return Err(format!("`{}` is not a path from the root", self.path));
        }
        fs::read_to_string(self.path).map_err(|_| format!("there is no file `{}`", self.path))
    }

    /// Whether the file is there and defines the symbol.
    ///
    /// # Errors
    /// What is missing.
    pub(crate) fn check(self) -> Result<(), String> {
        let text = self.text()?;
        match self.symbol {
            Some(symbol) if definition(&text, symbol).is_none() => {
                Err(format!("`{}` defines no `{symbol}`", self.path))
            }
            _ => Ok(()),
        }
    }

    /// Whether the symbol is a test: a function beneath `#[test]`, or one with an example that runs
    /// or within one.
    ///
    /// # Errors
    /// That it is not.
    pub(crate) fn check_test(self) -> Result<(), String> {
        self.check()?;
        let text = self.text()?;
        let symbol = self.symbol.ok_or("a test needs a symbol")?;
        if is_test(&text, symbol) {
            Ok(())
        } else {
            Err(format!("`{symbol}` of `{}` is not a test", self.path))
        }
    }
}

/// The line, from 0, on which `symbol` is defined.
fn definition(text: &str, symbol: &str) -> Option<usize> {
    text.lines().position(|line| {
        // An example within documentation defines things too; other comments mention them.
        let code = line.trim_start();
        let example = code.strip_prefix("///").or(code.strip_prefix("//!"));
        let code = example.or(code.split("//").next()).unwrap_or_default();
        defines(code, symbol)
    })
}

const KEYWORDS: [&str; 10] = [
    "fn",
    "struct",
    "enum",
    "union",
    "trait",
    "mod",
    "const",
    "static",
    "type",
    "macro_rules!",
];

fn defines(line: &str, symbol: &str) -> bool {
    let is_word = |c: char| c.is_alphanumeric() || c == '_';
    let whole = !symbol.is_empty() && symbol.chars().all(is_word);
    whole
        && line.match_indices(symbol).any(|(at, _)| {
            let before = line[..at].trim_end();
            let keyword = KEYWORDS.iter().any(|keyword| {
                let rest = before.strip_suffix(keyword);
                rest.is_some_and(|rest| !rest.ends_with(is_word))
            });
            keyword && before.len() < at && !line[at + symbol.len()..].starts_with(is_word)
        })
}

fn is_test(text: &str, symbol: &str) -> bool {
    let lines: Vec<&str> = text.lines().map(str::trim).collect();
    let is_doc = |line: &str| line.starts_with("///") || line.starts_with("//!");
    let defined = |(_, line): &(usize, &&str)| defines(line, symbol);
    lines.iter().enumerate().filter(defined).any(|(at, line)| {
        if is_doc(line) {
            return true;
        }
        let above = lines[..at].iter().rev();
        // Attributes and documentation, down from the item before.
        let mut above = above.take_while(|line| {
            line.starts_with("//") || line.starts_with("#[") || line.ends_with(")]")
        });
        line.contains("fn ") && above.any(|line| *line == "#[test]" || line.starts_with("/// ```"))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "\
//! About nothing.
// fn commented() {}
pub(crate) const SIZE: usize = 4;
pub struct Lattice<T> { cells: T }
macro_rules! codes { () => {} }

/// Adds.
///
/// ```
/// fn example() {}
/// ```
#[must_use]
pub const fn add(a: u32) -> u32 { a }

fn helper() {}

proptest! {
    #[test]
    fn sums_are_right(a in 0..9) {}
}

/// What it says.
#[test]
#[should_panic = \"x\"]
fn panics() {}
";

    #[test]
    fn a_definition_is_told_from_a_mention() {
        for symbol in [
            "SIZE",
            "Lattice",
            "codes",
            "add",
            "helper",
            "sums_are_right",
            "panics",
        ] {
            assert!(definition(TEXT, symbol).is_some(), "{symbol}");
        }
        for symbol in [
            "commented",
            "cells",
            "Latt",
            "T",
            "usize",
            "",
            "sums",
            "add a",
        ] {
            assert!(definition(TEXT, symbol).is_none(), "{symbol}");
        }
    }

    #[test]
    fn a_test_is_told_from_a_function() {
        for symbol in ["add", "sums_are_right", "panics", "example"] {
            assert!(is_test(TEXT, symbol), "{symbol}");
        }
        for symbol in ["helper", "SIZE", "Lattice", "missing"] {
            assert!(!is_test(TEXT, symbol), "{symbol}");
        }
    }

    #[test]
    fn references_are_checked_against_the_repository() {
        let this = "tests/book_pages/source.rs";
        assert_eq!(
            Reference::of("tests/book_pages/source.rs#Reference").check(),
            Ok(())
        );
        assert_eq!(Reference::of(this).check(), Ok(()));
        assert!(Reference::of("tests/book_pages/none.rs").check().is_err());
        assert!(Reference::of("tests/../Cargo.toml").check().is_err());
        let missing = format!("{this}#Missing");
        assert!(
            Reference::of(&missing)
                .check()
                .unwrap_err()
                .contains("no `Missing`")
        );
        let test = format!("{this}#a_test_is_told_from_a_function");
        assert_eq!(Reference::of(&test).check_test(), Ok(()));
        assert!(
            Reference::of(&format!("{this}#defines"))
                .check_test()
                .is_err()
        );
    }
}
