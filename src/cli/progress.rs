//! The progress bar on standard error.

use super::interrupt;
use indicatif::{HumanDuration, ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};
use qrt_runtime::workers::Progress;
use std::fmt::Write;
use std::time::Duration;

/// A bar on standard error if that is a terminal; else one that isn't seen.
pub(crate) struct Bar {
    bar: ProgressBar,
    style: String,
}

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

    /// Of what is not counted.
    pub(crate) fn setting_up() -> Self {
        let bar = Self::new(true, "");
        bar.set_up();
        bar
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
        Self { bar, style }
    }

    /// Shows, until there is something to count, how long it takes to get there. To be called once nothing else
    /// is to be told before that.
    pub(crate) fn set_up(&self) {
        self.style("{spinner} setting up, {elapsed}");
        self.bar.enable_steady_tick(Duration::from_millis(250));
    }

    fn style(&self, template: &str) {
        // A template that doesn't parse leaves the library's own.
        if let Ok(style) = ProgressStyle::with_template(template) {
            self.bar
                .set_style(style.with_key("left", left).progress_chars("=> "));
        }
    }

    pub(crate) fn show(&self, progress: Progress) {
        interrupt::begun();
        match progress {
            Progress::Started { total, resumed } => {
                self.style(&self.style);
                self.bar.set_length(total);
                self.bar.set_position(resumed);
                // What was done before says nothing about the time that the rest takes.
                self.bar.reset_eta();
                self.bar.enable_steady_tick(Duration::from_millis(250));
            }
            Progress::Finished(more) => self.bar.inc(more),
        }
    }

    /// Removes the bar.
    pub(crate) fn clear(&self) {
        self.bar.finish_and_clear();
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
