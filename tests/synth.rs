//! `pantin synth` from the outside.

#![allow(clippy::unwrap_used, reason = "a helper of tests may unwrap as they do")]

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

fn synth(arguments: &[&str], folder: &Path) -> Output {
    Command::new(env!("CARGO_BIN_EXE_pantin")).arg("synth").args(arguments).arg("-o").arg(folder).output().unwrap()
}

fn message(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

#[test]
fn a_preset_is_made_once_and_goes_on_when_asked() {
    let temporary = tempfile::tempdir().unwrap();
    let folder = temporary.path().join("walk");
    let arguments = ["--preset", "demo", "--frames", "2"];
    let done = synth(&arguments, &folder);
    assert!(done.status.success(), "{}", message(&done));
    assert!(String::from_utf8_lossy(&done.stdout).contains("made 2 frames in 4 views"));
    let picture = folder.join("frames/cam3_0001.png");
    let bytes = fs::read(&picture).unwrap();

    let refused = synth(&arguments, &folder);
    assert_eq!(refused.status.code(), Some(1));
    assert!(message(&refused).contains("--force"), "{}", message(&refused));
    fs::remove_file(&picture).unwrap();
    fs::remove_file(folder.join("sequence.toml")).unwrap();
    let resumed = synth(&[&arguments[..], &["--resume"]].concat(), &folder);
    assert!(resumed.status.success(), "{}", message(&resumed));
    assert_eq!(fs::read(&picture).unwrap(), bytes);
    let other = synth(&["--preset", "demo", "--frames", "3", "--resume"], &folder);
    assert!(message(&other).contains("other settings"), "{}", message(&other));

    // The record of the settings makes the same again.
    let again = temporary.path().join("again");
    let record = folder.join("scene.toml");
    let made = synth(&[record.to_str().unwrap()], &again);
    assert!(made.status.success(), "{}", message(&made));
    assert_eq!(fs::read(again.join("frames/cam3_0001.png")).unwrap(), bytes);
}

#[test]
fn bad_scenes_are_one_sentence_before_anything_is_written() {
    let temporary = tempfile::tempdir().unwrap();
    let folder = temporary.path().join("out");
    let scene = temporary.path().join("scene.toml");
    let bvh = temporary.path().join("stick.bvh");
    fs::write(
        &bvh,
        "HIERARCHY\nROOT stick { OFFSET 0 0 0 CHANNELS 1 Xposition }\nMOTION\nFrames: 1\nFrame Time: 0.1\n0\n",
    )
    .unwrap();
    for (text, expected) in [
        ("frmaes = 3", "nearest known key is `frames`"),
        ("frames = \"three\"", "line 1"),
        ("[[actor]]\nmotion = { gait = \"fly\" }", "gait is `fly`"),
        ("[[actor]]\nmotion = { gait = \"run\", file = \"x.bvh\" }", "both `gait` and `file`"),
        ("[[actor]]\nmotion = { file = \"nowhere.bvh\" }", "cannot read"),
        ("[[actor]]\nmotion = { file = \"walk.amc\" }", "expected an .asf file"),
        ("[[actor]]\nmotion = { file = \"scene.toml\" }", "ends in `.toml`, expected .bvh, .amc"),
        ("frames = 1\n[[actor]]\nmotion = { file = \"stick.bvh\" }", "no joint that is known to be `pelvis`"),
        ("[[actor]]\nmesh = \"nobody.glb\"", "nobody.glb"),
        ("[[camera]]\nname = \"cam7\"", "`cam7`, expected one of cam1"),
        ("[rig]\ncameras = \"none.toml\"", "none.toml"),
        ("frames = 900\n[[actor]]\nmotion = { gait = \"straight\" }", "in frame 0 he is at"),
        ("[[actor]]\n[actor.clothes]\nshirt = { material = \"silk\" }", "unknown material silk"),
        ("[room]\nfloor = { }", "neither a colour nor a material"),
    ] {
        fs::write(&scene, text).unwrap();
        let failed = synth(&[scene.to_str().unwrap()], &folder);
        let message = message(&failed);
        assert_eq!(failed.status.code(), Some(1), "{text}: {message}");
        assert!(message.contains(expected) && message.trim().lines().count() == 1, "{text}: {message}");
        assert!(!folder.exists(), "{text} wrote something");
    }
    let unknown = synth(&["--preset", "p3s"], &folder);
    assert!(message(&unknown).contains("the nearest known one is `p"), "{}", message(&unknown));
    assert_eq!(synth(&[], &folder).status.code(), Some(2), "neither a scene nor a preset");
}
