//! `pantin track` when things go wrong: killed at any moment, no room left, sources that stall, end early or deliver garbage,
//! a device lost; and tracking in real time, from recordings and from live sources.

#![allow(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::print_stdout,
    reason = "a test says what went wrong by panicking"
)]

mod interrupted;
mod live;
#[path = "../track/outcome.rs"]
mod outcome;
mod realtime;
#[path = "../track/walk.rs"]
#[allow(dead_code, reason = "its other user takes more of it")]
mod walk;

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use outcome::{refused, sequence, stderr};

fn command(sequence: &Path, output: &Path, more: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_pantin"));
    command.args(["track", sequence.to_str().unwrap(), "-o", output.to_str().unwrap()]).args(more);
    command
}

fn track(sequence: &Path, output: &Path, more: &[&str]) -> Output {
    command(sequence, output, more).output().unwrap()
}

#[track_caller]
fn succeeded(output: &Output) {
    assert!(output.status.success(), "{}", stderr(output));
}

/// Lines of the journal that are whole.
fn journalled(output: &Path) -> usize {
    fs::read(output.join("journal.txt")).map_or(0, |bytes| bytes.iter().filter(|byte| **byte == b'\n').count())
}

/// Whether ffmpeg is there; says so where not, so that a skipped test is seen.
fn has_ffmpeg(test: &str) -> bool {
    let here = Command::new("ffmpeg").arg("-version").output().is_ok();
    if !here {
        println!("SKIPPED {test}: ffmpeg is not installed");
    }
    here
}
