//! A note on standard error that this build is slow.
//!
//! Cargo's `dev` profile compiles dependencies without optimisation, and this crate then traces
//! paths some hundred times more slowly. No profile of a dependency can change that; only the
//! manifest of the workspace that is built can. So a job that will take long says so, once per
//! process.

use super::{Progress, Workers};
use std::io::{self, Write};
use std::sync::Once;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

/// True if Cargo compiled this crate at `opt-level = 0`. `debug_assertions` would not tell: a
/// profile may have both assertions and optimisation.
const UNOPTIMISED: bool = matches!(env!("QRT_OPT_LEVEL").as_bytes(), b"0");

/// The time to measure before a job's duration is estimated.
const SAMPLE: Duration = Duration::from_secs(1);

/// The shortest estimated duration of a job for which the note is printed.
const LONG: Duration = Duration::from_secs(10);

/// Runs `work` with `workers`. In an unoptimised build that is not `quiet`, a long job prints the
/// note to standard error, unless an earlier one of this process did.
pub(crate) fn noting<T>(
    workers: &Workers<'_>,
    quiet: bool,
    work: impl FnOnce(&Workers<'_>) -> T,
) -> T {
    static TOLD: Once = Once::new();
    if quiet || !UNOPTIMISED || TOLD.is_completed() {
        return work(workers);
    }
    let tell = |duration| {
        TOLD.call_once(|| {
            // Without a standard error the note cannot be shown, so errors are ignored.
            let _ = io::stderr().write_all(note(duration).as_bytes());
        });
    };
    watching(workers, tell, work)
}

/// Runs `work` with `workers`, whose progress is also used to estimate the duration of the job.
/// Each report after which that estimate is long calls `tell` with it.
fn watching<T>(
    workers: &Workers<'_>,
    tell: impl Fn(Duration) + Sync,
    work: impl FnOnce(&Workers<'_>) -> T,
) -> T {
    let start = Instant::now();
    let pace = Pace::default();
    let progress = |progress| {
        workers.report(progress);
        if let Some(duration) = pace.after(progress, start.elapsed()) {
            tell(duration);
        }
    };
    work(&Workers {
        progress: Some(&progress),
        ..*workers
    })
}

/// The progress of a job so far.
#[derive(Default)]
struct Pace {
    /// Paths to trace, without those that an earlier run has traced.
    total: AtomicU64,
    /// Of these, the paths traced so far.
    done: AtomicU64,
}

impl Pace {
    /// Adds `progress`, which was reported `elapsed` after the start. Returns the estimated
    /// duration of the whole job if it is long.
    fn after(&self, progress: Progress, elapsed: Duration) -> Option<Duration> {
        let more = match progress {
            Progress::Started { total, resumed } => {
                let open = total.saturating_sub(resumed);
                self.total.store(open, Ordering::Relaxed);
                return None;
            }
            Progress::Finished(more) => more,
        };
        let done = self.done.fetch_add(more, Ordering::Relaxed) + more;
        let total = self.total.load(Ordering::Relaxed);
        if elapsed < SAMPLE || done == 0 || done >= total {
            return None;
        }
        let seconds = elapsed.as_secs_f64() * (total as f64 / done as f64);
        let duration = Duration::try_from_secs_f64(seconds).unwrap_or(Duration::MAX);
        (duration >= LONG).then_some(duration)
    }
}

/// The text of the note for a job of the estimated `duration`.
fn note(duration: Duration) -> String {
    format!(
        "note: qrt is compiled without optimisation, so this job will take about {} s.\n\
         In the Cargo.toml of your workspace, this makes it many times faster:\n\
         \n    [profile.dev.package.qrt-counting]\n    opt-level = 3\n\
         \n    [profile.dev.package.qrt-machines]\n    opt-level = 3\n\
         \n    [profile.dev.package.qrt-runtime]\n    opt-level = 3\n\n\
         (`RenderOptions {{ quiet: true, .. }}` suppresses this note.)\n",
        duration.as_secs()
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    const SECOND: Duration = Duration::from_secs(1);

    fn paced(total: u64, resumed: u64) -> Pace {
        let pace = Pace::default();
        let started = pace.after(Progress::Started { total, resumed }, Duration::ZERO);
        assert_eq!(started, None);
        pace
    }

    #[test]
    fn a_long_job_is_known_by_the_pace_of_its_first_second() {
        let pace = paced(1_000, 0);
        // It is too early for an estimate.
        assert_eq!(pace.after(Progress::Finished(10), SECOND / 2), None);
        // 20 paths of 1,000 in two seconds.
        let duration = pace.after(Progress::Finished(10), 2 * SECOND);
        assert_eq!(duration, Some(100 * SECOND));
    }

    #[test]
    fn a_short_job_is_not_worth_a_note() {
        let pace = paced(1_000, 0);
        assert_eq!(pace.after(Progress::Finished(200), SECOND), None);
        // The rest of a long job is short if an earlier run has done most of it.
        let pace = paced(1_000_000, 999_000);
        assert_eq!(pace.after(Progress::Finished(200), SECOND), None);
        // A finished job prints no note.
        let pace = paced(10, 0);
        assert_eq!(pace.after(Progress::Finished(10), 60 * SECOND), None);
    }

    #[test]
    fn no_progress_is_too_odd_for_an_estimate() {
        for total in [0, 1, u64::MAX] {
            let pace = paced(total, 0);
            assert_eq!(pace.after(Progress::Finished(0), 60 * SECOND), None);
        }
        let pace = paced(u64::MAX, 0);
        let duration = pace.after(Progress::Finished(1), Duration::from_secs(1 << 40));
        assert_eq!(duration, Some(Duration::MAX));
        assert!(note(Duration::MAX).contains("about 18446744073709551615 s"));
    }

    #[test]
    fn who_is_told_of_progress_is_told_of_all_of_it() {
        let reports = AtomicU64::new(0);
        let listener = |_| {
            reports.fetch_add(1, Ordering::Relaxed);
        };
        let workers = Workers {
            progress: Some(&listener),
            ..Workers::default()
        };
        let durations = std::sync::Mutex::new(Vec::new());
        let tell = |duration| durations.lock().unwrap().push(duration);
        let given = watching(&workers, tell, |workers| {
            workers.report(Progress::Started {
                total: 1_000_000,
                resumed: 0,
            });
            std::thread::sleep(SAMPLE);
            workers.report(Progress::Finished(1));
            7
        });
        assert_eq!((given, reports.into_inner()), (7, 2));
        // One path took a second, and there are a million.
        let durations = durations.into_inner().unwrap();
        assert!(matches!(durations[..], [duration] if duration >= 1_000_000 * SAMPLE));
    }

    #[test]
    fn the_note_says_what_to_write_and_how_to_silence_it() {
        let note = note(75 * SECOND);
        for part in [
            "about 75 s",
            "[profile.dev.package.qrt-counting]",
            "[profile.dev.package.qrt-machines]",
            "[profile.dev.package.qrt-runtime]",
            "opt-level = 3",
            "quiet: true",
        ] {
            assert!(note.contains(part), "{part}: {note}");
        }
    }

    #[test]
    fn the_level_of_this_build_is_one_of_cargos() {
        let level = env!("QRT_OPT_LEVEL");
        assert!(["0", "1", "2", "3", "s", "z"].contains(&level), "{level}");
        assert_eq!(UNOPTIMISED, level == "0");
    }
}
