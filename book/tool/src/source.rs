//! Links into the repository's sources, and the pages that show them.

use crate::equation::Place;
use crate::symbol::line_of;
use anyhow::{Context as _, Result};
use qrt_drawing::escaped;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;
use std::path::{Component, Path, PathBuf};

/// Largest size of a file that is shown, in bytes: pages of larger files would be too large.
const LARGEST: u64 = 280_000;

/// Style sheet of these pages.
const STYLE: &str = include_str!("source.css");

/// Script that applies the theme that the reader chose in the book.
const THEME: &str = "try { const theme = localStorage.getItem('mdbook-theme'); \
    if (theme) document.documentElement.dataset.theme = \
    ['light', 'rust'].includes(theme) ? 'light' : 'dark'; } catch (e) {}";

/// The files that the book refers to.
pub(crate) struct Sources {
    root: PathBuf,
    files: BTreeMap<String, File>,
}

struct File {
    text: String,
    /// Chapters that refer to it: their page and name.
    chapters: BTreeSet<(String, String)>,
}

impl Sources {
    /// Creates the list of sources of the repository at `root`.
    pub(crate) fn new(root: &Path) -> Self {
        Self {
            root: root.to_owned(),
            files: BTreeMap::new(),
        }
    }

    /// Returns the page of a file, and the line where it defines the symbol, if one is named; as a path from
    /// the book's root. `chapter` is the page and the name of the chapter that refers to it.
    pub(crate) fn link(
        &mut self,
        path: &str,
        symbol: Option<&str>,
        chapter: (&str, &str),
    ) -> Result<String, String> {
        if !self.files.contains_key(path) {
            let text = self.read(path)?;
            let chapters = BTreeSet::new();
            self.files.insert(path.to_owned(), File { text, chapters });
        }
        let Some(file) = self.files.get_mut(path) else {
            return Err(format!("no file {path}"));
        };
        file.chapters
            .insert((chapter.0.to_owned(), chapter.1.to_owned()));
        let page = format!("source/{}", page_of(path));
        match symbol {
            None => Ok(page),
            Some(symbol) => match line_of(&file.text, symbol) {
                Some(line) => Ok(format!("{page}#L{line}")),
                None => Err(format!("{path} does not define `{symbol}`")),
            },
        }
    }

    /// Same as [`link`](Self::link), for an equation's place.
    pub(crate) fn place(&mut self, place: &Place, chapter: (&str, &str)) -> Result<String, String> {
        self.link(&place.path, Some(&place.symbol), chapter)
    }

    fn read(&self, path: &str) -> Result<String, String> {
        let inside = Path::new(path)
            .components()
            .all(|part| matches!(part, Component::Normal(_)));
        let file = self.root.join(path);
        let Some(size) = file
            .metadata()
            .ok()
            .filter(|data| inside && data.is_file())
            .map(|data| data.len())
        else {
            return Err(format!("no file {path} in the repository"));
        };
        if size > LARGEST {
            return Err(format!(
                "{path} has {size} bytes; pages are made of files up to {LARGEST}"
            ));
        }
        std::fs::read_to_string(&file).map_err(|error| format!("cannot read {path}: {error}"))
    }

    /// Writes the pages of all linked files, and removes those of earlier builds.
    pub(crate) fn write(&self, folder: &Path) -> Result<()> {
        let mut wanted = BTreeMap::new();
        wanted.insert("style.css".to_owned(), STYLE.to_owned());
        for (path, file) in &self.files {
            wanted.insert(page_of(path), page(path, file));
        }
        crate::files::write_all(folder, &wanted).context("cannot write the pages of source files")
    }
}

/// Returns the name of a file's page. mdBook takes `.md` in a link for one of its own pages.
fn page_of(path: &str) -> String {
    format!(
        "{}.html",
        path.strip_suffix(".md")
            .map_or(path.to_owned(), |path| format!("{path}-md"))
    )
}

fn page(path: &str, file: &File) -> String {
    let root = "../".repeat(path.split('/').count());
    let mut page = format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>{path}</title>\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <link rel=\"stylesheet\" href=\"{root}source/style.css\">\n<script>{THEME}</script>\n\
         </head>\n<body>\n<header><h1>{path}</h1>\n<p>The book refers to it in ",
        path = escaped(path)
    );
    for (index, (chapter, name)) in file.chapters.iter().enumerate() {
        let comma = if index == 0 { "" } else { ", " };
        let _ = write!(
            page,
            "{comma}<a href=\"{root}{chapter}\">{}</a>",
            escaped(name)
        );
    }
    // `tabindex` lets a reader scroll long lines by keyboard, too.
    page.push_str(".</p></header>\n<main><pre tabindex=\"0\">");
    for (index, line) in file.text.lines().enumerate() {
        let _ = writeln!(page, "<b id=L{}></b>{}", index + 1, escaped(line));
    }
    page.push_str("</pre></main>\n</body>\n</html>\n");
    page
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_link_leads_to_the_line_and_a_page_is_made() {
        let root = tempfile::tempdir().unwrap();
        std::fs::create_dir_all(root.path().join("a")).unwrap();
        std::fs::write(root.path().join("a/b.rs"), "\nfn f() -> Vec<u8> {}\n").unwrap();
        let mut sources = Sources::new(root.path());
        let chapter = ("x.html", "A & B");
        assert_eq!(
            sources.link("a/b.rs", Some("f"), chapter).unwrap(),
            "source/a/b.rs.html#L2"
        );
        let refused = |path, symbol| Sources::new(root.path()).link(path, symbol, chapter);
        assert_eq!(
            refused("a/b.rs", Some("g")).unwrap_err(),
            "a/b.rs does not define `g`"
        );
        for outside in ["a/c.rs", "a", "../etc/passwd", "/etc/passwd", ""] {
            let error = refused(outside, None).unwrap_err();
            assert_eq!(error, format!("no file {outside} in the repository"));
        }
        std::fs::write(root.path().join("large.txt"), "x".repeat(280_001)).unwrap();
        assert!(
            refused("large.txt", None)
                .unwrap_err()
                .contains("280001 bytes")
        );

        std::fs::write(root.path().join("a/README.md"), "").unwrap();
        assert_eq!(
            sources.link("a/README.md", None, chapter).unwrap(),
            "source/a/README-md.html"
        );

        let folder = root.path().join("source");
        std::fs::create_dir_all(&folder).unwrap();
        std::fs::write(folder.join("old.rs.html"), "").unwrap();
        sources.write(&folder).unwrap();
        let page = std::fs::read_to_string(folder.join("a/b.rs.html")).unwrap();
        assert!(page.contains("<b id=L2></b>fn f() -&gt; Vec&lt;u8&gt; {}"));
        assert!(page.contains("<a href=\"../../x.html\">A &amp; B</a>"));
        assert!(folder.join("style.css").exists() && !folder.join("old.rs.html").exists());
    }
}
