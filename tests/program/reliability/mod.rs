//! `pantin track` when things go wrong: killed at any moment, no room left, sources that stall, end early or deliver garbage,
//! a device lost; and tracking in real time, from recordings and from live sources, with its poses sent on.

mod interrupted;
mod live;
mod realtime;
mod sent;

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use super::support::program;

fn command(sequence: &Path, output: &Path, more: &[&str]) -> Command {
    let mut command = program();
    command.args(["track", sequence.to_str().unwrap(), "-o", output.to_str().unwrap()]).args(more);
    command
}

fn track(sequence: &Path, output: &Path, more: &[&str]) -> Output {
    command(sequence, output, more).output().unwrap()
}

/// Lines of the journal that are whole.
fn journalled(output: &Path) -> usize {
    fs::read(output.join("journal.txt")).map_or(0, |bytes| bytes.iter().filter(|byte| **byte == b'\n').count())
}
