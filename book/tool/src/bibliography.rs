//! The bibliography: the tooltips of citations in a chapter, for readers who point at one or reach it
//! by keyboard.

use qrt_drawing::escaped;
use std::collections::BTreeMap;
use std::path::Path;

/// Name of the page with the bibliography, without an extension.
const PAGE: &str = "related-work";

/// The entries of the bibliography, by key.
#[derive(Default)]
pub(crate) struct Bibliography(BTreeMap<String, String>);

impl Bibliography {
    /// Reads the bibliography of a book's sources: rows of a table that begin with
    /// `| <a id="KEY"></a>KEY |`. A book may have none.
    pub(crate) fn read(src: &Path) -> Self {
        let text = std::fs::read_to_string(src.join(PAGE).with_extension("md"));
        Self::parse(&text.unwrap_or_default())
    }

    fn parse(text: &str) -> Self {
        let entry = |line: &str| {
            let (key, rest) = line.strip_prefix("| <a id=\"")?.split_once('"')?;
            let said = rest.split_once(" | ")?.1.trim_end_matches([' ', '|']);
            Some((key.to_owned(), plain(said)))
        };
        Self(text.lines().filter_map(entry).collect())
    }

    /// Returns the HTML of a link that is a citation. `target` is the link's target, on the page `page`;
    /// `root` leads from that page to the book's root. `None` for a link that is not a citation.
    ///
    /// # Errors
    /// A key that the bibliography lacks.
    pub(crate) fn cite(
        &self,
        target: &str,
        (page, root): (&str, &str),
    ) -> Option<Result<String, String>> {
        let (file, key) = target.split_once('#')?;
        let own = file.is_empty() && page == format!("{PAGE}.html");
        let cites = file == format!("{PAGE}.md") || own;
        // Keys are written in capitals; headings are not.
        if !cites || !key.starts_with(|c: char| c.is_ascii_uppercase()) {
            return None;
        }
        let Some(said) = self.0.get(key) else {
            return Some(Err(format!("`{key}` is not in the bibliography")));
        };
        let said = escaped(said);
        Some(Ok(format!(
            "<a class=\"qrt-cite\" href=\"{root}{PAGE}.html#{key}\" aria-label=\"{key}: {said}\" \
             data-cite=\"{said}\">[{key}]</a>"
        )))
    }
}

/// Returns the words of `markdown`, without its marks and without the targets of links.
fn plain(markdown: &str) -> String {
    let mut out = String::new();
    let mut rest = markdown;
    while let Some((before, link)) = rest.split_once("](") {
        out.push_str(before);
        rest = link.split_once(')').map_or("", |(_, after)| after);
    }
    out.push_str(rest);
    out.replace(['*', '[', ']'], "")
}

#[cfg(test)]
mod tests {
    use super::*;

    const ROW: &str = "| <a id=\"VG95\"></a>VG95 | E. Veach, L. J. Guibas. *Optimally \"combining\"*. \
                       1995, [arXiv:1](https://arxiv.org/abs/1) |";

    #[test]
    fn a_citation_says_what_it_cites() {
        let all = Bibliography::parse(ROW);
        let cited = all.cite("related-work.md#VG95", ("lights.html", ""));
        let html = cited.unwrap().unwrap();
        assert!(html.contains("href=\"related-work.html#VG95\""), "{html}");
        let said = "E. Veach, L. J. Guibas. Optimally &quot;combining&quot;. 1995, arXiv:1";
        assert!(html.contains(&format!("data-cite=\"{said}\"")), "{html}");
        assert!(all.cite("#VG95", ("related-work.html", "")).is_some());
    }

    #[test]
    fn what_is_not_in_the_bibliography_is_told() {
        let all = Bibliography::parse(ROW);
        let none = all.cite("related-work.md#VG96", ("lights.html", ""));
        assert_eq!(
            none,
            Some(Err("`VG96` is not in the bibliography".to_owned()))
        );
        for other in [
            "#VG95",
            "lights.md#VG95",
            "related-work.md#bibliography",
            "related-work.md",
        ] {
            assert!(all.cite(other, ("lights.html", "")).is_none(), "{other}");
        }
    }
}
