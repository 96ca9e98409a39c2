//! `pantin check` as a user runs it: on drawn silhouettes of a walking body, whose truth is exact, and on the beam.

use std::fs;
use std::path::Path;
use std::sync::OnceLock;

use glam::{DAffine3, DMat3, DVec3};
use image::{GrayImage, Luma};
use pantin::body::Body;
use pantin::evaluate::Reference;
use pantin::files::Overwrite;
use pantin::geometry::{Camera, Lens, rodrigues_matrix};
use pantin::sequence::write_cameras_toml;

use super::scene;
use super::support::{has_ffmpeg, lay_out_beam, pantin, refused, shared, stderr, stdout};

const SIZE: [u32; 2] = [320, 400];
const FRAMES: usize = 20;
/// Frames of the longer walk.
const LONG: usize = 66;

/// Five cameras round a walk, no two of them opposite each other.
fn cameras() -> Vec<Camera> {
    let camera = |(index, degrees): (usize, f64)| {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let eye = DVec3::new(4200.0 * cos, 4200.0 * sin, 1500.0 + 150.0 * index as f64);
        let lens = scene::brown(520.0, SIZE, [-0.05, 0.02, 0.0], [0.0; 2]);
        scene::camera(&format!("c{index}"), SIZE, eye, DVec3::new(0.0, 0.0, 850.0), lens)
    };
    [15.0, 80.0, 155.0, 235.0, 300.0].into_iter().enumerate().map(camera).collect()
}

/// A walk: 50 mm a frame, arms and legs swinging, arms a little off the trunk.
fn pose(body: &Body, frame: usize) -> Vec<f32> {
    let mut pose = body.standing_pose();
    let names = body.dof_names();
    let mut set = |name: &str, value: f64| pose[names.iter().position(|dof| dof == name).unwrap()] = value;
    let phase = frame as f64 * 0.45;
    set("pelvis.tx", 50.0 * frame as f64 - 600.0);
    set("pelvis.ty", 60.0 * phase.cos());
    for (side, sign) in [("left", 1.0), ("right", -1.0)] {
        set(&format!("{side}_hip.ry"), sign * -0.45 * phase.sin());
        set(&format!("{side}_knee.ry"), 0.35 + 0.3 * (sign * phase.cos()).max(0.0));
        set(&format!("{side}_shoulder.ry"), sign * 0.6 * phase.sin());
        set(&format!("{side}_shoulder.rx"), sign * 0.45);
        set(&format!("{side}_elbow.ry"), -0.5);
    }
    pose.into_iter().map(|value| value as f32).collect()
}

/// The drawn masks, made once: folder/cN_FFF.png.
fn masks() -> &'static Path {
    static FOLDER: OnceLock<tempfile::TempDir> = OnceLock::new();
    FOLDER.get_or_init(|| drawn(FRAMES, pose)).path()
}

/// The masks of a longer walk of 30 mm a frame, made once.
fn long_masks() -> &'static Path {
    static FOLDER: OnceLock<tempfile::TempDir> = OnceLock::new();
    let slower = |body: &Body, frame: usize| {
        let mut pose = pose(body, frame);
        let along = body.dof_index("pelvis.tx").unwrap();
        pose[along] = 30.0 * frame as f32 - 900.0;
        pose
    };
    FOLDER.get_or_init(|| drawn(LONG, slower)).path()
}

fn drawn(frames: usize, pose: impl Fn(&Body, usize) -> Vec<f32>) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let body = Body::adult(1750.0).unwrap();
    let cameras = cameras();
    let reference = Reference::new(&body, &cameras);
    for frame in 0..frames {
        let pose = pose(&body, frame);
        for (view, camera) in cameras.iter().enumerate() {
            let drawn = reference.draw(&pose, view);
            let mask = GrayImage::from_fn(drawn.width, drawn.height, |x, y| {
                Luma([if drawn.bytes[(y * drawn.width + x) as usize] != 0 { 255 } else { 0 }])
            });
            mask.save(folder.path().join(format!("{}_{frame:03}.png", camera.name))).unwrap();
        }
    }
    folder
}

/// A sequence of those masks with other cameras; `late` is a camera whose pictures come a frame late.
fn sequence(cameras: &[Camera], late: Option<&str>) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    write_cameras_toml(&at.join("cameras.toml"), cameras, Overwrite::Refuse).unwrap();
    fs::write(at.join("body.toml"), Body::adult(1750.0).unwrap().to_toml()).unwrap();
    let mut manifest = "name = \"walk\"\nfps = 25.0\ncameras = \"cameras.toml\"\nbody = \"body.toml\"\n".to_string();
    for camera in cameras {
        let name = &camera.name;
        let source = if late == Some(name) {
            for frame in 0..FRAMES {
                let from = masks().join(format!("{name}_{:03}.png", frame.saturating_sub(1)));
                fs::copy(from, at.join(format!("{name}_{frame:03}.png"))).unwrap();
            }
            at.join(format!("{name}_%03d.png"))
        } else {
            masks().join(format!("{name}_%03d.png"))
        };
        let source = source.display();
        manifest += &format!("[[view]]\ncamera = \"{name}\"\nsource = \"{source}\"\nmask = \"{source}\"\n");
    }
    fs::write(at.join("sequence.toml"), manifest).unwrap();
    folder
}

/// Exit status, the report, and what stood on standard error.
pub(super) fn check(sequence: &Path) -> (i32, serde_json::Value, String) {
    let output = pantin(&["check", "--json", sequence.to_str().unwrap()]);
    let error = stderr(&output);
    let report = serde_json::from_slice(&output.stdout).unwrap_or_else(|_| panic!("{error}"));
    (output.status.code().unwrap(), report, error)
}

/// The failed checks, as `check` or `check camera`.
pub(super) fn failed(report: &serde_json::Value) -> Vec<String> {
    let checks = report["checks"].as_array().unwrap();
    let name = |finding: &&serde_json::Value| match finding["camera"].as_str() {
        Some(camera) => format!("{} {camera}", finding["check"].as_str().unwrap()),
        None => finding["check"].as_str().unwrap().to_string(),
    };
    checks.iter().filter(|finding| finding["status"] == "failed").map(|finding| name(&finding)).collect()
}

pub(super) fn finding<'a>(report: &'a serde_json::Value, check: &str, camera: &str) -> &'a serde_json::Value {
    let checks = report["checks"].as_array().unwrap();
    checks
        .iter()
        .find(|finding| finding["check"] == check && finding["camera"].as_str().unwrap_or("") == camera)
        .unwrap()
}

/// The failed checks of the drawn walk with other cameras.
fn fails(cameras: &[Camera], late: Option<&str>) -> (Vec<String>, serde_json::Value) {
    let folder = sequence(cameras, late);
    let (status, report, error) = check(folder.path());
    let failed = failed(&report);
    assert_eq!(status, i32::from(!failed.is_empty()), "{error}");
    assert_eq!(report["sane"], failed.is_empty());
    for finding in report["checks"].as_array().unwrap() {
        let is_well = finding["status"] == "ok" || finding["status"] == "not_measured";
        assert_eq!(is_well, finding["advice"] == "", "{finding}");
    }
    (failed, report)
}

/// The camera turned about its own centre by a Rodrigues vector in its own axes.
pub(super) fn turned(camera: &Camera, degrees: DVec3) -> Camera {
    let turn = DAffine3::from_mat3(rodrigues_matrix(degrees * 1.0_f64.to_radians()));
    Camera { camera_from_world: turn * camera.camera_from_world, ..camera.clone() }
}

/// The same cameras in a world that a map leads to.
fn moved(world_from_world: DAffine3) -> Vec<Camera> {
    let back = world_from_world.inverse();
    cameras()
        .into_iter()
        .map(|camera| Camera { camera_from_world: camera.camera_from_world * back, ..camera })
        .collect()
}

#[test]
fn a_clean_sequence_is_sane() {
    let (failed, report) = fails(&cameras(), None);
    assert!(failed.is_empty(), "{failed:?}\n{report:#}");
    for camera in cameras() {
        let value = |check: &str| finding(&report, check, &camera.name)["value"].as_f64().unwrap();
        println!("{}: {} {} {}", camera.name, value("direction"), value("roll"), value("timing"));
        assert!(
            value("direction") < 0.12 && value("timing").abs() < 0.3 && value("hull coverage") > 97.0,
            "{report:#}"
        );
    }
    let height = finding(&report, "height", "")["value"].as_f64().unwrap();
    assert!((1600.0..1800.0).contains(&height), "{height}");
}

#[test]
fn half_a_degree_is_caught_and_the_camera_named() {
    for (view, axis) in [(0, DVec3::X), (3, -DVec3::Y), (4, DVec3::Y)] {
        let mut cameras = cameras();
        cameras[view] = turned(&cameras[view], axis * 0.5);
        let (failed, report) = fails(&cameras, None);
        let name = format!("direction c{view}");
        let value = finding(&report, "direction", &format!("c{view}"))["value"].as_f64().unwrap();
        println!("c{view} by half a degree about {axis}: measured {value:.3}; failed {failed:?}");
        assert!(failed.contains(&name), "{failed:?}");
        assert!((0.3..0.65).contains(&value), "{value}");
        // The others are not accused.
        assert!(failed.iter().all(|check| !check.starts_with("direction") || *check == name), "{failed:?}");
    }
}

/// A lens that is not the calibrated one is named as that, and not as a turn of this camera or of others.
#[test]
fn a_wrong_focal_length_is_caught_and_named() {
    for (view, by) in [(2, 1.1), (0, 0.9)] {
        let mut cameras = cameras();
        let Lens::BrownConrady(lens) = &mut cameras[view].lens else { panic!("no such lens") };
        lens.focal *= by;
        let (failed, report) = fails(&cameras, None);
        println!("c{view} {by} times as long: {failed:?}");
        assert!(failed.contains(&format!("focal length c{view}")), "{failed:?}");
        let value = finding(&report, "focal length", &format!("c{view}"))["value"].as_f64().unwrap();
        // A weak pull to the stated one leaves some of it.
        assert!((value - 100.0 * (1.0 / by - 1.0)).abs() < 2.5, "{value}");
        let others = failed.iter().filter(|check| check.starts_with("direction") || check.starts_with("timing"));
        assert_eq!(others.count() + failed.iter().filter(|check| check.starts_with("focal")).count(), 1, "{failed:?}");
    }
    let mut cameras = cameras();
    cameras[1] = turned(&cameras[1], DVec3::X * 2.0);
    assert!(fails(&cameras, None).0.iter().all(|check| !check.starts_with("focal")), "a turn is no other lens");
}

#[test]
fn a_camera_a_frame_late_is_caught_and_named() {
    let (failed, report) = fails(&cameras(), Some("c2"));
    let late = finding(&report, "timing", "c2")["value"].as_f64().unwrap();
    println!("c2 a frame late: measured {late:.2}; failed {failed:?}");
    assert!(failed.contains(&"timing c2".to_string()) && (0.6..1.4).contains(&late), "{failed:?} {late}");
    assert!(failed.iter().all(|check| !check.starts_with("timing") || check == "timing c2"), "{failed:?}");
    let advice = finding(&report, "timing", "c2")["advice"].as_str().unwrap();
    assert!(advice.contains("write `delay = 1` into the [[view]]"), "{advice}");
    // With half of it stated the whole is named.
    let folder = sequence(&cameras(), Some("c2"));
    let path = folder.path().join("sequence.toml");
    let text = fs::read_to_string(&path).unwrap();
    let (before, after) = text.split_once("camera = \"c2\"\n").unwrap();
    let state = |delay: i32| fs::write(&path, format!("{before}camera = \"c2\"\ndelay = {delay}\n{after}")).unwrap();
    state(-1);
    let (_, report, _) = check(folder.path());
    let advice = finding(&report, "timing", "c2")["advice"].as_str().unwrap().to_string();
    assert!(advice.contains("write `delay = 1` (now -1) into the [[view]]"), "{advice}");
    state(1);
    let (status, report, error) = check(folder.path());
    assert!(status == 0 && self::failed(&report).is_empty(), "{error}");
}

#[test]
fn a_camera_that_stops_is_doubted_and_named() {
    let folder = sequence(&cameras(), Some("c2"));
    for frame in 8..16 {
        fs::copy(masks().join("c2_007.png"), folder.path().join(format!("c2_{frame:03}.png"))).unwrap();
    }
    let (_, report, _) = check(folder.path());
    for camera in cameras() {
        let status = &finding(&report, "repeated pictures", &camera.name)["status"];
        assert_eq!(status, if camera.name == "c2" { "doubtful" } else { "ok" }, "{}", camera.name);
    }
    let found = finding(&report, "repeated pictures", "c2")["found"].as_str().unwrap();
    // Where a late camera begins it shows its first picture twice.
    assert!(found.starts_with("8 of 19 are the one before again, those of frames 9 to 15 on end"), "{found}");
}

/// A sequence in which the pictures of c2 lack so many frames of the beginning; of the others they do, where that is below zero.
fn cut(by: isize) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    write_cameras_toml(&at.join("cameras.toml"), &cameras(), Overwrite::Refuse).unwrap();
    let mut manifest = "name = \"walk\"\nfps = 25.0\ncameras = \"cameras.toml\"\nheight = 1750\n".to_string();
    for camera in cameras() {
        let name = &camera.name;
        let lacks = if name == "c2" { by.max(0) } else { (-by).max(0) } as usize;
        for frame in 0..LONG - by.unsigned_abs() {
            let from = long_masks().join(format!("{name}_{:03}.png", frame + lacks));
            fs::hard_link(from, at.join(format!("{name}_{frame:03}.png"))).unwrap();
        }
        manifest +=
            &format!("[[view]]\ncamera = \"{name}\"\nsource = \"{name}_%03d.png\"\nmask = \"{name}_%03d.png\"\n");
    }
    fs::write(at.join("sequence.toml"), manifest).unwrap();
    folder
}

/// The one thing that is wrong where c2 was cut is said alone, with the whole delay.
fn is_named_with_its_whole_delay_alone(by: isize) {
    let folder = cut(by);
    let (status, report, error) = check(folder.path());
    let failed = failed(&report);
    println!("c2 cut by {by}: {failed:?}");
    assert_eq!((status, failed), (1, vec!["timing c2".to_string()]), "cut by {by}: {error}");
    let timing = finding(&report, "timing", "c2");
    assert!((timing["value"].as_f64().unwrap() + by as f64).abs() < 0.3, "cut by {by}: {timing}");
    let advice = timing["advice"].as_str().unwrap();
    assert!(advice.contains(&format!("write `delay = {}` into the [[view]]", -by)), "{advice}");
    assert!(!advice.contains("Nothing beyond"), "{advice}");
    for camera in cameras() {
        let direction = finding(&report, "direction", &camera.name);
        assert_eq!(direction["status"], "ok", "cut by {by}: {direction}");
    }
}

#[test]
fn a_camera_far_off_in_time_is_named_with_its_whole_delay_alone() {
    [20, -8].into_iter().for_each(is_named_with_its_whole_delay_alone);
}

#[test]
#[ignore = "a minute; the two hardest are tested always"]
fn cameras_off_by_any_delay_are_named_and_one_in_time_is_not() {
    let (_, report, _) = check(cut(0).path());
    assert!(failed(&report).is_empty(), "{report}");
    [5, 8, 20, -8, -20].into_iter().for_each(is_named_with_its_whole_delay_alone);
}

/// The longer walk with each camera's pictures from `from` to before `to` alone, numbered from 0.
fn started_by_hand(stretches: [[usize; 2]; 5]) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    write_cameras_toml(&at.join("cameras.toml"), &cameras(), Overwrite::Refuse).unwrap();
    let mut manifest = "name = \"walk\"\nfps = 25.0\ncameras = \"cameras.toml\"\nheight = 1750\n".to_string();
    for (camera, [from, to]) in cameras().iter().zip(stretches) {
        let name = &camera.name;
        for frame in from..to {
            let mask = long_masks().join(format!("{name}_{frame:03}.png"));
            fs::hard_link(mask, at.join(format!("{name}_{:03}.png", frame - from))).unwrap();
        }
        manifest +=
            &format!("[[view]]\ncamera = \"{name}\"\nsource = \"{name}_%03d.png\"\nmask = \"{name}_%03d.png\"\n");
    }
    fs::write(at.join("sequence.toml"), manifest).unwrap();
    folder
}

/// Cameras started and stopped by hand: their lengths say about when, their silhouettes say the frame. Every one is named, and nothing else.
#[test]
fn lengths_lead_to_the_delays_of_several_cameras() {
    // All stopped together; and not quite, which the lengths alone would get wrong by up to 5 frames.
    for (ends, delays) in [([LONG; 5], [-10, 0, 0, 0, -21]), ([LONG, 63, LONG, LONG - 5, 64], [-10, 0, 0, 0, -21])] {
        let from = delays.map(|delay: isize| delay.unsigned_abs());
        let folder = started_by_hand([0, 1, 2, 3, 4].map(|view: usize| [from[view], ends[view]]));
        let (status, report, error) = check(folder.path());
        let failed = failed(&report);
        assert_eq!((status, failed), (1, vec!["timing c0".to_string(), "timing c4".to_string()]), "{error}");
        for (view, delay) in delays.into_iter().enumerate().filter(|(_, delay)| *delay != 0) {
            let timing = finding(&report, "timing", &format!("c{view}"));
            assert!((timing["value"].as_f64().unwrap() - delay as f64).abs() < 0.4, "{timing}");
            let advice = timing["advice"].as_str().unwrap();
            assert!(advice.contains(&format!("write `delay = {delay}` into the [[view]]")), "{advice}");
        }
        // With them written down all is well.
        let path = folder.path().join("sequence.toml");
        let mut text = fs::read_to_string(&path).unwrap();
        for (view, delay) in delays.into_iter().enumerate() {
            let view = format!("camera = \"c{view}\"\n");
            text = text.replace(&view, &format!("{view}delay = {delay}\n"));
        }
        fs::write(&path, text).unwrap();
        let (status, report, error) = check(folder.path());
        assert!(status == 0 && self::failed(&report).is_empty(), "{error}");
    }
    // Started together and stopped one after the other: nothing is late.
    let folder = started_by_hand([LONG, 50, 44, LONG, 55].map(|to| [0, to]));
    let (status, report, error) = check(folder.path());
    assert!(status == 0 && failed(&report).is_empty(), "{error}");
    let said = report["checks"].to_string();
    assert!(said.contains("44 are taken, those of all") && said.contains("look for the delay"), "{said}");
}

#[test]
fn what_failed_comes_first_and_what_is_well_is_a_line() {
    let folder = cut(8);
    let out = stdout(&pantin(&["check", folder.path().to_str().unwrap()]));
    let lines: Vec<&str> = out.lines().collect();
    assert!(lines[1].starts_with("FAILED timing c2: ") && lines[1].contains("frames early"), "{out}");
    let last = lines[lines.len() - 1];
    assert!(
        last.starts_with("ok     files, repeated pictures (5), distortion (5)") && last.contains("timing (4)"),
        "{out}"
    );
    assert!(lines.len() < 8 && out.matches("\nok ").count() == 1, "{out}");
    let sane = sequence(&cameras(), None);
    let all = stdout(&pantin(&["check", sane.path().to_str().unwrap(), "--all"]));
    assert!(all.lines().count() > 30 && all.contains("ok     direction c0: "), "{all}");
}

/// A sequence in which the pictures of c3 were put another way.
fn put(way: impl Fn(&GrayImage) -> GrayImage, orientation: &str) -> tempfile::TempDir {
    let folder = sequence(&cameras(), None);
    put_view(folder.path(), "c3", way, orientation);
    folder
}

/// Puts the pictures of a view another way.
fn put_view(folder: &Path, view: &str, way: impl Fn(&GrayImage) -> GrayImage, orientation: &str) {
    for frame in 0..FRAMES {
        let name = format!("{view}_{frame:03}.png");
        way(&image::open(masks().join(&name)).unwrap().to_luma8()).save(folder.join(name)).unwrap();
    }
    let path = folder.join("sequence.toml");
    let text = fs::read_to_string(&path).unwrap();
    let [from, to] = [masks(), folder].map(|at| at.join(format!("{view}_")).to_str().unwrap().to_string());
    let camera = format!("camera = \"{view}\"\n");
    fs::write(path, text.replace(&from, &to).replace(&camera, &format!("{camera}{orientation}\n"))).unwrap();
}

/// A ray misses one as long as the other is not put right, so they are found together or not at all.
#[test]
fn two_turned_pictures_are_named_together() {
    use image::imageops::{flip_horizontal, rotate180};
    let folder = sequence(&cameras(), None);
    put_view(folder.path(), "c1", rotate180, "");
    put_view(folder.path(), "c4", flip_horizontal, "");
    let (status, report, error) = check(folder.path());
    let failed = failed(&report);
    let named: Vec<&String> = failed.iter().filter(|check| check.starts_with("orientation")).collect();
    assert!(status == 1 && named == ["orientation c1", "orientation c4"], "{failed:?} {error}");
    let said = |camera: &str| finding(&report, "orientation", camera)["advice"].as_str().unwrap().to_string();
    assert!(said("c1").contains("write `orientation = 180`"), "{}", said("c1"));
    assert!(said("c4").contains("write `orientation = \"mirrored\"`"), "{}", said("c4"));
    assert!(failed.iter().all(|check| !check.starts_with("direction") && !check.starts_with("timing")), "{failed:?}");
    let path = folder.path().join("sequence.toml");
    let text = fs::read_to_string(&path).unwrap();
    let text = text.replace("camera = \"c1\"\n", "camera = \"c1\"\norientation = 180\n");
    fs::write(&path, text.replace("camera = \"c4\"\n", "camera = \"c4\"\norientation = \"mirrored\"\n")).unwrap();
    let (status, report, error) = check(folder.path());
    assert!(status == 0 && self::failed(&report).is_empty(), "{error}");
}

#[test]
fn pictures_upside_down_or_mirrored_are_named_and_put_right() {
    use image::imageops::{flip_horizontal, rotate90, rotate180};
    type Way = fn(&GrayImage) -> GrayImage;
    let ways: [(Way, &str, &str); 2] = [
        (rotate180, "turned by 180 degrees", "orientation = 180"),
        (flip_horizontal, "mirrored", "orientation = \"mirrored\""),
    ];
    for (way, how, key) in ways {
        let folder = put(way, "");
        let (status, report, error) = check(folder.path());
        let failed = failed(&report);
        assert!(status == 1 && failed.contains(&"orientation c3".to_string()), "{how}: {failed:?} {error}");
        assert!(
            failed.iter().all(|check| !check.starts_with("direction") && !check.starts_with("timing")),
            "{failed:?}"
        );
        let advice = finding(&report, "orientation", "c3")["advice"].as_str().unwrap();
        let said = format!("c3 agrees with the others when its picture is {how}: write `{key}` into its [[view]]");
        assert!(advice.contains(&said), "{advice}");
        let (status, report, error) = check(put(way, key).path());
        assert!(status == 0 && self::failed(&report).is_empty(), "{how}: {error}");
    }
    // A quarter turn changes the sides.
    let (_, report, _) = check(put(rotate90, "").path());
    let found = report["checks"][0]["found"].as_str().unwrap();
    assert!(found.contains("calibrated for 320x400 (turned by 90 degrees it would fit"), "{found}");
    let (status, _, error) = check(put(rotate90, "orientation = 270").path());
    assert_eq!(status, 0, "{error}");
    let (_, report, _) = check(put(rotate180, "orientation = 45").path());
    let found = report["checks"][0]["found"].as_str().unwrap();
    assert!(found.contains("unknown orientation `45`"), "{found}");
}

#[test]
fn exchanged_cameras_are_caught_and_named() {
    let mut cameras = cameras();
    let names = [cameras[1].name.clone(), cameras[3].name.clone()];
    cameras.swap(1, 3);
    [cameras[1].name, cameras[3].name] = names;
    let (failed, report) = fails(&cameras, None);
    assert!(failed.contains(&"order of the cameras".to_string()), "{failed:?}");
    let advice = finding(&report, "order of the cameras", "")["advice"].as_str().unwrap().to_string();
    assert!(advice.contains("c1 and c3"), "{advice}");
}

#[test]
fn worlds_upside_down_or_on_their_side_are_caught() {
    let (failed, report) = fails(&moved(DAffine3::from_mat3(DMat3::from_rotation_x(std::f64::consts::PI))), None);
    assert!(failed.contains(&"up axis".to_string()) && failed.contains(&"feet".to_string()), "{failed:?}");
    let advice = finding(&report, "feet", "")["advice"].as_str().unwrap();
    assert!(advice.contains("turn the calibration's world over"), "{advice}");
    // The world of programs with y upwards.
    let (failed, report) =
        fails(&moved(DAffine3::from_mat3(DMat3::from_rotation_x(-0.5 * std::f64::consts::PI))), None);
    assert!(failed.contains(&"up axis".to_string()), "{failed:?}");
    let advice = finding(&report, "up axis", "")["advice"].as_str().unwrap();
    assert!(advice.contains("world has y upwards"), "{advice}");
    // The floor a metre too low.
    let (failed, _) = fails(&moved(DAffine3::from_translation(DVec3::new(0.0, 0.0, 1000.0))), None);
    assert_eq!(failed, ["feet"]);
}

#[test]
fn wrong_units_are_caught() {
    // Centimetres taken for millimetres pass the reader of calibrations: no camera is absurdly near.
    let cameras: Vec<Camera> = cameras()
        .into_iter()
        .map(|mut camera| {
            camera.camera_from_world.translation /= 10.0;
            camera
        })
        .collect();
    let (failed, report) = fails(&cameras, None);
    assert!(failed.contains(&"height".to_string()), "{failed:?}");
    let advice = finding(&report, "height", "")["advice"].as_str().unwrap();
    assert!(advice.contains("look like centimetres"), "{advice}");
}

#[test]
fn metres_for_millimetres_are_caught() {
    for (wrong, expected) in [("units = \"m\"", "wrong units"), ("", "the file states no units and metres are assumed")]
    {
        let folder = sequence(&cameras(), None);
        let path = folder.path().join("cameras.toml");
        let text = fs::read_to_string(&path).unwrap().replace("units = \"mm\"", wrong);
        fs::write(path, text).unwrap();
        let (status, report, error) = check(folder.path());
        assert_eq!((status, failed(&report)), (1, vec!["files".to_string()]), "{error}");
        let found = report["checks"][0]["found"].as_str().unwrap().to_string();
        assert!(found.contains(expected), "{found}");
    }
}

#[test]
fn mirrored_pictures_are_caught() {
    let folder = sequence(&cameras(), None);
    let manifest = folder.path().join("sequence.toml");
    for camera in cameras() {
        for frame in 0..FRAMES {
            let name = format!("{}_{frame:03}.png", camera.name);
            let mask = image::open(masks().join(&name)).unwrap().to_luma8();
            image::imageops::flip_horizontal(&mask).save(folder.path().join(name)).unwrap();
        }
    }
    let text = fs::read_to_string(&manifest).unwrap();
    fs::write(&manifest, text.replace(masks().to_str().unwrap(), folder.path().to_str().unwrap())).unwrap();
    let (status, report, _) = check(folder.path());
    assert!(status == 1 && failed(&report).contains(&"handedness".to_string()), "{:?}", failed(&report));
}

#[test]
fn a_wrong_lens_and_too_few_frames_are_said() {
    let mut cameras = cameras();
    cameras[0].lens = scene::brown(520.0, SIZE, [-3.0, 0.0, 0.0], [0.0; 2]);
    let (failed, report) = fails(&cameras, None);
    assert!(failed.contains(&"distortion c0".to_string()), "{failed:?}");
    assert!(finding(&report, "distortion", "c0")["found"].as_str().unwrap().contains("past the end"), "{report:#}");
    let folder = sequence(&self::cameras(), None);
    let run = |arguments: &[&str]| {
        let output = pantin(&[&["check", folder.path().to_str().unwrap()], arguments].concat());
        (output.status.code().unwrap(), stdout(&output), stderr(&output))
    };
    let (status, out, error) = run(&["--frames", "3..5"]);
    assert!(
        status == 0 && out.contains("-      timing c0 c1 c2 c3 c4: ") && out.contains("no three neighbours"),
        "{out}{error}"
    );
    let (status, _, error) = run(&["--frames", "3..50"]);
    assert!(status == 1 && error.contains("frames 3..50 are no frames of"), "{error}");
    let (_, _, error) = run(&["--frames", "4..5", "--samples", "1"]);
    assert!(!error.contains("checks failed") || error.contains(folder.path().to_str().unwrap()), "{error}");
    refused(
        &pantin(&["check", "nowhere"]),
        &["nowhere: 1 of 1 checks failed", "the first is `files`: cannot read nowhere"],
    );
}

/// The beam's two calibrations: what came with the recording differs by 0.3 to 0.7 degrees from what was refined on
/// static points.
#[test]
fn the_calibrations_of_the_beam_are_told_apart() {
    let name = "the_calibrations_of_the_beam_are_told_apart";
    let Some(data) = shared(name, "beam").filter(|_| has_ffmpeg(name)) else { return };
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    lay_out_beam(&data, at);
    let refined = pantin::sequence::read_cameras(&at.join("cameras.toml")).unwrap();
    let (status, report, error) = check(at);
    assert_eq!((status, failed(&report)), (0, vec![]), "{error}");
    // The original's extrinsics; two of its videos were cut since, so that its intrinsics are not theirs.
    let original = pantin::sequence::read_cameras(&data.join("Calib_original.qca.txt")).unwrap();
    let both: Vec<Camera> = refined
        .iter()
        .map(|refined| {
            let original = original.iter().find(|camera| camera.name == refined.name).unwrap();
            Camera { camera_from_world: original.camera_from_world, ..refined.clone() }
        })
        .collect();
    write_cameras_toml(&at.join("cameras.toml"), &both, Overwrite::Replace).unwrap();
    let (status, report, _) = check(at);
    assert_eq!(status, 1);
    let failed = failed(&report);
    for (original, refined) in both.iter().zip(&refined) {
        let between = refined.camera_from_world.matrix3 * original.camera_from_world.matrix3.transpose();
        let turn = pantin::geometry::rodrigues_vector(between).truncate().length().to_degrees();
        let measured = finding(&report, "direction", &refined.name)["value"].as_f64().unwrap();
        println!("{}: {turn:.3} degrees apart, measured {measured:.3}", refined.name);
        assert!(failed.contains(&format!("direction {}", refined.name)), "{failed:?}");
        assert!((turn - measured).abs() < 0.1, "{turn} {measured}");
    }
}
