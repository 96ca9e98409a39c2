//! Videos that are damaged or hold something else: cut short, no frame, sound alone, pictures whose size changes, another size or rate.

use std::fs;
use std::path::Path;
use std::process::Command;

use super::case::{Case, Spoilt};
use super::ground::Ground;
use crate::support::has_ffmpeg;

/// Cuts of each file.
const CUTS: usize = 8;

pub(super) fn cases(ground: &Ground) -> Vec<Case> {
    if !has_ffmpeg("hostile videos") {
        return Vec::new();
    }
    let mut videos = vec![
        ("a text", b"This is no video.\n".repeat(40)),
        ("a header alone", b"\0\0\0\x20ftypisom\0\0\x02\0isomiso2avc1mp41".to_vec()),
    ];
    videos.extend(made());
    let whole = ground.bytes("film/videos/cam1.mp4");
    for cut in 1..CUTS {
        videos.push(("cut short", whole[..whole.len() * cut / CUTS].to_vec()));
        let mut torn = whole.clone();
        let middle = whole.len() * cut / CUTS;
        torn[middle..(middle + 400).min(whole.len())].fill(0xa5);
        videos.push(("torn", torn));
    }
    let mut cases = Vec::new();
    for sound in Ground::commands_on_videos() {
        let file =
            if sound.arguments.contains(&"session") { "session/videos/cam1.mp4" } else { "film/videos/cam1.mp4" };
        for (what, bytes) in &videos {
            cases.push(Case::of_file("video", what, &sound, file, Spoilt::Holds(bytes.clone())));
        }
    }
    cases
}

/// What ffmpeg makes of drawn pictures, those of it that this ffmpeg can make.
fn made() -> Vec<(&'static str, Vec<u8>)> {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let picture = |size: &str| format!("-f lavfi -i testsrc=size={size}:rate=25:duration=0.48");
    let plain = picture("64x48");
    let commands = [
        ("sound alone", "-f lavfi -i sine=duration=1 -c:a aac".to_string(), "mp4"),
        ("no frames", format!("{plain} -frames:v 0 -c:v mpeg4"), "mp4"),
        ("one frame", format!("{plain} -frames:v 1 -c:v mpeg4"), "mp4"),
        ("another size", format!("{} -c:v mpeg4", picture("96x64")), "mp4"),
        ("lying", format!("{} -c:v mpeg4", picture("48x64")), "mp4"),
        ("another rate", format!("{plain} -r 7 -c:v mpeg4"), "mp4"),
        ("another length", "-f lavfi -i testsrc=size=64x48:rate=25:duration=2 -c:v mpeg4".to_string(), "mp4"),
        ("frames dropped", format!("{plain} -vf select=not(between(n\\,3\\,7)) -vsync vfr -c:v mpeg4"), "mp4"),
        ("a moving picture", plain.clone(), "gif"),
        ("a stream", format!("{plain} -c:v mpeg2video"), "ts"),
        ("a small stream", format!("{} -c:v mpeg2video", picture("32x32")), "ts"),
    ];
    let mut made = Vec::new();
    for (what, arguments, ending) in commands {
        let file = at(&format!("v.{ending}"));
        if ffmpeg(&arguments, &file) {
            made.push((what, fs::read(&file).unwrap()));
        }
    }
    let stream = |wanted: &str| made.iter().find(|(what, _)| *what == wanted).map(|(_, bytes)| bytes.clone());
    if let (Some(large), Some(small)) = (stream("a stream"), stream("a small stream")) {
        made.push(("pictures whose size changes", [large, small].concat()));
    }
    made
}

fn ffmpeg(arguments: &str, file: &Path) -> bool {
    let mut command = Command::new("ffmpeg");
    command.args(["-v", "error", "-y"]).args(arguments.split(' ')).arg(file);
    command.output().is_ok_and(|output| output.status.success()) && file.is_file()
}
