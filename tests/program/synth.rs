//! `pantin synth` from the outside.

use std::fs;
use std::path::Path;
use std::process::Output;

use super::support::{NO_DRIVER, program, stderr as message, stdout};

fn synth(arguments: &[&str], folder: &Path) -> Output {
    program().arg("synth").args(arguments).arg("-o").arg(folder).output().unwrap()
}

/// The same on a machine without a Vulkan driver.
fn synth_without_vulkan(arguments: &[&str], folder: &Path) -> Output {
    program().arg("synth").args(arguments).arg("-o").arg(folder).envs(NO_DRIVER).output().unwrap()
}

#[test]
fn a_preset_is_made_once_and_goes_on_when_asked() {
    let temporary = tempfile::tempdir().unwrap();
    let folder = temporary.path().join("walk");
    let arguments = ["--preset", "demo", "--frames", "2"];
    let done = synth(&arguments, &folder);
    assert!(done.status.success(), "{}", message(&done));
    assert!(stdout(&done).contains("made 2 frames in 4 views"));
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
fn a_device_draws_nearly_the_same_pictures_and_the_same_truth() {
    let temporary = tempfile::tempdir().unwrap();
    let arguments = |backend: &'static str| ["--preset", "two_straight", "--frames", "2", "--backend", backend];
    let [here, there] = ["cpu", "device"].map(|backend| temporary.path().join(backend));
    assert!(synth(&arguments("cpu"), &here).status.success());
    let drawn = synth(&arguments("device"), &there);
    if !drawn.status.success() && std::env::var_os("PANTIN_NEEDS_VULKAN").is_none() {
        println!("SKIPPED a_device_draws_nearly_the_same_pictures_and_the_same_truth: {}", message(&drawn));
        return;
    }
    assert!(drawn.status.success(), "{}", message(&drawn));
    for name in ["truth.trc", "truth.c3d", "truth_poses.csv", "plates/cam2.png", "sequence.toml", "scene.toml"] {
        assert_eq!(fs::read(here.join(name)).unwrap(), fs::read(there.join(name)).unwrap(), "{name}");
    }
    for camera in 1..=4 {
        let read =
            |folder: &Path| image::open(folder.join(format!("frames/cam{camera}_0001.png"))).unwrap().into_rgb8();
        let (a, b) = (read(&here), read(&there));
        let off = |(a, b): (&image::Rgb<u8>, &image::Rgb<u8>)| (0..3).any(|c| a.0[c].abs_diff(b.0[c]) > 2);
        let differing = a.pixels().zip(b.pixels()).filter(|pair| off(*pair)).count();
        assert!(differing * 1000 <= a.len() / 3, "{differing} pixels of camera {camera} differ");
    }
    // What a device cannot draw is said before anything is written.
    let scene = temporary.path().join("grass.toml");
    fs::write(&scene, "frames = 1\n[[actor]]\n[actor.clothes]\nshirt = { material = \"grass\" }\n").unwrap();
    let folder = temporary.path().join("grass");
    let failed = synth(&[scene.to_str().unwrap(), "--backend", "device"], &folder);
    assert!(message(&failed).contains("actor 1: shirt: its material is drawn on the processor alone"));
    assert!(failed.status.code() == Some(1) && !folder.exists());
}

#[test]
fn without_vulkan_the_processor_draws_and_says_so() {
    let temporary = tempfile::tempdir().unwrap();
    let folder = temporary.path().join("auto");
    let made = synth_without_vulkan(&["--preset", "p1s", "--frames", "1", "--backend", "auto"], &folder);
    assert!(made.status.success(), "{}", message(&made));
    assert!(
        message(&made).starts_with("on the processor: ") && message(&made).contains("Vulkan"),
        "{}",
        message(&made)
    );
    let failed = synth_without_vulkan(&["--preset", "p1s", "--backend", "device", "--force"], &folder);
    assert_eq!(failed.status.code(), Some(1));
    let message = message(&failed);
    assert!(
        message.starts_with("pantin: ") && message.contains("Vulkan") && message.trim().lines().count() == 1,
        "{message}"
    );
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
        (
            "[[actor]]\nmotion = { gait = \"fly\" }",
            "unknown gait `fly`, the nearest is `run` (known: circle, straight, diagonal, run, jump, stand, t-pose)",
        ),
        ("[[actor]]\nmotion = { gait = \"run\", file = \"x.bvh\" }", "both `gait` and `file`"),
        ("[[actor]]\nmotion = { file = \"nowhere.bvh\" }", "cannot read"),
        ("[[actor]]\nmotion = { file = \"walk.amc\" }", "expected an .asf file"),
        (
            "[[actor]]\nmotion = { file = \"scene.toml\" }",
            "unknown motion format `toml`, the nearest is `amc` (known: bvh, amc, txt, json)",
        ),
        ("frames = 1\n[[actor]]\nmotion = { file = \"stick.bvh\" }", "no joint that is known to be `pelvis`"),
        ("[[actor]]\nmesh = \"nobody.glb\"", "nobody.glb"),
        ("[[actor]]\n[[camera]]\nname = \"cam7\"", "`cam7`, expected one of cam1"),
        ("[[actor]]\n[rig]\ncameras = \"none.toml\"", "none.toml"),
        ("frames = 900\n[[actor]]\nmotion = { gait = \"straight\" }", "in frame 0 he is at"),
        (
            "[[actor]]\n[actor.clothes]\nshirt = { material = \"silk\" }",
            "unknown material `silk`, the nearest is `brick`",
        ),
        ("[[actor]]\n[room]\nfloor = { }", "scene.toml: [room] floor: it names neither a colour nor a material"),
        ("frames = 3", "scene.toml: there is no [[actor]], expected one to track"),
        ("[[actor]]\n[features]\nblobz = 1", "unknown key `blobz`"),
    ] {
        fs::write(&scene, text).unwrap();
        let failed = synth(&[scene.to_str().unwrap()], &folder);
        let message = message(&failed);
        assert_eq!(failed.status.code(), Some(1), "{text}: {message}");
        assert!(message.contains(expected) && message.trim().lines().count() == 1, "{text}: {message}");
        assert!(!folder.exists(), "{text} wrote something");
    }
    let unused = synth(&["--preset", "demo", "--people", "nowhere"], &folder);
    assert!(message(&unused).contains("--people means nothing without --lottery"), "{}", message(&unused));
    let unknown = synth(&["--preset", "p3s"], &folder);
    assert!(
        message(&unknown)
            .contains("unknown scene `p3s`, the nearest is `p1s` (known: demo, leewalk, p1s, p2s, p1d, p2d, two_straight, two_diagonal)"),
        "{}",
        message(&unknown)
    );
    assert_eq!(synth(&[], &folder).status.code(), Some(2), "neither a scene nor a preset");
}

#[test]
fn a_lottery_is_a_folder_that_can_be_tracked() {
    let temporary = tempfile::tempdir().unwrap();
    let first = temporary.path().join("first");
    let made = synth(&["--lottery", "5", "--frames", "2"], &first);
    assert!(made.status.success(), "{}", message(&made));
    assert!(stdout(&made).contains("measured: body off by"), "{}", stdout(&made));
    for name in
        ["true_body.toml", "true_start.csv", "truth.trc", "masks/cam2_0001.png", "plates/cam4.png", "t_pose/start.csv"]
    {
        assert!(first.join(name).is_file(), "{name}");
    }
    // What a user has is measured, not known, and each manifest opens.
    let read = |name: &str| fs::read_to_string(first.join(name)).unwrap();
    assert!(read("body.toml") != read("true_body.toml") && read("start.csv") != read("true_start.csv"));
    for (manifest, has_masks) in
        [("sequence.toml", false), ("exact.toml", true), ("true_sequence.toml", false), ("t_pose/sequence.toml", false)]
    {
        let sequence = pantin::sequence::Sequence::open(&first.join(manifest)).unwrap();
        assert_eq!(sequence.views.iter().all(|view| view.mask.is_some()), has_masks, "{manifest}");
        assert!(sequence.views.iter().all(|view| view.background.is_some()) && sequence.truth.is_some(), "{manifest}");
    }
    // The record makes the same pictures as any scene does. (That a seed draws one record is a test of the lottery's own.)
    let again = temporary.path().join("again");
    let scene = first.join("scene.toml");
    assert!(synth(&[scene.to_str().unwrap()], &again).status.success());
    let pictures = |folder: &Path| {
        let mut files: Vec<_> =
            fs::read_dir(folder.join("frames")).unwrap().map(|entry| entry.unwrap().path()).collect();
        files.sort();
        files.iter().map(|file| fs::read(file).unwrap()).collect::<Vec<_>>()
    };
    assert_eq!(pictures(&again), pictures(&first));
}

#[test]
fn a_lottery_says_what_it_cannot_read() {
    let temporary = tempfile::tempdir().unwrap();
    let folder = temporary.path().join("out");
    let empty = temporary.path().join("empty");
    fs::create_dir(&empty).unwrap();
    let torn = temporary.path().join("torn");
    fs::create_dir(&torn).unwrap();
    fs::write(torn.join("walk.bvh"), "HIERARCHY\n").unwrap();
    for (option, path, expected) in [
        ("--motions", "/nonexistent", "cannot read the motions of /nonexistent"),
        ("--people", "/nonexistent", "cannot read the people of /nonexistent"),
        ("--motions", empty.to_str().unwrap(), "holds no motion"),
        ("--people", empty.to_str().unwrap(), "holds no person"),
        ("--motions", torn.to_str().unwrap(), "walk.bvh"),
    ] {
        let failed = synth(&["--lottery", "1", option, path], &folder);
        let message = message(&failed);
        assert_eq!(failed.status.code(), Some(1), "{message}");
        assert!(message.contains(expected) && message.trim().lines().count() == 1, "{message}");
        assert!(!folder.exists(), "{option} {path} wrote something");
    }
    for wrong in [&["--motions", "x"][..], &["--lottery", "1", "--preset", "demo"], &["--lottery", "1", "--seed", "2"]]
    {
        assert_eq!(synth(wrong, &folder).status.code(), Some(2), "{wrong:?}");
    }
}
