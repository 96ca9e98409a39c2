//! What a run in real time is asked for.

use std::fmt;
use std::str::FromStr;
use std::time::Duration;

use anyhow::{Result, anyhow, ensure};

use crate::live::Destination;
use crate::sequence::Sequence;

/// How a run keeps time.
#[derive(Clone, Debug, PartialEq)]
pub struct RealtimeSettings {
    /// Speed of a recorded sequence over its own; live sources keep theirs.
    pub rate: f64,
    /// How long a recorded sequence is played.
    pub repeat: Repeat,
    /// How old a pose may be when it is out, counted from the capture of its pictures; without, every frame gets the whole
    /// search.
    pub deadline: Option<Duration>,
    /// Frames that a pose waits for: it is searched again with them known (METHOD A14), and out that much later.
    pub delay: usize,
    /// Where each pose goes as it is found. What a run yields does not depend on it, so run.toml does not tell of it.
    pub send: Vec<Destination>,
    /// The port of a page that shows the run to browsers on this machine, 0 for any that is free; none without. Nor does run.toml tell of it.
    pub live: Option<u16>,
}

/// Frames that a pose may wait for: beyond them nothing tells of it.
const LONGEST_DELAY: usize = 60;

impl Default for RealtimeSettings {
    fn default() -> Self {
        Self { rate: 1.0, repeat: Repeat::default(), deadline: None, delay: 0, send: Vec::new(), live: None }
    }
}

impl RealtimeSettings {
    /// Whether the settings make sense by themselves.
    ///
    /// # Errors
    /// With the setting, what it is and what was expected.
    pub fn check(&self) -> Result<()> {
        ensure!((0.01..=100.0).contains(&self.rate), "rate is {}, expected 0.01 to 100", self.rate);
        if let Some(deadline) = self.deadline {
            let ms = deadline.as_secs_f64() * 1e3;
            ensure!((1.0..=10_000.0).contains(&ms), "the deadline is {ms} ms, expected 1 to 10000");
        }
        ensure!(self.delay <= LONGEST_DELAY, "the delay is {} frames, expected 0 to {LONGEST_DELAY}", self.delay);
        Ok(())
    }

    /// Of the deadline, what the frames that a pose waits for leave; without a deadline none.
    ///
    /// # Errors
    /// When they leave nothing.
    pub(crate) fn time_to_search(&self, sequence: &Sequence) -> Result<Option<Duration>> {
        let rate = if sequence.is_live() { 1.0 } else { self.rate };
        let waits = self.delay as f64 / (sequence.fps * rate);
        let left = |deadline: Duration| {
            let left = deadline.as_secs_f64() - waits;
            ensure!(
                left > 0.0,
                "the deadline is {} ms, but a delay of {} frames alone takes {:.1} ms, expected a longer one or a shorter delay",
                deadline.as_secs_f64() * 1e3,
                self.delay,
                waits * 1e3
            );
            Ok(Duration::from_secs_f64(left))
        };
        self.deadline.map(left).transpose()
    }

    /// The flags that ask for it.
    pub(crate) fn flags(&self) -> String {
        let deadline =
            self.deadline.map(|time| format!(" --deadline {}", time.as_secs_f64() * 1e3)).unwrap_or_default();
        let delay = if self.delay > 0 { format!(" --delay {}", self.delay) } else { String::new() };
        format!(" --realtime --rate {} --loop {}{deadline}{delay}", self.rate, self.repeat)
    }
}

/// How long a recorded sequence is played.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Repeat {
    /// So many rounds.
    Times(usize),
    /// So many seconds, at least a frame.
    Seconds(f64),
}

impl Default for Repeat {
    fn default() -> Self {
        Self::Times(1)
    }
}

impl Repeat {
    /// Frames to play of a round of `length`, at `fps`.
    pub(super) fn frames(self, length: usize, fps: f64) -> usize {
        match self {
            Self::Times(times) => length.saturating_mul(times),
            Self::Seconds(seconds) => ((seconds * fps).ceil() as usize).max(1),
        }
    }
}

impl FromStr for Repeat {
    type Err = anyhow::Error;

    fn from_str(text: &str) -> Result<Self> {
        let wrong = || anyhow!("`{text}` is no length of a loop, expected a number of rounds (3) or of seconds (600s)");
        let repeat = match text.strip_suffix('s') {
            Some(seconds) => Self::Seconds(seconds.trim_end().parse().map_err(|_| wrong())?),
            None => Self::Times(text.parse().map_err(|_| wrong())?),
        };
        match repeat {
            Self::Times(1..=1_000_000) => Ok(repeat),
            Self::Seconds(seconds) if seconds > 0.0 && seconds <= 1e7 => Ok(repeat),
            _ => Err(wrong()),
        }
    }
}

impl fmt::Display for Repeat {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Times(times) => write!(out, "{times}"),
            Self::Seconds(seconds) => write!(out, "{seconds}s"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn loops_are_rounds_or_seconds() {
        let frames = |text: &str| text.parse::<Repeat>().map(|repeat| repeat.frames(100, 50.0));
        for (text, expected) in [("1", 100), ("3", 300), ("10s", 500), ("0.001s", 1), ("1.01 s", 51)] {
            assert_eq!(frames(text).unwrap(), expected, "{text}");
            assert_eq!(text.parse::<Repeat>().unwrap().to_string().parse::<Repeat>().unwrap(), text.parse().unwrap());
        }
        for text in ["", "s", "0", "-1", "0s", "NaNs", "infs", "3m", "99999999999999999999"] {
            let error = frames(text).unwrap_err().to_string();
            assert!(error.contains("no length of a loop"), "{error}");
        }
    }

    #[test]
    fn wrong_settings_are_named() {
        RealtimeSettings::default().check().unwrap();
        let error = RealtimeSettings { rate: f64::NAN, ..RealtimeSettings::default() }.check().unwrap_err();
        assert!(error.to_string().contains("rate is NaN"), "{error}");
        let deadline = Some(Duration::from_micros(10));
        let error = RealtimeSettings { deadline, ..RealtimeSettings::default() }.check().unwrap_err();
        assert!(error.to_string().contains("the deadline is 0.01 ms"), "{error}");
    }
}
