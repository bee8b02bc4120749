//! The figures of the book.
//!
//! ```sh
//! cargo run --release --example book-figures [NAME...]
//! ```
//!
//! writes all of them to `book/src/figures`, or those whose names contain one of the NAMEs, and
//! prints a description of each. Nothing in them depends on the machine: `cargo test --test book
//! figures` makes them again and compares. Tables that take too long to measure each time are in
//! `book/data`; its README names the commands that make them.

// A figure that cannot be made has nothing to show.
#![allow(clippy::unwrap_used, clippy::expect_used)]

mod figures;

use std::time::Instant;

fn main() {
    let names: Vec<String> = std::env::args().skip(1).collect();
    let asked = |file: &str| names.is_empty() || names.iter().any(|name| file.contains(name));
    let folder = figures::folder();
    std::fs::create_dir_all(&folder).expect("the folder of figures can be made");
    for (file, make) in figures::ALL.into_iter().filter(|(file, _)| asked(file)) {
        let begin = Instant::now();
        let figure = make();
        figure.write(&folder.join(file));
        let seconds = begin.elapsed().as_secs_f64();
        println!("{file} ({seconds:.1} s): {}", figure.says);
    }
}
