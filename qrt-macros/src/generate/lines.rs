//! Long straight lines of code, in blocks.
//!
//! Each `let` opens a scope within the scope of the one before, and compilers traverse scopes
//! recursively: a function of thousands of them overflows their stacks. The scopes of a block end
//! with it. In unoptimised code, each `let` also has a place of its own in the function's frame;
//! the frame of a closure ends with it.

use std::collections::HashMap;
use std::fmt::Write as _;

/// A statement of the generated code.
#[derive(Clone, Debug, Default)]
pub(super) struct Line {
    pub(super) text: String,
    /// The variables that the statement binds.
    pub(super) bound: Vec<String>,
    /// The variables that the statement consumes.
    pub(super) taken: Vec<String>,
}

/// The most statements of a block.
const LENGTH: usize = 100;

/// The closure around a block of statements.
#[derive(Clone, Copy)]
pub(super) enum Around {
    /// A closure that compilers may inline.
    Call,
    /// A closure that compilers must inline if they optimise, so that instructions for vectors end
    /// up in a function that may use them.
    Inlined,
}

/// Returns the statements in blocks. Each block returns the variables that it binds and does not
/// consume, if they are `needed` after its last statement, which is given by its number.
pub(super) fn blocks(
    lines: &[Line],
    around: Around,
    needed: impl Fn(&str, usize) -> bool,
) -> String {
    let [open, close] = match around {
        Around::Call => ["(|| {", "})()"],
        Around::Inlined => [
            "block(#[cfg_attr(not(debug_assertions), inline(always))] || {",
            "})",
        ],
    };
    let mut out = String::new();
    for (number, block) in lines.chunks(LENGTH).enumerate() {
        let last = number * LENGTH + block.len() - 1;
        let mut live: Vec<&str> = Vec::new();
        for line in block {
            live.retain(|name| !line.taken.iter().any(|taken| taken == name));
            live.extend(line.bound.iter().map(String::as_str));
        }
        live.retain(|name| needed(name, last));
        // A trailing comma suits tuples of one and of none, too.
        let live: String = live.iter().fold(String::new(), |mut all, name| {
            let _ = write!(all, "{name}, ");
            all
        });
        let _ = writeln!(out, "let ({live}) = {open}");
        for line in block {
            out.push_str(&line.text);
            out.push('\n');
        }
        let _ = writeln!(out, "({live})\n{close};");
    }
    out
}

/// Returns the number of the last statement that names each variable. If several statements bind
/// the same name, the last one counts.
pub(super) fn last_uses(lines: &[Line]) -> HashMap<&str, usize> {
    let mut uses = HashMap::new();
    for (number, line) in lines.iter().enumerate() {
        let words = line
            .text
            .split(|c: char| !c.is_ascii_alphanumeric() && c != '_');
        for word in words.filter(|word| !word.is_empty()) {
            uses.insert(word, number);
        }
    }
    uses
}
