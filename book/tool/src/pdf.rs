//! The book as one PDF: mdBook's print page, with a cover, printed by Chromium without a window.

use crate::complaint::Complaint;
use crate::preprocessor::QrtBook;
use crate::{rendered, serve};
use anyhow::{Context as _, Result, bail, ensure};
use mdbook_driver::config::BookConfig;
use mdbook_preprocessor::book::{Book, BookItem, Chapter};
use std::fmt::Write as _;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

/// Folder of the print page, in the book's.
const FOLDER: &str = ".cache/print";
/// Name of the print page.
const PAGE: &str = "print.html";
/// The book, printed, in the book's folder.
const FILE: &str = "qrt-book.pdf";
/// Environment variable that names a Chromium.
const VARIABLE: &str = "CHROMIUM";
/// Names of Chromium and of its relatives.
const NAMES: [&str; 5] = [
    "chromium",
    "chromium-browser",
    "google-chrome",
    "google-chrome-stable",
    "/Applications/Google Chrome.app/Contents/MacOS/Google Chrome",
];
/// Limit on the time that Chromium prints.
const PATIENCE: Duration = Duration::from_mins(5);

/// Prints the book to `file`, by default to `qrt-book.pdf` beside it; returns true if it has no faults.
pub(crate) fn print(root: &Path, draft: bool, file: Option<&Path>) -> Result<bool> {
    let started = Instant::now();
    let named = std::env::var(VARIABLE).ok();
    let chromium = chromium(named.as_deref())?;
    let file = file.map_or_else(|| root.join(FILE), Path::to_owned);
    let (complaints, repository) = print_page(root, draft)?;
    let folder = root.join(FOLDER);
    let page = folder.join(PAGE);
    let text = std::fs::read_to_string(&page)
        .with_context(|| format!("cannot read {}", page.display()))?;
    std::fs::write(&page, to_repository(&text, &repository))?;
    let listener = serve::listen(0)?;
    let address = format!("http://{}/{PAGE}", listener.local_addr()?);
    std::thread::spawn(move || serve::answer_all(&listener, &folder));
    let pages = printed(&chromium, &address, &file)?;
    for complaint in &complaints {
        eprintln!("{complaint}");
    }
    println!(
        "{}: {pages} pages, {} KB, in {:.1} s",
        file.display(),
        file.metadata()?.len() / 1000,
        started.elapsed().as_secs_f64()
    );
    Ok(complaints.is_empty() || draft)
}

/// Renders the print page; returns the complaints, and the address of the repository.
fn print_page(root: &Path, draft: bool) -> Result<(Vec<Complaint>, String)> {
    let mut repository = String::new();
    let ours = QrtBook {
        paper: true,
        ..QrtBook::new(draft)
    };
    let complaints = rendered(root, &ours, |config| {
        config.build.build_dir = PathBuf::from(FOLDER);
        config.set("output.html.print.enable", true)?;
        config.set("output.html.search.enable", false)?;
        // Still pictures, and nothing that waits for a reader.
        config.set("output.html.additional-js", Vec::<String>::new())?;
        repository = (config.get("output.html.git-repository-url")?).unwrap_or_default();
        Ok(())
    })?;
    Ok((complaints, repository))
}

/// Returns the cover: the title, the description and the contents.
pub(crate) fn cover(book: &BookConfig, chapters: &Book) -> Chapter {
    let title = book.title.as_deref().unwrap_or("The book");
    let mut text = format!("<div class=\"qrt-cover\">\n\n# {title}\n\n");
    if let Some(description) = &book.description {
        let _ = write!(text, "{description}\n\n");
    }
    list(&chapters.items, 0, &mut text);
    text.push_str("\n</div>\n");
    Chapter::new(title, text, "cover.md", Vec::new())
}

/// Adds the items of the contents, `depth` lists deep. Writing to a string cannot fail.
fn list(items: &[BookItem], depth: usize, text: &mut String) {
    for item in items {
        match item {
            BookItem::PartTitle(title) => {
                let _ = write!(text, "\n**{title}**\n\n");
            }
            BookItem::Chapter(chapter) => {
                let Some(path) = &chapter.path else { continue };
                let number = chapter
                    .number
                    .as_ref()
                    .map_or_else(String::new, |n| format!("{n} "));
                let indent = "  ".repeat(depth);
                let (name, path) = (&chapter.name, path.display());
                let _ = writeln!(text, "{indent}- {number}[{name}]({path})");
                list(&chapter.sub_items, depth + 1, text);
            }
            BookItem::Separator => {}
        }
    }
}

/// Returns a page whose links to pages of sources lead to the repository instead.
fn to_repository(page: &str, repository: &str) -> String {
    let mut parts = page.split("href=\"source/");
    let mut out = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let (target, rest) = part.split_once('"').unwrap_or((part, ""));
        let (path, line) = target.split_once('#').unwrap_or((target, ""));
        let path = path.strip_suffix(".html").unwrap_or(path);
        let path = path
            .strip_suffix("-md")
            .map_or_else(|| path.to_owned(), |page| format!("{page}.md"));
        let hash = if line.is_empty() { "" } else { "#" };
        let _ = write!(
            out,
            "href=\"{repository}/blob/main/{path}{hash}{line}\"{rest}"
        );
    }
    out
}

/// Finds a Chromium that starts: the one that `named` names, or one of the usual names.
fn chromium(named: Option<&str>) -> Result<String> {
    let names = named.map_or_else(|| NAMES.to_vec(), |name| vec![name]);
    for name in &names {
        let version = Command::new(name)
            .arg("--version")
            .stdin(Stdio::null())
            .stderr(Stdio::null())
            .output();
        match version {
            Ok(output) if output.status.success() => return Ok((*name).to_owned()),
            Err(error) if error.kind() != ErrorKind::NotFound => {
                return Err(error).with_context(|| format!("cannot run {name}"));
            }
            _ => {}
        }
    }
    bail!(
        "no Chromium to print with: none of {} starts; install one (Debian: apt install chromium), or \
         name it with {VARIABLE}",
        names.join(", ")
    )
}

/// Prints the page at `address` to `file`; returns the number of pages.
fn printed(chromium: &str, address: &str, file: &Path) -> Result<usize> {
    let profile = tempfile::tempdir()?;
    let mut command = Command::new(chromium);
    command
        .args(["--headless=new", "--disable-gpu", "--no-first-run"])
        .args(["--no-pdf-header-footer", "--generate-pdf-document-outline"])
        .arg(format!("--user-data-dir={}", profile.path().display()))
        .arg(format!("--print-to-pdf={}", file.display()))
        .arg(address)
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null());
    // Chromium's sandbox does not work for the superuser, as in containers.
    if Command::new("id")
        .arg("-u")
        .output()
        .is_ok_and(|id| id.stdout == b"0\n")
    {
        command.arg("--no-sandbox");
    }
    if file.exists() {
        std::fs::remove_file(file).with_context(|| format!("cannot replace {}", file.display()))?;
    }
    let mut child = command
        .spawn()
        .with_context(|| format!("cannot run {chromium}"))?;
    let end = Instant::now() + PATIENCE;
    while child.try_wait()?.is_none() {
        if Instant::now() > end {
            child.kill()?;
            bail!(
                "{chromium} takes longer than {} s to print",
                PATIENCE.as_secs()
            );
        }
        std::thread::sleep(Duration::from_millis(50));
    }
    let pdf = std::fs::read(file).with_context(|| format!("{chromium} printed nothing"))?;
    let pages = pages(&pdf);
    ensure!(
        pages > 0,
        "{chromium} printed no page to {}",
        file.display()
    );
    Ok(pages)
}

/// Counts the pages of a PDF whose objects of pages are not compressed, as Chromium writes it.
fn pages(pdf: &[u8]) -> usize {
    const PAGE: &[u8] = b"/Type /Page";
    let ends = pdf
        .windows(PAGE.len() + 1)
        .filter(|window| window.starts_with(PAGE));
    ends.filter(|window| window.last() != Some(&b's')).count()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn links_to_sources_lead_to_the_repository() {
        let page = "<a href=\"source/a/b.rs.html#L7\">f</a> <a href=\"source/a/README-md.html\">r</a> \
                    <a href=\"#x\">x</a>";
        assert_eq!(
            to_repository(page, "https://example.org/q"),
            "<a href=\"https://example.org/q/blob/main/a/b.rs#L7\">f</a> \
             <a href=\"https://example.org/q/blob/main/a/README.md\">r</a> <a href=\"#x\">x</a>"
        );
        assert_eq!(to_repository("no links", "x"), "no links");
    }

    #[test]
    fn a_missing_chromium_is_told_with_its_remedy() {
        let error = chromium(Some("/nowhere/chromium")).unwrap_err().to_string();
        assert!(
            error.contains("none of /nowhere/chromium starts"),
            "{error}"
        );
        assert!(
            error.contains("apt install chromium") && error.contains(VARIABLE),
            "{error}"
        );
    }

    #[test]
    fn the_cover_lists_parts_and_chapters() {
        let mut chapter = Chapter::new("One", String::new(), "one.md", Vec::new());
        let inner = Chapter::new("Two", String::new(), "two.md", vec!["One".to_owned()]);
        chapter.sub_items.push(BookItem::Chapter(inner));
        let items = vec![
            BookItem::PartTitle("Part".to_owned()),
            BookItem::Chapter(chapter),
        ];
        let book = Book::new_with_items(items);
        let mut config = BookConfig::default();
        config.title = Some("Title".to_owned());
        config.description = Some("A description".to_owned());
        assert_eq!(
            cover(&config, &book).content,
            "<div class=\"qrt-cover\">\n\n# Title\n\nA description\n\n\n**Part**\n\n- [One](one.md)\n  \
             - [Two](two.md)\n\n</div>\n"
        );
    }

    #[test]
    fn pages_are_counted_and_not_their_trees() {
        assert_eq!(
            pages(b"<< /Type /Pages >> << /Type /Page\n>> <</Type /Page /X>>"),
            2
        );
    }
}
