//! Who does the work: threads, how they are stopped, and who is told how far they are.
//!
//! Pictures, plans, checks and tables of trade-offs all take a [`Workers`]. Nothing that they find
//! depends on it.

pub(crate) mod slow_build;

use std::num::NonZeroUsize;
use std::sync::atomic::{AtomicBool, Ordering};

/// Threads, how they are stopped, and who is told how far they are.
///
/// ```
/// use qrt_runtime::workers::Workers;
/// use std::num::NonZeroUsize;
/// let one = Workers { threads: NonZeroUsize::new(1), ..Workers::default() };
/// ```
#[derive(Clone, Copy, Default)]
pub struct Workers<'a> {
    /// Threads; as many as the machine has cores unless set.
    pub threads: Option<NonZeroUsize>,
    /// Set it, from any thread, to stop.
    pub cancel: Option<&'a AtomicBool>,
    /// Told how far the work is, from any thread. Plans tell nothing.
    pub progress: Option<&'a (dyn Fn(Progress) + Sync)>,
}

/// How far the work is: in paths of a picture or of a check, in rows of a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Progress {
    /// Once, at the beginning.
    Started {
        /// All that there is to do.
        total: u64,
        /// Of this, what an earlier run has done.
        resumed: u64,
    },
    /// So much more is finished.
    Finished(u64),
}

/// The threads can't be started.
#[derive(Debug, thiserror::Error)]
#[error("the threads cannot be started: {0}")]
pub struct ThreadsError(#[from] rayon::ThreadPoolBuildError);

/// Bytes of a thread's stack: enough for the native code of the longest circuit that becomes code,
/// compiled without optimisation. Memory is taken as it is used.
const STACK: usize = 64 << 20;

impl Workers<'_> {
    /// Does `work` on threads that are started for it.
    pub(crate) fn run<T: Send>(&self, work: impl FnOnce() -> T + Send) -> Result<T, ThreadsError> {
        let threads = self.threads.map_or(0, NonZeroUsize::get);
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .stack_size(STACK)
            .build()?;
        Ok(pool.install(work))
    }

    /// Whether the work is to stop.
    pub(crate) fn cancelled(&self) -> bool {
        self.cancel.is_some_and(|flag| flag.load(Ordering::Relaxed))
    }

    /// Tells how far the work is.
    pub(crate) fn report(&self, progress: Progress) {
        if let Some(listener) = self.progress {
            listener(progress);
        }
    }
}
