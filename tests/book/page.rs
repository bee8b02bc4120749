//! The book's pages as its tests read them: fences, prose and links.

mod fences;
mod links;
mod prose;

pub(crate) use fences::Fence;
pub(crate) use links::Link;

use std::fs;
use std::path::PathBuf;

/// Folder of the pages, relative to the root of the repository.
pub(crate) const FOLDER: &str = "book/src";

/// True if generated files are to be written again.
pub(crate) fn bless() -> bool {
    std::env::var_os("QRT_BLESS").is_some()
}

/// A page of the book.
#[derive(Clone, Debug)]
pub(crate) struct Page {
    /// Name of the file, for example `sampling.md`.
    pub(crate) name: String,
    /// The whole text.
    pub(crate) text: String,
}

impl Page {
    /// Creates a page that is not in a file.
    pub(crate) fn new(name: &str, text: &str) -> Self {
        Self {
            name: name.to_owned(),
            text: text.to_owned(),
        }
    }

    /// Loads the page `name`, if its file is there.
    pub(crate) fn load(name: &str) -> Option<Self> {
        let text = fs::read_to_string(PathBuf::from(FOLDER).join(name)).ok()?;
        Some(Self::new(name, &text))
    }

    /// Returns the place of line `line`, counted from 1, for a message.
    pub(crate) fn at(&self, line: usize) -> String {
        format!("{FOLDER}/{}:{line}", self.name)
    }

    /// Returns the fenced blocks in order.
    pub(crate) fn fences(&self) -> Vec<Fence> {
        fences::read(&self.text)
    }

    /// Returns the text with fences, code, formulas and comments blanked out: lines stay where they are.
    pub(crate) fn prose(&self) -> String {
        prose::blanked(&self.text)
    }

    /// Returns the links and pictures of the prose, with their lines.
    pub(crate) fn links(&self) -> Vec<Link> {
        links::read(&self.prose())
    }
}

/// Returns the pages that `SUMMARY.md` lists, in its order.
pub(crate) fn listed() -> Vec<String> {
    let summary = Page::load("SUMMARY.md").expect("the book has a summary");
    let pages = summary.links().into_iter().map(|link| link.target);
    pages.collect()
}

/// Loads all listed pages that exist.
pub(crate) fn pages() -> Vec<Page> {
    listed()
        .iter()
        .filter_map(|name| Page::load(name))
        .collect()
}

/// Fails with all of `failures`, unless there are none.
pub(crate) fn report(failures: &[String]) {
    assert!(
        failures.is_empty(),
        "{} findings:\n{}",
        failures.len(),
        failures.join("\n")
    );
}
