//! Lines with the places that they come from.

use crate::html::within_markdown;

/// A text with the place in the file of each line.
#[derive(Default)]
pub(super) struct Traced {
    pub(super) text: String,
    /// For each line, its offset in the text, and the line's number in the file.
    lines: Vec<(usize, usize)>,
}

impl Traced {
    pub(super) fn push(&mut self, line: &str, origin: usize) {
        self.lines.push((self.text.len(), origin));
        self.text.push_str(line);
        self.text.push('\n');
    }

    /// Appends HTML as a block of its own, indented as the line that it replaces.
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

/// Returns, for each line of a text with included files, its line number in the file.
pub(super) fn origins(expanded: &str, original: &str) -> Vec<usize> {
    let originals: Vec<&str> = original.lines().collect();
    let mut next = 0;
    expanded
        .lines()
        .map(|line| {
            // An included line gets the line number of its `{{#include}}`.
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
