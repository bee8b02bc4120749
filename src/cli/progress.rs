//! The progress bar.

use indicatif::{HumanDuration, ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};
use qrt_runtime::render::Progress;
use qrt_runtime::trade;
use std::fmt::Write;
use std::time::Duration;

/// A bar on standard error if that is a terminal and `wanted`; else one that isn't seen.
pub(crate) struct Bar(ProgressBar);

impl Bar {
    pub(crate) fn new(wanted: bool) -> Self {
        Self(bar(wanted, "{human_pos} of {human_len} paths"))
    }

    pub(crate) fn show(&self, progress: Progress) {
        match progress {
            Progress::Started { paths, resumed } => start(&self.0, paths, resumed),
            Progress::Traced(paths) => self.0.inc(paths),
        }
    }

    /// Removes the bar.
    pub(crate) fn clear(&self) {
        self.0.finish_and_clear();
    }
}

/// A bar of the rows of a table.
pub(crate) struct Rows(ProgressBar);

impl Rows {
    pub(crate) fn new(wanted: bool) -> Self {
        Self(bar(wanted, "{pos} of {len} settings"))
    }

    pub(crate) fn show(&self, progress: trade::Progress) {
        match progress {
            trade::Progress::Started { rows, resumed } => start(&self.0, rows, resumed),
            trade::Progress::Row => self.0.inc(1),
        }
    }

    /// Removes the bar.
    pub(crate) fn clear(&self) {
        self.0.finish_and_clear();
    }
}

/// A bar of the gates of a circuit.
pub(crate) struct Gates(ProgressBar);

impl Gates {
    /// Of a circuit of so many.
    pub(crate) fn new(wanted: bool, gates: u64) -> Self {
        let bar = bar(wanted, "{human_pos} of {human_len} gates");
        start(&bar, gates, 0);
        Self(bar)
    }

    pub(crate) fn show(&self, written: u64) {
        self.0.inc(written);
    }

    /// Removes the bar.
    pub(crate) fn clear(&self) {
        self.0.finish_and_clear();
    }
}

/// A bar that counts `what`.
fn bar(wanted: bool, what: &str) -> ProgressBar {
    // Hidden by itself where there is no terminal.
    let target = if wanted {
        ProgressDrawTarget::stderr()
    } else {
        ProgressDrawTarget::hidden()
    };
    let bar = ProgressBar::with_draw_target(Some(0), target);
    let style = format!("{{bar:40}} {{percent:>3}} %  {what}, {{left}} to go");
    // A template that doesn't parse leaves the library's own.
    if let Ok(style) = ProgressStyle::with_template(&style) {
        bar.set_style(style.with_key("left", left).progress_chars("=> "));
    }
    bar
}

/// Shows a bar of so many, of which some were done before.
fn start(bar: &ProgressBar, length: u64, resumed: u64) {
    bar.set_length(length);
    bar.set_position(resumed);
    // What was done before says nothing about the time that the rest takes.
    bar.reset_eta();
    bar.enable_steady_tick(Duration::from_millis(250));
}

/// The time left, once something is finished to judge by.
fn left(state: &ProgressState, out: &mut dyn Write) {
    // What can't be shown on a terminal isn't.
    let _ = if state.per_sec() > 0.0 {
        write!(out, "{:#}", HumanDuration(state.eta()))
    } else {
        write!(out, "?")
    };
}
