//! One chapter: converts this book's extensions of Markdown to plain Markdown and HTML.

mod blocks;
mod equations;
mod figures;
mod inlines;
#[cfg(test)]
mod tests;
mod traced;

pub(crate) use equations::Indexed;
pub(crate) use figures::Figures;

use crate::bibliography::Bibliography;
use crate::complaint::Complaint;
use crate::equation::Equation;
use crate::formula::Formulas;
use crate::source::Sources;
use pulldown_cmark::Options;
use qrt_drawing::escaped;

/// State that all chapters share.
pub(crate) struct Workshop {
    /// Formulas, and KaTeX.
    pub(crate) formulas: Formulas,
    /// Files of the repository that chapters show.
    pub(crate) sources: Sources,
    /// Entries that a chapter may cite.
    pub(crate) bibliography: Bibliography,
    /// The numbers of figures so far.
    pub(crate) figures: Figures,
    /// Complaints so far.
    pub(crate) complaints: Vec<Complaint>,
}

/// Files and names of a chapter.
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
    /// True if it has an interactive figure.
    pub(crate) interactive: bool,
}

impl Chapter<'_> {
    /// Returns the path from this chapter's page to the book's root.
    fn to_root(&self) -> String {
        "../".repeat(self.page.matches('/').count())
    }
}

/// Returns the options with which mdBook parses Markdown, with formulas.
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

impl Workshop {
    /// Processes a chapter: formulas, equations and links to sources.
    pub(crate) fn process(&mut self, chapter: &Chapter<'_>, content: &str) -> Processed {
        let mut equations = Vec::new();
        let traced = self.blocks(chapter, content, &mut equations);
        let (markdown, interactive) = inlines::inlines(self, chapter, &traced);
        Processed {
            markdown,
            equations,
            interactive,
        }
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
                format!("<code>{}</code>", escaped(tex))
            }
        }
    }
}
