//! Names the measurement that is built: a hash of the sources that decide the rows of a table.
//!
//! A table is not continued by a build of the same version whose rows may differ.

use std::hash::{DefaultHasher, Hasher as _};
use std::path::PathBuf;
use std::{fs, io};

/// Folder of these sources, those of [`trade`](src/trade/mod.rs).
const SOURCES: &str = "src/trade";

fn main() -> io::Result<()> {
    println!("cargo::rerun-if-changed={SOURCES}");
    let entries = fs::read_dir(SOURCES)?.map(|entry| Ok(entry?.path()));
    let mut files: Vec<PathBuf> = entries.collect::<io::Result<_>>()?;
    files.retain(|file| file.is_file());
    files.sort();
    let mut hash = DefaultHasher::new();
    for file in files {
        hash.write(&fs::read(file)?);
    }
    println!("cargo::rustc-env=QRT_TRADE_BUILD={:016x}", hash.finish());
    Ok(())
}
