//! Handling of signals: Ctrl-C, and the limit on the size of files.

use super::failure::Failure;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// True once there is work to finish or to keep.
static BEGUN: AtomicBool = AtomicBool::new(false);

/// Marks that from here on there is work to finish or to keep when Ctrl-C comes.
pub(crate) fn begun() {
    BEGUN.store(true, Ordering::Relaxed);
}

/// Returns a flag that the first Ctrl-C sets. The second Ctrl-C ends the process at once, and so does the
/// first before [`begun`](begun) was called. In both cases a picture's finished tiles are safe.
pub(crate) fn cancel_on_interrupt() -> Result<Arc<AtomicBool>, Failure> {
    let cancel = Arc::new(AtomicBool::new(false));
    if cfg!(test) {
        // A process has one handler, and tests run many commands.
        return Ok(cancel);
    }
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

/// Makes a write beyond the limit on the size of files (`ulimit -f`) fail with an ordinary error, which the
/// command reports. Otherwise the system would end the process without a message.
#[cfg(unix)]
pub(crate) fn outlive_file_limits() {
    // SAFETY: `SIG_IGN` installs no handler, so no code runs in a signal's context; and no other
    // thread was started yet that could change the disposition of this signal.
    unsafe {
        libc::signal(libc::SIGXFSZ, libc::SIG_IGN);
    }
}

#[cfg(not(unix))]
pub(crate) fn outlive_file_limits() {}
