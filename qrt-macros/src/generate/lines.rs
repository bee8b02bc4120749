//! Long straight lines of code, in blocks.
//!
//! Each `let` opens a scope within the last one's, and compilers go through scopes recursively: a
//! function of thousands of them overflows their stacks. A block's scopes end with it. Compiled
//! without optimisation, each `let` also has a place of its own in the function's frame: a closure's
//! frame ends with it.

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

/// The closure that a block of statements is.
#[derive(Clone, Copy)]
pub(super) enum Around {
    /// One that compilers may inline.
    Call,
    /// One that they must inline if they optimise: instructions for vectors end up in a function
    /// that may use them.
    Inlined,
}

/// The statements, in blocks that hand on what they bind and do not consume, if `needed` after the
/// statement of that number.
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
        // Tuples of one and none are the block's affair: a trailing comma suits all.
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

/// The number of the last statement that names each variable. Of several statements that bind a
/// name, there is one.
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
