//! `pantin score` and `pantin convert` as a user runs them.

use std::fs;
use std::ops::Range;
use std::path::{Path, PathBuf};

use glam::DVec3;
use pantin::body::{Body, PoseTable};
use pantin::files::Overwrite;
use pantin::motion::{PointTrajectory, read_points, write_points};

use super::support::{pantin_in as pantin, refused_in as refused, shared};

fn points(names: &[&str], frames: usize, offset: DVec3) -> PointTrajectory {
    PointTrajectory {
        names: names.iter().map(|name| (*name).to_string()).collect(),
        rate: 25.0,
        first_frame: 0,
        frames: (0..frames)
            .map(|i| (0..names.len()).map(|j| Some(DVec3::new(i as f64, j as f64, 0.0) + offset)).collect())
            .collect(),
        smoothed: None,
    }
}

/// A folder with a truth and a track that is off by (3, 4, 0) mm.
fn track() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let write =
        |file: &str, points: &PointTrajectory| write_points(&folder.path().join(file), points, Overwrite::Refuse);
    fs::create_dir(folder.path().join("out")).unwrap();
    let offset = DVec3::new(3.0, 4.0, 0.0);
    write("out/markers.c3d", &points(&["LKNE", "RKNE"], 10, offset)).unwrap();
    write("out/joints.csv", &points(&["left_knee", "left_hip"], 10, offset)).unwrap();
    write("markers.trc", &points(&["LKNE", "RKNE", "HEAD"], 8, DVec3::ZERO)).unwrap();
    write("joints.csv", &points(&["LKnee", "LHip"], 10, DVec3::ZERO)).unwrap();
    folder
}

#[test]
fn markers_come_before_joints() {
    let folder = track();
    let (status, out, error) = pantin(folder.path(), &["score", "out", "--truth", "markers.trc", "--remove-offset"]);
    assert_eq!(status, 0, "{error}");
    assert!(out.contains("markers.c3d against markers.trc"), "{out}");
    assert!(out.contains("error 5.00 ± 0.00 mm over 2 points"), "{out}");
    assert!(out.contains("error 0.00 ± 0.00 mm without"), "{out}");
    assert!(out.contains("not in the track (1): HEAD"), "{out}");
    assert!(out.contains("2 frames of the track lie outside the truth"), "{out}");
}

#[test]
fn joints_by_a_map_as_json_and_frame_by_frame() {
    let folder = track();
    let mut arguments = vec!["score", "out", "--truth", "joints.csv", "--json", "--per-frame", "frames.csv"];
    arguments.extend(["--map", "LKnee=left_knee", "LHip=left_hip", "--exclude", "hips"]);
    let (status, out, error) = pantin(folder.path(), &arguments);
    assert_eq!(status, 0, "{error}");
    let object: serde_json::Value = serde_json::from_str(&out).unwrap();
    assert_eq!((&object["mean"], &object["frames"], &object["matched_by"]), (&5.0.into(), &10.into(), &"frame".into()));
    assert_eq!(object["points"][0]["ours"], "left_knee");
    assert_eq!(object["points"].as_array().unwrap().len(), 1);
    let table = fs::read_to_string(folder.path().join("frames.csv")).unwrap();
    assert!(table.starts_with("frame,mean,LKnee\n0,5.0000,5.0000\n") && table.lines().count() == 11, "{table}");
    refused(folder.path(), &arguments, "frames.csv exists already");
}

#[test]
fn score_refuses_in_one_sentence() {
    let folder = track();
    let at = folder.path();
    let markers = "out/markers.c3d";
    let (truth, none) = ("joints.csv", "the truth has `LKnee`, `LHip`, the track has `LKNE`, `RKNE`");
    refused(at, &["score", markers, "--truth", truth], none);
    refused(at, &["score", "out", "--truth", "none.trc"], "cannot read none.trc");
    refused(at, &["score", "none", "--truth", "joints.csv"], "there is no file none");
    fs::create_dir(at.join("empty")).unwrap();
    refused(at, &["score", "empty", "--truth", "joints.csv"], "neither markers.c3d nor joints.csv");
    refused(at, &["score", "out", "--truth", "markers.trc", "--points", "HIP"], "no point `HIP` to compare");
    let (status, _, error) = pantin(at, &["score", "out", "--truth", "joints.csv", "--map", "LKnee"]);
    assert!(status == 2 && error.contains("\"LKnee\" is no pair, expected two names with `=`"), "{error}");
}

#[test]
fn joints_of_other_programs_and_another_clock_are_compared() {
    let folder = track();
    let (status, out, error) = pantin(folder.path(), &["score", "out", "--truth", "joints.csv"]);
    assert!(status == 0 && out.contains("LKnee = left_knee") && out.contains("over 2 points"), "{out}{error}");
    // A swing whose truth was recorded 0.2 s late, at another rate.
    let swing = |rate: f64, late: f64, frames: usize| {
        let mut swing = PointTrajectory { rate, ..points(&["RKnee"], frames, DVec3::ZERO) };
        for (row, points) in swing.frames.iter_mut().enumerate() {
            points.fill(Some(DVec3::new(400.0 * (4.0 * (row as f64 / rate - late)).sin(), 0.0, 500.0)));
        }
        swing
    };
    let at = |name: &str| folder.path().join(name);
    write_points(&at("truth.trc"), &swing(100.0, 0.2, 400), Overwrite::Refuse).unwrap();
    let ours = PointTrajectory { names: vec!["right_knee".into()], ..swing(25.0, 0.0, 75) };
    write_points(&at("ours.csv"), &ours, Overwrite::Refuse).unwrap();
    let score = |more: &[&str]| {
        let all = [&["score", "ours.csv", "--truth", "truth.trc", "--json"], more].concat();
        let (status, out, error) = pantin(folder.path(), &all);
        assert_eq!(status, 0, "{error}");
        serde_json::from_str::<serde_json::Value>(&out).unwrap()
    };
    let plain = score(&[]);
    assert!(plain["mean"].as_f64().unwrap() > 100.0 && plain.get("shift").is_none(), "{plain}");
    assert!(score(&["--shift", "0.2"])["mean"].as_f64().unwrap() < 0.5);
    let found = score(&["--shift", "auto"]);
    assert!((found["shift"].as_f64().unwrap() - 0.2).abs() < 0.002, "{found}");
    assert!(found["mean"].as_f64().unwrap() < 2.0, "{found}");
    let (_, out, _) = pantin(folder.path(), &["score", "ours.csv", "--truth", "truth.trc", "--shift", "0.2"]);
    assert!(out.contains("the truth taken 0.2000 s later (--shift 0.2000)"), "{out}");
    let (status, _, error) = pantin(folder.path(), &["score", "ours.csv", "--truth", "truth.trc", "--shift", "nan"]);
    assert!(status == 2 && error.contains("expected `auto` or seconds"), "{error}");
}

const BVH: &str = "HIERARCHY\nROOT hip\n{\n OFFSET 0 0 0\n CHANNELS 3 Xposition Yposition Zposition\n End Site\n {\n  OFFSET 0 10 0\n }\n}\n\
    MOTION\nFrames: 2\nFrame Time: 0.01\n1 2 3\n4 5 6\n";

#[test]
fn what_a_file_leaves_open_is_noted() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let truth = PointTrajectory { first_frame: 100, ..points(&["hip"], 5, DVec3::ZERO) };
    write_points(&at("truth.trc"), &truth, Overwrite::Refuse).unwrap();
    let head =
        "HIERARCHY\nROOT hip\n{\nOFFSET 0 0 0\nCHANNELS 3 Xposition Yposition Zposition\n}\nMOTION\nFrames: 105\n";
    fs::write(at("walk.bvh"), format!("{head}Frame Time: 0.04\n{}", "0 0 0\n".repeat(105))).unwrap();
    let (status, _, error) = pantin(folder.path(), &["score", "walk.bvh", "--truth", "truth.trc"]);
    let note = "note: walk.bvh is taken to begin at frame 0, and what it is compared with at frame 100\n";
    assert_eq!((status, error.as_str()), (0, note));

    write_points(&at("m.c3d"), &points(&["LKNE", "RKNE"], 5, DVec3::ZERO), Overwrite::Refuse).unwrap();
    let mut bytes = fs::read(at("m.c3d")).unwrap();
    let label = bytes.windows(4).position(|window| window == b"RKNE").unwrap();
    bytes[label] = b'L';
    fs::write(at("m.c3d"), bytes).unwrap();
    let (status, _, error) = pantin(folder.path(), &["convert", "m.c3d", "m.csv"]);
    assert_eq!(status, 0, "{error}");
    assert!(
        error.starts_with("note: m.c3d: labels that stand several times were numbered") && error.lines().count() == 1
    );
    assert_eq!(read_points(&at("m.csv")).unwrap().names, ["LKNE", "LKNE#2"]);
}

#[test]
fn a_recording_goes_round_all_formats() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    fs::write(at.join("a.bvh"), BVH).unwrap();
    for pair in [["a.bvh", "b.csv"], ["b.csv", "c.trc"], ["c.trc", "d.c3d"], ["d.c3d", "e.csv"]] {
        let mut arguments = vec!["convert", pair[0], pair[1]];
        if pair[0] == "a.bvh" {
            arguments.extend(["--scale", "10", "--y-up"]);
        }
        let (status, out, error) = pantin(at, &arguments);
        assert!(status == 0 && out.contains("2 points, 2 frames"), "{out}{error}");
    }
    assert_eq!(fs::read(at.join("b.csv")).unwrap(), fs::read(at.join("e.csv")).unwrap());
    let points = read_points(&at.join("e.csv")).unwrap();
    assert_eq!((points.names.join(" "), points.rate), ("hip hip_end".into(), 100.0));
    assert_eq!(points.frames[0][1], Some(DVec3::new(30.0, 10.0, 120.0)), "z up, mm");

    let (status, _, error) = pantin(at, &["convert", "e.csv", "os.trc", "--convention", "opensim"]);
    assert_eq!(status, 0, "{error}");
    let text = fs::read_to_string(at.join("os.trc")).unwrap();
    assert!(text.contains("\tm\t") && text.contains("\n1\t0.000000\t0.0100000\t0.0200000\t0.0300000\t"), "{text}");
    let (status, _, error) = pantin(at, &["convert", "os.trc", "back.csv", "--y-up"]);
    assert_eq!(status, 0, "{error}");
    assert_eq!(fs::read(at.join("back.csv")).unwrap(), fs::read(at.join("e.csv")).unwrap());

    let (status, _, error) = pantin(at, &["convert", "a.bvh", "f.bvh", "--scale", "10", "--rate", "50"]);
    assert_eq!(status, 0, "{error}");
    let text = fs::read_to_string(at.join("f.bvh")).unwrap();
    assert!(text.contains("OFFSET 0.000000 100.000000 0.000000") && text.contains("Frame Time: 0.020000000"), "{text}");
    assert!(text.ends_with("40.000000 50.000000 60.000000\n"), "{text}");
}

/// A body that walks on, 10 mm a frame: `body.toml`, and `name` with the poses of these frames.
fn walk(at: &Path, name: &str, frames: Range<usize>) {
    let body = Body::adult(1750.0).unwrap();
    if !at.join("body.toml").exists() {
        body.save(&at.join("body.toml"), Overwrite::Refuse).unwrap();
    }
    let pose = |frame: usize| {
        let mut pose = body.standing_pose();
        pose[0] += 10.0 * frame as f64;
        pose[4] += 0.002 * frame as f64;
        pose
    };
    let table = PoseTable { poses: frames.clone().map(pose).collect(), frames: frames.collect() };
    table.write(&at.join(name), Overwrite::Refuse, &body).unwrap();
}

#[test]
fn poses_become_every_file_of_motion() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    walk(at, "poses.csv", 100..110);
    walk(at, "all.csv", 0..120);
    let convert = |input: &str, output: &str, more: &[&str]| {
        let arguments = [&["convert", input, output, "--body", "body.toml", "--rate", "50"], more].concat();
        let (status, out, error) = pantin(at, &arguments);
        assert!(status == 0 && out.contains("15 bones"), "{output}: {out}{error}");
    };
    for output in ["j.csv", "j.trc", "j.c3d", "m.bvh", "m.glb", "m.mot"] {
        convert("poses.csv", output, &[]);
    }
    convert("all.csv", "truth.csv", &[]);
    convert("poses.csv", "os.bvh", &["--convention", "opensim"]);
    let joints = read_points(&at.join("j.csv")).unwrap();
    for file in ["j.trc", "j.c3d", "m.bvh", "os.bvh"] {
        let points = read_points(&at.join(file)).unwrap();
        assert_eq!((points.first_frame, points.rate, points.frames.len()), (100, 50.0, 10), "{file}");
        let (ours, theirs) = (joints.column("left_knee").unwrap(), points.column("left_knee").unwrap());
        let far = |frame: usize| joints.frames[frame][ours].unwrap().distance(points.frames[frame][theirs].unwrap());
        assert!((0..10).all(|frame| far(frame) < 0.01), "{file}");
    }
    // What a BVH does not say by itself: that it begins in frame 100.
    let (status, out, error) = pantin(at, &["score", "m.bvh", "--truth", "truth.csv", "--json"]);
    assert_eq!(status, 0, "{error}");
    let object: serde_json::Value = serde_json::from_str(&out).unwrap();
    assert!(object["frames"] == 10 && object["mean"].as_f64().unwrap() < 0.01, "{object}");
    // A BVH that says its axes and unit goes round unchanged, and between its units.
    for (input, output, convention) in
        [("m.bvh", "same.bvh", "pantin"), ("m.bvh", "metres.bvh", "opensim"), ("os.bvh", "back.bvh", "pantin")]
    {
        let (status, _, error) = pantin(at, &["convert", input, output, "--convention", convention]);
        assert_eq!(status, 0, "{error}");
    }
    let bytes = |name: &str| fs::read(at.join(name)).unwrap();
    assert!(bytes("same.bvh") == bytes("m.bvh"));
    let [metres, back] = ["metres.bvh", "back.bvh"].map(|name| read_points(&at.join(name)).unwrap());
    for points in [metres, back] {
        let knee = points.column("left_knee").unwrap();
        let far =
            points.frames[9][knee].unwrap().distance(joints.frames[9][joints.column("left_knee").unwrap()].unwrap());
        assert!(far < 0.01 && points.first_frame == 100, "{far}");
    }
    // Another name for a coordinate.
    fs::write(at.join("names.toml"), "[coordinate]\n\"left_knee.ry\" = { name = \"bend\", factor = -1 }\n").unwrap();
    convert("poses.csv", "own.mot", &["--coordinates", "names.toml"]);
    let text = fs::read_to_string(at.join("own.mot")).unwrap();
    assert!(text.contains("inDegrees=yes\nendheader\ntime\tpelvis_tz\tpelvis_tx\tpelvis_ty\t"), "{text}");
    assert!(text.contains("\tbend\t") && text.contains("nRows=10\nnColumns=32\n"), "{text}");

    // Who says so too turns nothing twice.
    let (status, out, error) = pantin(at, &["score", "j.csv", "--truth", "m.bvh", "--truth-y-up", "--json"]);
    assert_eq!(status, 0, "{error}");
    let object: serde_json::Value = serde_json::from_str(&out).unwrap();
    assert!(object["mean"].as_f64().unwrap() < 0.01, "{object}");
    refused(
        at,
        &["convert", "poses.csv", "x.glb", "--body", "body.toml"],
        "poses.csv has no times, expected --rate HZ",
    );
    let turned = ["convert", "poses.csv", "x.glb", "--body", "body.toml", "--rate", "50", "--y-up"];
    refused(at, &turned, "--scale and --y-up are for recordings");
    refused(at, &["convert", "j.csv", "x.glb"], "a .glb needs poses.csv and --body body.toml");
    let named = ["convert", "poses.csv", "x.glb", "--body", "body.toml", "--rate", "50", "--coordinates", "names.toml"];
    refused(at, &named, "--coordinates is for .mot files, found x.glb");
    fs::write(at.join("names.toml"), "[coordinate]\n\"left_kne.ry\" = { name = \"bend\" }\n").unwrap();
    let named = ["convert", "poses.csv", "x.mot", "--body", "body.toml", "--rate", "50", "--coordinates", "names.toml"];
    refused(
        at,
        &named,
        "names.toml: it names `left_kne.ry`, which is no degree of freedom, the nearest known one is `left_knee.ry`",
    );
}

/// A trembling of 10 Hz on a steady walk of 50 frames a second goes at 3 Hz, in points and in poses; the cut-off is said.
#[test]
fn smoothing_takes_the_trembling_away_and_nothing_else() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let body = Body::adult(1750.0).unwrap();
    body.save(&at.join("body.toml"), Overwrite::Refuse).unwrap();
    let knee = body.dof_index("left_knee.ry").unwrap();
    let pose = |frame: usize, trembling: f64| {
        let phase = std::f64::consts::TAU * frame as f64 / 5.0;
        let mut pose = body.standing_pose();
        pose[0] += 10.0 * frame as f64 + 20.0 * trembling * phase.sin();
        pose[knee] += 0.4 + 0.1 * trembling * phase.cos();
        pose
    };
    let write = |name: &str, trembling: f64| {
        let poses = (0..100).map(|frame| pose(frame, trembling)).collect();
        let table = PoseTable { poses, frames: (0..100).collect() };
        table.write(&at.join(name), Overwrite::Refuse, &body).unwrap();
    };
    write("trembling.csv", 1.0);
    write("steady.csv", 0.0);
    let convert = |arguments: &[&str]| {
        let (status, out, error) = pantin(at, &[&["convert"], arguments].concat());
        assert_eq!(status, 0, "{out}{error}");
        error
    };
    let of_poses = ["--body", "body.toml", "--rate", "50"];
    for (from, to, smooth) in
        [("steady", "s.csv", &[][..]), ("trembling", "t.csv", &[]), ("trembling", "p.csv", &["--smooth", "3"])]
    {
        convert(&[&[&format!("{from}.csv"), to], &of_poses[..], smooth].concat());
    }
    let told = convert(&["t.csv", "q.csv", "--smooth", "3"]);
    assert!(told.contains("smoothed at 3 Hz (-3 dB after both passes): Butterworth low-pass without delay"), "{told}");
    let read = |name: &str| read_points(&at.join(name)).unwrap();
    let steady = read("s.csv");
    let off = |name: &str| {
        let points = read(name);
        // The ends are guessed at on one side.
        let far = |frame: usize| {
            points.frames[frame].iter().zip(&steady.frames[frame]).map(|(a, b)| a.unwrap().distance(b.unwrap()))
        };
        (10..90).flat_map(far).fold(0.0, f64::max)
    };
    let [trembling, poses, points] = ["t.csv", "p.csv", "q.csv"].map(off);
    // A knee that swings moves the mean of the ankle's arc by a millimetre too.
    assert!(trembling > 20.0 && poses < 2.0 && points < 2.0, "{trembling}, {poses} and {points} mm");

    refused(
        at,
        &["convert", "t.csv", "x.csv", "--smooth", "25"],
        "t.csv: the cut-off is 25 Hz, expected more than 0 and less than half",
    );
    fs::write(at.join("few.csv"), "frame,time,a.x,a.y,a.z\n0,0,1,2,3\n1,0.02,1,2,3\n").unwrap();
    refused(
        at,
        &["convert", "few.csv", "x.csv", "--smooth", "6"],
        "few.csv: no point is there in 10 consecutive frames",
    );
    fs::write(at.join("a.bvh"), BVH).unwrap();
    refused(at, &["convert", "a.bvh", "b.bvh", "--smooth", "6"], "--smooth is for points and poses");
}

#[test]
fn convert_refuses_in_one_sentence() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    fs::write(at.join("a.bvh"), BVH).unwrap();
    fs::write(at.join("still.csv"), "frame,a.x,a.y,a.z\n0,1,2,3\n").unwrap();
    fs::write(at.join("poses.csv"), "frame,pelvis.tx\n0,1\n").unwrap();
    refused(at, &["convert", "a.bvh", "a.bvh"], "a.bvh exists already");
    refused(at, &["convert", "still.csv", "b.trc", "--rate", "1e308"], "--rate is 1e308, expected a positive number");
    refused(at, &["convert", "still.csv", "b.csv", "--scale", "1e-300"], "--scale is 1e-300, expected a positive");
    refused(at, &["convert", "still.csv", "b.bvh"], "which points alone do not give");
    refused(at, &["convert", "still.csv", "b.trc"], "frame rate is unknown");
    refused(at, &["convert", "poses.csv", "b.trc"], "table of poses");
    refused(
        at,
        &["convert", "a.bvh", "b.fbx"],
        "b.fbx: unknown point format `fbx`, the nearest is `c3d` (known: c3d, trc, csv, bvh)",
    );
    refused(at, &["convert", "a.bvh", "b.bvh", "--y-up"], "--y-up turns points");
    refused(
        at,
        &["convert", "a.bvh", "b.bvh", "--convention", "opensim"],
        "a.bvh: it says neither its unit nor its axes",
    );
    refused(at, &["convert", "a.bvh", "b.csv", "--scale", "nan"], "--scale is NaN");
    refused(at, &["convert", "a.bvh", "b.csv", "--scale", "1e300"], "--scale is 1e300, expected a positive number");
    refused(at, &["convert", "a.bvh", "b.csv", "--convention", "opensim"], "expected .trc for the convention opensim");
    refused(at, &["convert", "a.bvh", "b.csv", "--rate", "0"], "--rate is 0.0");
    let left: Vec<PathBuf> = fs::read_dir(at).unwrap().map(|entry| entry.unwrap().path()).collect();
    assert_eq!(left.len(), 3, "nothing was written: {left:?}");
}

#[test]
fn two_triangulations_of_the_beam_agree() {
    let Some(reference) = shared("two_triangulations_of_the_beam_agree", "beam/reference") else { return };
    let truth = "authors_Balancing_for_IK.trc";
    let arguments =
        ["score", "openpose_body25b_3d_filt6hz.csv", "--truth", truth, "--truth-y-up", "--remove-offset", "--json"];
    let (status, out, error) = pantin(&reference, &arguments);
    assert_eq!(status, 0, "{error}");
    let object: serde_json::Value = serde_json::from_str(&out).unwrap();
    assert_eq!((&object["frames"], &object["missing"]), (&100.into(), &0.into()));
    assert_eq!(object["points"].as_array().unwrap().len(), 21);
    // The detectors' nose is unusable, all else agrees to the accuracy of such detectors; a wrong axis would be off by
    // metres.
    for point in object["points"].as_array().unwrap().iter().filter(|point| point["name"] != "Nose") {
        assert!(point["mean"].as_f64().unwrap() < 70.0, "{point}");
    }
}
