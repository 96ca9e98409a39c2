//! Standard output and error that are closed or full: nothing panics, and what the program was asked for is done.

use std::fs::{File, OpenOptions};
use std::process::{Child, Stdio};

use super::support::{program, stderr};

/// A device that takes nothing, where there is one.
fn full() -> Option<File> {
    OpenOptions::new().write(true).open("/dev/full").ok()
}

fn matrix(arguments: &[&str], output: impl Into<Stdio>, messages: impl Into<Stdio>) -> Child {
    program().arg("matrix").args(arguments).stdout(output).stderr(messages).spawn().unwrap()
}

#[test]
fn a_reader_who_leaves_ends_the_output_and_not_the_work() {
    let folder = tempfile::tempdir().unwrap();
    let made = folder.path().join("scene");
    let arguments = ["synth", "--preset", "demo", "--frames", "1", "-o", made.to_str().unwrap()];
    let mut child = program().args(arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    let messages = stderr(&output);
    assert_eq!(output.status.code(), Some(0), "{messages}");
    assert!(messages.lines().all(|line| line.starts_with("making the sequence: frame")), "{messages}");
    assert!(made.join("sequence.toml").is_file() && made.join("truth.trc").is_file());

    let mut child = matrix(&["--json", "--n", "3"], Stdio::piped(), Stdio::piped());
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    assert_eq!((output.status.code(), stderr(&output).as_str()), (Some(0), ""));
}

#[test]
fn a_stream_that_takes_no_more_is_told_of() {
    let Some(device) = full() else { return println!("SKIPPED: there is no /dev/full") };
    let output = matrix(&["--n", "3"], device, Stdio::piped()).wait_with_output().unwrap();
    let message = stderr(&output);
    assert_eq!(output.status.code(), Some(1), "{message}");
    assert!(
        message.starts_with("pantin: standard output takes no more: ") && message.lines().count() == 1,
        "{message}"
    );

    let help = program().arg("--help").stdout(full().unwrap()).stderr(Stdio::piped()).output().unwrap();
    assert_eq!(help.status.code(), Some(1));

    // A sentence that finds no room: the status is left.
    let output = matrix(&["--n", "0"], Stdio::piped(), full().unwrap()).wait_with_output().unwrap();
    assert!(matches!(output.status.code(), Some(1 | 2)), "{:?}", output.status);
    let mut child = matrix(&["--n", "3", "--bits", "99"], Stdio::piped(), Stdio::piped());
    drop(child.stderr.take());
    assert!(matches!(child.wait().unwrap().code(), Some(1 | 2)));
}
