//! `pantin features` from a manifest to pictures, and the silhouettes of a real sequence.

use std::fs;
use std::path::Path;

use image::{GrayImage, Luma, Rgb, RgbImage};
use pantin::features::{Extractor, FeatureSettings, Observation, ViewSource};
use pantin::sequence::Sequence;

use super::support::{self, has_vulkan, shared, stderr};

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
    let output = support::pantin(arguments);
    (output.status.success(), stderr(&output))
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

    if !has_vulkan("the device of body_parts_and_other_operators_are_written_and_a_device_agrees") {
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
    let Some(beam) = shared("silhouettes_of_a_real_sequence_hold_the_joints", "beam") else { return };
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

/// The outline of the woman in frame 120 of the outdoor video, drawn by hand over the picture: pixels of 1768 x 994.
#[rustfmt::skip]
const WALKER: [[i32; 2]; 103] = [
    [808, 525], [821, 518], [838, 516], [851, 522], [857, 533], [858, 549], [856, 564], [859, 577], [869, 594], [877, 608],
    [887, 627], [904, 643], [899, 648], [892, 654], [900, 674], [910, 694], [920, 712], [932, 723], [945, 732], [945, 738],
    [935, 743], [925, 738], [917, 730], [907, 710], [894, 687], [879, 669], [872, 659], [874, 684], [870, 697], [863, 707],
    [856, 727], [852, 738], [853, 753], [859, 773], [864, 796], [874, 807], [887, 820], [907, 845], [909, 848], [917, 861],
    [938, 881], [951, 899], [943, 909], [932, 919], [925, 922], [907, 922], [917, 917], [916, 899], [904, 875], [894, 860],
    [887, 858], [864, 838], [838, 825], [833, 809], [826, 786], [821, 771], [817, 779], [802, 796], [794, 807], [791, 829],
    [789, 855], [786, 875], [784, 901], [787, 914], [784, 922], [766, 928], [731, 929], [731, 924], [746, 919], [757, 911],
    [764, 894], [766, 871], [764, 845], [762, 815], [764, 799], [769, 779], [777, 756], [789, 732], [792, 727], [789, 720],
    [789, 684], [790, 680], [772, 686], [752, 697], [739, 704], [726, 717], [716, 717], [716, 704], [726, 696], [743, 689],
    [769, 669], [792, 658], [798, 651], [797, 638], [803, 622], [812, 608], [821, 589], [818, 576], [805, 571], [803, 559],
    [800, 551], [805, 539], [808, 531],
];

/// Whether a point is within a polygon: it crosses an odd number of sides on its way to the right.
fn within(polygon: &[[i32; 2]], x: f64, y: f64) -> bool {
    let sides = polygon.iter().zip(polygon.iter().cycle().skip(1));
    let crossed = sides.filter(|(a, b)| {
        let ([ax, ay], [bx, by]) = (a.map(f64::from), b.map(f64::from));
        (ay > y) != (by > y) && x < ax + (y - ay) / (by - ay) * (bx - ax)
    });
    crossed.count() % 2 == 1
}

/// A background learnt while leaves and people move before a low sun: of the walker drawn by hand the silhouette holds nearly all,
/// and little beside her. A shirt as green and as dark as the trees' shade passes for their shadow, so both settings are asked.
#[test]
fn a_learnt_background_shows_a_walker_as_drawn_by_hand() {
    let name = "a_learnt_background_shows_a_walker_as_drawn_by_hand";
    let Some(video) = shared(name, "video/sports2d_demo.mp4") else { return };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("sequence.toml");
    let camera = "[metadata]\nunits = \"mm\"\n[cam]\nname = \"cam\"\nsize = [1768, 994]\n\
                  matrix = [[1500.0, 0.0, 884.0], [0.0, 1500.0, 497.0], [0.0, 0.0, 1.0]]\ndistortions = [0.0, 0.0, 0.0, 0.0]\n\
                  rotation = [1.2, -1.2, 1.2]\ntranslation = [0.0, 0.0, 5000.0]\n";
    fs::write(folder.path().join("cameras.toml"), camera).unwrap();
    fs::write(folder.path().join("body.toml"), "").unwrap();
    let manifest = format!(
        "name = \"outdoor\"\nfps = 30.0\nscale = 0.5\nbody = \"body.toml\"\ncameras = \"cameras.toml\"\n\
         [[view]]\ncamera = \"cam\"\nsource = {video:?}\n"
    );
    fs::write(&path, manifest).unwrap();
    let sequence = Sequence::open(&path).unwrap();
    let views: Vec<ViewSource> =
        sequence.sizes.iter().map(|&[width, height]| ViewSource { width, height, plate: None }).collect();
    let mut kept = FeatureSettings::default();
    kept.shadow.suppress = false;
    let mut extractors =
        [FeatureSettings::default(), kept].map(|settings| Extractor::new(settings, views.clone()).unwrap());
    let mut reader = sequence.read_frames(0..121).unwrap();
    let mut silhouettes = Vec::new();
    while let Some(set) = reader.next_frame().unwrap() {
        for extractor in &mut extractors {
            let features = extractor.extract(&set.pictures, &set.masks).unwrap();
            if set.index == 120 {
                silhouettes.push(features[0].silhouette.clone());
            }
        }
    }
    for (silhouette, [least_recall, least_precision]) in silhouettes.iter().zip([[0.75, 0.85], [0.87, 0.8]]) {
        let (mut both, mut drawn, mut found) = (0, 0, 0);
        // Around her alone: a man on the roof and a passer-by far behind move too.
        for y in 250..480 {
            for x in 345..485 {
                let inside = within(&WALKER, 2.0 * f64::from(x) + 0.5, 2.0 * f64::from(y) + 0.5);
                let seen = silhouette.get(x, y);
                both += u32::from(inside && seen);
                drawn += u32::from(inside);
                found += u32::from(seen);
            }
        }
        let (recall, precision) = (f64::from(both) / f64::from(drawn), f64::from(both) / f64::from(found.max(1)));
        println!("recall {recall:.3}, precision {precision:.3}");
        assert!(recall > least_recall && precision > least_precision, "recall {recall}, precision {precision}");
    }
}
