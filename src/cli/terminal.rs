//! Standard output and standard error. A reader that has gone away is never a panic: on standard
//! output it ends the output quietly, and what can't be said on standard error isn't said.

use super::failure::Failure;
use qrt_runtime::image::ImageError;
use std::env;
use std::io::{self, BufWriter, ErrorKind, IsTerminal, StdoutLock, Write};

/// Writes `text` to standard output.
///
/// # Errors
/// If it can't be written, other than to a reader that has seen enough.
pub(crate) fn print(text: &str) -> Result<(), Failure> {
    stream(|out| out.write_all(text.as_bytes()))
}

/// Writes to standard output whatever `write` does.
///
/// # Errors
/// Like [`print`], and returns other errors of `write` too.
pub(crate) fn stream<E: Into<WriteError>>(
    write: impl FnOnce(&mut BufWriter<StdoutLock<'static>>) -> Result<(), E>,
) -> Result<(), Failure> {
    let mut out = BufWriter::new(io::stdout().lock());
    let written = write(&mut out).map_err(Into::into);
    match written.and_then(|()| out.flush().map_err(WriteError::Io)) {
        Ok(()) => Ok(()),
        Err(WriteError::Io(error)) if error.kind() == ErrorKind::BrokenPipe => Ok(()),
        Err(WriteError::Io(error)) => Err(Failure::Job(format!("standard output: {error}"))),
        Err(WriteError::Other(failure)) => Err(failure),
    }
}

/// Why nothing was written: by the output, or by what was to be written.
pub(crate) enum WriteError {
    Io(io::Error),
    Other(Failure),
}

impl From<io::Error> for WriteError {
    fn from(error: io::Error) -> Self {
        Self::Io(error)
    }
}

impl From<ImageError> for WriteError {
    fn from(error: ImageError) -> Self {
        match error {
            ImageError::Write(error) => Self::Io(error),
            other => Self::Other(other.into()),
        }
    }
}

/// A remark on standard error.
pub(crate) fn note(text: &str) {
    let _ = writeln!(io::stderr(), "note: {text}");
}

/// What is not wrong, but surely not meant, on standard error.
pub(crate) fn warn(report: &qrt_core::syntax::Report) {
    let _ = io::stderr().write_all(report.render(colour()).as_bytes());
}

/// What went wrong, on standard error.
pub(crate) fn error(failure: &Failure) {
    let colour = colour();
    let text = match failure {
        Failure::Scene(report) => report.render(colour),
        Failure::Usage(message) | Failure::Job(message) if colour => {
            format!("\u{1b}[1m\u{1b}[91merror\u{1b}[0m: {message}\n")
        }
        Failure::Usage(message) | Failure::Job(message) => format!("error: {message}\n"),
    };
    let _ = io::stderr().write_all(text.as_bytes());
}

/// Colours are for terminals, and for whoever hasn't set <https://no-color.org>.
fn colour() -> bool {
    let unwanted = env::var_os("NO_COLOR").is_some_and(|value| !value.is_empty())
        || env::var_os("TERM").is_some_and(|value| value == "dumb");
    io::stderr().is_terminal() && !unwanted
}
