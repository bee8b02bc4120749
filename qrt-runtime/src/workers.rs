//! Threads that do the work, cancellation, and progress reports.
//!
//! Pictures, plans, checks and tables of trade-offs all take a [`Workers`]. Their results do not
//! depend on it.

pub(crate) mod slow_build;

use std::fmt;
use std::num::NonZeroUsize;
use std::sync::atomic::{AtomicBool, Ordering};

/// Number of threads, a cancel flag, and a progress callback.
///
/// ```
/// use qrt_runtime::workers::Workers;
/// use std::num::NonZeroUsize;
/// let one = Workers { threads: NonZeroUsize::new(1), ..Workers::default() };
/// ```
#[derive(Clone, Copy, Default)]
pub struct Workers<'a> {
    /// Number of threads; the number of the machine's cores unless set.
    pub threads: Option<NonZeroUsize>,
    /// A flag that stops the work when any thread sets it.
    pub cancel: Option<&'a AtomicBool>,
    /// A callback for progress, called from any thread. Plans do not call it.
    pub progress: Option<&'a (dyn Fn(Progress) + Sync)>,
}

impl fmt::Debug for Workers<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Workers")
            .field("threads", &self.threads)
            .field("cancel", &self.cancel)
            .field("progress", &self.progress.map(|_| ".."))
            .finish()
    }
}

/// Progress of the work: in paths of a picture or of a check, or in rows of a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Progress {
    /// Once, at the beginning.
    Started {
        /// The total amount of work.
        total: u64,
        /// The part of `total` that an earlier run has finished.
        resumed: u64,
    },
    /// The amount finished since the last report.
    Finished(u64),
}

/// The threads can't be started.
#[derive(Debug, thiserror::Error)]
#[error("the threads cannot be started: {0}")]
pub struct ThreadsError(#[from] rayon::ThreadPoolBuildError);

/// Bytes of a thread's stack. Without optimisation, the inlined code of the machines has large
/// frames, and the default of 2 MiB overflows. The system allocates memory as the stack is used.
const STACK: usize = 64 << 20;

impl Workers<'_> {
    /// Runs `work` on threads that are started for it.
    ///
    /// # Errors
    /// If the threads can't be started.
    pub fn on_threads<T: Send>(&self, work: impl FnOnce() -> T + Send) -> Result<T, ThreadsError> {
        let threads = self.threads.map_or(0, NonZeroUsize::get);
        let pool = rayon::ThreadPoolBuilder::new()
            .num_threads(threads)
            .stack_size(STACK)
            .build()?;
        Ok(pool.install(work))
    }

    /// Returns whether the work must stop.
    pub fn cancelled(&self) -> bool {
        self.cancel.is_some_and(|flag| flag.load(Ordering::Relaxed))
    }

    /// Reports progress to the callback.
    pub fn report(&self, progress: Progress) {
        if let Some(listener) = self.progress {
            listener(progress);
        }
    }
}
