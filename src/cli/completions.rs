//! `qrt completions`: scripts for completion with the Tab key.

use super::failure::Failure;
use super::{Cli, terminal};
use clap::{Args, CommandFactory};
use clap_complete::Shell;

/// Print a shell's completions of this command
#[derive(Clone, Copy, Debug, Args)]
#[command(after_help = "\
Examples:
  qrt completions bash > ~/.local/share/bash-completion/completions/qrt
  qrt completions zsh > ~/.zfunc/_qrt
  qrt completions fish > ~/.config/fish/completions/qrt.fish")]
pub(crate) struct CompletionsArgs {
    /// The shell
    shell: Shell,
}

pub(crate) fn run(args: CompletionsArgs) -> Result<(), Failure> {
    // The generator panics if it cannot write, so it does not write straight to standard output.
    let mut script = Vec::new();
    clap_complete::generate(args.shell, &mut Cli::command(), "qrt", &mut script);
    terminal::print(&String::from_utf8_lossy(&script))
}
