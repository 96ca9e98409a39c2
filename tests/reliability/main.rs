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
mod realtime;
#[path = "../track/walk.rs"]
#[allow(dead_code, reason = "its other user takes more of it")]
mod walk;

use std::fs;
use std::path::Path;
use std::process::{Command, Output};
use std::sync::OnceLock;

use tempfile::TempDir;

/// The sequence, made once: six frames of pictures and masks, four cameras, 160x120.
fn sequence() -> &'static Path {
    static SEQUENCE: OnceLock<TempDir> = OnceLock::new();
    SEQUENCE
        .get_or_init(|| {
            let folder = tempfile::tempdir().unwrap();
            walk::write(folder.path());
            folder
        })
        .path()
}

fn command(sequence: &Path, output: &Path, more: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_pantin"));
    command.args(["track", sequence.to_str().unwrap(), "-o", output.to_str().unwrap()]).args(more);
    command
}

fn track(sequence: &Path, output: &Path, more: &[&str]) -> Output {
    command(sequence, output, more).output().unwrap()
}

fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

#[track_caller]
fn succeeded(output: &Output) {
    assert!(output.status.success(), "{}", stderr(output));
}

/// A run that must fail with status 1 and one sentence that holds `parts`.
#[track_caller]
fn refused(output: &Output, parts: &[&str]) {
    let text = stderr(output);
    assert_eq!(output.status.code(), Some(1), "{text}");
    let sentence = text.lines().last().unwrap_or_default();
    assert!(sentence.starts_with("pantin: ") && !text.contains("panicked"), "{text}");
    for part in parts {
        assert!(sentence.contains(part), "`{sentence}` lacks `{part}`");
    }
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
