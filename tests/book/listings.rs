//! Checks that the output of commands in the book is what the commands print, and that its scenes are valid.
//!
//! The test executes every ```` ```console ```` block of every page, page by page, in a folder of its
//! own that holds a copy of `scenes-yaml`. A line that begins with `$ ` is a command for `sh`; the
//! lines below it are its expected output, standard error included, where a line `...` stands for any
//! lines. `QRT_BLESS=1 cargo test --test book listings` writes the output of the commands into the
//! pages, except for commands with a `...`, whose differences it reports.
//!
//! Every ```` ```yaml ```` block must be accepted, every ```` ```yaml,wrong ```` refused. If a block
//! lacks some of the blocks that a scene needs, the test adds them from a scene with the materials
//! `white` and `lamp`. A first line `# NAME.yaml` saves the block under that name for the commands
//! below; `# in NAME.yaml` replaces those blocks of the file.

#![cfg(unix)]

mod console;
mod diff;
mod run;
mod scenes;

use super::page::{FOLDER, bless, pages, report};
use std::fs;
use std::sync::Mutex;
use std::time::Instant;

/// Least number of commands and scenes in the book: with fewer, the test would not have found all.
const LEAST: [usize; 2] = [80, 25];

#[test]
fn every_listing_of_the_book_is_true() {
    let pages = pages();
    let found = Mutex::new([0; 2]);
    let queue = Mutex::new(pages.iter());
    let failures = Mutex::new(Vec::new());
    std::thread::scope(|scope| {
        for _ in 0..std::thread::available_parallelism().map_or(1, usize::from) {
            scope.spawn(|| {
                loop {
                    let next = queue.lock().unwrap().next();
                    let Some(page) = next else { return };
                    let start = Instant::now();
                    let outcome = run::page(page);
                    let seconds = start.elapsed().as_secs_f64();
                    println!(
                        "{}: {} commands, {} scenes, {seconds:.1} s",
                        page.name, outcome.commands, outcome.scenes
                    );
                    {
                        let mut found = found.lock().unwrap();
                        found[0] += outcome.commands;
                        found[1] += outcome.scenes;
                    }
                    if bless() && outcome.text != page.text {
                        fs::write(format!("{}/{}", FOLDER, page.name), outcome.text).unwrap();
                    }
                    failures.lock().unwrap().extend(outcome.failures);
                }
            });
        }
    });
    report(&failures.into_inner().unwrap());
    let found = found.into_inner().unwrap();
    let enough = found
        .iter()
        .zip(LEAST)
        .all(|(found, least)| *found >= least);
    assert!(
        enough,
        "{found:?} commands and scenes, of at least {LEAST:?}"
    );
}
