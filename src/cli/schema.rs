//! `qrt schema`: prints the scene format for editors.

use super::failure::Failure;
use super::terminal;
use clap::Args;

/// Print the JSON Schema (draft-07) of scenes, for editors
///
/// An editor that speaks YAML's language server then completes keys and marks mistakes.
#[derive(Clone, Copy, Debug, Args)]
#[command(after_help = "\
Examples:
  qrt schema > scene.schema.json

  In Visual Studio Code, put this first into a scene:
  # yaml-language-server: $schema=scene.schema.json")]
pub(crate) struct SchemaArgs {}

pub(crate) fn run() -> Result<(), Failure> {
    terminal::print(&qrt_scene::schema::text())
}
