use std::fs;
use std::path::Path;

use super::super::turn::Turn;
use super::super::video::tests::{ffmpeg_is_here, make_video};
use super::Sequence;
use super::tests::{CAMERA_SIZE, Scene};

/// Copies a video with a mark that players turn it by, degrees; false where this ffmpeg cannot write one.
fn mark_turned(from: &Path, to: &Path, degrees: i32) -> bool {
    let made = std::process::Command::new("ffmpeg")
        .args(["-v", "error", "-y", "-i"])
        .arg(from)
        .args(["-c", "copy", "-metadata:s:v:0", &format!("rotate={degrees}")])
        .arg(to)
        .status();
    assert!(made.unwrap().success());
    crate::sequence::probe_video(to).unwrap().turn != Turn::None
}

/// The first frame as ffmpeg shows it to people, with its size.
fn shown_by_ffmpeg(video: &Path) -> image::RgbImage {
    let picture = video.with_extension("shown.png");
    let made = std::process::Command::new("ffmpeg")
        .args(["-v", "error", "-y", "-i"])
        .arg(video)
        .args(["-frames:v", "1", "-pix_fmt", "rgb24"])
        .arg(&picture)
        .status();
    assert!(made.unwrap().success());
    image::open(picture).unwrap().into_rgb8()
}

/// The mean difference of two pictures, grey levels.
fn difference(a: &image::RgbImage, b: &image::RgbImage) -> f64 {
    assert_eq!(a.dimensions(), b.dimensions());
    let sum: u64 = a.as_raw().iter().zip(b.as_raw()).map(|(a, b)| u64::from(a.abs_diff(*b))).sum();
    sum as f64 / a.as_raw().len() as f64
}

#[test]
fn videos_marked_to_be_turned_are_read_as_the_calibration_has_them() {
    if !ffmpeg_is_here("videos_marked_to_be_turned_are_read_as_the_calibration_has_them") {
        return;
    }
    let scene = Scene::new();
    // Stored lying, as telephones do; the calibration is of 40x30.
    make_video(&scene.path("lying.mp4"), "30x40", 3, &["-c:v", "mpeg4", "-q:v", "2"]);
    make_video(&scene.path("upright.mp4"), "40x30", 3, &["-c:v", "mpeg4", "-q:v", "2"]);
    let first = |more: &str, file: &str| {
        scene.manifest("", &[&format!("camera = \"cam01\"\nsource = \"{file}\"\n{more}"), &Scene::view("cam02")]);
        let sequence = Sequence::open(scene.folder.path()).unwrap();
        let picture = sequence.read_frames(0..1).unwrap().next_frame().unwrap().unwrap().pictures.swap_remove(0);
        (picture, sequence.remarks())
    };
    for degrees in [90, 180, 270] {
        let (from, file) = if degrees == 180 { ("upright.mp4", "turned.mp4") } else { ("lying.mp4", "turned.mp4") };
        if !mark_turned(&scene.path(from), &scene.path(file), degrees) {
            println!(
                "SKIPPED videos_marked_to_be_turned_are_read_as_the_calibration_has_them: ffmpeg writes marks otherwise"
            );
            return;
        }
        let (picture, remarks) = first("", file);
        // Only the rounding of colours differs; turned the other way it is another picture.
        let shown = shown_by_ffmpeg(&scene.path(file));
        let (near, far) = (difference(&picture, &shown), difference(&picture, &image::imageops::rotate180(&shown)));
        assert!(near < 15.0 && far > 4.0 * near, "{degrees}: {near} and {far}");
        assert!(remarks.len() == 1 && remarks[0].contains("when it is read, as players do: 40x30"), "{remarks:?}");
    }
    // The calibration may be of the pictures as they are stored.
    assert!(mark_turned(&scene.path("upright.mp4"), &scene.path("marked.mp4"), 90));
    let (stored, remarks) = first("", "marked.mp4");
    let (plain, none) = first("", "upright.mp4");
    assert_eq!(stored, plain);
    assert!(remarks.len() == 1 && remarks[0].contains("is read as it is stored: 40x30"), "{remarks:?}");
    assert!(none.is_empty(), "{none:?}");
    assert!(mark_turned(&scene.path("upright.mp4"), &scene.path("half.mp4"), 180));
    assert_eq!(first("orientation = \"stored\"", "half.mp4").0, plain);
    let view = |size: &str| format!("camera = \"cam02\"\nsource = \"marked.mp4\"\norientation = \"{size}\"");
    let error = scene.error("", &[&view("upright")]);
    assert!(error.contains("pictures of 30x40 pixels") && error.contains("turned by 90 degrees"), "{error}");
    let error = scene.error("", &[&view("lying")]);
    assert!(error.contains("unknown orientation `lying`") && error.contains("upright"), "{error}");
}

/// A video whose frames tell their number by their grey, without those that are missing: 8 levels a frame.
pub(in crate::sequence) fn numbered_video(path: &Path, rate: u32, frames: u32, missing: &str) {
    let made = std::process::Command::new("ffmpeg")
        .args(["-v", "error", "-y", "-f", "lavfi", "-i"])
        .arg(format!("color=size=40x30:rate={rate}:color=black,format=gray,geq=lum=8*N+8,select='not({missing})'"))
        .args(["-fps_mode", "passthrough", "-frames:v", &frames.to_string(), "-c:v", "ffv1"])
        .arg(path)
        .status();
    assert!(made.unwrap().success());
}

/// The numbers that the frames of a view's video say.
fn numbers(sequence: &Sequence, view: usize, range: std::ops::Range<usize>) -> Vec<u8> {
    let mut reader = sequence.read_frames(range).unwrap();
    let mut numbers = Vec::new();
    while let Some(set) = reader.next_frame().unwrap() {
        numbers.push((f64::from(set.pictures[view].get_pixel(20, 15)[1]) / 8.0 - 1.0).round() as u8);
    }
    numbers
}

#[test]
fn dropped_frames_are_made_up_for_and_cameras_stay_together() {
    if !ffmpeg_is_here("dropped_frames_are_made_up_for_and_cameras_stay_together") {
        return;
    }
    let scene = Scene::new();
    numbered_video(&scene.path("whole.mkv"), 25, 24, "0");
    numbered_video(&scene.path("drops.mkv"), 25, 20, "between(n,5,7)+eq(n,15)");
    let views = ["camera = \"cam01\"\nsource = \"whole.mkv\"", "camera = \"cam02\"\nsource = \"drops.mkv\""];
    scene.manifest("", &views);
    let sequence = Sequence::open(scene.folder.path()).unwrap();
    let all: Vec<u8> = (0..24).collect();
    let made_up = [0, 1, 2, 3, 4, 4, 4, 8, 8, 9, 10, 11, 12, 13, 14, 14, 16, 17, 18, 19, 20, 21, 22, 23];
    assert_eq!((sequence.frame_count, numbers(&sequence, 0, 0..24)), (24, all.clone()));
    assert_eq!(numbers(&sequence, 1, 0..24), made_up);
    assert!(sequence.views[0].picks.is_none(), "a whole video is read as ever");
    for range in [3..9, 6..8, 7..24, 15..17, 23..24] {
        assert_eq!(numbers(&sequence, 1, range.clone()), made_up[range]);
    }
    let remarks = sequence.remarks();
    assert!(
        remarks.len() == 1
            && remarks[0].contains("cam02")
            && remarks[0].contains("40.0 ms apart in the median, 160.0 ms at most, 4 missing"),
        "{remarks:?}"
    );
    // As it was before: every picture a frame, and then the lengths differ.
    let error = scene.error("timestamps = \"ignore\"", &views);
    assert!(error.contains("has 24 frames and camera \"cam02\" has 20") && error.contains("`delay = 0`"), "{error}");
    let error = scene.error("timestamps = \"nearest\"", &views);
    assert!(error.contains("unknown use of timestamps `nearest`") && error.contains("resample, ignore"), "{error}");
    // Another rate in the manifest: times are not believed unless told so.
    scene.manifest("", &views);
    let text = fs::read_to_string(scene.path("sequence.toml")).unwrap();
    scene.write("sequence.toml", &text.replace("fps = 25.0", "fps = 12.5"));
    let error = format!("{:#}", Sequence::open(scene.folder.path()).unwrap_err());
    assert!(error.contains("4 missing; every picture is taken as a frame, since `fps` is another rate"), "{error}");
    scene.manifest("timestamps = \"resample\"", &views);
    let text = fs::read_to_string(scene.path("sequence.toml")).unwrap();
    scene.write("sequence.toml", &text.replace("fps = 25.0", "fps = 12.5"));
    let sequence = Sequence::open(scene.folder.path()).unwrap();
    assert_eq!(numbers(&sequence, 0, 0..12), [0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 22]);
    assert_eq!(numbers(&sequence, 1, 0..12), [0, 2, 4, 4, 8, 10, 12, 14, 16, 18, 20, 22]);
    assert!(sequence.remarks()[0].contains("`fps` is 12.5 and the videos have 25.000"), "{:?}", sequence.remarks());
}

#[test]
fn rates_that_differ_are_said_with_names_and_resampled_where_asked() {
    if !ffmpeg_is_here("rates_that_differ_are_said_with_names_and_resampled_where_asked") {
        return;
    }
    let scene = Scene::new();
    numbered_video(&scene.path("a.mkv"), 25, 24, "0");
    numbered_video(&scene.path("b.mkv"), 50, 24, "0");
    let views = ["camera = \"cam01\"\nsource = \"a.mkv\"", "camera = \"cam02\"\nsource = \"b.mkv\""];
    scene.manifest("", &views);
    let remarks = Sequence::open(scene.folder.path()).unwrap().remarks();
    assert!(
        remarks.len() == 1 && remarks[0].contains("`fps` is 25") && remarks[0].contains("cam02 50.000"),
        "{remarks:?}"
    );
    scene.manifest("timestamps = \"resample\"", &views);
    let sequence = Sequence::open(scene.folder.path()).unwrap();
    assert_eq!(sequence.frame_count, 13, "as long as the shorter: {:?}", sequence.remarks());
    assert_eq!(numbers(&sequence, 0, 0..13), (0..13).collect::<Vec<u8>>());
    assert_eq!(numbers(&sequence, 1, 0..12), (0..24).step_by(2).collect::<Vec<u8>>());
    assert!(sequence.remarks().iter().any(|remark| remark.contains("cam01 24, cam02 13")), "{:?}", sequence.remarks());
    numbered_video(&scene.path("b.mkv"), 50, 20, "0");
    let error = scene.error("", &views);
    assert!(error.contains("25.000 and 50.000 frames a second: `timestamps = \"resample\"`"), "{error}");
    scene.manifest("timestamps = \"ignore\"", &[views[1]]);
    assert_eq!(Sequence::open(scene.folder.path()).unwrap().remarks().len(), 1, "one view alone is said");
}

#[test]
fn a_camera_that_was_started_late_is_put_right_by_one_key() {
    let scene = Scene::new();
    scene.pictures("cam02", CAMERA_SIZE, 5);
    scene.pictures("mask", CAMERA_SIZE, 5);
    let late = Scene::view("cam02") + "\nmask = \"mask_%03d.png\"\ndelay = 2";
    scene.manifest("", &[&Scene::view("cam01"), &late]);
    let sequence = Sequence::open(scene.folder.path()).unwrap();
    assert_eq!((sequence.frame_count, sequence.remarks()), (3, vec![]));
    let mut reader = sequence.read_frames(1..3).unwrap();
    for frame in 1..3 {
        let set = reader.next_frame().unwrap().unwrap();
        assert_eq!(set.pictures[0].get_pixel(0, 0)[0], 10 * (frame + 1));
        assert_eq!(set.pictures[1].get_pixel(0, 0)[0], 10 * (frame + 3));
    }
    // One that is early leaves out what the others saw before.
    scene.manifest("", &[&Scene::view("cam01"), &(Scene::view("cam03") + "\ndelay = -1.2")]);
    let sequence = Sequence::open(scene.folder.path()).unwrap();
    assert_eq!(sequence.frame_count, 2);
    let set = sequence.read_frames(0..1).unwrap().next_frame().unwrap().unwrap();
    assert_eq!([0, 1].map(|view: usize| set.pictures[view].get_pixel(0, 0)[0]), [20, 10]);
    let remarks = sequence.remarks();
    assert!(
        remarks[0].contains("frame 0 lies 1.2 frames (0.048 s) after") && remarks[0].contains("\"cam03\""),
        "{remarks:?}"
    );
    assert!(remarks[1].contains("cam01 2, cam03 3"), "{remarks:?}");
    assert_eq!(sequence.notes(), remarks, "nothing is amiss");
    // All as late or as early as each other are not late.
    for delay in [7, -7] {
        let both = ["cam01", "cam03"].map(|camera| format!("{}\ndelay = {delay}", Scene::view(camera)));
        scene.manifest("", &both.each_ref().map(String::as_str));
        let sequence = Sequence::open(scene.folder.path()).unwrap();
        assert_eq!((sequence.frame_count, sequence.remarks()), (3, vec![]));
    }
    let of =
        |delay: &str| scene.error("", &[&Scene::view("cam01"), &format!("{}\ndelay = {delay}", Scene::view("cam03"))]);
    assert!(of("3").contains("camera \"cam03\" has no frame"), "{}", of("3"));
    assert!(of("nan").contains("the delay of camera \"cam03\" is NaN"), "{}", of("nan"));
    assert!(of("1e9").contains("expected at most 100000 frames"), "{}", of("1e9"));
}

#[test]
fn views_of_different_lengths_are_taken_as_far_as_all_go_and_said() {
    let scene = Scene::new();
    scene.pictures("cam02", CAMERA_SIZE, 5);
    scene.manifest("", &[&Scene::view("cam01"), &Scene::view("cam02")]);
    let sequence = Sequence::open(scene.folder.path()).unwrap();
    assert_eq!(sequence.frame_count, 3);
    let remarks = sequence.remarks();
    assert!(remarks.len() == 2 && remarks[0].contains("cam01 3, cam02 5"), "{remarks:?}");
    assert!(remarks[1].contains("look for the delay") && sequence.notes() == &remarks[..1], "{remarks:?}");
    // What the lengths make likely is a guess, and too short a stretch makes none.
    assert!(sequence.likely_delays().is_empty());
    scene.pictures("cam01", CAMERA_SIZE, 20);
    scene.pictures("cam02", CAMERA_SIZE, 25);
    let sequence = Sequence::open(scene.folder.path()).unwrap();
    assert_eq!(sequence.likely_delays(), [[-5.0, 0.0]]);
    let delayed = sequence.delayed(&[-5.0, 0.0]).unwrap();
    assert_eq!((delayed.frame_count, delayed.views[0].delay), (20, -5.0));
    let set = delayed.read_frames(1..2).unwrap().next_frame().unwrap().unwrap();
    assert_eq!([0, 1].map(|view: usize| set.pictures[view].get_pixel(0, 0)[0]), [20, 70]);
    assert!(sequence.delayed(&[0.0, 60.0]).is_err());
}

#[test]
fn videos_that_filmed_as_long_at_other_rates_are_taken_by_their_times() {
    if !ffmpeg_is_here("videos_that_filmed_as_long_at_other_rates_are_taken_by_their_times") {
        return;
    }
    let scene = Scene::new();
    numbered_video(&scene.path("a.mkv"), 25, 12, "0");
    numbered_video(&scene.path("b.mkv"), 50, 20, "0");
    let views = ["camera = \"cam01\"\nsource = \"a.mkv\"", "camera = \"cam02\"\nsource = \"b.mkv\""];
    scene.manifest("", &views);
    let sequence = Sequence::open(scene.folder.path()).unwrap();
    assert_eq!(numbers(&sequence, 0, 0..10), (0..10).collect::<Vec<u8>>());
    assert_eq!(numbers(&sequence, 1, 0..10), (0..20).step_by(2).collect::<Vec<u8>>());
    let remarks = sequence.remarks();
    assert!(
        remarks.iter().any(|remark| remark.contains("cam02 50.000") && remark.contains("nearest in time")),
        "{remarks:?}"
    );
}

#[test]
fn videos_that_begin_at_different_times_are_said() {
    if !ffmpeg_is_here("videos_that_begin_at_different_times_are_said") {
        return;
    }
    let scene = Scene::new();
    let from = |name: &str, first: &str, made: &str| {
        let time = format!("creation_time={made}");
        make_video(&scene.path(name), "40x30", 6, &["-c:v", "mpeg4", "-metadata", &time, "-output_ts_offset", first]);
    };
    from("a.ts", "0", "2024-05-01T10:00:00Z");
    from("b.ts", "0.12", "2024-05-01T10:00:00Z");
    let views = ["camera = \"cam01\"\nsource = \"a.ts\"", "camera = \"cam02\"\nsource = \"b.ts\""];
    scene.manifest("", &views);
    let remarks = Sequence::open(scene.folder.path()).unwrap().remarks();
    assert!(remarks.len() == 1 && remarks[0].contains("cam02 0.120 s (`delay = -3`)"), "{remarks:?}");
    from("a.mp4", "0", "2024-05-01T10:00:00Z");
    from("b.mp4", "0", "2024-05-01T10:00:35Z");
    let views = views.map(|view| view.replace(".ts", ".mp4"));
    scene.manifest("", &views.each_ref().map(String::as_str));
    let remarks = Sequence::open(scene.folder.path()).unwrap().remarks();
    assert!(remarks.len() == 1 && remarks[0].contains("cam01 at 2024-05-01T10:00:00"), "{remarks:?}");
    scene.manifest("", &[&views[0], &(views[1].clone() + "\ndelay = 0")]);
    assert!(Sequence::open(scene.folder.path()).unwrap().remarks().is_empty());
}
