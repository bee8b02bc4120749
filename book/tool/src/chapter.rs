//! One chapter: what our Markdown has beyond mdBook's becomes plain Markdown and HTML.

use crate::complaint::Complaint;
use crate::equation::{Equation, Place};
use crate::formula::Formulas;
use crate::html::{escape, within_markdown};
use crate::source::Sources;
use pulldown_cmark::{Event, LinkType, Options, Parser, Tag, TagEnd};
use std::fmt::Write as _;
use std::ops::Range;

/// What all chapters share while they are worked on.
pub(crate) struct Workshop {
    /// Formulas, and KaTeX.
    pub(crate) formulas: Formulas,
    /// Files of the repository that chapters show.
    pub(crate) sources: Sources,
    /// What is wrong so far.
    pub(crate) complaints: Vec<Complaint>,
}

/// Where a chapter comes from and goes.
pub(crate) struct Chapter<'a> {
    /// Its file, as seen from the repository's root.
    pub(crate) file: &'a str,
    /// Its page, as seen from the book's root.
    pub(crate) page: &'a str,
    /// Its name in the table of contents.
    pub(crate) name: &'a str,
    /// Its text as it is in the file, before anything was included.
    pub(crate) original: &'a str,
}

/// A chapter that has been worked on.
pub(crate) struct Processed {
    /// Its Markdown, ready for mdBook.
    pub(crate) markdown: String,
    /// The equations that it restates, and the lines where they begin.
    pub(crate) equations: Vec<(Equation, usize)>,
    /// Whether it has an interactive figure.
    pub(crate) interactive: bool,
}

impl Chapter<'_> {
    /// From this chapter's page to the book's root.
    fn to_root(&self) -> String {
        "../".repeat(self.page.matches('/').count())
    }
}

/// Markdown as mdBook reads it, with formulas.
fn options() -> Options {
    Options::ENABLE_TABLES
        | Options::ENABLE_FOOTNOTES
        | Options::ENABLE_STRIKETHROUGH
        | Options::ENABLE_TASKLISTS
        | Options::ENABLE_HEADING_ATTRIBUTES
        | Options::ENABLE_DEFINITION_LIST
        | Options::ENABLE_GFM
        | Options::ENABLE_MATH
}

/// A text of which each line knows where it comes from.
#[derive(Default)]
struct Traced {
    text: String,
    /// Of each line: where it begins in the text, and the line in the file.
    lines: Vec<(usize, usize)>,
}

impl Traced {
    fn push(&mut self, line: &str, origin: usize) {
        self.lines.push((self.text.len(), origin));
        self.text.push_str(line);
        self.text.push('\n');
    }

    /// HTML that stands by itself, indented as the line in whose place it comes.
    fn push_block(&mut self, indented_as: &str, html: &str, origin: usize) {
        let indent: String = indented_as
            .chars()
            .take_while(|c| c.is_whitespace())
            .collect();
        self.push("", origin);
        self.push(&format!("{indent}{}", within_markdown(html)), origin);
        self.push("", origin);
    }

    fn origin(&self, offset: usize) -> usize {
        let after = self.lines.partition_point(|&(start, _)| start <= offset);
        self.lines
            .get(after.saturating_sub(1))
            .map_or(0, |&(_, origin)| origin)
    }
}

/// For each line of a text into which files may have been included, the line in the file.
fn origins(expanded: &str, original: &str) -> Vec<usize> {
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

/// A line that opens or closes a fence: its indentation, character, length and what follows.
fn fence(line: &str) -> Option<(usize, char, usize, &str)> {
    let text = line.trim_start();
    let mark = text.chars().next().filter(|c| matches!(c, '`' | '~'))?;
    let info = text.trim_start_matches(mark);
    let length = text.len() - info.len();
    (length >= 3 && !(mark == '`' && info.contains('`')))
        .then(|| (line.len() - text.len(), mark, length, info.trim()))
}

impl Workshop {
    /// Works on a chapter: formulas, equations and links to sources.
    pub(crate) fn process(&mut self, chapter: &Chapter<'_>, content: &str) -> Processed {
        let mut equations = Vec::new();
        let traced = self.blocks(chapter, content, &mut equations);
        let (markdown, interactive) = self.inlines(chapter, &traced);
        Processed {
            markdown,
            equations,
            interactive,
        }
    }

    /// Equations, and formulas that begin on a line of their own.
    fn blocks(
        &mut self,
        chapter: &Chapter<'_>,
        content: &str,
        equations: &mut Vec<(Equation, usize)>,
    ) -> Traced {
        let origins = origins(content, chapter.original);
        let lines: Vec<&str> = content.lines().collect();
        let mut traced = Traced::default();
        let mut index = 0;
        while let Some(&line) = lines.get(index) {
            let origin = origins[index];
            if let Some((_, mark, length, info)) = fence(line) {
                let body = index + 1;
                let end = lines[body..]
                    .iter()
                    .position(|line| {
                        fence(line).is_some_and(|(_, other, long, rest)| {
                            other == mark && long >= length && rest.is_empty()
                        })
                    })
                    .map_or(lines.len(), |offset| body + offset);
                if info.split_whitespace().next() == Some("equation") {
                    match Equation::parse(info, &lines[body..end], chapter.file, origin + 1) {
                        Ok(equation) => {
                            let html = self.equation(chapter, &equation, origin);
                            traced.push_block(line, &html, origin);
                            equations.push((equation, origin));
                        }
                        Err(complaints) => self.complaints.extend(complaints),
                    }
                } else {
                    for at in index..lines.len().min(end + 1) {
                        traced.push(lines[at], origins[at]);
                    }
                }
                index = end + 1;
            } else if let Some((tex, after)) = display(&lines, index) {
                let html = self.formula(chapter, &tex, true, origin);
                traced.push_block(
                    line,
                    &format!("<div class=\"formula\">{html}</div>"),
                    origin,
                );
                index = after;
            } else {
                traced.push(line, origin);
                index += 1;
            }
        }
        traced
    }

    /// Formulas within lines, links to sources, and whether there is an interactive figure.
    fn inlines(&mut self, chapter: &Chapter<'_>, traced: &Traced) -> (String, bool) {
        let text = &traced.text;
        let mut changes: Vec<(Range<usize>, String)> = Vec::new();
        let mut interactive = false;
        let mut in_code = false;
        let mut in_table = false;
        for (event, range) in Parser::new_ext(text, options()).into_offset_iter() {
            let origin = traced.origin(range.start);
            match event {
                Event::Start(Tag::CodeBlock(_)) => in_code = true,
                Event::End(TagEnd::CodeBlock) => in_code = false,
                Event::Start(Tag::Table(_)) => in_table = true,
                Event::End(TagEnd::Table) => in_table = false,
                Event::InlineMath(tex) | Event::DisplayMath(tex) => {
                    let display = text[range.clone()].starts_with("$$");
                    let mut tex = tex.into_string();
                    if in_table {
                        // There, a bar is written `\|` lest it end the cell.
                        tex = tex.replace("\\|", "|");
                    }
                    let html = self.formula(chapter, &tex, display, origin);
                    changes.push((range, within_markdown(&html)));
                }
                Event::Start(Tag::Link {
                    link_type: LinkType::Inline,
                    dest_url,
                    ..
                }) => {
                    if let Some(target) = dest_url.strip_prefix("source:")
                        && let Some(start) = text[range.clone()].rfind("](source:")
                    {
                        let start = range.start + start + 2;
                        let end = start + "source:".len() + target.len();
                        let (path, symbol) = match target.split_once('#') {
                            Some((path, symbol)) => (path, Some(symbol)),
                            None => (target, None),
                        };
                        let link = self
                            .sources
                            .link(path, symbol, (chapter.page, chapter.name))
                            .unwrap_or_else(|message| {
                                self.complain(chapter, origin, message);
                                "#".to_owned()
                            });
                        changes.push((start..end, chapter.to_root() + &link));
                    }
                }
                Event::Text(words) if !in_code => {
                    let escaped = text[..range.start].ends_with('\\');
                    let words = words
                        .strip_prefix('$')
                        .filter(|_| escaped)
                        .unwrap_or(&words);
                    if words.contains('$') {
                        let rest: String = text[range.start..]
                            .chars()
                            .take(30)
                            .take_while(|&c| c != '\n')
                            .collect();
                        self.complain(
                            chapter,
                            origin,
                            format!(
                                "a `$` without its pair at `{rest}`: a dollar is written `\\$`"
                            ),
                        );
                    }
                }
                Event::Html(html) | Event::InlineHtml(html) => {
                    interactive |= html.contains("data-figure=");
                    if html.contains('$') {
                        self.complain(chapter, origin, "formulas are not read within HTML");
                    }
                }
                _ => {}
            }
        }
        changes.sort_by_key(|(range, _)| range.start);
        let mut markdown = String::with_capacity(text.len() * 2);
        let mut done = 0;
        for (range, replacement) in changes {
            markdown.push_str(&text[done..range.start]);
            markdown.push_str(&replacement);
            done = range.end;
        }
        markdown.push_str(&text[done..]);
        (markdown, interactive)
    }

    fn complain(&mut self, chapter: &Chapter<'_>, line: usize, message: impl Into<String>) {
        self.complaints
            .push(Complaint::at(chapter.file, line, message));
    }

    fn formula(&mut self, chapter: &Chapter<'_>, tex: &str, display: bool, line: usize) -> String {
        match self.formulas.render(tex, display) {
            Ok(html) => html,
            Err(error) => {
                self.complain(chapter, line, format!("`{}`: {error}", tex.trim()));
                format!("<code>{}</code>", escape(tex))
            }
        }
    }

    /// An equation's HTML: it, its number, and where its code and its test are.
    fn equation(&mut self, chapter: &Chapter<'_>, equation: &Equation, line: usize) -> String {
        let number = equation.number;
        let formula = self.formula(chapter, &equation.tex, true, line);
        let mut html = format!(
            "<div class=\"equation\" id=\"eq-{number}\"><div class=\"equation-row\">\
             <div class=\"formula\">{formula}</div>\
             <a class=\"equation-number\" href=\"#eq-{number}\">({number})</a></div>\
             <div class=\"equation-links\">code {}, test {}",
            self.places(chapter, &equation.code, line),
            self.places(chapter, &equation.test, line),
        );
        if let Some(letter) = equation.erratum {
            let root = chapter.to_root();
            let _ = write!(
                html,
                ", <a href=\"{root}errata.html#{letter}\">erratum {letter}</a>"
            );
        }
        html.push_str("</div></div>");
        html
    }

    fn places(&mut self, chapter: &Chapter<'_>, places: &[Place], line: usize) -> String {
        let mut html = String::new();
        for place in places {
            let link = self
                .sources
                .place(place, (chapter.page, chapter.name))
                .unwrap_or_else(|message| {
                    self.complain(chapter, line, message);
                    "#".to_owned()
                });
            let comma = if html.is_empty() { "" } else { ", " };
            let _ = write!(
                html,
                "{comma}<a href=\"{}{link}\" title=\"{}\"><code>{}</code></a>",
                chapter.to_root(),
                escape(&place.path),
                // Where a narrow page may break it.
                escape(&place.symbol).replace('_', "_<wbr>")
            );
        }
        html
    }

    /// The index of all equations, for the line `{{#equations}}` of a chapter.
    pub(crate) fn index(&mut self, chapter: &Chapter<'_>, equations: &[Indexed]) -> String {
        let mut html = String::from(
            "<div class=\"table-wrapper\"><table class=\"equations\"><thead><tr><th></th>\
             <th>What it says, and where</th><th>Code and test</th><th>Erratum</th>\
             </tr></thead><tbody>",
        );
        let root = chapter.to_root();
        for Indexed {
            equation,
            page,
            name,
            file,
            line,
        } in equations
        {
            let of = Chapter {
                file,
                page,
                name,
                original: "",
            };
            let number = equation.number;
            let what = self.line(&of, &equation.what, *line);
            let code = self.places(chapter, &equation.code, *line);
            let test = self.places(chapter, &equation.test, *line);
            let erratum = equation.erratum.map_or(String::new(), |letter| {
                format!("<a href=\"{root}errata.html#{letter}\">{letter}</a>")
            });
            let _ = write!(
                html,
                "<tr><td><a href=\"{root}{page}#eq-{number}\">({number})</a></td>\
                 <td>{what}<br><small><a href=\"{root}{page}\">{}</a></small></td>\
                 <td><small>code {code}<br>test {test}</small></td><td>{erratum}</td></tr>",
                escape(name)
            );
        }
        html.push_str("</tbody></table></div>");
        within_markdown(&html)
    }

    /// A line of Markdown as HTML.
    fn line(&mut self, chapter: &Chapter<'_>, markdown: &str, line: usize) -> String {
        let mut traced = Traced::default();
        traced.push(markdown, line);
        let (markdown, _) = self.inlines(chapter, &traced);
        let mut html = String::new();
        pulldown_cmark::html::push_html(&mut html, Parser::new_ext(&markdown, options()));
        html.trim()
            .trim_start_matches("<p>")
            .trim_end_matches("</p>")
            .to_owned()
    }
}

/// An equation as the index lists it.
pub(crate) struct Indexed {
    /// The equation.
    pub(crate) equation: Equation,
    /// The page that restates it.
    pub(crate) page: String,
    /// The name of that chapter.
    pub(crate) name: String,
    /// That chapter's file.
    pub(crate) file: String,
    /// The line there.
    pub(crate) line: usize,
}

/// A formula that begins with `$$` at the beginning of a line and ends with `$$` at the end of
/// this or a later one, before any empty line; and the line after it.
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

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    fn workshop(root: &Path) -> Workshop {
        Workshop {
            formulas: Formulas::new(),
            sources: Sources::new(root),
            complaints: Vec::new(),
        }
    }

    fn processed(content: &str) -> (Processed, Vec<String>) {
        let mut workshop = workshop(Path::new(env!("CARGO_MANIFEST_DIR")));
        let chapter = Chapter {
            file: "x.md",
            page: "x.html",
            name: "X",
            original: content,
        };
        let processed = workshop.process(&chapter, content);
        let complaints = workshop
            .complaints
            .iter()
            .map(ToString::to_string)
            .collect();
        (processed, complaints)
    }

    /// As mdBook would go on.
    fn html(markdown: &str) -> String {
        let mut html = String::new();
        let options = (options() - Options::ENABLE_MATH) | Options::ENABLE_SMART_PUNCTUATION;
        pulldown_cmark::html::push_html(&mut html, Parser::new_ext(markdown, options));
        html
    }

    #[test]
    fn formulas_are_read_outside_code_only() {
        let content = "Let $x_1*y_1*z$ be, and `$x$`.\n\n```sh\n$ qrt\n$$ a $$\n```\n\n    $ qrt\n";
        let (processed, complaints) = processed(content);
        assert_eq!(complaints, [""; 0]);
        assert_eq!(processed.markdown.matches("class=\"katex\"").count(), 1);
        assert!(processed.markdown.contains("`$x$`"));
        assert!(processed.markdown.contains("```sh\n$ qrt\n$$ a $$\n```"));
        assert!(processed.markdown.contains("    $ qrt"));
        assert!(!html(&processed.markdown).contains("<em>"));
    }

    #[test]
    fn a_dollar_is_written_with_a_backslash() {
        let (processed, complaints) = processed("It costs \\$3, or \\$4.\n");
        assert_eq!(complaints, [""; 0]);
        assert_eq!(processed.markdown, "It costs \\$3, or \\$4.\n");
        let (_, complaints) = super::tests::processed("Well.\n\nIt costs $3.\n");
        assert_eq!(
            complaints,
            ["x.md:3: a `$` without its pair at `$3.`: a dollar is written `\\$`"]
        );
    }

    #[test]
    fn displayed_formulas_may_look_like_lists() {
        let (processed, complaints) =
            processed("Text\n$$\na\n- b\n+ c\n= d\n$$\nmore.\n\n- item\n  $$x$$\n");
        assert_eq!(complaints, [""; 0]);
        let html = html(&processed.markdown);
        assert_eq!(html.matches("class=\"katex-display\"").count(), 2);
        assert!(html.contains("<p>more.</p>"));
        assert_eq!(html.matches("<li>").count(), 1);
        let item = html.split("<li>").nth(1).unwrap();
        assert!(
            item.split("</li>")
                .next()
                .unwrap()
                .contains("katex-display")
        );
    }

    #[test]
    fn formulas_stand_in_tables_and_headings() {
        let (processed, complaints) = processed(
            "| a | b |\n|---|---|\n| $P(x \\| y)$ | $\\{0, 1\\}^n$ |\n\n## The sign of $\\lvert x\\rvert$\n",
        );
        assert_eq!(complaints, [""; 0]);
        let html = html(&processed.markdown);
        assert_eq!(html.matches("<td>").count(), 2);
        assert_eq!(html.matches("class=\"katex\"").count(), 3);
    }

    #[test]
    fn a_bad_formula_is_refused_at_its_line() {
        let (_, complaints) = processed("One\n\n$a$ and\n$\\wrong$\n\n$$\n\\frac{1\n$$\n");
        assert_eq!(complaints.len(), 2);
        assert!(complaints[0].starts_with("x.md:6: "), "{complaints:?}");
        assert!(complaints[1].starts_with("x.md:4: `\\wrong`: KaTeX parse error: Undefined"));
    }

    #[test]
    fn lines_are_those_of_the_file_whatever_it_includes() {
        let original = "a\n```rust\n{{#include x}}\n```\nb\n";
        let expanded = "a\n```rust\n1\n2\n3\n```\nb\n";
        assert_eq!(origins(expanded, original), [1, 2, 3, 3, 3, 4, 5]);
    }

    #[test]
    fn equations_and_links_lead_to_sources() {
        let content = "See [it](source:src/equation.rs#Equation).\n\n```equation 3\na = b\n---\n\
            what: `a` is $b$\ncode: src/equation.rs#parse\ntest: src/equation.rs#a_block_is_read\n\
            erratum: c\n```\n\nand [this](source:src/equation.rs#Nothing)\n";
        let (processed, complaints) = processed(content);
        assert_eq!(
            complaints,
            ["x.md:12: src/equation.rs does not define `Nothing`"]
        );
        let markdown = &processed.markdown;
        assert!(markdown.contains("See [it](source/src/equation.rs.html#L"));
        assert!(markdown.contains("<div class=\"equation\" id=\"eq-3\">"));
        assert!(markdown.contains("errata.html#c"));
        assert_eq!(processed.equations.len(), 1);
        assert_eq!(processed.equations[0].1, 3);

        let mut workshop = workshop(Path::new(env!("CARGO_MANIFEST_DIR")));
        let (equation, line) = processed.equations.into_iter().next().unwrap();
        let indexed = Indexed {
            equation,
            page: "x.html".to_owned(),
            name: "X".to_owned(),
            file: "x.md".to_owned(),
            line,
        };
        let chapter = Chapter {
            file: "equations.md",
            page: "equations.html",
            name: "Equations",
            original: "",
        };
        let index = workshop.index(&chapter, &[indexed]);
        assert!(index.contains("<a href=\"x.html#eq-3\">(3)</a>"));
        assert!(index.contains("<code>a</code> is <span class=\"katex\">"));
        assert!(workshop.complaints.is_empty());
    }

    #[test]
    fn interactive_figures_are_noticed() {
        let figure = "<figure class=\"qrt-interactive\" data-figure=\"map\"><img src=\"a.svg\" alt=\"\"></figure>\n";
        assert!(processed(figure).0.interactive);
        assert!(!processed("`data-figure=\"map\"`\n").0.interactive);
    }
}
