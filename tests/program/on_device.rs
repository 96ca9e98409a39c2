//! Features that the searching device makes and holds: the same files as with the processor's, made while the frame before is searched.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::OnceLock;

use image::{GrayImage, Luma, Rgb, RgbImage};
use serde_json::Value;
use tempfile::TempDir;

use super::support::{TRACK_FILES, has_vulkan, program, refused, stderr, succeeded};
use super::walk;

/// Frames of the empty scene before the walk.
const EMPTY: usize = 4;

/// The walk behind some frames of the empty scene. Of its four views the first has masks, the second a plate, and two learn.
fn sequence() -> &'static Path {
    static SEQUENCE: OnceLock<TempDir> = OnceLock::new();
    let views = ["", "background = \"plate.png\"", "", ""];
    SEQUENCE.get_or_init(|| written(views, "[features.mixture]\ncomponents = 3\n")).path()
}

/// The same with a plate where backgrounds are learnt, and pixels of the last view that do not count.
fn with_plates(features: &str) -> TempDir {
    let plate = "background = \"plate.png\"";
    let ignoring = "background = \"plate.png\"\nignore = \"ignored.png\"";
    let folder = written(["", plate, plate, ignoring], features);
    let ignored = GrayImage::from_fn(160, 120, |x, y| Luma([if (70..80).contains(&x) && y > 50 { 255 } else { 0 }]));
    ignored.save(folder.path().join("ignored.png")).unwrap();
    folder
}

/// What the manifest says of the views in the place of masks, but of the first one, and of features.
fn written(views: [&str; 4], features: &str) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    walk::write(folder.path());
    let frames = folder.path().join("frames");
    let empty = RgbImage::from_pixel(160, 120, Rgb([40, 60, 50]));
    empty.save(folder.path().join("plate.png")).unwrap();
    for view in 0..4 {
        let file = |kind: &str, frame: usize| frames.join(format!("cam{view}_{kind}{frame:04}.png"));
        for kind in ["", "mask_"] {
            (0..walk::FRAMES).rev().for_each(|at| fs::rename(file(kind, at), file(kind, at + EMPTY)).unwrap());
        }
        for frame in 0..EMPTY {
            empty.save(file("", frame)).unwrap();
            GrayImage::new(160, 120).save(file("mask_", frame)).unwrap();
        }
    }
    let manifest = folder.path().join("sequence.toml");
    let mut view = 0;
    let mut lines = Vec::new();
    for line in fs::read_to_string(&manifest).unwrap().lines() {
        if line.starts_with("mask") {
            lines.push(if view == 0 { line.to_string() } else { views[view].to_string() });
            view += 1;
        } else if !line.starts_with("truth") {
            lines.push(line.to_string());
        }
    }
    fs::write(&manifest, lines.join("\n") + "\n" + features).unwrap();
    folder
}

/// A run to be.
fn track(output: &Path, more: &[&str]) -> Command {
    track_of(sequence(), output, more)
}

fn track_of(sequence: &Path, output: &Path, more: &[&str]) -> Command {
    let frames = format!("{EMPTY}..{}", EMPTY + walk::FRAMES);
    let mut command = program();
    command.args(["track", sequence.to_str().unwrap(), "-o", output.to_str().unwrap(), "--frames", &frames]);
    command.args(["--particles", "24", "--iterations", "4", "--overlay-every", "3"]).args(more);
    if !more.contains(&"--objective") {
        command.args(["--objective", "sp"]);
    }
    command
}

fn tracked(output: &Path, more: &[&str]) -> Output {
    tracked_of(sequence(), output, more)
}

fn tracked_of(sequence: &Path, output: &Path, more: &[&str]) -> Output {
    // Any message of the validation layer ends the run.
    let done = track_of(sequence, output, more).env("PANTIN_VALIDATION", "sync").output().unwrap();
    succeeded(&done);
    done
}

#[track_caller]
fn same(found: &Path, expected: &Path) {
    for name in TRACK_FILES {
        assert!(fs::read(found.join(name)).unwrap() == fs::read(expected.join(name)).unwrap(), "{name} differs");
    }
}

fn machine(folder: &Path, key: &str) -> String {
    let record: toml::Table = fs::read_to_string(folder.join("run.toml")).unwrap().parse().unwrap();
    record["machine"][key].as_str().unwrap().to_string()
}

#[test]
fn what_a_device_makes_and_holds_gives_the_processor_s_files() {
    if !has_vulkan("what_a_device_makes_and_holds_gives_the_processor_s_files") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let run = |name: String, search: &str, more: &[&str]| -> (PathBuf, Output) {
        let output = folder.path().join(name);
        let done = tracked(&output, &[&["--search", search], more].concat());
        (output, done)
    };
    let mut before: Option<PathBuf> = None;
    for search in ["pso", "hpso", "pf", "apf", "maes", "cmaes"] {
        let (expected, _) = run(format!("{search}_cpu"), search, &["--backend", "cpu"]);
        assert_eq!(machine(&expected, "features_made_by"), "cpu");
        let backends: &[&str] = if ["pso", "pf"].contains(&search) { &["compute", "graphics"] } else { &["compute"] };
        for backend in backends {
            let (found, done) =
                run(format!("{search}_{backend}"), search, &["--backend", backend, "--features", "device"]);
            same(&found, &expected);
            assert_eq!(machine(&found, "features_made_by"), "device");
            let said = stderr(&done);
            assert!(said.contains("the device makes the features and holds them"), "{said}");
        }
        // A comparison that could not fail would be worth nothing.
        if let Some(before) = before.replace(expected.clone()) {
            let read = |folder: &Path| fs::read(folder.join("poses.csv")).unwrap();
            assert!(read(&before) != read(&expected), "{search} gives another search's poses");
        }
    }
    // A run that was stopped goes on, from backgrounds that have learnt from all frames before.
    let (whole, stopped) = (folder.path().join("pso_compute"), folder.path().join("stopped"));
    tracked(&stopped, &["--search", "pso", "--backend", "compute", "--features", "device"]);
    let journal = fs::read_to_string(stopped.join("journal.txt")).unwrap();
    let kept: Vec<&str> = journal.lines().take(3).collect();
    fs::write(stopped.join("journal.txt"), kept.join("\n") + "\n").unwrap();
    tracked(&stopped, &["--search", "pso", "--backend", "compute", "--features", "device", "--resume"]);
    same(&stopped, &whole);
}

#[test]
fn evidence_that_a_device_makes_gives_the_processor_s_files() {
    if !has_vulkan("evidence_that_a_device_makes_gives_the_processor_s_files") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let plated = [with_plates(""), with_plates("[features]\nforeground = \"likelihood\"\n")];
    let sequences = [plated[0].path(), plated[1].path(), sequence()];
    let mut before: Option<PathBuf> = None;
    // The default objective with its search, both passes and one, driven by the device and by the host; silhouettes of either kind, and
    // backgrounds that are learnt.
    for (name, sequence, more, backends) in [
        ("both", 0, &["--search", "maes", "--passes", "both"][..], &["compute", "graphics"][..]),
        ("forward", 1, &["--search", "maes", "--passes", "forward"], &["compute"]),
        ("host", 0, &["--search", "cmaes", "--passes", "forward"], &["graphics"]),
        ("learnt", 2, &["--search", "maes", "--passes", "forward"], &["compute"]),
        // A filter keeps what it has recorded, whatever classes are learnt.
        ("filter", 0, &["--search", "pf", "--passes", "forward"], &["compute", "graphics"]),
        ("refined", 0, &["--search", "pso", "--refine", "20", "--passes", "forward"], &["compute"]),
    ] {
        let sequence = sequences[sequence];
        let more = [more, &["--objective", "evidence"]].concat();
        let expected = folder.path().join(name);
        tracked_of(sequence, &expected, &[&more[..], &["--backend", "cpu"]].concat());
        for (backend, maker) in backends.iter().flat_map(|backend| [(backend, "cpu"), (backend, "device")]) {
            let found = folder.path().join(format!("{name}_{backend}_{maker}"));
            tracked_of(sequence, &found, &[&more[..], &["--backend", backend, "--features", maker]].concat());
            same(&found, &expected);
            assert_eq!(machine(&found, "features_made_by"), maker);
        }
        if let Some(before) = before.replace(expected.clone()) {
            let read = |folder: &Path| fs::read(folder.join("poses.csv")).unwrap();
            assert!(read(&before) != read(&expected), "{name} gives another run's poses");
        }
    }
    // A run that was stopped goes on with the colours that it had learnt.
    let stopped = folder.path().join("stopped");
    let options = ["--search", "maes", "--passes", "forward", "--objective", "evidence", "--backend", "compute"];
    let options = [&options[..], &["--features", "device"]].concat();
    tracked_of(sequences[1], &stopped, &options);
    let journal = fs::read_to_string(stopped.join("journal.txt")).unwrap();
    let kept: Vec<&str> = journal.lines().take(5).collect();
    fs::write(stopped.join("journal.txt"), kept.join("\n") + "\n").unwrap();
    tracked_of(sequences[1], &stopped, &[&options[..], &["--resume"]].concat());
    same(&stopped, &folder.path().join("forward"));
}

/// When an event begins and ends, microseconds, of every frame in order.
fn spans(events: &[Value], name: &str) -> Vec<[f64; 2]> {
    let of_name = events.iter().filter(|event| event["name"] == name && event["pid"] == 1);
    let number = |event: &Value, key: &str| event[key].as_f64().unwrap();
    let mut found: Vec<_> = of_name
        .map(|event| {
            let start = number(event, "ts");
            (event["args"]["frame"].as_u64().unwrap(), [start, start + number(event, "dur")])
        })
        .collect();
    found.sort_by_key(|(frame, _)| *frame);
    found.into_iter().map(|(_, span)| span).collect()
}

/// Whether each frame's features begin before the search of the frame before has ended.
fn overlaps(features: &[[f64; 2]], searches: &[[f64; 2]]) -> bool {
    features.len() == searches.len() && features[1..].iter().zip(searches).all(|(next, search)| next[0] < search[1])
}

#[test]
fn features_of_the_next_frame_begin_before_the_search_ends() {
    if !has_vulkan("features_of_the_next_frame_begin_before_the_search_ends") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let output = folder.path().join("track");
    tracked(&output, &["--search", "pso", "--backend", "compute", "--features", "device", "--trace"]);
    let trace: Value = serde_json::from_slice(&fs::read(output.join("trace.json")).unwrap()).unwrap();
    let events = trace["traceEvents"].as_array().unwrap();
    let (features, searches) = (spans(events, "features"), spans(events, "frame"));
    assert_eq!(searches.len(), walk::FRAMES);
    assert!(overlaps(&features, &searches), "{features:?} and {searches:?}");
    // One after the other would be found out.
    let mut late = features.clone();
    late[3][0] = searches[2][1] + 1.0;
    assert!(!overlaps(&late, &searches));
    // The device's passes have a row for each: once a frame, and once an iteration and more.
    let passes = |name: &str, row: u64| {
        events.iter().filter(|event| event["name"] == name && event["pid"] == 2 && event["tid"] == row).count()
    };
    assert_eq!((passes("pack", 2), passes("pack", 1)), (walk::FRAMES, 0));
    assert!(passes("raster", 1) + passes("raster_spans", 1) > walk::FRAMES && passes("raster", 2) == 0);
}

#[test]
fn a_device_that_is_lost_in_either_thread_leaves_a_run_to_go_on_with() {
    if !has_vulkan("a_device_that_is_lost_in_either_thread_leaves_a_run_to_go_on_with") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let options = ["--search", "pso", "--backend", "compute", "--features", "device"];
    let whole = folder.path().join("whole");
    tracked(&whole, &options);
    // What is left to run changes with the frame and with who is at work; all of it must end in the same sentence.
    for passes in ["170", "230", "290", "350"] {
        let output = folder.path().join(passes);
        let lost = track(&output, &options).env("PANTIN_LOSE_DEVICE_AFTER", passes).output().unwrap();
        refused(&lost, &["was lost", "frames before it are safe in", "--resume", "--backend cpu"]);
        tracked(&output, &[&options[..], &["--resume"]].concat());
        same(&output, &whole);
    }
}

#[test]
fn who_makes_the_features_is_chosen_and_said() {
    if !has_vulkan("who_makes_the_features_is_chosen_and_said") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let output = |name: &str| folder.path().join(name);
    let device = ["--search", "pso", "--features", "device"];
    for (more, why) in [
        (&["--backend", "cpu"][..], "the backend cpu is on none"),
        (&["--backend", "compute", "--devices", "0,0"], "several devices share the poses"),
        (&["--backend", "graphics", "--gather", "readback"], "poses are compared on the host"),
    ] {
        let done = track(&output("refused"), &[&device, more].concat()).output().unwrap();
        refused(&done, &["the features cannot be made on a device", why, "expected --features auto or cpu"]);
    }
    let shirt = "[[features.segment]]\nname = 'head'\nparts = ['head']\nweight = 1.0\ncue = 'skin'\n";
    let (parts, refused_to) = (with_plates(shirt), output("refused"));
    let more = [&device[..], &["--backend", "compute"]].concat();
    let done = track_of(parts.path(), &refused_to, &more).output().unwrap();
    refused(&done, &["the features cannot be made on a device (body parts are told apart)"]);
    let said = stderr(&tracked(&output("shared"), &["--search", "pso", "--backend", "compute", "--devices", "0,0"]));
    assert!(said.contains("the processor makes the features, since several devices share the poses"), "{said}");
    let alone = output("alone");
    let said = stderr(&tracked(&alone, &["--search", "pso", "--backend", "compute"]));
    let opened = pantin::evaluate::device::open_device().unwrap();
    if opened.facts().kind == pantin::gpu::DeviceKind::Cpu {
        assert!(said.contains("the processor makes the features, since the device is a part of it"), "{said}");
        assert_eq!(machine(&alone, "features_made_by"), "cpu");
    } else {
        assert_eq!(machine(&alone, "features_made_by"), "device", "{said}");
    }
}
