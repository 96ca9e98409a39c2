//! Things in the way: what a view ignores counts neither for nor against the person, whoever looks at the sequence.

use std::fs;
use std::path::Path;

use image::{GrayImage, Luma, Rgb};
use pantin::body::{Body, PoseTable};

use super::support::{pantin, stdout, succeeded};
use super::{drawn, walk};

const FRAMES: usize = 10;

/// A man who strides on the spot, his legs hidden from two of four cameras by a block that stands there.
fn write(folder: &Path) {
    let body = Body::adult(1750.0).unwrap();
    let names = body.dof_names();
    let index = |name: &str| names.iter().position(|dof| dof == name).unwrap();
    let pose = |frame: usize| {
        let phase = 0.35 * frame as f64;
        let mut pose = body.standing_pose();
        for (side, sign) in [("left", 1.0), ("right", -1.0)] {
            pose[index(&format!("{side}_hip.ry"))] += 0.55 * sign * phase.sin();
            pose[index(&format!("{side}_knee.ry"))] += 0.45 * (1.0 + sign * phase.cos()) / 2.0;
            pose[index(&format!("{side}_shoulder.ry"))] -= 0.4 * sign * phase.sin();
        }
        body.clamp_to_limits(&mut pose);
        pose
    };
    let table = PoseTable { frames: (0..FRAMES).collect(), poses: (0..FRAMES).map(pose).collect() };
    drawn::write(folder, "hidden", &body, &walk::cameras(), &table);
    let block = |x: u32, y: u32| (30..130).contains(&x) && y >= 72;
    for camera in ["cam0", "cam2"] {
        for frame in 0..FRAMES {
            let [picture, mask] =
                ["", "_mask"].map(|kind| folder.join(format!("frames/{camera}{kind}_{frame:04}.png")));
            let mut seen = image::open(&picture).unwrap().to_rgb8();
            let mut silhouette = image::open(&mask).unwrap().to_luma8();
            for (x, y, pixel) in seen.enumerate_pixels_mut().filter(|(x, y, _)| block(*x, *y)) {
                *pixel = Rgb([120, 70 + (x / 9 + y / 7) as u8 % 2 * 60, 30]);
                silhouette.put_pixel(x, y, Luma([0]));
            }
            seen.save(&picture).unwrap();
            silhouette.save(&mask).unwrap();
        }
    }
    GrayImage::from_fn(160, 120, |x, y| Luma([if block(x, y) { 255 } else { 0 }]))
        .save(folder.join("block.png"))
        .unwrap();
    let manifest = fs::read_to_string(folder.join("sequence.toml")).unwrap();
    let with_mask = |name: &str, ignore: &str| {
        let view = |manifest: String, camera: &str| {
            let key = format!("camera = \"{camera}\"\n");
            manifest.replace(&key, &format!("{key}ignore = \"{ignore}\"\n"))
        };
        let manifest = ["cam0", "cam2"].into_iter().fold(manifest.clone(), view);
        fs::write(folder.join(name), manifest).unwrap();
    };
    with_mask("ignoring.toml", "block.png");
    with_mask("everywhere.toml", "white.png");
    GrayImage::from_pixel(160, 120, Luma([255])).save(folder.join("white.png")).unwrap();
}

/// The error that a track reports, mm.
fn error(folder: &Path, manifest: &str, objective: &str) -> f64 {
    let (sequence, output) = (folder.join(manifest), folder.join(format!("{manifest}_{objective}")));
    let run = pantin(&[
        "track",
        sequence.to_str().unwrap(),
        "-o",
        output.to_str().unwrap(),
        "--objective",
        objective,
        "--particles",
        "100",
        "--iterations",
        "10",
        "--overlay-every",
        "0",
        "--backend",
        "cpu",
        "--passes",
        "forward",
    ]);
    succeeded(&run);
    let text = stdout(&run);
    let after = text.split("error ").nth(1).unwrap_or_else(|| panic!("{text}"));
    after.split_whitespace().next().unwrap().parse().unwrap()
}

#[test]
fn legs_behind_a_block_are_followed_where_the_block_is_ignored() {
    let folder = tempfile::tempdir().unwrap();
    write(folder.path());
    for objective in ["sp", "evidence"] {
        let [without, with] = ["sequence.toml", "ignoring.toml"].map(|name| error(folder.path(), name, objective));
        println!("{objective}: {without} mm, {with} mm with the block ignored");
        assert!(with < 0.5 * without, "{objective}: {with} mm with the block ignored, {without} mm without");
    }
    let at = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    // Poses are scored by the same pixels, in real time too.
    let poses = at("start.csv");
    for (manifest, is_seen) in [("ignoring.toml", true), ("everywhere.toml", false)] {
        let output = at(&format!("{manifest}_scored"));
        let scored = ["evaluate", "--sequence", &at(manifest), "--frame", "0", "--poses", &poses, "-o", &output];
        succeeded(&pantin(&scored));
        let table = fs::read_to_string(Path::new(&output).join("components.csv")).unwrap();
        let cam0 = table.lines().find(|line| line.starts_with("0,cam0")).unwrap();
        assert_eq!(cam0 != "0,cam0,0,0,0,0,0", is_seen, "{cam0}");
    }
    let live = at("live");
    let arguments =
        ["track", &at("ignoring.toml"), "-o", &live, "--realtime", "--particles", "30", "--iterations", "3"];
    succeeded(&pantin(&[&arguments[..], &["--overlay-every", "0"]].concat()));
    // The cut through the legs is no border of the person.
    let border = |manifest: &str| {
        let checked = pantin(&["check", &at(manifest), "--samples", "2", "--json"]);
        let report: serde_json::Value = serde_json::from_str(&stdout(&checked)).unwrap();
        let explained = |camera: &str| {
            let found = report["checks"].as_array().unwrap().iter();
            let mut found = found.filter(|finding| finding["check"] == "hull coverage" && finding["camera"] == camera);
            found.next().unwrap_or_else(|| panic!("{report:#}"))["value"].as_f64().unwrap()
        };
        println!("{manifest}: sane {}", report["sane"]);
        ["cam1", "cam3"].map(explained)
    };
    let [without, with] = ["sequence.toml", "ignoring.toml"].map(border);
    assert!(with[0] > without[0] && with[1] > without[1], "{with:?} {without:?}");
}
