//! Processor time.

use std::sync::LazyLock;
use std::time::Instant;

/// Returns the seconds that all threads of this process have worked so far, where the system reports them,
/// so that other processes do not count; else the seconds that have passed.
#[cfg(unix)]
pub(crate) fn seconds() -> f64 {
    use rustix::time::{ClockId, clock_gettime};
    let time = clock_gettime(ClockId::ProcessCPUTime);
    time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64
}

#[cfg(not(unix))]
pub(crate) fn seconds() -> f64 {
    static STARTED: LazyLock<Instant> = LazyLock::new(Instant::now);
    STARTED.elapsed().as_secs_f64()
}

/// Returns the seconds that all ended children of this process have worked so far, where Linux reports them;
/// else the seconds that have passed.
pub(crate) fn of_children() -> f64 {
    static STARTED: LazyLock<Instant> = LazyLock::new(Instant::now);
    // In the unit of /proc, a hundredth of a second.
    let ticks = |text: String| {
        let fields = text.rsplit_once(')')?.1.split_ascii_whitespace();
        // Fields 16 and 17 of proc_pid_stat(5): cutime and cstime. Two fields precede the bracket.
        let both: Vec<f64> = fields
            .skip(13)
            .take(2)
            .filter_map(|field| field.parse().ok())
            .collect();
        (both.len() == 2).then(|| both.iter().sum::<f64>() / 100.0)
    };
    let started = *STARTED;
    let reported = std::fs::read_to_string("/proc/self/stat")
        .ok()
        .and_then(ticks);
    reported.unwrap_or_else(|| started.elapsed().as_secs_f64())
}

/// Least seconds that are measured together.
const LEAST: f64 = 0.1;

/// Returns the processor's seconds of a run, the least of `runs` measurements. Each repeats the run for at
/// least `LEAST` seconds, so that a coarse clock errs by less than a tenth.
pub(crate) fn least(runs: usize, mut run: impl FnMut()) -> f64 {
    let mut timed = |times: u32| {
        let started = seconds();
        (0..times).for_each(|_| run());
        (seconds() - started) / f64::from(times)
    };
    let mut times = 1;
    while timed(times) * f64::from(times) < LEAST {
        times *= 2;
    }
    (0..runs)
        .map(|_| timed(times))
        .fold(f64::INFINITY, f64::min)
}
