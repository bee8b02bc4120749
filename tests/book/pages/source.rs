//! Tests that pages refer to.

use crate::equation::Place;
use crate::symbol::{Kind, defines, lines};
use std::fs;

/// Checks that a place is a test: a function beneath `#[test]`, or an item with an example that runs, or
/// a function within one.
///
/// # Errors
/// The place is not a test.
pub(crate) fn check_test(place: &Place) -> Result<(), String> {
    let Place { path, symbol } = place;
    let text = fs::read_to_string(path).map_err(|_| format!("there is no file `{path}`"))?;
    if is_test(&text, symbol) {
        Ok(())
    } else {
        Err(format!("`{symbol}` of `{path}` is not a test"))
    }
}

/// True if a symbol is that of a test. If code defines it, a definition in an example does not count.
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
        // Attributes and documentation, from the symbol up to the item before.
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
    fn a_place_is_a_test_or_told() {
        let check = |path: &str, symbol: &str| {
            let (path, symbol) = (path.to_owned(), symbol.to_owned());
            check_test(&Place { path, symbol }).is_ok()
        };
        let this = "tests/book/pages/source.rs";
        assert!(check(this, "a_place_is_a_test_or_told"));
        assert!(!check(this, "check_test"));
        assert!(!check("tests/book/pages/none.rs", "check_test"));
    }
}
