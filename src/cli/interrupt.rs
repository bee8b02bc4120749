//! Signals: Ctrl-C, and the limit on the size of files.

use super::failure::Failure;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// Whether there is something to finish or to keep.
static BEGUN: AtomicBool = AtomicBool::new(false);

/// From here on there is something to finish or to keep when Ctrl-C comes.
pub(crate) fn begun() {
    BEGUN.store(true, Ordering::Relaxed);
}

/// A flag that the first Ctrl-C sets. The second ends the process at once, as the first does before anything
/// has [begun](begun); a picture's finished tiles are safe then, too.
pub(crate) fn cancel_on_interrupt() -> Result<Arc<AtomicBool>, Failure> {
    let cancel = Arc::new(AtomicBool::new(false));
    let flag = Arc::clone(&cancel);
    let handler = move || {
        let is_second = flag.swap(true, Ordering::Relaxed);
        if !BEGUN.load(Ordering::Relaxed) {
            eprintln!("error: interrupted before the first path");
        } else if !is_second {
            return;
        }
        std::process::exit(1);
    };
    match ctrlc::set_handler(handler) {
        Ok(()) => Ok(cancel),
        Err(error) => Err(Failure::Job(format!("Ctrl-C cannot be handled: {error}"))),
    }
}

/// Lets a write beyond the limit on the size of files (`ulimit -f`) fail as any other does, and be
/// told of. Otherwise the system would end the process without a word.
#[cfg(unix)]
pub(crate) fn outlive_file_limits() {
    // SAFETY: no handler is installed, so that nothing runs in a signal's context; and no other
    // thread was started yet that could change what this signal does.
    unsafe {
        libc::signal(libc::SIGXFSZ, libc::SIG_IGN);
    }
}

#[cfg(not(unix))]
pub(crate) fn outlive_file_limits() {}
