//! Elements within lines: formulas, links to sources, and HTML.

use super::traced::Traced;
use super::{Chapter, Workshop, options};
use crate::html::within_markdown;
use pulldown_cmark::{Event, LinkType, Parser, Tag, TagEnd};
use std::ops::Range;

/// Replaces formulas and links to sources by Markdown that mdBook reads; also returns true if the text
/// has an interactive figure.
pub(super) fn inlines(
    workshop: &mut Workshop,
    chapter: &Chapter<'_>,
    traced: &Traced,
) -> (String, bool) {
    let mut inlines = Inlines {
        workshop,
        chapter,
        traced,
        changes: Vec::new(),
        in_code: false,
        in_table: false,
        interactive: false,
    };
    for (event, range) in Parser::new_ext(&traced.text, options()).into_offset_iter() {
        inlines.read(event, range);
    }
    (inlines.changed(), inlines.interactive)
}

/// State while a text is read.
struct Inlines<'a> {
    workshop: &'a mut Workshop,
    chapter: &'a Chapter<'a>,
    traced: &'a Traced,
    /// Ranges of the text, and their replacements.
    changes: Vec<(Range<usize>, String)>,
    in_code: bool,
    in_table: bool,
    interactive: bool,
}

impl Inlines<'_> {
    fn read(&mut self, event: Event<'_>, range: Range<usize>) {
        match event {
            Event::Start(Tag::CodeBlock(_)) => self.in_code = true,
            Event::End(TagEnd::CodeBlock) => self.in_code = false,
            Event::Start(Tag::Table(_)) => self.in_table = true,
            Event::End(TagEnd::Table) => self.in_table = false,
            Event::InlineMath(tex) | Event::DisplayMath(tex) => self.formula(&tex, range),
            Event::Start(Tag::Link {
                link_type: LinkType::Inline,
                dest_url,
                ..
            }) => {
                if let Some(target) = dest_url.strip_prefix("source:") {
                    self.source(target, range);
                } else {
                    self.cite(&dest_url, range);
                }
            }
            Event::Text(words) if !self.in_code => self.check_dollars(&words, range.start),
            Event::Html(html) | Event::InlineHtml(html) => {
                self.interactive |= html.contains("data-figure=");
                if html.contains('$') {
                    self.complain(range.start, "formulas are not read within HTML");
                }
            }
            _ => {}
        }
    }

    fn formula(&mut self, tex: &str, range: Range<usize>) {
        let display = self.traced.text[range.clone()].starts_with("$$");
        let origin = self.traced.origin(range.start);
        // In a table, a bar is written `\|`, so that it does not end the cell.
        let unescaped = self.in_table.then(|| tex.replace("\\|", "|"));
        let tex = unescaped.as_deref().unwrap_or(tex);
        let html = self.workshop.formula(self.chapter, tex, display, origin);
        self.changes.push((range, within_markdown(&html)));
    }

    /// Replaces a link to a source; `target` is the file and maybe the symbol.
    fn source(&mut self, target: &str, range: Range<usize>) {
        let Some(start) = self.traced.text[range.clone()].rfind("](source:") else {
            return;
        };
        let start = range.start + start + 2;
        let end = start + "source:".len() + target.len();
        let (path, symbol) = match target.split_once('#') {
            Some((path, symbol)) => (path, Some(symbol)),
            None => (target, None),
        };
        let of = (self.chapter.page, self.chapter.name);
        let link = self.workshop.sources.link(path, symbol, of);
        let link = link.unwrap_or_else(|message| {
            self.complain(range.start, message);
            "#".to_owned()
        });
        self.changes
            .push((start..end, self.chapter.to_root() + &link));
    }

    /// Replaces a link that cites an entry of the bibliography.
    fn cite(&mut self, target: &str, range: Range<usize>) {
        let root = self.chapter.to_root();
        let cited = (self.workshop.bibliography).cite(target, (self.chapter.page, &root));
        match cited {
            None => {}
            Some(Ok(html)) => self.changes.push((range, within_markdown(&html))),
            Some(Err(message)) => self.complain(range.start, message),
        }
    }

    /// Checks words, in which a dollar sign must have a backslash before it.
    fn check_dollars(&mut self, words: &str, at: usize) {
        let (before, text) = self.traced.text.split_at(at);
        let words = match words.strip_prefix('$') {
            Some(rest) if before.ends_with('\\') => rest,
            _ => words,
        };
        if words.contains('$') {
            let rest = text.lines().next().unwrap_or_default();
            let rest: String = rest.chars().take(30).collect();
            self.complain(
                at,
                format!("a `$` without its pair at `{rest}`: a dollar is written `\\$`"),
            );
        }
    }

    fn complain(&mut self, at: usize, message: impl Into<String>) {
        let origin = self.traced.origin(at);
        self.workshop.complain(self.chapter, origin, message);
    }

    /// Returns the text with all changes.
    fn changed(&mut self) -> String {
        let text = &self.traced.text;
        self.changes.sort_by_key(|(range, _)| range.start);
        let mut markdown = String::with_capacity(text.len() * 2);
        let mut done = 0;
        for (range, replacement) in &self.changes {
            markdown.push_str(&text[done..range.start]);
            markdown.push_str(replacement);
            done = range.end;
        }
        markdown.push_str(&text[done..]);
        markdown
    }
}
