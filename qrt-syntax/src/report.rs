//! Reports: problems shown in their source as a compiler shows them, with file, line and column,
//! the source line, a caret, the code and the suggested fix.

use super::kinds::{Description, What};
use super::line::line_starts;
use super::problem::{At, Problem};
use super::tree::{Node, Span, Value};
use annotate_snippets::renderer::DecorStyle;
use annotate_snippets::{
    AnnotationKind, Group, Level, Origin, Renderer, Snippet, normalize_untrusted_str,
};
use std::fmt;
use std::ops::Range;

/// A text that problems point into.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Source {
    /// The name shown before the line number: a file's path, or `<--set>`.
    pub name: String,
    /// The text, without a byte order mark, its lines ended by LF.
    pub text: String,
}

impl Source {
    /// Creates a named source. It drops a byte order mark at the start, and replaces CR LF and CR
    /// by LF, which means the same in YAML.
    pub fn new(name: impl Into<String>, text: impl Into<String>) -> Self {
        let mut text = text.into();
        if text.starts_with('\u{feff}') {
            text.drain(..'\u{feff}'.len_utf8());
        }
        if text.contains("\r\n") {
            text = text.replace("\r\n", "\n");
        }
        if text.contains('\r') {
            text = text.replace('\r', "\n");
        }
        Self {
            name: name.into(),
            text,
        }
    }
}

/// A problem in words, and its place if it has one.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Described {
    description: Description,
    /// The place; `None` if the file cannot be read.
    span: Option<Span>,
    /// The second relevant place.
    also: Option<Span>,
}

/// A report of all problems of a scene.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Report {
    /// The scene's text first, then that of each override.
    sources: Vec<Source>,
    /// The problems in the order of their places, at most [`MOST`].
    problems: Vec<Described>,
    /// Number of further problems that were left out.
    omitted: usize,
    /// True if the report holds only warnings.
    warns: bool,
}

/// One problem of a report, for callers that format problems themselves.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Reported<'a> {
    /// The problem's code, such as `QRT0101`.
    pub code: &'static str,
    /// The problem in one sentence.
    pub message: &'a str,
    /// The label at the place; may be empty.
    pub label: &'a str,
    /// The suggested fix, if there is one.
    pub help: Option<&'a str>,
    /// The name of the source that has the problem: a file's path, or `<--set>`.
    pub file: &'a str,
    /// The place in that source; `None` if the file cannot be read.
    pub place: Option<Location>,
}

/// A place in a text that a report shows.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Location {
    /// True if the place is in the scene's own text, not in that of an override.
    pub in_scene: bool,
    /// The line, from 1.
    pub line: usize,
    /// The column, from 1, in characters.
    pub column: usize,
    /// The byte range in the text as [`Source::new`] stores it.
    pub bytes: Range<usize>,
}

/// Maximum number of problems that a report lists.
pub const MOST: usize = 1000;

/// Maximum number of source bytes shown with a problem. Longer lines are of no use to a reader and
/// slow to lay out, so their problems show line and column only.
const LONGEST: usize = 4000;

impl Report {
    /// Creates a report of one problem about a file as a whole.
    pub fn of_file(name: &str, what: impl Into<What>) -> Self {
        let problem = Problem::new(super::Path::root(), what);
        Self::new(vec![Source::new(name, "")], None, vec![problem])
    }

    /// Creates a report of `problems` at their places in `sources`. Paths refer to `tree`, which is
    /// the tree of the first source.
    pub fn new(sources: Vec<Source>, tree: Option<&Node>, mut problems: Vec<Problem>) -> Self {
        let omitted = problems.len().saturating_sub(MOST);
        problems.truncate(MOST);
        let described = problems
            .iter()
            .map(|problem| describe(&sources, tree, problem));
        let mut described: Vec<Described> = described.collect();
        described.sort_by_key(|described| {
            described
                .span
                .map(|span| (span.source, span.start, span.end))
        });
        let mut problems: Vec<Described> = Vec::with_capacity(described.len());
        for described in described {
            let same = |other: &Described| {
                (other.description.code, &other.description.message)
                    == (described.description.code, &described.description.message)
            };
            let mut here = problems
                .iter()
                .rev()
                .take_while(|other| other.span == described.span);
            if !here.any(same) {
                problems.push(described);
            }
        }
        Self {
            sources,
            problems,
            omitted,
            warns: false,
        }
    }

    /// Turns the report into warnings, about things that are not wrong but probably unintended.
    pub fn warning(self) -> Self {
        Self {
            warns: true,
            ..self
        }
    }

    /// The codes, in order.
    pub fn codes(&self) -> Vec<&'static str> {
        self.problems
            .iter()
            .map(|described| described.description.code)
            .collect()
    }

    /// The problems, in the order of their places; at most [`MOST`].
    ///
    /// ```
    /// use qrt_syntax::tree::Span;
    /// use qrt_syntax::{Problem, Report, Source, Yaml};
    ///
    /// let second = Span { source: 0, start: 8, end: 11 };
    /// let problem = Problem::new(second, Yaml::SecondDocument);
    /// let source = Source::new("two.yaml", "name: a\n---\n");
    /// let report = Report::new(vec![source], None, vec![problem]);
    /// let last = report.problems().last().unwrap();
    /// let place = last.place.unwrap();
    /// assert_eq!((place.line, place.column, place.bytes), (2, 1, 8..11));
    /// assert_eq!(last.help, Some("a file holds one scene"));
    /// ```
    pub fn problems(&self) -> impl Iterator<Item = Reported<'_>> {
        let first = self.sources.first().map_or("", |source| &source.name);
        let sources = self.sources.iter();
        let lines: Vec<Lines<'_>> = sources
            .map(|source| Lines::from_text(&source.text))
            .collect();
        self.problems.iter().map(move |described| {
            let place = described.span.and_then(|span| {
                let source = self.sources.get(span.source as usize)?;
                let (line, column) = lines.get(span.source as usize)?.position(span);
                Some(Location {
                    in_scene: span.source == 0,
                    line,
                    column,
                    bytes: visible(&source.text, span),
                })
            });
            Reported {
                code: described.description.code,
                message: &described.description.message,
                label: &described.description.label,
                help: described.description.help.as_deref(),
                file: described.span.map_or(first, |span| self.name(span)),
                place,
            }
        })
    }

    /// Returns the scene's own text, to which places with [`Location::in_scene`] refer.
    pub fn text(&self) -> &str {
        self.sources.first().map_or("", |source| &source.text)
    }

    /// Renders all problems as text, with terminal escape codes if `colour`.
    pub fn render(&self, colour: bool) -> String {
        let renderer = if colour {
            Renderer::styled()
        } else {
            Renderer::plain()
        };
        let renderer = renderer.decor_style(DecorStyle::Ascii);
        let mut out = String::new();
        let lines: Vec<_> = self
            .sources
            .iter()
            .map(|source| Lines::from_text(&source.text))
            .collect();
        for described in &self.problems {
            out.push_str(&self.render_one(&renderer, &lines, described));
            out.push_str("\n\n");
        }
        let name = self
            .sources
            .first()
            .map_or("scene", |source| source.name.as_str());
        let count = self.problems.len() + self.omitted;
        if self.warns {
            return visible_controls(&out);
        }
        let plural = if count == 1 { "" } else { "s" };
        let shown = match self.omitted {
            0 => String::new(),
            _ => format!(", the first {} of them above", self.problems.len()),
        };
        let closing = format!("{name}: {count} error{plural}{shown}");
        let last = Level::ERROR.no_name().primary_title(closing.as_str());
        out.push_str(&renderer.render(&[Group::with_title(last)]));
        out.push('\n');
        visible_controls(&out)
    }

    fn render_one(
        &self,
        renderer: &Renderer,
        lines: &[Lines<'_>],
        described: &Described,
    ) -> String {
        let description = &described.description;
        let level = if self.warns {
            Level::WARNING
        } else {
            Level::ERROR
        };
        let title = level
            .primary_title(description.message.as_str())
            .id(description.code);
        let mut group = Group::with_title(title);
        let primary = described
            .span
            .and_then(|span| Some((lines.get(span.source as usize)?, span)));
        if let Some((lines_here, span)) = primary {
            let other = described.also.map(|also| (also, description.also));
            let near = other.filter(|(also, _)| also.source == span.source);
            let both = near.map(|(also, _)| lines_here.excerpt(&[span, also]));
            let both = both.filter(|excerpt| excerpt.text.len() <= LONGEST);
            let near = near.filter(|_| both.is_some());
            let excerpt = both.unwrap_or_else(|| lines_here.excerpt(&[span]));
            let mut marks = vec![Mark {
                kind: AnnotationKind::Primary,
                range: excerpt.within(span),
                label: description.label.as_str(),
            }];
            if let Some((also, label)) = near {
                marks.push(Mark {
                    kind: AnnotationKind::Context,
                    range: excerpt.within(also),
                    label,
                });
            }
            if excerpt.text.len() > LONGEST {
                let (line, column) = lines_here.position(span);
                let origin = Origin::path(self.name(span)).line(line).char_column(column);
                group = group.element(origin);
                if !description.label.is_empty() {
                    group = group
                        .element(Level::NOTE.message(normalize_untrusted_str(&description.label)));
                }
            } else {
                group = group.element(excerpt.snippet(self.name(span), marks));
            }
            if let Some((also, label)) = other.filter(|_| near.is_none())
                && let Some(lines) = lines.get(also.source as usize)
                && let excerpt = lines.excerpt(&[also])
                && excerpt.text.len() <= LONGEST
            {
                let marks = vec![Mark {
                    kind: AnnotationKind::Context,
                    range: excerpt.within(also),
                    label,
                }];
                group = group.element(excerpt.snippet(self.name(also), marks));
            }
        } else {
            let name = self
                .sources
                .first()
                .map_or("", |source| source.name.as_str());
            group = group.element(Origin::path(name));
        }
        if let Some(help) = &description.help {
            group = group.element(Level::HELP.message(normalize_untrusted_str(help)));
        }
        renderer.render(&[group])
    }

    fn name(&self, span: Span) -> &str {
        self.sources
            .get(span.source as usize)
            .map_or("", |source| source.name.as_str())
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.render(false))
    }
}

impl std::error::Error for Report {}

/// Replaces the control characters U+0080 to U+009F, which a terminal may obey. The renderer itself
/// makes ASCII control characters visible.
fn visible_controls(text: &str) -> String {
    text.replace(|c| matches!(c, '\u{80}'..='\u{9f}'), "\u{fffd}")
}

/// A source with the starts of its lines.
struct Lines<'a> {
    text: &'a str,
    starts: Vec<usize>,
}

impl<'a> Lines<'a> {
    fn from_text(text: &'a str) -> Self {
        let starts = std::iter::once(0).chain(line_starts(text.as_bytes()));
        Self {
            text,
            starts: starts.collect(),
        }
    }

    /// Line and column of a span's start, from 1; columns count characters.
    fn position(&self, span: Span) -> (usize, usize) {
        let at = visible(self.text, span).start;
        let line = self.starts.partition_point(|&start| start <= at).max(1);
        (
            line,
            1 + self.text[self.starts[line - 1]..at].chars().count(),
        )
    }

    /// The lines from the first to the last of the spans.
    fn excerpt(&self, spans: &[Span]) -> Excerpt<'a> {
        let shown = spans.iter().map(|span| visible(self.text, *span));
        let (start, end) = shown.fold((self.text.len(), 0), |(start, end), range| {
            (start.min(range.start), end.max(range.end))
        });
        let first = self.starts.partition_point(|&at| at <= start).max(1) - 1;
        let after = self.starts.partition_point(|&at| at <= end);
        let end = self.starts.get(after).map_or(self.text.len(), |at| at - 1);
        let start = self.starts[first];
        Excerpt {
            first_line: first + 1,
            start,
            text: &self.text[start..end],
        }
    }
}

/// A mark under the bytes `range` of an excerpt.
struct Mark<'a> {
    kind: AnnotationKind,
    range: Range<usize>,
    label: &'a str,
}

/// The source lines to show: enough for the spans, however long the source is.
struct Excerpt<'a> {
    first_line: usize,
    start: usize,
    text: &'a str,
}

impl<'a> Excerpt<'a> {
    /// The visible part of `span`, counted from the excerpt's start.
    fn within(&self, span: Span) -> Range<usize> {
        let start = span.start.saturating_sub(self.start);
        let end = span.end.saturating_sub(self.start);
        visible(
            self.text,
            Span {
                source: span.source,
                start,
                end,
            },
        )
    }

    fn snippet(
        &self,
        name: &'a str,
        marks: Vec<Mark<'a>>,
    ) -> Snippet<'a, annotate_snippets::Annotation<'a>> {
        let annotations = marks.into_iter().map(|mark| {
            let annotation = mark.kind.span(mark.range);
            if mark.label.is_empty() {
                annotation
            } else {
                annotation.label(mark.label)
            }
        });
        Snippet::source(self.text)
            .path(name)
            .line_start(self.first_line)
            .annotations(annotations)
    }
}

/// Returns the bytes of `span` to show: on character boundaries, within the text, only the span's
/// first line, without trailing blanks.
fn visible(text: &str, span: Span) -> Range<usize> {
    let start = text.floor_char_boundary(span.start.min(text.len()));
    let end = text
        .floor_char_boundary(span.end.min(text.len()))
        .max(start);
    let line = text[start..end]
        .split(['\n', '\r'])
        .next()
        .unwrap_or_default();
    start..start + line.trim_end().len()
}

fn describe(sources: &[Source], tree: Option<&Node>, problem: &Problem) -> Described {
    let span = |at: &At| match at {
        At::Span(span) => Some(*span),
        At::Path(path) => {
            let found = tree?.resolve(path);
            let part = problem.within.as_ref().filter(|_| found.exact);
            let part = part.and_then(|within| inner(sources, found.node, within));
            Some(part.unwrap_or(found.span))
        }
    };
    Described {
        description: problem.description(),
        span: span(&problem.at),
        also: problem.also.as_ref().and_then(span),
    }
}

/// Converts a byte range within a scalar's text to its source; `None` unless the source has the
/// text verbatim.
fn inner(sources: &[Source], node: &Node, within: &Range<usize>) -> Option<Span> {
    let Value::Scalar(scalar) = &node.value else {
        return None;
    };
    let written = sources
        .get(node.span.source as usize)?
        .text
        .get(node.span.start..node.span.end)?;
    let quote = usize::from(scalar.quoted);
    let body = written.get(quote..written.len().checked_sub(quote)?)?;
    let verbatim = body == scalar.text && within.end <= body.len() && within.start <= within.end;
    let start = node.span.start + quote;
    verbatim.then_some(Span {
        source: node.span.source,
        start: start + within.start,
        end: start + within.end,
    })
}
