//! The book as a whole: mdBook's preprocessor.

use crate::bibliography::Bibliography;
use crate::chapter::{Chapter, Figures, Indexed, Workshop};
use crate::complaint::Complaint;
use crate::equation;
use crate::formula::Formulas;
use crate::interactive;
use crate::source::Sources;
use anyhow::{Context as _, Result};
use mdbook_preprocessor::book::{Book, BookItem};
use mdbook_preprocessor::{Preprocessor, PreprocessorContext};
use std::cell::RefCell;
use std::collections::BTreeMap;
use std::path::Path;
use std::rc::Rc;

/// Line of a chapter that the index of equations replaces.
const INDEX: &str = "{{#equations}}";

/// Our preprocessor, and its complaints.
#[derive(Clone, Default)]
pub(crate) struct QrtBook {
    /// True while chapters are still being written: equations may be missing.
    pub(crate) draft: bool,
    /// True if the book is printed: figures are still pictures, and a cover comes first.
    pub(crate) paper: bool,
    /// Complaints about the chapters, once they have been processed.
    pub(crate) complaints: Rc<RefCell<Vec<Complaint>>>,
}

impl QrtBook {
    /// Creates the preprocessor of the book as pages for a browser.
    pub(crate) fn new(draft: bool) -> Self {
        Self {
            draft,
            ..Self::default()
        }
    }
}

impl Preprocessor for QrtBook {
    fn name(&self) -> &'static str {
        "qrt-book"
    }

    fn run(&self, context: &PreprocessorContext, mut book: Book) -> Result<Book> {
        let repository = context
            .root
            .parent()
            .context("the book has no folder above it")?;
        let src = context.root.join(&context.config.book.src);
        let seen = crate::files::relative(repository, &src);
        let mut workshop = Workshop {
            formulas: Formulas::kept_in(&context.root.join(".cache")),
            sources: Sources::new(repository),
            bibliography: Bibliography::read(&src),
            figures: Figures::default(),
            complaints: Vec::new(),
        };
        let assets =
            !self.paper && interactive::prepare(&context.root, &src, &mut workshop.complaints)?;

        let mut equations: BTreeMap<u32, Indexed> = BTreeMap::new();
        let mut indices = Vec::new();
        each(&mut book, &mut |chapter| {
            let Some(path) = chapter.source_path.clone() else {
                return;
            };
            let of = Names::new(&seen, &path, &chapter.name, &src);
            let processed = workshop.process(&of.chapter(), &chapter.content);
            chapter.content = processed.markdown;
            for (equation, line) in processed.equations {
                let number = equation.number;
                let indexed = Indexed {
                    equation,
                    page: of.page.clone(),
                    name: of.name.clone(),
                    file: of.file.clone(),
                    line,
                };
                if let Some(first) = equations.get(&number) {
                    workshop.complaints.push(Complaint::at(
                        &of.file,
                        line,
                        format!(
                            "equation {number} is restated in {}:{} already",
                            first.file, first.line
                        ),
                    ));
                } else {
                    equations.insert(number, indexed);
                }
            }
            if processed.interactive && assets {
                chapter
                    .content
                    .push_str(&interactive::scripts(path.components().count() - 1));
            }
            if chapter.content.lines().any(|line| line.trim() == INDEX) {
                indices.push(path);
            }
        });

        each(&mut book, &mut |chapter| {
            if let Some(path) = chapter.source_path.clone() {
                let of = Names::new(&seen, &path, &chapter.name, &src);
                chapter.content = workshop.numbered(&of.chapter(), &chapter.content);
            }
        });

        let equations: Vec<Indexed> = equations.into_values().collect();
        let numbers = equations.iter().map(|indexed| indexed.equation.number);
        let missing = missing(numbers, &seen, self.draft);
        workshop.complaints.extend(missing);
        each(&mut book, &mut |chapter| {
            if let Some(path) = chapter.source_path.clone()
                && indices.contains(&path)
            {
                let of = Names::new(&seen, &path, &chapter.name, &src);
                let index = workshop.index(&of.chapter(), &equations);
                chapter.content = chapter.content.replace(INDEX, &index);
            }
        });

        if self.paper {
            let cover = crate::pdf::cover(&context.config.book, &book);
            book.items.insert(0, BookItem::Chapter(cover));
        }
        workshop.sources.write(&src.join("source"))?;
        workshop.formulas.save()?;
        workshop.complaints.sort();
        workshop.complaints.dedup();
        *self.complaints.borrow_mut() = workshop.complaints;
        Ok(book)
    }

    fn supports_renderer(&self, renderer: &str) -> Result<bool> {
        Ok(renderer == "html")
    }
}

/// Returns the complaint about equations that no chapter restates; for a draft, only prints it.
fn missing(numbers: impl Iterator<Item = u32>, seen: &str, draft: bool) -> Option<Complaint> {
    let missing = equation::missing(numbers)?;
    let message = format!("no chapter restates the paper's equations {missing}");
    if draft {
        eprintln!("draft: {message}");
        return None;
    }
    Some(Complaint::about(seen, message))
}

fn each(book: &mut Book, work: &mut impl FnMut(&mut mdbook_preprocessor::book::Chapter)) {
    book.for_each_mut(|item| {
        if let BookItem::Chapter(chapter) = item {
            work(chapter);
        }
    });
}

/// Files and names of a chapter.
struct Names {
    file: String,
    page: String,
    name: String,
    original: String,
}

impl Names {
    fn new(seen: &str, path: &Path, name: &str, src: &Path) -> Self {
        Self {
            file: format!("{seen}/{}", path.display()),
            page: path.with_extension("html").display().to_string(),
            name: name.to_owned(),
            original: std::fs::read_to_string(src.join(path)).unwrap_or_default(),
        }
    }

    fn chapter(&self) -> Chapter<'_> {
        Chapter {
            file: &self.file,
            page: &self.page,
            name: &self.name,
            original: &self.original,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use mdbook_driver::config::Config;

    /// Returns the complaints about a book of one chapter.
    fn complaints(chapter: &str, draft: bool) -> Vec<String> {
        let root = tempfile::tempdir().unwrap();
        let book = root.path().join("book");
        std::fs::create_dir_all(book.join("src")).unwrap();
        std::fs::write(root.path().join("x.rs"), "fn x() {}\n").unwrap();
        std::fs::write(book.join("src/SUMMARY.md"), "- [X](x.md)\n").unwrap();
        std::fs::write(book.join("src/x.md"), chapter).unwrap();
        let ours = QrtBook::new(draft);
        let mut whole = mdbook_driver::MDBook::load_with_config(&book, Config::default()).unwrap();
        whole.with_preprocessor(ours.clone());
        whole.build().unwrap();
        let said = ours.complaints.take();
        said.iter().map(ToString::to_string).collect()
    }

    /// Returns blocks that restate the equations `numbers`.
    fn equations(numbers: impl Iterator<Item = u32>) -> String {
        let block = |number| {
            format!("```equation {number}\na\n---\nwhat: it\ncode: x.rs#x\ntest: x.rs#x\n```\n\n")
        };
        numbers.map(block).collect()
    }

    #[test]
    fn equations_that_are_missing_are_told_with_an_index_or_without() {
        let some = equations((1..=equation::COUNT).filter(|&number| number != 9));
        let told = ["book/src: no chapter restates the paper's equations 9"];
        assert_eq!(complaints(&some, false), told);
        assert_eq!(complaints(&format!("{some}\n{INDEX}\n"), false), told);
        assert_eq!(complaints(&some, true), [""; 0]);
        assert_eq!(complaints(&equations(1..=equation::COUNT), false), [""; 0]);
    }

    #[test]
    fn an_equation_that_comes_twice_is_told() {
        let all = equations((1..=equation::COUNT).chain([3]));
        assert_eq!(
            complaints(&all, false),
            ["book/src/x.md:225: equation 3 is restated in book/src/x.md:17 already"]
        );
    }
}
