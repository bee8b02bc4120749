//! Converts lines and columns of characters to bytes.

use qrt_syntax::line_starts;
use qrt_syntax::tree::Span;
use saphyr_parser::Marker;

/// Turns the parser's lines and columns, which count characters, into bytes.
pub(super) struct Locator<'a> {
    text: &'a str,
    /// Added to every offset.
    base: usize,
    number: u32,
    /// The start of each line; a line ends in LF, CR LF or CR, as in YAML.
    lines: Vec<usize>,
    /// The last result: events mostly come in order, so long lines are walked once.
    last: Position,
}

/// A place in the text, by line, column and byte.
struct Position {
    line: usize,
    column: usize,
    byte: usize,
}

impl<'a> Locator<'a> {
    pub(super) fn new(text: &'a str, base: usize, number: u32) -> Self {
        let lines = std::iter::once(0)
            .chain(line_starts(text.as_bytes()))
            .collect();
        Self {
            text,
            base,
            number,
            lines,
            last: Position {
                line: 1,
                column: 0,
                byte: 0,
            },
        }
    }

    /// Returns the byte in `text` of a marker; past the end, the end.
    pub(super) fn offset(&mut self, marker: &Marker) -> usize {
        let (line, column) = (marker.line().max(1), marker.col());
        let last = &self.last;
        let (mut at, skip) = if line == last.line && column >= last.column {
            (last.byte, column - last.column)
        } else {
            (
                self.lines.get(line - 1).copied().unwrap_or(self.text.len()),
                column,
            )
        };
        at += self.text[at..]
            .chars()
            .take(skip)
            .map(char::len_utf8)
            .sum::<usize>();
        self.last = Position {
            line,
            column,
            byte: at,
        };
        at
    }

    pub(super) fn span(&mut self, span: &saphyr_parser::Span) -> Span {
        let start = self.offset(&span.start);
        let end = self.offset(&span.end).max(start);
        let trimmed = self.text[start..end].trim_end().len();
        Span {
            source: self.number,
            start: self.base + start,
            end: self.base + start + trimmed,
        }
    }

    /// Returns the word that starts at `at`, or the one character there.
    pub(super) fn word(&self, at: usize) -> Span {
        let rest = self.text.get(at..).unwrap_or_default();
        let word = |c: char| c.is_alphanumeric() || "_-*&!".contains(c);
        let length = rest.find(|c| !word(c)).unwrap_or(rest.len());
        let length = length.max(rest.chars().next().map_or(0, char::len_utf8));
        let (start, end) = (self.base + at, self.base + at + length);
        Span {
            source: self.number,
            start,
            end,
        }
    }

    /// Returns `at`, if a tab indents its line; else the first tab that indents a line below it.
    pub(super) fn indented_by_tab(&self, at: usize) -> Option<usize> {
        let line = self.lines.partition_point(|&start| start <= at).max(1) - 1;
        let tab = |start: &usize| {
            let rest = &self.text[*start..];
            let blanks = rest.len() - rest.trim_start_matches([' ', '\t']).len();
            rest[..blanks].find('\t').map(|tab| start + tab)
        };
        if tab(&self.lines[line]).is_some() {
            return Some(at);
        }
        self.lines[line + 1..].iter().find_map(tab)
    }

    pub(super) fn is_bracket(&self, span: Span) -> bool {
        let start = span.start - self.base;
        self.text[start..].starts_with([']', '}'])
    }
}
