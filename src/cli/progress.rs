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
        // Hidden by itself where there is no terminal.
        let target = if wanted {
            ProgressDrawTarget::stderr()
        } else {
            ProgressDrawTarget::hidden()
        };
        let bar = ProgressBar::with_draw_target(Some(0), target);
        let style = "{bar:40} {percent:>3} %  {human_pos} of {human_len} paths, {left} to go";
        // A template that doesn't parse leaves the library's own.
        if let Ok(style) = ProgressStyle::with_template(style) {
            bar.set_style(style.with_key("left", left).progress_chars("=> "));
        }
        Self(bar)
    }

    pub(crate) fn show(&self, progress: Progress) {
        match progress {
            Progress::Started { paths, resumed } => {
                self.0.set_length(paths);
                self.0.set_position(resumed);
                // What was done before says nothing about the time that the rest takes.
                self.0.reset_eta();
                self.0.enable_steady_tick(Duration::from_millis(250));
            }
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
        let target = if wanted {
            ProgressDrawTarget::stderr()
        } else {
            ProgressDrawTarget::hidden()
        };
        let bar = ProgressBar::with_draw_target(Some(0), target);
        let style = "{bar:40} {percent:>3} %  {pos} of {len} settings, {left} to go";
        if let Ok(style) = ProgressStyle::with_template(style) {
            bar.set_style(style.with_key("left", left).progress_chars("=> "));
        }
        Self(bar)
    }

    pub(crate) fn show(&self, progress: trade::Progress) {
        match progress {
            trade::Progress::Started { rows, resumed } => {
                self.0.set_length(rows);
                self.0.set_position(resumed);
                self.0.reset_eta();
                self.0.enable_steady_tick(Duration::from_millis(250));
            }
            trade::Progress::Row => self.0.inc(1),
        }
    }

    /// Removes the bar.
    pub(crate) fn clear(&self) {
        self.0.finish_and_clear();
    }
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
