//! Figures: a picture, or an interactive figure, with the caption below it and a number.
//!
//! ```text
//! ![What is seen](figures/noise-strip.png)
//! ; labels of | its parts | side by side, which may be left out
//! : What it means, in Markdown, to the end of the paragraph.
//! ```
//!
//! An interactive figure has its caption behind `</figure>`. A link `[Figure](page.md#fig-NAME)`
//! gets the figure's number, wherever it stands: NAME is the file's, or `interactive-` and the
//! interactive figure's.

use super::traced::Traced;
use super::{Chapter, Workshop};
use crate::html::within_markdown;
use qrt_drawing::escaped;
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// Beginning of a caption.
const CAPTION: &str = ": ";
/// Beginning of a line of labels.
const LABELS: &str = "; ";
/// A link to which the figure's number is added.
const LINK: &str = "[Figure](";

/// The line of a chapter that the list of figures replaces.
const LIST: &str = "{{#figures}}";

/// Figures, by `page.html#fig-NAME`.
#[derive(Default)]
pub(crate) struct Figures(BTreeMap<String, Numbered>);

/// A figure with its number.
struct Numbered {
    number: usize,
    /// The first sentence of its caption, in Markdown.
    says: String,
    /// The name of its chapter.
    chapter: String,
}

/// A figure of a chapter.
struct Figure<'a> {
    id: String,
    /// The lines of the picture, or those of the interactive figure but for its end.
    shown: &'a [&'a str],
    interactive: bool,
    labels: Option<&'a str>,
    caption: Vec<&'a str>,
    /// Number of the line after its last one.
    after: usize,
}

impl Workshop {
    /// Adds the figure that begins on the line `first`, if one does; returns the line after it.
    pub(super) fn figure(
        &mut self,
        chapter: &Chapter<'_>,
        (lines, origins): (&[&str], &[usize]),
        first: usize,
        traced: &mut Traced,
    ) -> Option<usize> {
        let figure = read(lines, first)?;
        let origin = origins[first];
        if figure.caption.is_empty() {
            self.complain(
                chapter,
                origin,
                "this figure has no caption: a paragraph right below it that begins with `: `",
            );
        }
        let number = self.figures.0.len() + 1;
        let place = format!("{}#{}", chapter.page, figure.id);
        let numbered = Numbered {
            number,
            says: first_sentence(&figure.caption.join(" ")),
            chapter: chapter.name.to_owned(),
        };
        if self.figures.0.insert(place, numbered).is_some() {
            self.complain(chapter, origin, "this page shows the figure twice");
        }
        let mut push =
            |text: &str, line: usize| traced.push(text, origins[line.min(origins.len() - 1)]);
        push("", first);
        if figure.interactive {
            let tag =
                figure.shown[0].replacen("<figure ", &format!("<figure id=\"{}\" ", figure.id), 1);
            push(&tag, first);
        } else {
            push(
                &format!("<figure class=\"qrt-figure\" id=\"{}\">", figure.id),
                first,
            );
            push("", first);
            push(figure.shown[0], first);
        }
        for (k, line) in figure.shown.iter().enumerate().skip(1) {
            push(line, first + k);
        }
        let at = first + figure.shown.len();
        if let Some(labels) = figure.labels {
            let cells = labels
                .split(" | ")
                .map(|label| format!("<span>{label}</span>"));
            let cells: String = cells.collect();
            push("", at);
            push(&format!("<div class=\"qrt-labels\">{cells}</div>"), at);
        }
        for text in ["", "<figcaption>", ""] {
            push(text, at);
        }
        for (k, line) in figure.caption.iter().enumerate() {
            let line = match k {
                0 => format!("<strong>Figure {number}.</strong> {line}"),
                _ => (*line).to_owned(),
            };
            push(&line, at + k);
        }
        for text in ["", "</figcaption>", "</figure>", ""] {
            push(text, figure.after - 1);
        }
        Some(figure.after)
    }

    /// Returns a chapter's text with the numbers of the figures that it refers to, and with the list of all
    /// figures in place of a line `{{#figures}}`.
    pub(crate) fn numbered(&mut self, chapter: &Chapter<'_>, content: &str) -> String {
        let is_list = |line: &str| line.trim() == LIST;
        let content = if content.lines().any(is_list) {
            &content.replace(LIST, &self.list(chapter))
        } else {
            content
        };
        let mut parts = content.split(LINK);
        let mut out = parts.next().unwrap_or_default().to_owned();
        for part in parts {
            let target = part.split(')').next().unwrap_or_default();
            let (page, id) = target.split_once('#').unwrap_or((target, ""));
            let page = match page {
                "" => chapter.page.to_owned(),
                page => page.replace(".md", ".html"),
            };
            if let Some(figure) = self.figures.0.get(&format!("{page}#{id}")) {
                // Writing to a string cannot fail.
                let _ = write!(out, "[Figure {}](", figure.number);
            } else {
                self.complain(chapter, 1, format!("`{LINK}{target})` leads to no figure"));
                out.push_str(LINK);
            }
            out.push_str(part);
        }
        out
    }
}

impl Workshop {
    /// Returns the list of all figures, by chapter and number.
    fn list(&mut self, chapter: &Chapter<'_>) -> String {
        let figures = std::mem::take(&mut self.figures.0);
        let mut ordered: Vec<_> = figures.iter().collect();
        ordered.sort_by_key(|(_, figure)| figure.number);
        let root = chapter.to_root();
        let mut html = String::new();
        for chapters in ordered.chunk_by(|(_, a), (_, b)| a.chapter == b.chapter) {
            let _ = write!(html, "<h2>{}</h2><ul>", escaped(&chapters[0].1.chapter));
            for (place, figure) in chapters {
                let says = self.line(chapter, &figure.says, 1);
                let number = figure.number;
                let _ = write!(
                    html,
                    "<li><a href=\"{root}{place}\">Figure {number}</a>. {says}</li>"
                );
            }
            html.push_str("</ul>");
        }
        self.figures.0 = figures;
        within_markdown(&html)
    }
}

/// Returns the first sentence of a caption, with the texts of links in place of the links.
fn first_sentence(caption: &str) -> String {
    let mut text = String::new();
    let mut rest = caption;
    while let Some((before, link)) = rest.split_once('[') {
        let Some((shown, after)) = link.split_once("](") else {
            break;
        };
        let (_, after) = after.split_once(')').unwrap_or_default();
        text.push_str(before);
        text.push_str(shown);
        rest = after;
    }
    text.push_str(rest);
    let end = text.find(". ").map_or(text.len(), |end| end + 1);
    text.truncate(end);
    text
}

/// Parses the figure that begins on the line `first`.
fn read<'a>(lines: &'a [&'a str], first: usize) -> Option<Figure<'a>> {
    let line = lines[first];
    let interactive = line.starts_with("<figure ");
    let end = if interactive {
        if name(line)? == "playground" {
            return None;
        }
        (first..lines.len()).find(|&k| lines[k].trim_end().ends_with("</figure>"))?
    } else {
        if !line.starts_with("![") {
            return None;
        }
        (first..lines.len()).find(|&k| lines[k].trim_end().ends_with(')'))?
    };
    let shown = &lines[first..=end];
    let id = if interactive {
        format!("fig-interactive-{}", name(line)?)
    } else {
        let last = lines[end];
        let file = last.rsplit_once("(figures/")?.1.strip_suffix(')')?;
        format!("fig-{}", file.rsplit_once('.')?.0)
    };
    let mut caption = Vec::new();
    let mut after = end + 1;
    let labels = lines.get(after).and_then(|line| line.strip_prefix(LABELS));
    after += usize::from(labels.is_some());
    if let Some(text) = lines.get(after).and_then(|line| line.strip_prefix(CAPTION)) {
        caption.push(text);
        after += 1;
        while let Some(line) = lines.get(after).filter(|line| !line.trim().is_empty()) {
            caption.push(line);
            after += 1;
        }
    }
    // The end tag of an interactive figure comes after the caption.
    let shown = match shown.split_last() {
        Some((last, rest)) if interactive && last.trim() == "</figure>" => rest,
        _ => shown,
    };
    Some(Figure {
        id,
        shown,
        interactive,
        labels,
        caption,
        after,
    })
}

/// Returns the name of an interactive figure: `data-figure` names one that needs a server, `data-still`
/// one that does not.
fn name(tag: &str) -> Option<&str> {
    let named = ["data-figure=\"", "data-still=\""];
    let after = named.iter().find_map(|attribute| tag.split_once(attribute));
    after?.1.split('"').next()
}
