//! Progress as lines, for logs.

use std::{
    sync::Mutex,
    time::{Duration, Instant},
};

use indicatif::HumanDuration;

use crate::digits::si_prefixed;

/// The time before the first line, and the longest between two.
const FIRST: Duration = Duration::from_secs(2);
const LONGEST: Duration = Duration::from_secs(60);

/// Prints the progress in lines that become rarer: each line waits as long again as the work has
/// taken so far.
#[derive(Debug)]
pub(super) struct Lines {
    total: u64,
    what: &'static str,
    start: Instant,
    state: Mutex<State>,
}

#[derive(Debug)]
struct State {
    name: String,
    /// The time of the next line.
    next: Duration,
}

impl Lines {
    /// Starts with nothing done, of `total` units of `what`.
    pub(super) fn new(total: u64, what: &'static str) -> Self {
        Self {
            total,
            what,
            start: Instant::now(),
            state: Mutex::new(State {
                name: String::new(),
                next: FIRST,
            }),
        }
    }

    /// Names the work that the progress belongs to from now on.
    pub(super) fn name(&self, name: String) {
        if let Ok(mut state) = self.state.lock() {
            state.name = name;
        }
    }

    /// Returns the line that is due, if any.
    pub(super) fn due(&self, done: u64) -> Option<String> {
        self.due_after(self.start.elapsed(), done)
    }

    fn due_after(&self, elapsed: Duration, done: u64) -> Option<String> {
        // Whoever holds the lock writes the line.
        let mut state = self.state.try_lock().ok()?;
        if elapsed < state.next {
            return None;
        }
        state.next = elapsed + elapsed.clamp(FIRST, LONGEST);
        Some(self.line(&state.name, elapsed, done))
    }

    fn line(&self, name: &str, elapsed: Duration, done: u64) -> String {
        let share = done as f64 / self.total.max(1) as f64;
        let rate = done as f64 / elapsed.as_secs_f64().max(1e-9);
        let percent = (100.0 * share).floor();
        let left = if share > 0.0 {
            let seconds = elapsed.as_secs_f64() * (1.0 / share - 1.0).max(0.0);
            // Beyond a million years the number does not matter.
            let left = Duration::from_secs_f64(seconds.min(3e13));
            format!("{} left", HumanDuration(left))
        } else {
            "time left unknown".into()
        };
        format!(
            "{name}: {percent} %, {}{}/s, {left}",
            si_prefixed(rate),
            self.what
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_say_how_far_how_fast_and_how_long() {
        let lines = Lines::new(4_000, "samples");
        lines.name("spot".into());
        let line = lines
            .due_after(Duration::from_secs(10), 1_000)
            .expect("due");
        assert_eq!(line, "spot: 25 %, 100 samples/s, 30 seconds left");
        let nothing = Lines::new(0, "trials").due_after(Duration::from_secs(9), 0);
        assert!(nothing.expect("due").contains("unknown"));
    }

    #[test]
    fn lines_become_rarer() {
        let lines = Lines::new(u64::MAX, "samples");
        let seconds = (0..600).filter(|&second| {
            let line = lines.due_after(Duration::from_secs(second), second);
            line.is_some()
        });
        let seconds: Vec<_> = seconds.collect();
        assert_eq!(seconds[..7], [2, 4, 8, 16, 32, 64, 124]);
        assert!(
            seconds.windows(2).all(|two| two[1] - two[0] <= 60),
            "{seconds:?}"
        );
    }
}
