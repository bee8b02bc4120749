//! Lines that know where they come from.

use crate::html::within_markdown;

/// A text of which each line knows where it comes from.
#[derive(Default)]
pub(super) struct Traced {
    pub(super) text: String,
    /// Of each line: where it begins in the text, and the line in the file.
    lines: Vec<(usize, usize)>,
}

impl Traced {
    pub(super) fn push(&mut self, line: &str, origin: usize) {
        self.lines.push((self.text.len(), origin));
        self.text.push_str(line);
        self.text.push('\n');
    }

    /// HTML that stands by itself, indented as the line in whose place it comes.
    pub(super) fn push_block(&mut self, indented_as: &str, html: &str, origin: usize) {
        let indent: String = indented_as
            .chars()
            .take_while(|c| c.is_whitespace())
            .collect();
        self.push("", origin);
        self.push(&format!("{indent}{}", within_markdown(html)), origin);
        self.push("", origin);
    }

    pub(super) fn origin(&self, offset: usize) -> usize {
        let after = self.lines.partition_point(|&(start, _)| start <= offset);
        self.lines
            .get(after.saturating_sub(1))
            .map_or(0, |&(_, origin)| origin)
    }
}

/// For each line of a text into which files may have been included, the line in the file.
pub(super) fn origins(expanded: &str, original: &str) -> Vec<usize> {
    let originals: Vec<&str> = original.lines().collect();
    let mut next = 0;
    expanded
        .lines()
        .map(|line| {
            // An included line is that of the `{{#include}}`: the file stands still there.
            let including = originals.get(next).is_some_and(|text| text.contains("{{#"));
            if originals.get(next) == Some(&line) {
                next += 1;
                next
            } else if including && originals.get(next + 1) == Some(&line) {
                next += 2;
                next
            } else {
                next + 1
            }
        })
        .collect()
}
