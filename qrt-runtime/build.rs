//! Names the arithmetic that is built: a hash of the sources that decide a picture's bits.
//!
//! Two builds of one version may differ while qrt is worked on, and what one has left must not be
//! gone on with by the other.
//!
//! It also tells the crate its own `opt-level`, which Cargo tells build scripts alone.

use std::path::{Path, PathBuf};
use std::{env, fs, io};

/// This crate's sources, and those of the crates beside it, where they stand beside it.
const SOURCES: [&str; 8] = [
    "src",
    "../qrt-core/src",
    "../qrt-circuit/src",
    "../qrt-counting/src",
    "../qrt-machines/src",
    "../qrt-scene/src",
    "../qrt-syntax/src",
    "../qrt-tracer/src",
];

fn main() -> io::Result<()> {
    let root = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").unwrap_or_default());
    let mut files = Vec::new();
    for folder in SOURCES.map(|folder| root.join(folder)) {
        if folder.is_dir() {
            println!("cargo::rerun-if-changed={}", folder.display());
            list(&folder, &mut files)?;
        }
    }
    files.sort();
    let mut hash = FNV_OFFSET;
    for file in files {
        let name = file.strip_prefix(&root).unwrap_or(&file);
        hash = fnv(hash, name.to_string_lossy().as_bytes());
        hash = fnv(hash, &fs::read(&file)?);
    }
    println!("cargo::rustc-env=QRT_BUILD={hash:016x}");
    // Another build tool may not set it.
    let level = env::var("OPT_LEVEL").unwrap_or_else(|_| "unknown".to_owned());
    println!("cargo::rustc-env=QRT_OPT_LEVEL={level}");
    Ok(())
}

fn list(folder: &Path, files: &mut Vec<PathBuf>) -> io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() {
            list(&path, files)?;
        } else if path.extension().is_some_and(|end| end == "rs") && path.is_file() {
            files.push(path);
        }
    }
    Ok(())
}

const FNV_OFFSET: u64 = 0xcbf2_9ce4_8422_2325;

/// FNV-1a, after the bytes of which `hash` is the hash.
fn fnv(hash: u64, bytes: &[u8]) -> u64 {
    let next = |hash: u64, byte: &u8| (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3);
    bytes.iter().fold(hash, next)
}
