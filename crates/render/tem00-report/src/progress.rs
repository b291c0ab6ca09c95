//! The progress on standard error: a bar on a terminal, lines elsewhere.

mod lines;

use std::{
    cell::Cell,
    io::IsTerminal,
    sync::atomic::{AtomicU64, Ordering},
};

use indicatif::{HumanDuration, ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};
use tem00_config::printable_line;

use self::lines::Lines;
use crate::{
    digits::si_prefixed,
    output::{is_quiet, note},
};

/// Percent, speed and time left: a bar if standard error is a terminal, else a line now and then.
#[derive(Debug)]
pub struct Progress {
    bar: ProgressBar,
    lines: Option<Lines>,
}

impl Progress {
    /// Starts a bar that is full after `total` units of `what`, named in the plural: "samples".
    pub fn of(total: u64, what: &'static str) -> Self {
        let target = if is_quiet() {
            ProgressDrawTarget::hidden()
        } else {
            ProgressDrawTarget::stderr()
        };
        let bar = ProgressBar::with_draw_target(Some(total), target);
        let template = "{msg} {wide_bar} {percent:>3} %  {rate}  {left} left";
        if let Ok(style) = ProgressStyle::with_template(template) {
            bar.set_style(
                style
                    .with_key(
                        "rate",
                        move |state: &ProgressState, out: &mut dyn core::fmt::Write| {
                            // A line that cannot be formatted is not shown.
                            let _ = write!(out, "{}{what}/s", si_prefixed(state.per_sec()));
                        },
                    )
                    .with_key(
                        "left",
                        |state: &ProgressState, out: &mut dyn core::fmt::Write| {
                            let _ = write!(out, "{}", HumanDuration(state.eta()));
                        },
                    ),
            );
        }
        let lines = (!std::io::stderr().is_terminal()).then(|| Lines::new(total, what));
        Self { bar, lines }
    }

    /// Names the work that the progress belongs to from now on.
    pub fn name(&self, message: String) {
        let message = printable_line(&message, 60);
        if let Some(lines) = &self.lines {
            lines.name(message.clone());
        }
        self.bar.set_message(message);
    }

    /// Moves the bar to `done`.
    pub fn set(&self, done: u64) {
        self.bar.set_position(done);
        self.tell();
    }

    /// Moves the bar on, from any thread.
    pub fn advance(&self, done: u64) {
        self.bar.inc(done);
        self.tell();
    }

    /// Writes a line, if progress is shown by lines and one is due.
    fn tell(&self) {
        if let Some(line) = self
            .lines
            .as_ref()
            .and_then(|lines| lines.due(self.bar.position()))
        {
            note(&line);
        }
    }
}

/// Progress bar over all frames.
#[derive(Debug)]
pub struct FrameProgress {
    bar: Progress,
    /// The work of each frame, and the number of frames that have begun.
    samples_per_frame: u64,
    begun: Cell<u64>,
}

impl FrameProgress {
    /// Starts a bar over frames that count `samples_per_frame` samples each.
    pub fn new(frames: u64, samples_per_frame: u64) -> Self {
        Self {
            bar: Progress::of(frames.saturating_mul(samples_per_frame), "samples"),
            samples_per_frame,
            begun: Cell::new(0),
        }
    }

    /// Begins the next frame and returns the function that moves the bar on. Samples beyond the
    /// count of a frame, which a target error can take, do not move it.
    pub fn begin(&self, name: String) -> impl Fn(u64) + Sync + use<'_> {
        self.bar.name(name);
        let start = self.begun.get() * self.samples_per_frame;
        self.begun.set(self.begun.get() + 1);
        let (bar, max, done) = (&self.bar, self.samples_per_frame, AtomicU64::new(0));
        move |samples| {
            let done = done.fetch_add(samples, Ordering::Relaxed) + samples;
            bar.set(start + done.min(max));
        }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        self.bar.finish_and_clear();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_bar_nobody_sees_can_be_moved() {
        let progress = Progress::of(10, "samples");
        progress.name("frame 1 of 1".into());
        progress.set(3);
        progress.advance(2);
        assert_eq!(progress.bar.position(), 5);
    }
}
