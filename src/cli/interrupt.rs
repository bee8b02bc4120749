//! Ctrl-C.

use super::failure::Failure;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// A flag that the first Ctrl-C sets. The second ends the process at once; a
/// picture's finished tiles are safe then, too.
pub(crate) fn cancel_on_interrupt() -> Result<Arc<AtomicBool>, Failure> {
    let cancel = Arc::new(AtomicBool::new(false));
    let flag = Arc::clone(&cancel);
    let handler = move || {
        if flag.swap(true, Ordering::Relaxed) {
            std::process::exit(1);
        }
    };
    match ctrlc::set_handler(handler) {
        Ok(()) => Ok(cancel),
        Err(error) => Err(Failure::Job(format!("Ctrl-C cannot be handled: {error}"))),
    }
}
