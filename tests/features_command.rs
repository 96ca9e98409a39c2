//! `pantin features` from a manifest to pictures, and the silhouettes of a real sequence.
#![allow(clippy::unwrap_used, reason = "helpers of tests are tests too")]

use std::fs;
use std::path::Path;

use image::{GrayImage, Luma, Rgb, RgbImage};
use pantin::features::{Extractor, FeatureSettings, Observation, ViewSource};
use pantin::sequence::Sequence;

const WIDTH: u32 = 80;
const HEIGHT: u32 = 60;

fn person(frame: u32, x: u32, y: u32) -> bool {
    (20 + 3 * frame..34 + 3 * frame).contains(&x) && (10..50).contains(&y)
}

fn room() -> RgbImage {
    RgbImage::from_fn(WIDTH, HEIGHT, |x, y| Rgb([(60 + x) as u8, (70 + y) as u8, 90]))
}

fn picture(frame: u32) -> RgbImage {
    let mut picture = room();
    for (x, y, pixel) in picture.enumerate_pixels_mut() {
        if person(frame, x, y) {
            *pixel = Rgb([240, 180, 150]);
        }
    }
    picture
}

/// Two cameras, the first with a plate and the second with ready masks; four frames.
fn write_sequence(folder: &Path, features: &str) {
    let camera = |name: &str, yaw: f64| {
        // Looking along the world's x or y from three metres away, picture upright.
        let (rotation, translation) = if yaw == 0.0 {
            ([-std::f64::consts::FRAC_PI_2, 0.0, 0.0], [0.0, 900.0, 3000.0])
        } else {
            ([-1.209_199_576_156_145, 1.209_199_576_156_145, -1.209_199_576_156_145], [0.0, 900.0, 3000.0])
        };
        format!(
            "[{name}]\nname = \"{name}\"\nsize = [{WIDTH}, {HEIGHT}]\n\
             matrix = [[80.0, 0.0, 39.5], [0.0, 80.0, 29.5], [0.0, 0.0, 1.0]]\n\
             distortions = [0.0, 0.0, 0.0, 0.0]\nrotation = {rotation:?}\ntranslation = {translation:?}\n"
        )
    };
    let cameras = format!("[metadata]\nunits = \"mm\"\n{}{}", camera("left", 0.0), camera("right", 1.0));
    fs::write(folder.join("cameras.toml"), cameras).unwrap();
    fs::write(folder.join("body.toml"), "").unwrap();
    room().save(folder.join("plate.png")).unwrap();
    for frame in 0..4 {
        for camera in ["left", "right"] {
            picture(frame).save(folder.join(format!("{camera}_{frame:02}.png"))).unwrap();
        }
        let mask = GrayImage::from_fn(WIDTH, HEIGHT, |x, y| Luma([if person(frame, x, y) { 255 } else { 0 }]));
        mask.save(folder.join(format!("mask_{frame:02}.png"))).unwrap();
    }
    let manifest = format!(
        "name = \"test\"\nfps = 25.0\ncameras = \"cameras.toml\"\nbody = \"body.toml\"\n{features}\n\
         [[view]]\ncamera = \"left\"\nsource = \"left_%02d.png\"\nbackground = \"plate.png\"\n\
         [[view]]\ncamera = \"right\"\nsource = \"right_%02d.png\"\nmask = \"mask_%02d.png\"\n"
    );
    fs::write(folder.join("sequence.toml"), manifest).unwrap();
}

fn pantin(arguments: &[&str]) -> (bool, String) {
    let output = std::process::Command::new(env!("CARGO_BIN_EXE_pantin")).args(arguments).output().unwrap();
    (output.status.success(), String::from_utf8_lossy(&output.stderr).into_owned())
}

#[test]
fn pictures_of_every_stage_are_written() {
    let folder = tempfile::tempdir().unwrap();
    write_sequence(folder.path(), "features = { silhouette = { element = \"square\" } }");
    let manifest = folder.path().join("sequence.toml").display().to_string();
    let out = folder.path().join("out");
    let arguments = ["features", &manifest, "--frames", "1..3", "-o", &out.display().to_string()];
    let (done, messages) = pantin(&arguments);
    assert!(done, "{messages}");
    assert!(messages.contains("features: frame 2 of 2"), "{messages}");

    for frame in [1, 2] {
        for camera in ["left", "right"] {
            let silhouette = image::open(out.join(format!("{camera}/silhouette_{frame:06}.png"))).unwrap().to_luma8();
            for (x, y, pixel) in silhouette.enumerate_pixels() {
                assert_eq!(pixel[0] == 255, person(frame, x, y), "{camera}, frame {frame}, pixel {x}, {y}");
            }
            for stage in ["input", "foreground", "edges", "distance", "proximity", "observation", "region"] {
                assert!(out.join(format!("{camera}/{stage}_{frame:06}.png")).is_file(), "{stage}");
            }
            let packed = Observation::read_png(&out.join(format!("frame_{frame:06}/{camera}.png"))).unwrap();
            assert_eq!(packed.silhouette().to_gray(), silhouette);
        }
    }
    assert!(!out.join("frame_000000").exists() && !out.join("frame_000003").exists());

    let (again, messages) = pantin(&arguments);
    assert!(!again && messages.contains("--force"), "{messages}");
    assert!(pantin(&[&arguments[..], &["--force"]].concat()).0);
}

/// Head and hands by skin, the rest by position, with every other stage chosen anew; on a device the same files.
#[test]
fn body_parts_and_other_operators_are_written_and_a_device_agrees() {
    let folder = tempfile::tempdir().unwrap();
    write_sequence(
        folder.path(),
        "[features]\nedges = { operator = \"laplace8\", threshold = 60 }\ndistance = { metric = \"euclidean\" }\n\
         proximity = { normalisation = \"exponential\", d_max = 30, n_range = 0.9 }\n\
         [[features.segment]]\nname = \"top\"\nlabels = [1, 2]\nweight = 0.5\ncue = \"skin\"\nwithin = [0, 0, 1, 0.25]\n\
         [[features.segment]]\nname = \"rest\"\nlabels = [3]\nweight = 0.5\ncue = \"position\"\n",
    );
    let manifest = folder.path().join("sequence.toml").display().to_string();
    let out = folder.path().join("out");
    let arguments = ["features", &manifest, "--frames", "1..2", "-o", &out.display().to_string()];
    let (done, messages) = pantin(&arguments);
    assert!(done, "{messages}");
    let segments = image::open(out.join("right/segments_000001.png")).unwrap().to_rgb8();
    let colours = |rows: std::ops::Range<u32>| {
        let mut colours: Vec<[u8; 3]> = rows.map(|y| segments.get_pixel(30, y).0).collect();
        colours.dedup();
        colours
    };
    let (top, rest) = (colours(10..20), colours(20..50));
    assert!(top.len() == 1 && rest.len() == 1 && top != rest && colours(0..10) == [[0; 3]], "{top:?}, {rest:?}");

    if let Err(error) = pantin::gpu::Instance::open(pantin::gpu::Validation::Off) {
        assert!(std::env::var_os("PANTIN_NEEDS_VULKAN").is_none(), "{error:#}");
        println!("SKIPPED the device: {error:#}");
        return;
    }
    let device = folder.path().join("device");
    let (done, messages) = pantin(&[&arguments[..5], &[&device.display().to_string(), "--backend", "device"]].concat());
    assert!(done, "{messages}");
    for camera in ["left", "right"] {
        for stage in ["edges", "distance", "proximity", "observation", "segments"] {
            let name = format!("{camera}/{stage}_000001.png");
            assert_eq!(fs::read(out.join(&name)).unwrap(), fs::read(device.join(&name)).unwrap(), "{name}");
        }
    }
}

#[test]
fn what_is_wrong_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let manifest = folder.path().join("sequence.toml").display().to_string();
    let out = folder.path().join("out").display().to_string();
    for (features, frames, expected) in [
        ("features = { edges = { treshold = 5 } }", "0..2", "`treshold`, the nearest known key is `threshold`"),
        ("features = { edges = { dilate = 4 } }", "0..2", "edges.dilate is 4"),
        ("", "2..9", "which has frames 0..4"),
        ("", "3..3", "expected A..B"),
    ] {
        write_sequence(folder.path(), features);
        let (done, messages) = pantin(&["features", &manifest, "--frames", frames, "-o", &out]);
        assert!(!done && messages.contains(expected), "{messages}");
        assert!(!Path::new(&out).exists(), "nothing is written before the input is known to be sound");
    }
}

/// There is no true silhouette of this take, but joints triangulated from a keypoint detector: they must lie on it.
#[test]
fn silhouettes_of_a_real_sequence_hold_the_joints() {
    let beam = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/data/beam"));
    if !beam.is_dir() {
        eprintln!("SKIPPED silhouettes_of_a_real_sequence_hold_the_joints: ../shared/data is absent");
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("sequence.toml");
    let at = |name: String| beam.join(name).display().to_string();
    // The file leaves its units to its readme.
    let cameras = fs::read_to_string(beam.join("cameras.toml")).unwrap();
    fs::write(folder.path().join("cameras.toml"), format!("[metadata]\nunits = \"mm\"\n{cameras}")).unwrap();
    let mut manifest =
        String::from("name = \"beam\"\nfps = 60.0\nscale = 0.25\nbody = \"body.toml\"\ncameras = \"cameras.toml\"\n");
    for camera in ["cam01", "cam02", "cam03", "cam04"] {
        let (video, plate) = (at(format!("videos/{camera}.mp4")), at(format!("background/bg_{camera}.png")));
        manifest += &format!("[[view]]\ncamera = {camera:?}\nsource = {video:?}\nbackground = {plate:?}\n");
    }
    fs::write(&path, manifest).unwrap();
    fs::write(folder.path().join("body.toml"), "").unwrap();

    let sequence = Sequence::open(&path).unwrap();
    let views = sequence.sizes.iter().zip(sequence.backgrounds().unwrap());
    let views = views.map(|(&[width, height], plate)| ViewSource { width, height, plate }).collect();
    let mut extractor = Extractor::new(FeatureSettings::default(), views).unwrap();
    let joints = fs::read_to_string(beam.join("reference/openpose_body25b_3d_filt6hz.csv")).unwrap();
    let (mut on, mut off) = (0, 0);
    let mut reader = sequence.read_frames(0..100).unwrap();
    while let Some(set) = reader.next_frame().unwrap() {
        if set.index % 9 != 0 {
            continue;
        }
        let row: Vec<f64> = joints
            .lines()
            .nth(set.index + 1)
            .unwrap()
            .split(',')
            .map(|cell| cell.parse().unwrap_or(f64::NAN))
            .collect();
        let features = extractor.extract(&set.pictures, &set.masks).unwrap();
        for (camera, features) in sequence.cameras.iter().zip(&features) {
            let area = features.silhouette.count();
            assert!((4500..13_000).contains(&area), "{}, frame {}: {area} pixels", camera.name, set.index);
            // Past frame, time and the nose, which the detector could not see.
            for point in row[5..].chunks_exact(3).filter(|point| point.iter().all(|value| value.is_finite())) {
                let Some(pixel) = camera.project(glam::DVec3::new(point[0], point[1], point[2])) else { continue };
                let (x, y) = (pixel.x.round(), pixel.y.round());
                if x < 0.0 || y < 0.0 || x >= f64::from(camera.size[0]) || y >= f64::from(camera.size[1]) {
                    continue;
                }
                // The joints are good to some 20 mm, which is three pixels.
                let hit = (-3..=3).any(|dy| {
                    (-3..=3).any(|dx| {
                        features.silhouette.get((x as u32).wrapping_add_signed(dx), (y as u32).wrapping_add_signed(dy))
                    })
                });
                if hit {
                    on += 1;
                } else {
                    off += 1;
                }
            }
        }
    }
    assert!(on > 900, "{on} joints seen");
    assert!(off * 50 <= on, "{off} of {} joints are off the silhouette", on + off);
}
