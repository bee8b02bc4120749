//! Tests of scenes of `qrt!` against those of YAML.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::format_push_string)]

pub(crate) mod checks;
mod fuzzed;
mod grammar;
mod twins;
mod writer;

use crate::scene::{Faults, Read, Table, read};
use std::path::Path;

/// Reads `text`, relative to `root`. Returns the scenes and the errors, with codes and messages.
fn read_text(text: &str, root: &Path) -> (Vec<Read>, Vec<String>) {
    let stream = text
        .parse()
        .unwrap_or_else(|error| panic!("{error}: {text}"));
    let mut table = Table::default();
    let mut faults = Faults::default();
    let scenes = read(stream, root, &mut table, &mut faults);
    let faults = faults.finalize();
    let texts = faults.iter().map(|fault| fault.text(&table));
    (scenes, texts.collect())
}

/// Returns the code in an error's text.
fn code(text: &str) -> &str {
    let line = text.lines().next().unwrap_or_default();
    let (_, code) = line.rsplit_once('[').unwrap_or_default();
    code.trim_end_matches(']')
}
