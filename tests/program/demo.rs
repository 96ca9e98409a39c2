//! `pantin demo` from the outside: the sequence, the track and the report, from nothing.

use std::path::Path;
use std::process::Output;

use super::support::{program, stderr, stdout};

fn demo(folder: &Path, more: &[&str]) -> Output {
    let mut command = program();
    command.args(["demo", "-o"]).arg(folder).args(["--frames", "12"]).args(more);
    command.output().unwrap()
}

#[test]
fn a_walk_is_made_tracked_and_scored() {
    let temporary = tempfile::tempdir().unwrap();
    let folder = temporary.path().join("demo");
    let done = demo(&folder, &["--particles", "300", "--iterations", "12"]);
    let (out, err) = (stdout(&done), stderr(&done));
    assert!(done.status.success(), "{err}");
    let line = out.lines().find(|line| line.starts_with("error ")).unwrap_or_else(|| panic!("no error in {out}"));
    let error: f64 = line.split_whitespace().nth(1).unwrap().parse().unwrap();
    // Exact truth: eight seeds gave 12.5 mm with a deviation of 1.1; four of those are left for another scene's luck.
    assert!(error > 1.0 && error < 17.0, "{line}");

    for name in ["sequence/sequence.toml", "sequence/truth.trc", "poses.csv", "joints.trc", "markers.c3d", "demo.png"] {
        assert!(folder.join(name).is_file(), "{name} is missing");
    }
    let report = std::fs::read_to_string(folder.join("report.html")).unwrap();
    assert!(report.contains("data:image/jpeg;base64,") && report.contains("<canvas") && report.contains("left_wrist"));

    let poses = std::fs::read(folder.join("poses.csv")).unwrap();
    let refused = demo(&folder, &[]);
    let message = stderr(&refused);
    assert_eq!(refused.status.code(), Some(1));
    assert!(message.contains("--force"), "{message}");
    let again = demo(&folder, &["--force", "--particles", "300", "--iterations", "12"]);
    assert!(again.status.success());
    assert_eq!(std::fs::read(folder.join("poses.csv")).unwrap(), poses, "the same seed gives the same bytes");
}

#[test]
fn impossible_numbers_are_named_before_anything_is_written() {
    let temporary = tempfile::tempdir().unwrap();
    let folder = temporary.path().join("demo");
    for (arguments, expected) in [(["--particles", "0"], "particles is 0"), (["--iterations", "0"], "iterations is 0")]
    {
        let failed = demo(&folder, &arguments);
        let message = stderr(&failed);
        assert_eq!(failed.status.code(), Some(1), "{message}");
        assert!(message.contains(expected) && message.trim().lines().count() == 1, "{message}");
        assert!(!folder.exists(), "{arguments:?} wrote something");
    }
    let failed = program().args(["demo", "--frames", "0", "-o"]).arg(&folder).output().unwrap();
    assert!(stderr(&failed).contains("frames is 0"));
}
