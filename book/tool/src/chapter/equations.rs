//! Equations as chapters and the index of all equations show them.

use super::inlines::inlines;
use super::traced::Traced;
use super::{Chapter, Workshop, options};
use crate::equation::{Equation, Place};
use crate::html::within_markdown;
use pulldown_cmark::Parser;
use qrt_drawing::escaped;
use std::fmt::Write as _;

/// An equation in the index.
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

impl Workshop {
    /// Returns the HTML of an equation: the formula, its number, and the places of its code and its test.
    pub(super) fn equation(
        &mut self,
        chapter: &Chapter<'_>,
        equation: &Equation,
        line: usize,
    ) -> String {
        let number = equation.number;
        let formula = self.formula(chapter, &equation.tex, true, line);
        let mut html = format!(
            "<div class=\"equation\" id=\"eq-{number}\"><div class=\"equation-row\">\
             <div class=\"formula\">{formula}</div>\
             <a class=\"equation-number\" href=\"#eq-{number}\">({number})</a></div>{}\
             <div class=\"equation-links\">code {}, test {}",
            self.printed(chapter, equation, line),
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

    /// Returns the formula that the paper prints in an equation's place, if it differs.
    fn printed(&mut self, chapter: &Chapter<'_>, equation: &Equation, line: usize) -> String {
        if equation.printed.is_empty() {
            return String::new();
        }
        let formula = self.formula(chapter, &equation.printed, true, line);
        format!(
            "<div class=\"equation-printed\"><span>as printed</span>\
             <div class=\"formula\">{formula}</div></div>"
        )
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
                escaped(&place.path),
                // A narrow page may break the line there.
                escaped(&place.symbol).replace('_', "_<wbr>")
            );
        }
        html
    }

    /// Returns the index of all equations, for the line `{{#equations}}` of a chapter.
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
                escaped(name)
            );
        }
        html.push_str("</tbody></table></div>");
        within_markdown(&html)
    }

    /// Renders a line of Markdown as HTML.
    pub(super) fn line(&mut self, chapter: &Chapter<'_>, markdown: &str, line: usize) -> String {
        let mut traced = Traced::default();
        traced.push(markdown, line);
        let (markdown, _) = inlines(self, chapter, &traced);
        let mut html = String::new();
        pulldown_cmark::html::push_html(&mut html, Parser::new_ext(&markdown, options()));
        html.trim()
            .trim_start_matches("<p>")
            .trim_end_matches("</p>")
            .to_owned()
    }
}
