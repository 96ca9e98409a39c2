//! Live sources: streams that ffmpeg opens, by way of files it reads at their rate and of named pipes.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};

use super::{journalled, track};
use crate::support::{has_ffmpeg, refused, sequence, stderr, succeeded};

/// Lays the walk out as one lossless video a camera, with a plate: what a live source needs.
pub(crate) fn as_videos(folder: &Path) {
    for name in ["body.toml", "cameras.toml", "start.csv"] {
        fs::copy(sequence().join(name), folder.join(name)).unwrap();
    }
    let mut text =
        "name = \"walk\"\nfps = 25.0\ncameras = \"cameras.toml\"\nbody = \"body.toml\"\nstart = \"start.csv\"\n"
            .to_string();
    for camera in 0..4 {
        let picture = sequence().join(format!("frames/cam{camera}_%04d.png"));
        let status = Command::new("ffmpeg")
            .args(["-v", "error", "-nostdin", "-y", "-framerate", "25", "-i", picture.to_str().unwrap()])
            .args(["-c:v", "ffv1", "-pix_fmt", "bgr0"])
            .arg(folder.join(format!("cam{camera}.mkv")))
            .status()
            .unwrap();
        assert!(status.success());
        let first = image::open(sequence().join(format!("frames/cam{camera}_0000.png"))).unwrap().to_rgb8();
        let plate = image::RgbImage::from_pixel(first.width(), first.height(), *first.get_pixel(0, 0));
        plate.save(folder.join(format!("plate{camera}.png"))).unwrap();
        text += &format!(
            "[[view]]\ncamera = \"cam{camera}\"\nsource = \"cam{camera}.mkv\"\nbackground = \"plate{camera}.png\"\n"
        );
    }
    fs::write(folder.join("sequence.toml"), text).unwrap();
}

const FEW: [&str; 9] =
    ["--realtime", "--backend", "cpu", "--particles", "60", "--iterations", "5", "--stall-timeout", "20"];

/// The manifest with every source live; `change` says what becomes of a camera's lines.
fn live(folder: &Path, change: impl Fn(usize, String) -> String) {
    let text = fs::read_to_string(folder.join("sequence.toml")).unwrap();
    let mut parts = text.split("[[view]]\n");
    let head = parts.next().unwrap().to_string();
    let views = parts.enumerate().map(|(camera, view)| {
        let input = "input = [\"-re\", \"-stream_loop\", \"24\"]\n";
        format!("[[view]]\n{}", change(camera, format!("{view}{input}")))
    });
    fs::write(folder.join("live.toml"), head + &views.collect::<String>()).unwrap();
}

#[test]
fn live_views_are_tracked_until_they_end() {
    if !has_ffmpeg("live_views_are_tracked_until_they_end") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    as_videos(folder.path());
    live(folder.path(), |_, view| view);
    let (manifest, output) = (folder.path().join("live.toml"), folder.path().join("track"));
    refused(&track(&manifest, &output, &[]), &["live.toml", "is live, which only `track --realtime` reads"]);
    let done = track(&manifest, &output, &FEW);
    succeeded(&done);
    assert!(stderr(&done).contains("ended after"), "{}", stderr(&done));
    let account: serde_json::Value = serde_json::from_slice(&fs::read(output.join("realtime.json")).unwrap()).unwrap();
    let poses = account["poses"].as_u64().unwrap();
    assert!(poses >= 3 && poses as usize == journalled(&output), "{account}");
    assert!(account["ended"].as_str().unwrap().contains("ended after"), "{account}");
    assert!(output.join("joints.trc").exists() && output.join("timeline.svg").exists());
}

#[test]
fn what_goes_wrong_with_a_live_view_is_named() {
    if !has_ffmpeg("what_goes_wrong_with_a_live_view_is_named") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    as_videos(folder.path());
    fs::write(folder.path().join("garbage"), [7; 20_000]).unwrap();
    let failed = |name: &str, view: &str, parts: &[&str]| {
        live(folder.path(), |camera, old| {
            if camera == 2 { format!("camera = \"cam2\"\nbackground = \"plate2.png\"\n{view}\n") } else { old }
        });
        let output = folder.path().join(name);
        refused(&track(&folder.path().join("live.toml"), &output, &FEW), parts);
    };
    failed(
        "garbage_out",
        "source = \"garbage\"\ninput = [\"-f\", \"h264\"]",
        &["camera \"cam2\"", "delivered no picture: ffmpeg says"],
    );
    failed(
        "none",
        "source = \"/dev/no-such-camera\"",
        &["camera \"cam2\"", "/dev/no-such-camera", "delivered no picture"],
    );
    failed(
        "size",
        "source = \"testsrc2=size=64x48\"\ninput = [\"-re\", \"-f\", \"lavfi\"]",
        &["camera \"cam2\"", "delivers pictures of 64x48 pixels", "expected 160x120"],
    );
    failed("options", "source = \"x\"\ninput = [\"-i\", \"y\"]", &["source of camera \"cam2\"", "`input` has \"-i\""]);
}

/// Lays the walk out with its second view from a named pipe, whose path this is; the others play `loops` times more.
#[cfg(unix)]
fn piped(folder: &Path, loops: usize) -> PathBuf {
    as_videos(folder);
    let pipe = folder.join("pipe");
    assert!(Command::new("mkfifo").arg(&pipe).status().unwrap().success());
    live(folder, |camera, view| {
        if camera == 1 {
            "camera = \"cam1\"\nbackground = \"plate1.png\"\nsource = \"pipe\"\ninput = [\"-f\", \"nut\"]\n".to_string()
        } else {
            view.replace("\"24\"", &format!("\"{loops}\""))
        }
    });
    pipe
}

#[cfg(unix)]
fn shell(script: &str) -> Child {
    Command::new("sh").args(["-c", script]).stdin(Stdio::null()).spawn().unwrap()
}

/// Writes six seconds of pictures into the pipe, and then nothing while it holds it open.
#[cfg(unix)]
fn stopping_writer(folder: &Path, pipe: &Path) -> Child {
    shell(&format!(
        "exec 3>'{}'; ffmpeg -v error -nostdin -re -stream_loop 24 -i '{}' -c:v rawvideo -f nut -flush_packets 1 pipe:1 >&3; exec sleep 60",
        pipe.display(),
        folder.join("cam1.mkv").display()
    ))
}

/// A camera that falls silent in the middle: the others go on without it, and where that was is told.
#[cfg(unix)]
#[test]
fn a_view_that_falls_silent_is_left_out_and_named() {
    if !has_ffmpeg("a_view_that_falls_silent_is_left_out_and_named") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let pipe = piped(folder.path(), 49);
    let mut writer = stopping_writer(folder.path(), &pipe);
    let output = folder.path().join("track");
    let done = track(&folder.path().join("live.toml"), &output, &FEW);
    writer.kill().unwrap();
    writer.wait().unwrap();
    succeeded(&done);
    let said = stderr(&done);
    for part in ["delivers nothing; frames from", "camera \"cam1\" delivered nothing in frames", "ended after"] {
        assert!(said.contains(part), "no {part:?} in {said}");
    }
    let mut rows = csv::Reader::from_path(output.join("confidence.csv")).unwrap();
    let column = rows.headers().unwrap().iter().position(|name| name == "cam1.f1").unwrap();
    let seen: Vec<bool> = rows.records().map(|row| !row.unwrap()[column].is_empty()).collect();
    let (with, without) = (seen.iter().filter(|seen| **seen).count(), seen.iter().filter(|seen| !**seen).count());
    assert!(with >= 3 && without >= 3 && seen.is_sorted_by(|a, b| a >= b), "{seen:?}");
}

/// Of two views one stops in the middle: the frames before are kept, the view is named.
#[cfg(unix)]
#[test]
fn a_pipe_that_stalls_is_named_and_the_poses_stay() {
    if !has_ffmpeg("a_pipe_that_stalls_is_named_and_the_poses_stay") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let pipe = piped(folder.path(), 400);
    let manifest = folder.path().join("live.toml");
    let text = fs::read_to_string(&manifest).unwrap();
    let two: Vec<&str> = text.split("[[view]]").take(3).collect();
    fs::write(&manifest, two.join("[[view]]")).unwrap();
    let mut writer = stopping_writer(folder.path(), &pipe);
    let output = folder.path().join("track");
    let stalled = track(
        &manifest,
        &output,
        &["--realtime", "--backend", "cpu", "--particles", "60", "--iterations", "5", "--stall-timeout", "5"],
    );
    writer.kill().unwrap();
    writer.wait().unwrap();
    refused(&stalled, &["camera \"cam1\" stalled", "--stall-timeout", "poses before it are in"]);
    assert!(journalled(&output) > 0 && output.join("joints.trc").exists());
}

/// One view that never delivers and another that ends: no set of pictures came, so there is no track and no success.
#[cfg(unix)]
#[test]
fn where_no_set_comes_it_is_said() {
    if !has_ffmpeg("where_no_set_comes_it_is_said") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let pipe = piped(folder.path(), 4);
    let mut silent = shell(&format!("exec 3>'{}'; exec sleep 60", pipe.display()));
    let failed = track(&folder.path().join("live.toml"), &folder.path().join("track"), &FEW);
    silent.kill().unwrap();
    silent.wait().unwrap();
    refused(&failed, &["no pose was made: ", "ended after"]);
}
