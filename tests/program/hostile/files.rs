//! Something else where a file should be: nothing, a folder, a device that never ends, a pipe that nobody writes into, links in a circle, a
//! file of another kind, more than any file of its kind holds.

use super::case::{Case, Spoilt};
use super::ground::Ground;

pub(super) fn cases(ground: &Ground) -> Vec<Case> {
    let png = ground.bytes("made/plates/cam1.png");
    let mut others = vec![
        ("nothing", Spoilt::Absent),
        ("a folder", Spoilt::Folder),
        ("an empty file", Spoilt::Holds(Vec::new())),
        ("a file of zeros", Spoilt::Holds(vec![0; 5000])),
        ("a picture", Spoilt::Holds(png)),
        ("a table", Spoilt::Holds(b"a,b\n1,2\n".to_vec())),
        ("more than it may hold", Spoilt::Long(3 << 30)),
        ("a playlist", Spoilt::Holds(b"#EXTM3U\n#EXTINF:1,\nwalk.ts\n".to_vec())),
    ];
    if cfg!(unix) {
        others.extend([
            ("an endless device", Spoilt::Link("/dev/zero")),
            ("a pipe", Spoilt::Pipe),
            ("a link to nothing", Spoilt::Link("nowhere")),
        ]);
    }
    let mut cases = Vec::new();
    for sound in Ground::commands() {
        for file in files_of(sound.arguments) {
            for (what, spoilt) in &others {
                cases.push(Case::of_file("another kind of file", what, &sound, file, spoilt.clone()));
            }
            if cfg!(unix) {
                // By its own name.
                let target = file.rsplit('/').next().unwrap_or(file);
                let link = Spoilt::Link(target.to_string().leak());
                cases.push(Case::of_file("another kind of file", "a link to itself", &sound, file, link));
            }
        }
    }
    cases
}

/// The files that a command is told, and those that these name.
fn files_of(arguments: &[&'static str]) -> Vec<&'static str> {
    let mut files: Vec<&str> = arguments[1..]
        .iter()
        .copied()
        .filter(|argument| argument.contains('.') && !argument.starts_with("out") && !argument.contains(".."))
        .collect();
    if arguments.contains(&"made") {
        files.extend(["made/sequence.toml", "made/cameras.toml", "made/plates/cam1.png", "made/frames/cam2_0001.png"]);
        files.extend(["made/masks/cam3_0000.png"]);
    }
    if arguments.contains(&"recorded.toml") {
        files.extend(["walk.bvh", "made/cameras.toml"]);
    }
    if arguments[0] == "study" && !arguments.contains(&"--plan") {
        files.extend(["truth.trc", "made/sequence.toml", "made/start.csv"]);
    }
    if arguments.contains(&"film") {
        files.extend(["film/sequence.toml", "film/videos/cam1.mp4"]);
    }
    if arguments.contains(&"session") {
        files.extend(["session/Config.toml", "session/calibration/Calib.toml", "session/videos/cam1.mp4"]);
    }
    if arguments.contains(&"made/plates") {
        files.push("made/plates/cam1.png");
    }
    if arguments[0] == "batch" {
        files.extend(["made/body.toml", "made/start.csv"]);
    }
    if arguments[0] == "track" {
        files.extend(["made/body.toml", "made/start.csv", "made/truth.trc"]);
    }
    files
}
