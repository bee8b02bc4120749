//! Long straight lines of code, in blocks.
//!
//! Each `let` opens a scope within the scope of the one before, and compilers traverse scopes
//! recursively: a function of thousands of them overflows their stacks. The scopes of a block end
//! with it. In unoptimised code, each `let` also has a place of its own in the function's frame;
//! the frame of a closure ends with it.

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

/// Returns the statements in blocks. Each block returns the variables that it binds and does not
/// consume.
pub(super) fn blocks(lines: &[Line]) -> String {
    let mut out = String::new();
    for block in lines.chunks(LENGTH) {
        let mut live: Vec<&str> = Vec::new();
        for line in block {
            live.retain(|name| !line.taken.iter().any(|taken| taken == name));
            live.extend(line.bound.iter().map(String::as_str));
        }
        // A trailing comma suits tuples of one and of none, too.
        let live: String = live.iter().fold(String::new(), |mut all, name| {
            let _ = write!(all, "{name}, ");
            all
        });
        let _ = writeln!(out, "let ({live}) = (|| {{");
        for line in block {
            out.push_str(&line.text);
            out.push('\n');
        }
        let _ = writeln!(out, "({live})\n}})();");
    }
    out
}
