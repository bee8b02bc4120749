//! Runs long work without the interpreter's lock, and meanwhile reports progress and checks for Ctrl-C.

use crate::errors;
use pyo3::prelude::*;
use qrt_runtime::workers::{Progress, Workers};
use std::num::NonZeroUsize;
use std::ops::Range;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{RecvTimeoutError, sync_channel};
use std::thread;
use std::time::Duration;

/// Interval at which the thread checks for Ctrl-C and reports progress.
const TICK: Duration = Duration::from_millis(50);
/// Bytes of the stack of the thread that works.
const STACK: usize = 64 << 20;

/// Number of paths traced between two checks for cancellation.
const RUN: u64 = 1 << 12;

/// Splits the path indices below `paths` into runs, which end when the work is cancelled; its result is
/// discarded then.
pub(crate) fn runs(workers: Workers<'_>, paths: u64) -> impl Iterator<Item = Range<u64>> {
    (0..paths)
        .step_by(RUN as usize)
        .take_while(move |_| !(workers.cancel).is_some_and(|cancel| cancel.load(Ordering::Relaxed)))
        .map(move |first| first..(first + RUN).min(paths))
}

/// Progress of the work, in paths.
#[derive(Default)]
struct Far {
    done: AtomicU64,
    total: AtomicU64,
}

impl Far {
    fn tell(&self, progress: Progress) {
        match progress {
            Progress::Started { total, resumed } => {
                self.total.store(total, Ordering::Relaxed);
                self.done.store(resumed, Ordering::Relaxed);
            }
            Progress::Finished(more) => {
                self.done.fetch_add(more, Ordering::Relaxed);
            }
        }
    }

    /// Calls `listener` with the progress, once the total is known.
    fn pass_on(&self, listener: Option<&Bound<'_, PyAny>>) -> PyResult<()> {
        let total = self.total.load(Ordering::Relaxed);
        if let Some(listener) = listener.filter(|_| total > 0) {
            listener.call1((self.done.load(Ordering::Relaxed), total))?;
        }
        Ok(())
    }
}

/// Checks the number of threads, 1 to 4096; `None` stands for one for each core.
pub(crate) fn threads(py: Python<'_>, asked: Option<usize>) -> PyResult<Option<NonZeroUsize>> {
    match asked {
        None => Ok(None),
        Some(number @ 1..=4096) => Ok(NonZeroUsize::new(number)),
        Some(number) => Err(errors::request(
            py,
            format!("threads={number} is not in 1..=4096"),
        )),
    }
}

/// Runs `work` on a thread of its own; meanwhile checks for Ctrl-C and calls `listener(done, total)`.
/// An exception of either cancels the work.
pub(crate) fn run<T: Send>(
    py: Python<'_>,
    threads: Option<NonZeroUsize>,
    listener: Option<&Bound<'_, PyAny>>,
    work: impl FnOnce(Workers<'_>) -> T + Send,
) -> PyResult<T> {
    let cancel = AtomicBool::new(false);
    let far = Far::default();
    let listener = listener.map(|listener| listener.clone().unbind());
    let done = py.detach(|| {
        thread::scope(|scope| {
            let (send, receive) = sync_channel(1);
            let (far, cancel) = (&far, &cancel);
            let started = thread::Builder::new()
                .stack_size(STACK)
                .spawn_scoped(scope, move || {
                    let tell = |progress| far.tell(progress);
                    let workers = Workers {
                        threads,
                        cancel: Some(cancel),
                        progress: Some(&tell),
                    };
                    // After an interruption the channel is closed, so the error is ignored.
                    let _ = send.send(work(workers));
                });
            if let Err(error) = started {
                return Err(PyErr::from(error));
            }
            let hear = || {
                Python::attach(|py| {
                    py.check_signals()?;
                    far.pass_on(listener.as_ref().map(|listener| listener.bind(py)))
                })
            };
            loop {
                match receive.recv_timeout(TICK) {
                    Ok(done) => return hear().map(|()| Some(done)),
                    Err(RecvTimeoutError::Disconnected) => return Ok(None),
                    Err(RecvTimeoutError::Timeout) => {
                        if let Err(error) = hear() {
                            cancel.store(true, Ordering::Relaxed);
                            return Err(error);
                        }
                    }
                }
            }
        })
    })?;
    done.ok_or_else(|| errors::job(py, "the work ended without a result"))
}

/// [`run`] with the listener that Python's argument `progress` asks for, which is closed at the end. `failure`
/// makes the exception of work that fails.
pub(crate) fn listened<T: Send, E: Send>(
    py: Python<'_>,
    threads: Option<NonZeroUsize>,
    progress: Option<Py<PyAny>>,
    work: impl FnOnce(Workers<'_>) -> Result<T, E> + Send,
    failure: impl FnOnce(E) -> PyErr,
) -> PyResult<T> {
    let progress = progress.unwrap_or_else(|| py.None());
    let listener = py
        .import("qrt._progress")?
        .call_method1("listener", (progress,))?;
    let heard = (!listener.is_none()).then_some(&listener);
    let made = run(py, threads, heard, work).and_then(|made| made.map_err(failure));
    let closed = heard.map(|listener| listener.call_method0("close"));
    // The first error is the one that is raised.
    made.and_then(|made| closed.transpose().map(|_| made))
}
