//! Finds the line on which a source file defines a symbol.
//!
//! It needs nothing else from the tool: the book's tests include this file.

/// Kind of a line of Rust.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    /// Code.
    Code,
    /// Code of an example within documentation that is tested.
    Example,
    /// Words, or an example that is not run.
    Words,
}

/// Returns the lines of a text: code without a comment at its end, documentation without the comment
/// mark.
pub(crate) fn lines(text: &str) -> Vec<(Kind, &str)> {
    // Length of the open fence in documentation, and whether its example is tested.
    let mut open: Option<(usize, bool)> = None;
    let mut lines = Vec::new();
    for line in text.lines() {
        let code = line.trim_start();
        let documentation = code
            .strip_prefix("///")
            .filter(|rest| !rest.starts_with('/'))
            .or(code.strip_prefix("//!"));
        let Some(documentation) = documentation else {
            open = None;
            lines.push(match line.split_once("//") {
                Some((before, _)) if before.trim().is_empty() => (Kind::Words, line),
                Some((before, _)) => (Kind::Code, before),
                None => (Kind::Code, line),
            });
            continue;
        };
        let info = documentation.trim_start().trim_start_matches('`');
        let ticks = documentation.trim_start().len() - info.len();
        let mut kind = Kind::Words;
        match open {
            Some((length, _)) if ticks >= length && info.trim().is_empty() => open = None,
            Some((_, true)) => kind = Kind::Example,
            None if ticks >= 3 => open = Some((ticks, is_tested(info))),
            _ => {}
        }
        lines.push((kind, documentation));
    }
    lines
}

/// True if `rustdoc` runs a block with this `info`, or checks that it does not compile.
fn is_tested(info: &str) -> bool {
    let mut words = info.split([',', ' ', '\t']).filter(|word| !word.is_empty());
    words.all(|word| {
        let digits = |rest: &str| rest.bytes().all(|byte| byte.is_ascii_digit());
        matches!(word, "rust" | "should_panic" | "compile_fail")
            || word.strip_prefix("edition").is_some_and(digits)
            || word.strip_prefix('E').is_some_and(digits)
    })
}

/// Returns the line, counted from 1, that defines a symbol: the first in code, or else the first in an
/// example.
pub(crate) fn line_of(text: &str, symbol: &str) -> Option<usize> {
    let lines = lines(text);
    let first = |wanted| {
        let mut lines = lines.iter();
        let index = lines.position(|&(kind, line)| kind == wanted && defines(line, symbol));
        index.map(|index| index + 1)
    };
    first(Kind::Code).or_else(|| first(Kind::Example))
}

/// Words before a name that is defined.
const KEYWORDS: [&str; 12] = [
    "fn",
    "struct",
    "enum",
    "union",
    "trait",
    "mod",
    "const",
    "static",
    "static mut",
    "type",
    "macro",
    "macro_rules!",
];

/// True if a line of code defines a symbol.
pub(crate) fn defines(line: &str, symbol: &str) -> bool {
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

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "\
// fn probability
use x::probability;
let y = probability(3); // as fn other does
pub(crate) const fn probability<T>(x: T) {}
impl Probability {}
pub struct Probability;
macro_rules! probable {
fn probability() {}
static mut COUNT: u32 = 0;
pub mod tests;
";

    #[test]
    fn symbols_are_found_where_they_are_defined() {
        for (symbol, line) in [
            ("probability", 4),
            ("Probability", 6),
            ("probable", 7),
            ("COUNT", 9),
            ("tests", 10),
        ] {
            assert_eq!(line_of(TEXT, symbol), Some(line), "{symbol}");
        }
        for symbol in ["T", "x", "prob", "other", "u32", "", "fn probability"] {
            assert_eq!(line_of(TEXT, symbol), None, "{symbol}");
        }
    }

    #[test]
    fn an_example_defines_things_if_it_is_tested() {
        let text = "\
/// The fn mentioned is another.
///
/// ```
/// fn shown() {}
/// fn real() {}
/// ```
/// ```compile_fail,E0277
/// fn refused() {}
/// ```
/// fn after() {}
/// ````text
/// ```
/// fn quoted() {}
/// ````
/// ```no_run
/// fn idle() {}
/// ```
//// fn struck() {}
fn real() {}
";
        assert_eq!(line_of(text, "shown"), Some(4));
        assert_eq!(line_of(text, "refused"), Some(8));
        assert_eq!(line_of(text, "real"), Some(19));
        for symbol in ["mentioned", "after", "quoted", "idle", "struck"] {
            assert_eq!(line_of(text, symbol), None, "{symbol}");
        }
    }

    #[test]
    fn a_fence_ends_with_its_documentation() {
        let text = "/// ```\n/// fn shown() {}\nstruct S;\n/// fn words() {}\n";
        assert_eq!(line_of(text, "shown"), Some(2));
        assert_eq!(line_of(text, "words"), None);
    }
}
