//! The flags of a run in real time.

use std::time::Duration;

use anyhow::{Context, Result};

use crate::live::Destination;
use crate::track::{RealtimeSettings, Repeat};

/// Keeping time with the pictures.
#[derive(clap::Args, Debug)]
#[command(next_help_heading = "Real time")]
pub(super) struct RealtimeFlags {
    /// Track as the pictures come: the newest complete set wins, older ones are passed over. Takes live sources too.
    #[arg(long)]
    pub(super) realtime: bool,
    /// Speed of a recorded sequence over its own.
    #[arg(long, value_name = "F", default_value_t = 1.0, requires = "realtime")]
    rate: f64,
    /// Play a recorded sequence N times, or for so many seconds (600s); each round begins at the start pose.
    #[arg(long = "loop", value_name = "N|SECONDSs", default_value_t = Repeat::default(), requires = "realtime")]
    repeat: Repeat,
    /// How old a pose may be when it is out, ms from the capture: particles, then iterations are given up to hold it.
    #[arg(long, value_name = "MS", requires = "realtime")]
    deadline: Option<f64>,
    /// Let every pose wait for so many frames after it, and search it again with them known: later, and steadier.
    #[arg(long, value_name = "FRAMES", default_value_t = 0, requires = "realtime")]
    delay: usize,
    /// Send each pose as it is found; may be given several times. vmc://HOST:PORT: to an application that receives the Virtual Motion
    /// Capture protocol there (UDP). jsonl://HOST:PORT: HOST and PORT are where pantin listens, and whoever connects (TCP) gets a line
    /// of JSON a pose.
    #[arg(long, value_name = "URL", requires = "realtime")]
    send: Vec<Destination>,
    /// Show the run on a page that browsers on this machine can open: at this port, or at any that is free.
    #[arg(long, value_name = "PORT", num_args = 0..=1, default_missing_value = "0", requires = "realtime")]
    live: Option<u16>,
}

impl RealtimeFlags {
    /// The settings they ask for, if any.
    ///
    /// # Errors
    /// When the deadline is no length of time.
    pub(super) fn settings(&self) -> Result<Option<RealtimeSettings>> {
        if !self.realtime {
            return Ok(None);
        }
        let deadline = self.deadline.map(|ms| duration("the deadline, ms,", ms / 1e3)).transpose()?;
        let Self { rate, repeat, delay, live, .. } = *self;
        Ok(Some(RealtimeSettings { rate, repeat, deadline, delay, send: self.send.clone(), live }))
    }
}

/// Seconds as a user gave them.
///
/// # Errors
/// When they are negative, no number, or too many to count.
pub(super) fn duration(name: &str, seconds: f64) -> Result<Duration> {
    Duration::try_from_secs_f64(seconds).with_context(|| format!("{name} is no length of time"))
}
