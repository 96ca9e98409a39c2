//! Whatever looks at a sequence takes body parts by name from it: the example of docs/FEATURES.md through every command.

use std::fs;
use std::path::Path;

use glam::DVec3;
use image::{GrayImage, Luma, Rgb, RgbImage};
use pantin::body::{Body, PoseTable};
use pantin::evaluate::Reference;
use pantin::files::Overwrite;
use pantin::geometry::Camera;
use pantin::sequence::write_cameras_toml;

use super::{scene, support};

const SIZE: [u32; 2] = [160, 200];
const FRAMES: usize = 4;

/// The settings of the document, as they stand there.
fn example() -> &'static str {
    let text = include_str!("../../docs/FEATURES.md");
    let start = text.find("```toml\n[[features.segment]]").unwrap() + "```toml\n".len();
    &text[start..start + text[start..].find("```").unwrap()]
}

fn cameras() -> Vec<Camera> {
    let camera = |(index, degrees): (usize, f64)| {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let lens = scene::brown(260.0, SIZE, [0.0; 3], [0.0; 2]);
        let eye = DVec3::new(4200.0 * cos, 4200.0 * sin, 1400.0);
        scene::camera(&format!("c{index}"), SIZE, eye, DVec3::new(0.0, 0.0, 900.0), lens)
    };
    [15.0, 130.0, 250.0].into_iter().enumerate().map(camera).collect()
}

/// A person with a bare head, a blue shirt and grey trousers who stands still.
fn write_sequence(folder: &Path) {
    let (body, cameras) = (Body::adult(1750.0).unwrap(), cameras());
    let pose = body.standing_pose();
    fs::write(folder.join("body.toml"), body.to_toml()).unwrap();
    write_cameras_toml(&folder.join("cameras.toml"), &cameras, Overwrite::Refuse).unwrap();
    let start = PoseTable { frames: vec![0], poses: vec![pose.clone()] };
    start.write(&folder.join("start.csv"), Overwrite::Refuse, &body).unwrap();
    let colour = |label: u8| match body.parts.iter().find(|part| part.label == label).map(|part| part.name.as_str()) {
        None => [20, 90, 20],
        Some("head" | "neck") => [200, 140, 110],
        Some("chest" | "belly") => [30, 60, 160],
        Some(_) => [120, 120, 120],
    };
    let reference = Reference::new(&body, &cameras);
    let pose: Vec<f32> = pose.into_iter().map(|value| value as f32).collect();
    let mut manifest = "name = \"parts\"\nfps = 25.0\ncameras = \"cameras.toml\"\nbody = \"body.toml\"\n\
                        start = \"start.csv\"\n"
        .to_string();
    for (view, Camera { name, .. }) in cameras.iter().enumerate() {
        let drawn = reference.draw(&pose, view);
        let label = |x: u32, y: u32| drawn.bytes[(y * drawn.width + x) as usize] & 0x7f;
        let mask = GrayImage::from_fn(SIZE[0], SIZE[1], |x, y| Luma([if label(x, y) > 0 { 255 } else { 0 }]));
        let picture = RgbImage::from_fn(SIZE[0], SIZE[1], |x, y| Rgb(colour(label(x, y))));
        for frame in 0..FRAMES {
            mask.save(folder.join(format!("mask_{name}_{frame:02}.png"))).unwrap();
            picture.save(folder.join(format!("{name}_{frame:02}.png"))).unwrap();
        }
        manifest +=
            &format!("[[view]]\ncamera = \"{name}\"\nsource = \"{name}_%02d.png\"\nmask = \"mask_{name}_%02d.png\"\n");
    }
    fs::write(folder.join("sequence.toml"), manifest + example()).unwrap();
}

/// What a command prints; it must not fail but as its checks say.
fn pantin(folder: &Path, arguments: &[&str]) -> String {
    let (status, output, messages) = support::pantin_in(folder, arguments);
    assert!(status == 0 || messages.contains("checks failed"), "{arguments:?}: {messages}");
    output
}

#[test]
fn parts_are_taken_by_name_in_every_command() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    write_sequence(folder);

    pantin(folder, &["features", "sequence.toml", "--frames", "0..1", "-o", "features"]);
    let segments = image::open(folder.join("features/c0/segments_000000.png")).unwrap().to_rgb8();
    let shown = |colour: [u8; 3]| segments.pixels().filter(|pixel| pixel.0 == colour).count();
    let (head, shirt) = (shown([230, 159, 0]), shown([86, 180, 233]));
    assert!(head > 50 && shirt > 300, "{head} pixels of head, {shirt} of shirt");

    pantin(folder, &["evaluate", "--sequence", ".", "--frame", "0", "--poses", "start.csv", "-o", "evaluated"]);
    let table = fs::read_to_string(folder.join("evaluated/segments.csv")).unwrap();
    // The pose is the person's own, so each segment that is seen is covered.
    for (row, name, seen) in [(1, "head", head), (2, "shirt", shirt)] {
        let cells: Vec<&str> = table.lines().nth(row).unwrap().split(',').collect();
        assert_eq!(cells[..4], ["0", "c0", name, &seen.to_string()], "{table}");
        assert!(cells[5].parse::<usize>().unwrap() * 10 > seen * 9, "{table}");
    }

    let few = ["--particles", "16", "--iterations", "2"];
    let track = ["track", ".", "--backend", "cpu", "--overlay-every", "0"];
    pantin(folder, &[&track[..], &few, &["-o", "tracked"]].concat());
    assert_eq!(fs::read_to_string(folder.join("tracked/poses.csv")).unwrap().lines().count(), 1 + FRAMES);
    pantin(folder, &[&track[..], &few, &["--realtime", "-o", "realtime"]].concat());
    assert!(fs::read_to_string(folder.join("realtime/poses.csv")).unwrap().lines().count() > 1);

    let fitted = ["fit", ".", "--height", "1750", "--start", "start.csv", "-o", "fitted.toml"];
    pantin(folder, &[&fitted[..], &few].concat());
    Body::load(&folder.join("fitted.toml")).unwrap();

    let report: serde_json::Value =
        serde_json::from_str(&pantin(folder, &["check", ".", "--samples", "1", "--json"])).unwrap();
    let checks = report["checks"].as_array().unwrap();
    let seen = checks.iter().filter(|check| check["check"] == "silhouettes" && check["value"] == 100.0);
    assert_eq!(seen.count(), 3, "{report:#}");
}

/// The fitness by hand from what segments.csv and components.csv have of the first pose.
fn fitness_by_hand(folder: &Path) -> f64 {
    let table = |name: &str| fs::read_to_string(folder.join(name)).unwrap();
    let (components, segments) = (table("components.csv"), table("segments.csv"));
    assert_eq!(segments.lines().next().unwrap(), "pose,view,segment,area_obs,area_model,overlap,edges,proximity");
    let sums = |rows: &str, name: &str, first: usize| {
        let mut sums = [0.0; 5];
        for row in rows.lines().filter(|row| row.starts_with("0,") && row.contains(name)) {
            for (sum, cell) in sums.iter_mut().zip(row.split(',').skip(first)) {
                *sum += cell.parse::<f64>().unwrap();
            }
        }
        sums
    };
    let (mut f1, mut f2) = (0.0, 0.0);
    for (name, weight) in [("head", 0.4), ("shirt", 0.6)] {
        let [area_obs, area_model, overlap, edges, proximity] = sums(&segments, name, 3);
        assert!(edges > 20.0 && proximity > 0.0, "{segments}");
        f1 += weight * (overlap / area_obs + overlap / area_model) / 2.0;
        f2 += weight * proximity / (127.0 * edges);
    }
    let [.., edges, proximity] = sums(&components, "", 2);
    assert!((f2 - proximity / (127.0 * edges)).abs() > 1e-3, "all edges together would do too");
    (f1 * f2).sqrt()
}

#[test]
fn edges_go_by_segments_where_that_is_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    write_sequence(folder);
    let evaluate = ["evaluate", "--sequence", ".", "--frame", "0", "--poses", "start.csv"];
    let fitness = |name: &str, more: &[&str]| -> f64 {
        pantin(folder, &[&evaluate[..], more, &["-o", name]].concat());
        let table = fs::read_to_string(folder.join(name).join("fitness.csv")).unwrap();
        table.lines().nth(1).unwrap().split_once(',').unwrap().1.parse().unwrap()
    };
    let whole = fitness("whole", &[]);
    let by_segments = fitness("by_segments", &["--edges", "segments"]);
    let expected = fitness_by_hand(&folder.join("by_segments"));
    assert!((by_segments - expected).abs() < 1e-5, "{by_segments} is not {expected}");
    assert!((by_segments - whole).abs() > 1e-4, "{whole} either way");
    let header = fs::read_to_string(folder.join("whole/segments.csv")).unwrap();
    assert!(header.starts_with("pose,view,segment,area_obs,area_model,overlap\n"), "{header}");

    // The sequence's own table, from which a flag leads back; run.toml says what was taken where it is not as usual.
    let manifest = fs::read_to_string(folder.join("sequence.toml")).unwrap();
    fs::write(folder.join("sequence.toml"), format!("{manifest}\n[objective]\nedges = \"segments\"\n")).unwrap();
    assert_eq!(fitness("of_the_table", &[]), by_segments);
    assert_eq!(fitness("and_back", &["--edges", "whole"]), whole);
    let track = ["track", ".", "--backend", "cpu", "--overlay-every", "0", "--particles", "8", "--iterations", "1"];
    let record = |name: &str, more: &[&str]| {
        pantin(folder, &[&track[..], more, &["-o", name]].concat());
        fs::read_to_string(folder.join(name).join("run.toml")).unwrap()
    };
    let found = record("tracked", &[]);
    assert!(found.contains("edges = \"segments\"") && found.contains(" --edges segments --backend"), "{found}");
    let found = record("tracked_whole", &["--edges", "whole"]);
    assert!(!found.contains("edges = \"whole\"") && !found.contains("--edges"), "{found}");

    // What takes no segments, or has none, says so.
    let refused = |command: &[&str], name: &str, reason: &str| {
        let more = ["-o", name, "--edges", "segments"];
        let (status, _, messages) = support::pantin_in(folder, &[command, &more].concat());
        assert!(status != 0 && messages.contains(reason), "{messages}");
    };
    let by = |objective| [&track[..], &["--objective", objective]].concat();
    refused(&by("evidence"), "beside_evidence", "do not count in the objective evidence");
    let (without, _) = manifest.split_once("[[features.segment]]").unwrap();
    fs::write(folder.join("sequence.toml"), without).unwrap();
    let reason = "no [[features.segment]] tells body parts apart";
    refused(&by("sp"), "without", reason);
    refused(&evaluate, "none", reason);
    assert!(!folder.join("none").exists());
}
