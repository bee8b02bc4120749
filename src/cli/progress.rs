//! The progress bar on standard error.

use super::interrupt;
use indicatif::{HumanDuration, ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};
use qrt_runtime::workers::Progress;
use std::fmt::Write;
use std::time::Duration;

/// A bar on standard error if that is a terminal; else one that isn't seen.
pub(crate) struct Bar(ProgressBar);

impl Bar {
    /// A bar of paths, if it is `wanted`.
    pub(crate) fn paths(wanted: bool) -> Self {
        Self::new(wanted, "{human_pos} of {human_len} paths")
    }

    /// A bar of the rows of a table.
    pub(crate) fn settings(wanted: bool) -> Self {
        Self::new(wanted, "{pos} of {len} settings")
    }

    /// A bar of the gates of a circuit.
    pub(crate) fn gates(wanted: bool) -> Self {
        Self::new(wanted, "{human_pos} of {human_len} gates")
    }

    fn new(wanted: bool, what: &str) -> Self {
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
        Self(bar)
    }

    pub(crate) fn show(&self, progress: Progress) {
        interrupt::begun();
        match progress {
            Progress::Started { total, resumed } => {
                self.0.set_length(total);
                self.0.set_position(resumed);
                // What was done before says nothing about the time that the rest takes.
                self.0.reset_eta();
                self.0.enable_steady_tick(Duration::from_millis(250));
            }
            Progress::Finished(more) => self.0.inc(more),
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
