//! The progress bar on standard error.

use super::interrupt;
use indicatif::{HumanDuration, ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};
use qrt_runtime::workers::Progress;
use std::fmt::Write;
use std::time::Duration;

/// A progress bar on standard error; hidden if that is not a terminal.
pub(crate) struct Bar {
    bar: ProgressBar,
    style: String,
}

impl Bar {
    /// Returns a bar that counts paths; hidden unless `wanted`.
    pub(crate) fn paths(wanted: bool) -> Self {
        Self::new(wanted, "{human_pos} of {human_len} paths")
    }

    /// Returns a bar that counts the rows of a table.
    pub(crate) fn settings(wanted: bool) -> Self {
        Self::new(wanted, "{pos} of {len} settings")
    }

    /// Returns a bar that counts the gates of a circuit.
    pub(crate) fn gates(wanted: bool) -> Self {
        Self::new(wanted, "{human_pos} of {human_len} gates")
    }

    /// Returns a bar that counts pixels.
    pub(crate) fn pixels(wanted: bool) -> Self {
        Self::new(wanted, "{pos} of {len} pixels")
    }

    /// Returns a bar for work without a count.
    pub(crate) fn setting_up() -> Self {
        let bar = Self::new(true, "");
        bar.set_up();
        bar
    }

    fn new(wanted: bool, what: &str) -> Self {
        // indicatif hides the bar itself where there is no terminal.
        let target = if wanted {
            ProgressDrawTarget::stderr()
        } else {
            ProgressDrawTarget::hidden()
        };
        let bar = ProgressBar::with_draw_target(Some(0), target);
        let style = format!("{{bar:40}} {{percent:>3}} %  {what}, {{left}} to go");
        Self { bar, style }
    }

    /// Shows a spinner and the elapsed time until there is something to count. Call it after the last message
    /// that is printed before that.
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
                // Resumed work says nothing about the time that the rest takes.
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

/// Writes the time left, or `?` until the rate is known.
fn left(state: &ProgressState, out: &mut dyn Write) {
    // Progress on a terminal is best effort, so errors are ignored.
    let _ = if state.per_sec() > 0.0 {
        write!(out, "{:#}", HumanDuration(state.eta()))
    } else {
        write!(out, "?")
    };
}
