//! Progress of long work: a bar on a terminal, a plain line now and then elsewhere.

use std::io::{IsTerminal, stderr};

use indicatif::{ProgressBar, ProgressStyle};

/// Plain lines are written each time this many hundredths of the work are done.
const PLAIN_STEP: u64 = 10;

/// Progress through `total` units of work.
pub struct Progress {
    name: &'static str,
    unit: &'static str,
    total: u64,
    done: u64,
    bar: Option<ProgressBar>,
}

impl Progress {
    /// Begins with `total` frames; `name` says what is being done.
    pub fn new(name: &'static str, total: usize) -> Self {
        Self::of(name, "frame", total)
    }

    /// Begins with `total` units of work, `unit` what one is called.
    pub fn of(name: &'static str, unit: &'static str, total: usize) -> Self {
        let total = total as u64;
        let bar = stderr().is_terminal().then(|| {
            let bar = ProgressBar::new(total);
            if let Ok(style) = ProgressStyle::with_template("{prefix} {wide_bar} {msg} {pos} of {len}, {eta} left") {
                bar.set_style(style);
            }
            bar.set_prefix(name);
            bar.set_message(unit);
            bar
        });
        Self { name, unit, total, done: 0, bar }
    }

    /// One more is done.
    pub fn advance(&mut self) {
        self.done += 1;
        match &self.bar {
            Some(bar) => bar.set_position(self.done),
            None if self.is_worth_a_line() => eprintln!("{}: {} {} of {}", self.name, self.unit, self.done, self.total),
            None => {}
        }
    }

    fn is_worth_a_line(&self) -> bool {
        let step = |done: u64| done * 100 / (self.total.max(1) * PLAIN_STEP);
        step(self.done) > step(self.done - 1)
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ten_lines_however_long_the_work() {
        for total in [10, 100, 999] {
            let mut progress = Progress { name: "test", unit: "frame", total, done: 0, bar: None };
            let lines = (0..total)
                .filter(|_| {
                    progress.done += 1;
                    progress.is_worth_a_line()
                })
                .count();
            assert_eq!(lines, 10, "{total} frames");
        }
    }
}
