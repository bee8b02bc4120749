//! Standard output and standard error. A closed pipe never causes a panic: on standard output it ends
//! the output quietly, and on standard error the message is dropped.

use super::failure::Failure;
use qrt_runtime::image::ImageError;
use std::env;
use std::io::{self, BufWriter, ErrorKind, IsTerminal, StdoutLock, Write};

/// Writes `text` to standard output.
///
/// # Errors
/// Standard output can't be written, unless the reader has closed the pipe.
pub(crate) fn print(text: &str) -> Result<(), Failure> {
    stream(|out| out.write_all(text.as_bytes()))
}

/// Streams the output of `write` to standard output.
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

/// An error of the output, or of the text to be written.
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

/// Prints a remark on standard error.
pub(crate) fn note(text: &str) {
    let _ = writeln!(io::stderr(), "note: {text}");
}

/// Prints a warning on standard error: valid input that is surely not meant.
pub(crate) fn warn(report: &qrt_syntax::Report) {
    let _ = io::stderr().write_all(report.render(colour()).as_bytes());
}

/// Prints an error on standard error.
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

/// True if standard error is a terminal that takes colours and `NO_COLOR` (<https://no-color.org>) is not set.
fn colour() -> bool {
    let unwanted = env::var_os("NO_COLOR").is_some_and(|value| !value.is_empty())
        || env::var_os("TERM").is_some_and(|value| value == "dumb");
    io::stderr().is_terminal() && !unwanted
}
