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
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// Beginning of a caption.
const CAPTION: &str = ": ";
/// Beginning of a line of labels.
const LABELS: &str = "; ";
/// A link to which the figure's number is added.
const LINK: &str = "[Figure](";

/// Numbers of figures, by `page.html#fig-NAME`.
#[derive(Default)]
pub(crate) struct Figures(BTreeMap<String, usize>);

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
        if self.figures.0.insert(place, number).is_some() {
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

    /// Returns a chapter's text with the numbers of the figures that it refers to.
    pub(crate) fn numbered(&mut self, chapter: &Chapter<'_>, content: &str) -> String {
        let mut parts = content.split(LINK);
        let mut out = parts.next().unwrap_or_default().to_owned();
        for part in parts {
            let target = part.split(')').next().unwrap_or_default();
            let (page, id) = target.split_once('#').unwrap_or((target, ""));
            let page = match page {
                "" => chapter.page.to_owned(),
                page => page.replace(".md", ".html"),
            };
            if let Some(number) = self.figures.0.get(&format!("{page}#{id}")) {
                // Writing to a string cannot fail.
                let _ = write!(out, "[Figure {number}](");
            } else {
                self.complain(chapter, 1, format!("`{LINK}{target})` leads to no figure"));
                out.push_str(LINK);
            }
            out.push_str(part);
        }
        out
    }
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
