//! Extremes that must hold: for each, the requirement and the measurement.
//!
//! `docs/extremes.md` is the table of all of them. These tests measure all of it, and it depends on no
//! machine, so they compare the file as it is; `QRT_BLESS=1` writes it again.

mod counts;
mod rooms;
mod spheres;

use std::fmt::Write as _;
use std::path::Path;

/// One extreme.
struct Extreme {
    what: &'static str,
    must: &'static str,
    measured: String,
}

impl Extreme {
    fn new(what: &'static str, must: &'static str, measured: String) -> Self {
        Self {
            what,
            must,
            measured,
        }
    }
}

#[test]
fn the_table_is_what_was_measured() {
    let mut table = String::from(
        "# Extremes\n\nWhat must hold where numbers are extreme, and what was measured. `cargo test \
         --test\npictures extremes` measures all of it, fails where something does not hold, and \
         compares this page with\nwhat it measured.\n\n| extreme | what must hold | measured |\n|---|---|---|\n",
    );
    for Extreme {
        what,
        must,
        measured,
    } in counts::all()
        .into_iter()
        .chain(rooms::all())
        .chain(spheres::all())
    {
        writeln!(table, "| {what} | {must} | {measured} |").unwrap();
    }
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/extremes.md");
    if std::env::var_os("QRT_BLESS").is_some() {
        std::fs::write(&path, &table).unwrap();
    }
    let written = std::fs::read_to_string(&path).unwrap_or_default();
    assert!(
        written == table,
        "{} is not what was measured; QRT_BLESS=1 writes it anew:\n{table}",
        path.display()
    );
}
