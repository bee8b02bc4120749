//! The promises of a bench: each is told as it is kept or broken, and one that is broken fails it.

use std::process::ExitCode;

/// Promises that were judged.
pub(crate) struct Promises {
    kept: bool,
}

impl Promises {
    pub(crate) fn new() -> Self {
        Self { kept: true }
    }

    /// Tells whether a promise is kept.
    pub(crate) fn judge(&mut self, what: &str, kept: bool) {
        println!("{} {what}", if kept { "kept  " } else { "BROKEN" });
        self.kept &= kept;
    }

    /// What the bench exits with.
    pub(crate) fn exit(&self) -> ExitCode {
        ExitCode::from(u8::from(!self.kept))
    }
}
