//! The promises of a bench: prints each as kept or broken, and fails the bench if one is broken.

use std::process::ExitCode;

/// The verdict on all promises so far.
pub(crate) struct Promises {
    kept: bool,
}

impl Promises {
    pub(crate) fn new() -> Self {
        Self { kept: true }
    }

    /// Records and prints whether a promise is kept.
    pub(crate) fn judge(&mut self, what: &str, kept: bool) {
        println!("{} {what}", if kept { "kept  " } else { "BROKEN" });
        self.kept &= kept;
    }

    /// Returns the exit code of the bench.
    pub(crate) fn exit(&self) -> ExitCode {
        ExitCode::from(u8::from(!self.kept))
    }
}
