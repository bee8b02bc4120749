//! Files of this repository that pages refer to.

use crate::symbol::{Kind, defines, line_of, lines};
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
            Some(symbol) if line_of(&text, symbol).is_none() => {
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

/// Whether a symbol is that of a test. Where code defines it, an example's of the same name is none.
fn is_test(text: &str, symbol: &str) -> bool {
    let lines = lines(text);
    let found = |wanted| {
        let all = lines.iter().enumerate();
        let defined = all.filter(move |(_, (kind, line))| *kind == wanted && defines(line, symbol));
        defined.map(|(at, _)| at).collect::<Vec<_>>()
    };
    let in_code = found(Kind::Code);
    if in_code.is_empty() {
        return !found(Kind::Example).is_empty();
    }
    in_code.into_iter().any(|at| {
        let above = lines[..at].iter().rev();
        // Attributes and documentation, down from the item before.
        let above = above.map(|(kind, line)| (*kind, line.trim()));
        let mut above = above.take_while(|(kind, line)| {
            *kind != Kind::Code || line.starts_with("#[") || line.ends_with(")]")
        });
        let is_marked = |(kind, line)| kind == Kind::Example || line == "#[test]";
        lines[at].1.contains("fn ") && above.any(is_marked)
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

/// Says nothing: but for fn mentioned, see `#[test]`.
///
/// ```text
/// fn quoted() {}
/// ```
/// ```ignore
/// fn idle() {}
/// ```
fn shown() {}

/// ```
/// fn helper() {}
/// ```
struct Documented;

/// What it says.
#[test]
#[should_panic = \"x\"]
fn panics() {}
";

    #[test]
    fn a_test_is_told_from_a_function() {
        for symbol in ["add", "sums_are_right", "panics", "example"] {
            assert!(is_test(TEXT, symbol), "{symbol}");
        }
        for symbol in [
            "helper",
            "SIZE",
            "Lattice",
            "missing",
            "commented",
            "mentioned",
            "quoted",
            "idle",
            "shown",
            "Documented",
        ] {
            assert!(!is_test(TEXT, symbol), "{symbol}");
        }
    }

    #[test]
    fn references_are_checked_against_the_repository() {
        let this = "tests/book/pages/source.rs";
        assert_eq!(
            Reference::of("tests/book/pages/source.rs#Reference").check(),
            Ok(())
        );
        assert_eq!(Reference::of(this).check(), Ok(()));
        assert!(Reference::of("tests/book/pages/none.rs").check().is_err());
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
            Reference::of(&format!("{this}#is_test"))
                .check_test()
                .is_err()
        );
    }
}
