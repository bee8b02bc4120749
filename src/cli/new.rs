//! `qrt new`: writes a first scene.

use super::failure::Failure;
use super::files::Output;
use super::terminal;
use clap::Args;
use qrt_lab::shell;
use qrt_runtime::disk::naming_folder;
use qrt_runtime::replace_file::replace_file;
use qrt_scene::text::Data;
use std::fs::{self, OpenOptions};
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};

/// A template: its text, the line that names the scene, and the command that the new user runs first.
struct Template {
    text: &'static str,
    name: &'static str,
    first: &'static str,
    then: &'static str,
}

const FIRST: Template = Template {
    text: include_str!("new.yaml"),
    name: "name: first-scene",
    first: "render it with",
    then: "qrt render",
};

const SMALL: Template = Template {
    text: include_str!("../../scenes-yaml/small/edge.yaml"),
    name: "name: edge",
    first: "run the circuit of a pixel with",
    then: "qrt simulate --pixel 1,0",
};

/// Write a small commented scene to start from
#[derive(Clone, Debug, Args)]
#[command(after_help = "\
Examples:
  qrt new box               writes box.yaml
  qrt render box.yaml       renders it to box.png
  qrt new edge --small      a scene whose whole circuit a simulator runs")]
pub(crate) struct NewArgs {
    /// The scene's name; its file is NAME.yaml
    #[arg(value_name = "NAME")]
    name: PathBuf,
    /// A scene so small that `qrt simulate`, or another simulator, runs the complete counting circuit of a
    /// pixel: 20 qubits
    #[arg(long)]
    small: bool,
    /// Replace a file that is there
    #[arg(long)]
    force: bool,
}

pub(crate) fn run(args: &NewArgs) -> Result<(), Failure> {
    let path = file(&args.name)?;
    Output::new(&path)?;
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let name = format!("name: {}", Data::text(stem).canonical());
    let template = if args.small { &SMALL } else { &FIRST };
    let text = template.text.replacen(template.name, &name, 1);
    let written = if args.force {
        replace_file(&path, |out| out.write_all(text.as_bytes()))
    } else {
        create(&path, &text)
    };
    match written {
        Ok(()) => terminal::print(&format!(
            "{}: {} `{}`\n",
            path.display(),
            template.first,
            shell::command(template.then, &path)
        )),
        Err(error) if error.kind() == ErrorKind::AlreadyExists => Err(Failure::Usage(format!(
            "`{}` is already there; `--force` replaces it",
            path.display()
        ))),
        Err(error) => Err(Failure::file(&path, &error)),
    }
}

/// Appends `.yaml` unless `name` ends in `.yaml` or `.yml`; a dot elsewhere is a part of the name.
fn file(name: &Path) -> Result<PathBuf, Failure> {
    let Some(last) = name.file_name() else {
        let message = format!("`{}` names no file", name.display());
        return Err(Failure::Usage(message));
    };
    let extension = name.extension();
    if extension.is_some_and(|e| e == "yaml" || e == "yml") {
        return Ok(name.to_path_buf());
    }
    let mut last = last.to_owned();
    last.push(".yaml");
    Ok(name.with_file_name(last))
}

fn create(path: &Path, text: &str) -> io::Result<()> {
    let opened = OpenOptions::new().write(true).create_new(true).open(path);
    let mut file = opened.map_err(|error| naming_folder(path, error))?;
    let written = file.write_all(text.as_bytes());
    if written.is_err() {
        let _ = fs::remove_file(path);
    }
    written
}
