//! Runs without a clock that are interrupted: nothing tracked so far is lost, and gone on with they end with the same bytes.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::Stdio;
use std::time::Duration;

use super::{command, journalled, track};
use crate::support::{TRACK_FILES, has_ffmpeg, refused, sequence, stderr, succeeded};
use crate::walk;

/// Slow enough that a kill meets it at work.
const SLOW: [&str; 8] = ["--particles", "150", "--iterations", "12", "--overlay-every", "3", "--backend", "cpu"];

fn results(folder: &Path) -> BTreeMap<&'static str, Vec<u8>> {
    TRACK_FILES.into_iter().map(|name| (name, fs::read(folder.join(name)).unwrap())).collect()
}

/// Kills a run at `kills` moments, drawn by a small generator from all of its time, going on with it each time; returns
/// how many kills met it at work.
fn killed(kills: u32, seed: u64) -> u32 {
    let folder = tempfile::tempdir().unwrap();
    let whole = folder.path().join("whole");
    let begin = std::time::Instant::now();
    succeeded(&track(sequence(), &whole, &SLOW));
    let time = begin.elapsed();
    let expected = results(&whole);
    let (mut state, mut at_work) = (seed, 0);
    let mut output = folder.path().join("0");
    let mut begins_anew = true;
    for kill in 0..kills {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let moment = time.mul_f64((state >> 40) as f64 / (1_u64 << 24) as f64);
        // Killed before it had begun, there is no run to go on with.
        let resume = if output.join("run.toml").exists() { "--resume" } else { "--force" };
        let mut child = command(sequence(), &output, &SLOW).arg(resume).stderr(Stdio::null()).spawn().unwrap();
        let before = if begins_anew { 0 } else { journalled(&output) };
        std::thread::sleep(moment);
        let finished = child.try_wait().unwrap();
        child.kill().unwrap();
        child.wait().unwrap();
        at_work += u32::from(finished.is_none());
        begins_anew = false;
        assert!(journalled(&output) >= before, "kill {kill} lost a frame");
        if let Some(status) = finished {
            assert!(status.success());
            assert!(results(&output) == expected, "kill {kill}");
            output = folder.path().join((kill + 1).to_string());
            begins_anew = true;
        }
    }
    let resume = if output.join("run.toml").exists() { "--resume" } else { "--force" };
    let done = command(sequence(), &output, &SLOW).arg(resume).output().unwrap();
    succeeded(&done);
    for (name, bytes) in results(&output) {
        assert!(expected[name] == bytes, "{name} differs");
    }
    at_work
}

#[test]
fn killed_at_random_moments_it_ends_with_the_same_bytes() {
    assert!(killed(5, 1) > 0, "no kill met a run at work");
}

#[test]
#[ignore = "a minute"]
fn killed_fifty_times_it_ends_with_the_same_bytes() {
    let at_work = killed(50, 2);
    assert!(at_work >= 25, "only {at_work} kills met a run at work");
}

/// A limit on the size of files stands for a full disk: writes past it fail.
#[cfg(unix)]
#[test]
fn no_room_is_one_sentence_and_loses_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let few = ["--particles", "20", "--iterations", "3", "--overlay-every", "0", "--backend", "cpu"];
    let whole = folder.path().join("whole");
    succeeded(&track(sequence(), &whole, &few));
    let line = fs::read(whole.join("journal.txt")).unwrap().len() / walk::FRAMES;
    for more in [&[][..], &["--realtime"]] {
        let output = folder.path().join(format!("full{}", more.len()));
        // Room for run.toml, and for some frames of the journal, not all: a block is 512 or 1024 bytes.
        let limited = |blocks: usize| {
            let program = format!("trap '' XFSZ; ulimit -f {blocks}; exec \"$0\" \"$@\"");
            let mut shell = std::process::Command::new("sh");
            shell.args(["-c", &program, env!("CARGO_BIN_EXE_pantin"), "track", sequence().to_str().unwrap(), "-o"]);
            shell.arg(&output).args(few).args(more).arg("--force").output().unwrap()
        };
        let record = fs::read(whole.join("run.toml")).unwrap().len() + 300;
        let full = limited((3 * line + line / 2).max(record).div_ceil(512));
        refused(&full, &["cannot write"]);
        let kept = journalled(&output);
        assert!(kept < walk::FRAMES, "{kept} frames were kept: {}", stderr(&full));
        let mut arguments = few.to_vec();
        arguments.extend(more);
        arguments.push("--resume");
        if kept > 0 {
            let done = track(sequence(), &output, &arguments);
            succeeded(&done);
            assert!(stderr(&done).contains("going on from frame"), "{}", stderr(&done));
        }
        if more.is_empty() {
            assert!(kept > 0);
            assert!(results(&output) == results(&whole), "the bytes differ");
        }
    }
}

/// A decoder that stands still: a script in ffmpeg's place.
#[cfg(unix)]
#[test]
fn a_source_that_stalls_is_named() {
    use std::os::unix::fs::PermissionsExt;
    if !has_ffmpeg("a_source_that_stalls_is_named") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    super::live::as_videos(folder.path());
    let programs = folder.path().join("bin");
    fs::create_dir(&programs).unwrap();
    let script = programs.join("ffmpeg");
    // Two pictures of the second camera, and no more; the others are decoded.
    let path = std::env::var("PATH").unwrap();
    let text = format!(
        "#!/bin/sh\nPATH='{path}'\ncase \"$*\" in *cam1.mkv*) head -c 115200 /dev/zero; exec sleep 600;; esac\nexec ffmpeg \"$@\"\n"
    );
    fs::write(&script, text).unwrap();
    fs::set_permissions(&script, fs::Permissions::from_mode(0o755)).unwrap();
    for more in [&[][..], &["--realtime"]] {
        let output = folder.path().join(format!("out{}", more.len()));
        let begin = std::time::Instant::now();
        let stalled =
            command(&folder.path().join("sequence.toml"), &output, &["--particles", "20", "--iterations", "3"])
                .args(["--stall-timeout", "2", "--backend", "cpu", "--overlay-every", "0"])
                .args(more)
                .env("PATH", format!("{}:{path}", programs.display()))
                .output()
                .unwrap();
        refused(&stalled, &["camera \"cam1\" stalled", "--stall-timeout"]);
        assert!(begin.elapsed() < Duration::from_secs(60));
        assert!(journalled(&output) >= 1, "what came before is kept");
    }
}
