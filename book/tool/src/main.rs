//! Builds and checks the book of qrt: `cargo book`, from the repository's root.
//!
//! mdBook does most of the work. Before it, a [preprocessor] turns formulas into HTML, numbers the
//! paper's equations and links them to their code and tests, and makes pages of the source files
//! that chapters refer to. After it, a [check] follows every link of the finished book, and checks
//! that nothing is loaded from another host and that no page is large.
//!
//! The preprocessor also speaks mdBook's protocol, so that plain `mdbook build book` does the same
//! except for the check.

#![forbid(unsafe_code)]

mod bibliography;
mod chapter;
mod check;
mod complaint;
mod equation;
mod files;
mod formula;
mod html;
mod interactive;
mod log;
mod pdf;
mod preprocessor;
mod serve;
mod source;
mod symbol;

use anyhow::{Context as _, Result, bail};
use complaint::Complaint;
use log::Log;
use mdbook_driver::MDBook;
use mdbook_driver::config::Config;
use mdbook_preprocessor::Preprocessor as _;
use mdbook_summary::{Summary, SummaryItem};
use preprocessor::QrtBook;
use std::fmt;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

const USAGE: &str = "\
Builds and checks the book.

Usage: cargo book [COMMAND] [--draft]

  build               builds the book into book/book and checks it (the default)
  check               checks the book that is built: links, other hosts, sizes
  serve [PORT]        builds it and serves it on this machine (port 3000)
  pdf [FILE]          prints all of it to one PDF (book/qrt-book.pdf), with Chromium
  preprocess          speaks mdBook's protocol, for `mdbook build book`

  --draft             chapters may be missing, and what is wrong is said but is no failure
";

/// An error in the command line.
#[derive(Debug)]
struct Usage(String);

impl fmt::Display for Usage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for Usage {}

fn main() -> ExitCode {
    let result = run(std::env::args().skip(1).collect());
    if let Err(error) = &result {
        eprintln!("error: {error:#}");
    }
    ExitCode::from(status(&result))
}

/// Returns the exit code: 0 for success, 2 for a wrong command line, 1 otherwise.
fn status(result: &Result<bool>) -> u8 {
    match result {
        Ok(true) => 0,
        Err(error) if error.is::<Usage>() => 2,
        Ok(false) | Err(_) => 1,
    }
}

/// Runs the command; returns true if the book has no faults.
fn run(mut arguments: Vec<String>) -> Result<bool> {
    let before = arguments.len();
    arguments.retain(|argument| argument != "--draft");
    let draft = arguments.len() < before;
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    match arguments[..] {
        [] | ["build"] => build(&book()?, draft),
        ["check"] => checked(&book()?, draft, Vec::new()),
        ["serve"] => serve(&book()?, draft, 3000),
        ["serve", port] => match port.parse() {
            Ok(port) => serve(&book()?, draft, port),
            Err(_) => bail!(Usage(format!("`{port}` is no port: from 0 to 65535"))),
        },
        ["pdf"] => pdf::print(&book()?, draft, None),
        ["pdf", file] => pdf::print(&book()?, draft, Some(Path::new(file))),
        ["preprocess"] => preprocess(draft),
        ["preprocess", "supports", renderer] => QrtBook::default().supports_renderer(renderer),
        ["help" | "--help" | "-h"] => {
            print!("{USAGE}");
            Ok(true)
        }
        _ => bail!(Usage(format!(
            "`{}` is no command\n\n{USAGE}",
            arguments.join(" ")
        ))),
    }
}

/// Finds the folder of the book, in the working folder or above.
fn book() -> Result<PathBuf> {
    let here = std::env::current_dir().context("cannot tell the working folder")?;
    here.ancestors()
        .map(|folder| folder.join("book"))
        .find(|folder| folder.join("book.toml").is_file())
        .context("there is no book/book.toml here or above")
}

/// Builds the book, and checks it.
fn build(root: &Path, draft: bool) -> Result<bool> {
    let started = Instant::now();
    let complaints = rendered(root, &QrtBook::new(draft), |_| Ok(()))?;
    let well = checked(root, draft, complaints)?;
    println!(
        "{} in {:.1} s",
        root.join("book/index.html").display(),
        started.elapsed().as_secs_f64()
    );
    Ok(well)
}

/// Renders the book by mdBook, with changes of its configuration; returns all complaints.
fn rendered(
    root: &Path,
    ours: &QrtBook,
    change: impl FnOnce(&mut Config) -> Result<()>,
) -> Result<Vec<Complaint>> {
    let log = Log::default();
    // No other subscriber is set in this process.
    let _ = tracing::subscriber::set_global_default(log.clone());
    let file = root.join("book.toml");
    let mut config =
        Config::from_disk(&file).with_context(|| format!("cannot read {}", file.display()))?;
    change(&mut config)?;
    let src = root.join(&config.book.src);
    // The preprocessor runs in this process instead, after all others.
    let config = without(&config, ours.name())?;
    let mut book = if ours.draft {
        let mut summary = summary(&src)?;
        leave_out_missing(&mut summary, &src);
        MDBook::load_with_config_and_summary(root, config, summary)?
    } else {
        MDBook::load_with_config(root, config)?
    };
    book.with_preprocessor(ours.clone());
    book.build()?;
    let mut complaints = ours.complaints.take();
    complaints.extend(log.complaints(&src, "book/src")?);
    Ok(complaints)
}

/// Returns the book's configuration without the preprocessor `preprocessor`.
fn without(config: &Config, preprocessor: &str) -> Result<Config> {
    let mut config = serde_json::to_value(config)?;
    if let Some(table) = config
        .get_mut("preprocessor")
        .and_then(serde_json::Value::as_object_mut)
    {
        table.remove(preprocessor);
    }
    Ok(serde_json::from_value(config)?)
}

/// Reads the table of contents.
fn summary(src: &Path) -> Result<Summary> {
    let file = src.join("SUMMARY.md");
    std::fs::read_to_string(&file)
        .map_err(anyhow::Error::new)
        .and_then(|text| mdbook_summary::parse_summary(&text))
        .with_context(|| format!("cannot read {}", file.display()))
}

/// Turns chapters whose files are missing into drafts, which mdBook lists without a link.
fn leave_out_missing(summary: &mut Summary, src: &Path) {
    fn visit(items: &mut [SummaryItem], src: &Path) {
        for item in items {
            if let SummaryItem::Link(link) = item {
                let missing = link.location.take_if(|file| !src.join(file).exists());
                if let Some(file) = missing {
                    eprintln!("draft: there is no {}", file.display());
                }
                visit(&mut link.nested_items, src);
            }
        }
    }
    visit(&mut summary.prefix_chapters, src);
    visit(&mut summary.numbered_chapters, src);
    visit(&mut summary.suffix_chapters, src);
}

/// Checks the built book, and prints all faults.
fn checked(root: &Path, draft: bool, mut complaints: Vec<Complaint>) -> Result<bool> {
    let report = check::check(&root.join("book"), "book/book")?;
    complaints.extend(report.complaints);
    for note in report.notes {
        println!("{note}");
    }
    for complaint in &complaints {
        eprintln!("{complaint}");
    }
    println!(
        "{} pages, {} links, largest page {} with {} bytes: {}",
        report.pages,
        report.links,
        report.largest.0,
        report.largest.1,
        match complaints.len() {
            0 => "all well".to_owned(),
            1 => "one thing is wrong".to_owned(),
            many => format!("{many} things are wrong"),
        }
    );
    Ok(complaints.is_empty() || draft)
}

fn serve(root: &Path, draft: bool, port: u16) -> Result<bool> {
    if !build(root, draft)? {
        return Ok(false);
    }
    serve::serve(&root.join("book"), port)?;
    Ok(true)
}

/// Processes one exchange of mdBook's protocol: reads the book and writes the processed book.
fn preprocess(draft: bool) -> Result<bool> {
    let (mut context, book) = mdbook_preprocessor::parse_input(std::io::stdin())?;
    if context.root.is_relative() {
        // The path is relative to mdBook's working folder, but mdBook runs this tool in the book's folder.
        context.root = std::env::current_dir()?;
    }
    let ours = QrtBook::new(draft);
    let book = ours.run(&context, book)?;
    let complaints = ours.complaints.take();
    for complaint in &complaints {
        eprintln!("{complaint}");
    }
    serde_json::to_writer(std::io::stdout(), &book)?;
    Ok(complaints.is_empty() || draft)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wrong_command_line_exits_with_2_and_a_wrong_book_with_1() {
        for wrong in [
            &["biuld"][..],
            &["build", "twice"],
            &["--drafty"],
            &["serve", "door"],
            &["serve", "65536"],
            &["pdf", "a.pdf", "b.pdf"],
        ] {
            let result = run(wrong.iter().copied().map(str::to_owned).collect());
            assert_eq!(status(&result), 2, "{wrong:?}");
        }
        assert_eq!(status(&run(vec!["help".to_owned()])), 0);
        let none = anyhow::Error::msg("no book").context("cannot build");
        assert_eq!((status(&Err(none)), status(&Ok(false))), (1, 1));
    }

    #[test]
    fn a_summary_that_cannot_be_read_is_named() {
        let folder = tempfile::tempdir().unwrap();
        let error = summary(folder.path()).unwrap_err();
        let file = folder.path().join("SUMMARY.md");
        assert_eq!(error.to_string(), format!("cannot read {}", file.display()));
        std::fs::write(file, "- [X](x.md)\n").unwrap();
        let mut summary = summary(folder.path()).unwrap();
        leave_out_missing(&mut summary, folder.path());
        let SummaryItem::Link(link) = &summary.numbered_chapters[0] else {
            panic!("a chapter");
        };
        assert_eq!((&*link.name, &link.location), ("X", &None));
    }
}
