//! Blocks: equations, and formulas that begin on a line of their own.

use super::traced::{Traced, origins};
use super::{Chapter, Workshop, options};
use crate::equation::Equation;
use pulldown_cmark::{CodeBlockKind, Event, Parser, Tag};
use std::collections::BTreeMap;

/// A block of code as the Markdown parser finds it, also within lists.
struct Code {
    /// Number of the line after its last one, from 0.
    after: usize,
    /// Text after the fence; `None` for a block that is code by its indentation.
    info: Option<String>,
}

/// Returns the blocks of code of a text, by their first lines, from 0.
fn code(content: &str) -> BTreeMap<usize, Code> {
    let starts: Vec<usize> = std::iter::once(0)
        .chain(content.match_indices('\n').map(|(at, _)| at + 1))
        .collect();
    let line = |offset| starts.partition_point(|&start| start <= offset) - 1;
    let mut blocks = BTreeMap::new();
    for (event, range) in Parser::new_ext(content, options()).into_offset_iter() {
        if let Event::Start(Tag::CodeBlock(kind)) = event {
            let after = line(range.end.saturating_sub(1)) + 1;
            let info = match kind {
                CodeBlockKind::Fenced(info) => Some(info.into_string()),
                CodeBlockKind::Indented => None,
            };
            blocks.insert(line(range.start), Code { after, info });
        }
    }
    blocks
}

/// Parses a line that opens or closes a fence: its character, its length, and the text after it.
fn fence(line: &str) -> Option<(char, usize, &str)> {
    let text = line.trim_start();
    let mark = text.chars().next().filter(|c| matches!(c, '`' | '~'))?;
    let info = text.trim_start_matches(mark);
    let length = text.len() - info.len();
    (length >= 3 && !(mark == '`' && info.contains('`'))).then(|| (mark, length, info.trim()))
}

/// Returns the text after the fence of a block, and the lines within.
fn within<'a, 'b>(block: &'b [&'a str]) -> Result<(&'a str, &'b [&'a str]), &'static str> {
    let (first, rest) = block.split_first().ok_or("an equation without a line")?;
    let (mark, length, info) =
        fence(first).ok_or("an equation's fence stands at the beginning of its line")?;
    let indentation = |line: &str| line.len() - line.trim_start().len();
    let closes = |(other, long, after): (char, usize, &str)| {
        other == mark && long >= length && after.is_empty()
    };
    let closed = rest.split_last().filter(|(last, _)| {
        // A fence that is indented further is a line of the block.
        indentation(last) < indentation(first) + 4 && fence(last).is_some_and(closes)
    });
    let (_, body) = closed.ok_or("this equation's block is never closed")?;
    Ok((info, body))
}

impl Workshop {
    /// Replaces equations, and formulas that begin on a line of their own.
    pub(super) fn blocks(
        &mut self,
        chapter: &Chapter<'_>,
        content: &str,
        equations: &mut Vec<(Equation, usize)>,
    ) -> Traced {
        let origins = origins(content, chapter.original);
        let lines: Vec<&str> = content.lines().collect();
        let code = code(content);
        let mut traced = Traced::default();
        let mut index = 0;
        while let Some(&line) = lines.get(index) {
            let origin = origins[index];
            if let Some(block) = code.get(&index) {
                let after = block.after.clamp(index + 1, lines.len());
                let info = block.info.as_deref().unwrap_or_default();
                if info.split_whitespace().next() == Some("equation") {
                    let block = &lines[index..after];
                    if let Some(equation) = self.read(chapter, block, origin) {
                        let html = self.equation(chapter, &equation, origin);
                        traced.push_block(line, &html, origin);
                        equations.push((equation, origin));
                    }
                } else {
                    for at in index..after {
                        traced.push(lines[at], origins[at]);
                    }
                }
                index = after;
            } else if let Some((tex, after)) = display(&lines, index) {
                let html = self.formula(chapter, &tex, true, origin);
                let html = format!("<div class=\"formula\">{html}</div>");
                traced.push_block(line, &html, origin);
                index = after;
            } else if let Some(after) = self.figure(chapter, (&lines, &origins), index, &mut traced)
            {
                index = after;
            } else {
                traced.push(line, origin);
                index += 1;
            }
        }
        traced
    }

    /// Returns the equation of a block, or records its faults.
    fn read(&mut self, chapter: &Chapter<'_>, block: &[&str], line: usize) -> Option<Equation> {
        let (info, body) = within(block)
            .map_err(|message| self.complain(chapter, line, message))
            .ok()?;
        Equation::parse(info, body, chapter.file, line + 1)
            .map_err(|complaints| self.complaints.extend(complaints))
            .ok()
    }
}

/// Returns the formula that begins with `$$` at the beginning of the line `first` and ends with `$$` at
/// the end of this or a later line, before any empty line; and the number of the line after it.
fn display(lines: &[&str], first: usize) -> Option<(String, usize)> {
    let rest = lines[first].trim().strip_prefix("$$")?;
    if let Some(tex) = rest.strip_suffix("$$").filter(|tex| !tex.is_empty()) {
        return (!tex.contains("$$")).then(|| (tex.to_owned(), first + 1));
    }
    if rest.contains("$$") {
        return None;
    }
    let mut tex = rest.to_owned();
    for (index, line) in lines.iter().enumerate().skip(first + 1) {
        let line = line.trim();
        if line.is_empty() {
            return None;
        }
        tex.push('\n');
        if let Some(last) = line.strip_suffix("$$") {
            tex.push_str(last);
            return Some((tex, index + 1));
        }
        tex.push_str(line);
    }
    None
}
