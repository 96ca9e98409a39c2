//! Progress of long work: a bar on a terminal, a plain line now and then elsewhere.

use std::io::{IsTerminal, stderr};
use std::time::{Duration, Instant};

use indicatif::ProgressStyle;

use super::output::tell;

/// Plain lines are written each time this many hundredths of the work are done.
const PLAIN_STEP: usize = 10;

/// A bar on a terminal, nothing elsewhere; cleared when dropped.
#[derive(Default)]
pub(super) struct TerminalBar(Option<indicatif::ProgressBar>);

impl TerminalBar {
    /// At `done` of `total`; a spinner where the end is not known. `template` is that of `indicatif`.
    pub(super) fn new(template: &str, done: usize, total: Option<usize>) -> Self {
        let bar = || {
            let bar = match total {
                Some(total) => indicatif::ProgressBar::new(total as u64),
                None => indicatif::ProgressBar::new_spinner(),
            };
            let bar = bar.with_position(done as u64);
            bar.reset_eta();
            if let Ok(style) = ProgressStyle::with_template(template) {
                bar.set_style(style);
            }
            bar
        };
        Self(stderr().is_terminal().then(bar))
    }

    /// Shows how much is done; false where there is no terminal.
    pub(super) fn show(&self, done: usize, message: &str) -> bool {
        let Some(bar) = &self.0 else { return false };
        bar.set_message(message.to_string());
        bar.set_position(done as u64);
        true
    }

    /// Writes a line above it.
    pub(super) fn tell(&self, line: &str) {
        match &self.0 {
            Some(bar) => bar.suspend(|| tell!("{line}")),
            None => tell!("{line}"),
        }
    }
}

impl Drop for TerminalBar {
    fn drop(&mut self) {
        if let Some(bar) = &self.0 {
            bar.finish_and_clear();
        }
    }
}

/// How often a plain line is written of work of unknown length.
const LINE_INTERVAL: Duration = Duration::from_secs(5);

/// Progress through work of several kinds, one after the other: a bar each on a terminal, a plain line every few seconds elsewhere.
#[derive(Default)]
pub(super) struct WorkBar {
    what: &'static str,
    bar: TerminalBar,
    last_line: Option<Instant>,
}

impl WorkBar {
    /// `done` of `total` steps of `what` are done.
    pub(super) fn show(&mut self, what: &'static str, done: usize, total: usize) {
        if self.what != what {
            self.what = what;
            self.bar = TerminalBar::new("{msg} {wide_bar} {percent} %, {eta} left", done, Some(total));
        }
        let last_line = *self.last_line.get_or_insert_with(Instant::now);
        if !self.bar.show(done, what) && last_line.elapsed() >= LINE_INTERVAL {
            self.last_line = Some(Instant::now());
            tell!("{what}: {} %", 100 * done / total.max(1));
        }
    }
}

/// Progress through `total` units of work.
pub(super) struct ProgressBar {
    name: &'static str,
    unit: &'static str,
    total: usize,
    done: usize,
    bar: TerminalBar,
}

impl ProgressBar {
    /// Begins with `total` frames; `name` says what is being done.
    pub(super) fn new(name: &'static str, total: usize) -> Self {
        Self::of(name, "frame", total)
    }

    /// Begins with `total` units of work, `unit` what one is called.
    pub(super) fn of(name: &'static str, unit: &'static str, total: usize) -> Self {
        let template = format!("{name} {{wide_bar}} {{msg}} {{pos}} of {{len}}, {{eta}} left");
        let bar = TerminalBar::new(&template, 0, Some(total));
        bar.show(0, unit);
        Self { name, unit, total, done: 0, bar }
    }

    /// One more is done.
    pub(super) fn advance(&mut self) {
        self.done += 1;
        if !self.bar.show(self.done, self.unit) && self.is_worth_a_line() {
            tell!("{}: {} {} of {}", self.name, self.unit, self.done, self.total);
        }
    }

    fn is_worth_a_line(&self) -> bool {
        let step = |done: usize| done * 100 / (self.total.max(1) * PLAIN_STEP);
        step(self.done) > step(self.done - 1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ten_lines_however_long_the_work() {
        for total in [10, 100, 999] {
            let mut progress = ProgressBar { name: "test", unit: "frame", total, done: 0, bar: TerminalBar::default() };
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
