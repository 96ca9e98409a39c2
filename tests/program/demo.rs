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

    smoothed_results_lie_beside_those_found(&folder.join("sequence"), &temporary.path().join("track"));
    let poses = std::fs::read(folder.join("poses.csv")).unwrap();
    let refused = demo(&folder, &[]);
    let message = stderr(&refused);
    assert_eq!(refused.status.code(), Some(1));
    assert!(message.contains("--force"), "{message}");
    let again = demo(&folder, &["--force", "--particles", "300", "--iterations", "12"]);
    assert!(again.status.success());
    assert_eq!(std::fs::read(folder.join("poses.csv")).unwrap(), poses, "the same seed gives the same bytes");
}

/// `track --smooth`: the results as they were found stay, the smoothed ones are beside them, and the cut-off is said everywhere.
fn smoothed_results_lie_beside_those_found(sequence: &Path, output: &Path) {
    let track = |more: &[&str]| {
        let mut command = program();
        command.arg("track").arg(sequence).arg("-o").arg(output).args(["--particles", "60", "--iterations", "6"]);
        // Forwards alone: a second pass leaves little but the person's own motion to smooth.
        command.args(["--passes", "forward", "--overlay-every", "0", "--force"]).args(more).output().unwrap()
    };
    let plain = track(&[]);
    assert!(plain.status.success(), "{}", stderr(&plain));
    let found = std::fs::read(output.join("poses.csv")).unwrap();
    assert!(!output.join("smoothed").exists());
    let done = track(&["--smooth", "6"]);
    assert!(done.status.success(), "{}", stderr(&done));
    assert!(
        stderr(&done).contains("smoothed/ holds the results smoothed at 6 Hz (-3 dB after both passes)"),
        "{}",
        stderr(&done)
    );
    assert_eq!(std::fs::read(output.join("poses.csv")).unwrap(), found, "what was found stays");
    let read = |name: &str| std::fs::read_to_string(output.join(name)).unwrap();
    assert!(read("run.toml").contains("smooth = 6.0") && read("run.toml").contains(" --smooth 6"));
    assert!(read("smoothed/smoothing.toml").contains("cut_off = 6.0 # Hz"), "{}", read("smoothed/smoothing.toml"));
    assert!(read("report.html").contains("results smoothed at 6 Hz"));
    let cut_off = |name: &str| pantin::motion::read_points(&output.join(name)).unwrap().smoothed;
    assert_eq!([cut_off("markers.c3d"), cut_off("smoothed/markers.c3d")], [None, Some(6.0)]);
    // The steps from step to step tremble less.
    let body = pantin::body::Body::load(&sequence.join("body.toml")).unwrap();
    let trembling = |name: &str| {
        let poses = pantin::body::PoseTable::read(&output.join(name), &body).unwrap().poses;
        let bend = |at: usize, dof: usize| (poses[at - 1][dof] - 2.0 * poses[at][dof] + poses[at + 1][dof]).abs();
        (1..poses.len() - 1).flat_map(|at| (3..6).map(move |dof| (at, dof))).map(|(at, dof)| bend(at, dof)).sum::<f64>()
    };
    let (rough, smooth) = (trembling("poses.csv"), trembling("smoothed/poses.csv"));
    assert!(smooth > 0.0 && smooth < 0.8 * rough, "{smooth} of {rough}");
    for name in ["joints.csv", "joints.trc", "markers.c3d", "motion.bvh", "motion.mot"] {
        assert!(output.join("smoothed").join(name).is_file(), "{name}");
    }
    for (more, expected) in [
        (&["--smooth", "6", "--frames", "0..9"][..], "--smooth takes 10 frames or more, and 9 are to be tracked"),
        (&["--smooth", "40"], "the cut-off is 40 Hz"),
        (&["--smooth", "6", "--realtime"], "leave out --smooth"),
    ] {
        let refused = track(more);
        assert!(refused.status.code() == Some(1) && stderr(&refused).contains(expected), "{}", stderr(&refused));
    }
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
