//! Interactive figures: builds their WebAssembly if it can, and copies it for mdBook.

use crate::complaint::Complaint;
use anyhow::{Context as _, Result};
use std::collections::BTreeMap;
use std::io;
use std::path::Path;
use std::process::{Command, Stdio};

/// Exit status of the script that builds the WebAssembly, if its tools are missing.
const NO_TOOLS: i32 = 3;

/// Names of the WebAssembly files, in `interactive/dist` and in the book: one for each figure.
const WASM: [&str; 5] = [
    "qrt_circuit.wasm",
    "qrt_counting.wasm",
    "qrt_map.wasm",
    "qrt_picture.wasm",
    "qrt_playground.wasm",
];

/// Folder and name of the schema that the editor of scenes reads; the folder is beside the book's.
const SCHEMA: [&str; 2] = ["../scenes-yaml", "scene.schema.json"];

/// Script that drives the figures.
const SCRIPT: &str = "figures.js";

/// Builds the figures and copies them into the book's sources, for mdBook to take along. Returns
/// true if they can be used: without WebAssembly, readers see the static pictures.
pub(crate) fn prepare(book: &Path, src: &Path, complaints: &mut Vec<Complaint>) -> Result<bool> {
    let script = book.join("widgets/build.sh");
    let built = script.exists() && build("bash", &script, complaints)?;
    let mut files = BTreeMap::new();
    let folder = book.join("interactive");
    let wasm = WASM.map(|name| folder.join("dist").join(name));
    if built && wasm.iter().all(|wasm| wasm.exists()) && folder.join(SCRIPT).exists() {
        for (name, wasm) in WASM.into_iter().zip(&wasm) {
            files.insert(name.to_owned(), read(wasm)?);
        }
        let schema = book.join(SCHEMA[0]).join(SCHEMA[1]);
        files.insert(SCHEMA[1].to_owned(), read(&schema)?);
        let cannot = || format!("cannot read the folder {}", folder.display());
        for entry in std::fs::read_dir(&folder).with_context(cannot)? {
            let path = entry.with_context(cannot)?.path();
            if path
                .extension()
                .is_some_and(|kind| kind == "js" || kind == "css")
            {
                files.insert(crate::files::relative(&folder, &path), read(&path)?);
            }
        }
    }
    crate::files::write_all(&src.join("interactive"), &files)
        .context("cannot copy the interactive figures")?;
    Ok(!files.is_empty())
}

fn read(file: &Path) -> Result<Vec<u8>> {
    std::fs::read(file).with_context(|| format!("cannot read {}", file.display()))
}

/// Builds the WebAssembly by the script `script` in `shell`; returns true if it succeeded.
fn build(shell: &str, script: &Path, complaints: &mut Vec<Complaint>) -> Result<bool> {
    let output = Command::new(shell)
        .arg(script)
        .stdin(Stdio::null())
        // The build takes minutes and prints its progress; standard output may be mdBook's.
        .stderr(Stdio::inherit())
        .output();
    let output = match output {
        Err(error) if error.kind() == io::ErrorKind::NotFound => {
            eprintln!("figures: no `{shell}` to build them with, so that they stay still");
            return Ok(false);
        }
        output => output.with_context(|| format!("cannot run {}", script.display()))?,
    };
    match output.status.code() {
        Some(0) => Ok(true),
        Some(NO_TOOLS) => {
            eprintln!("figures: no tools for WebAssembly, so that they stay still");
            Ok(false)
        }
        _ => {
            complaints.push(Complaint::about(
                "book/widgets/build.sh",
                format!(
                    "failed ({}): it said why above\n{}",
                    output.status,
                    String::from_utf8_lossy(&output.stdout)
                ),
            ));
            Ok(false)
        }
    }
}

/// Returns the scripts that a page with an interactive figure loads; `depth` is its depth in folders.
pub(crate) fn scripts(depth: usize) -> String {
    let root = "../".repeat(depth);
    format!(
        "\n\n<link rel=\"stylesheet\" href=\"{root}interactive/figures.css\">\n\
         <script type=\"module\" src=\"{root}interactive/{SCRIPT}\"></script>\n"
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Prepares a book with this script; returns the verdict, and the numbers of files and of complaints.
    fn prepared(script: Option<&str>) -> (bool, usize, usize) {
        let folder = tempfile::tempdir().unwrap();
        let book = folder.path();
        let book = &book.join("book");
        for name in ["interactive/dist", "src", "widgets", "../scenes-yaml"] {
            std::fs::create_dir_all(book.join(name)).unwrap();
        }
        std::fs::write(book.join("../scenes-yaml/scene.schema.json"), "{}").unwrap();
        let wasm = WASM.map(|name| format!("dist/{name}"));
        let others = ["figures.js", "figures.css", "notes.md"].map(str::to_owned);
        for name in wasm.into_iter().chain(others) {
            std::fs::write(book.join("interactive").join(&name), name).unwrap();
        }
        if let Some(script) = script {
            std::fs::write(book.join("widgets/build.sh"), script).unwrap();
        }
        let mut complaints = Vec::new();
        let used = prepare(book, &book.join("src"), &mut complaints).unwrap();
        let files = crate::files::all(&book.join("src/interactive")).unwrap();
        (used, files.len(), complaints.len())
    }

    #[test]
    fn figures_come_along_if_their_webassembly_can_be_built() {
        assert_eq!(prepared(Some("exit 0")), (true, 8, 0));
        assert_eq!(prepared(Some("exit 3")), (false, 0, 0));
        assert_eq!(prepared(Some("echo no; exit 1")), (false, 0, 1));
        assert_eq!(prepared(None), (false, 0, 0));
    }

    #[test]
    fn without_a_shell_figures_stay_still() {
        let folder = tempfile::tempdir().unwrap();
        let script = folder.path().join("build.sh");
        std::fs::write(&script, "exit 0").unwrap();
        let mut complaints = Vec::new();
        let none = folder.path().join("no-such-shell").display().to_string();
        assert!(!build(&none, &script, &mut complaints).unwrap());
        assert!(build("bash", &script, &mut complaints).unwrap());
        assert_eq!(complaints, []);
    }

    #[test]
    fn a_file_that_cannot_be_read_is_named() {
        let folder = tempfile::tempdir().unwrap();
        let error = read(&folder.path().join("x.wasm")).unwrap_err();
        assert!(error.to_string().contains("x.wasm"), "{error}");
    }
}
