//! `pantin calibrate` as a user runs it.

use std::fmt::Write as _;
use std::fs;

use glam::{DAffine3, DMat3, DVec2, DVec3};
use pantin::files::Overwrite;
use pantin::geometry::Camera;
use pantin::motion::{PointTrajectory, read_points, write_points};
use pantin::sequence::read_cameras;

use super::scene;
use super::support::{pantin_in as pantin, refused_in as refused, shared};

fn truth() -> Vec<Camera> {
    let target = DVec3::new(0.0, 0.0, 900.0);
    let lens = |focal| scene::brown(focal, [640, 480], [-0.12, 0.05, 0.0], [5e-4, -4e-4]);
    vec![
        scene::camera("left", [640, 480], DVec3::new(4000.0, 800.0, 1500.0), target, lens(700.0)),
        scene::camera("right", [640, 480], DVec3::new(-700.0, -4200.0, 1900.0), target, lens(650.0)),
    ]
}

fn points(count: usize) -> Vec<DVec3> {
    let mut random = scene::Random(11);
    let mut side = |low, high| f64::from(random.uniform(low, high));
    (0..count).map(|_| DVec3::new(side(-1000.0, 1000.0), side(-1000.0, 1000.0), side(100.0, 1800.0))).collect()
}

/// The largest distance between the images of points all over the volume, pixels.
fn farthest(a: &Camera, b: &Camera) -> f64 {
    let apart = |point: &DVec3| a.project(*point).unwrap().distance(b.project(*point).unwrap());
    points(300).iter().map(apart).fold(0.0, f64::max)
}

#[test]
fn a_table_becomes_cameras_that_project_as_the_truth_does() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let mut table = "camera,point,x,y,z,u,v\n".to_string();
    for camera in truth() {
        for (index, point) in points(120).iter().enumerate() {
            // One pair is wrong.
            let slip = if index == 17 && camera.name == "left" { DVec2::new(35.0, 0.0) } else { DVec2::ZERO };
            let (p, pixel) = (point / 1000.0, camera.project(*point).unwrap() + slip);
            writeln!(table, "{},p{index},{},{},{},{},{}", camera.name, p.x, p.y, p.z, pixel.x, pixel.y).unwrap();
        }
    }
    fs::write(at.join("points.csv"), table).unwrap();
    let size = ["--size", "640x480"];
    let arguments = ["calibrate", "points.csv", "-o", "cameras.toml", "--model", "brown-conrady", "--units", "m"];
    let (status, out, error) = pantin(at, &[&arguments[..], &size, &["--residuals", "residuals"]].concat());
    assert_eq!(status, 0, "{error}");
    assert!(out.contains("left: 119 points in space") && out.contains("1 outliers left out"), "{out}");
    assert!(out.contains("p17 at") && out.contains("35.00 px off"), "{out}");
    let found = read_cameras(&at.join("cameras.toml")).unwrap();
    for (found, truth) in found.iter().zip(&truth()) {
        assert_eq!((&found.name, found.size), (&truth.name, truth.size));
        assert!(farthest(found, truth) < 1e-6, "{}", farthest(found, truth));
    }
    let picture = fs::read_to_string(at.join("residuals/left.svg")).unwrap();
    assert!(picture.starts_with("<svg") && picture.matches("<circle").count() == 120);
    let table = fs::read_to_string(at.join("residuals/residuals.csv")).unwrap();
    assert!(table.lines().count() == 241 && table.contains("left,p17,") && table.contains(",35.0000,"), "{table}");
    refused(at, &[&arguments[..], &size].concat(), "cameras.toml exists");
    // Tsai's lens is another one: it fits to a fraction of a pixel, and its file is read again too.
    let tsai = ["calibrate", "points.csv", "-o", "tsai.toml", "--units", "m", "--size", "left=640x480"];
    refused(at, &tsai, "camera `right` has no --size");
    let (status, out, error) = pantin(at, &[&tsai[..], &["--size", "right=640x480"]].concat());
    assert!(status == 0 && out.contains("kappa"), "{out}{error}");
    for (found, truth) in read_cameras(&at.join("tsai.toml")).unwrap().iter().zip(&truth()) {
        assert!(farthest(found, truth) < 1.0, "{}", farthest(found, truth));
    }
}

#[test]
fn a_wand_and_its_tracks_become_cameras() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let cloud = points(100);
    let frames = cloud.iter().map(|p| vec![Some(*p), Some(*p + DVec3::new(60.0, 300.0, 90.0))]).collect();
    let names = vec!["W1".to_string(), "W2".to_string()];
    let wand = PointTrajectory { names, rate: 50.0, first_frame: 0, frames, smoothed: None };
    write_points(&at.join("wand.c3d"), &wand, Overwrite::Refuse).unwrap();
    // C3D holds single precision: what is in the file is what was seen.
    let wand = read_points(&at.join("wand.c3d")).unwrap();
    let mut tracks = "camera,frame,marker,u,v\n".to_string();
    for camera in truth() {
        for (frame, row) in wand.frames.iter().enumerate() {
            for (name, point) in wand.names.iter().zip(row) {
                let pixel = camera.project(point.unwrap()).unwrap();
                writeln!(tracks, "{},{frame},{name},{},{}", camera.name, pixel.x, pixel.y).unwrap();
            }
        }
    }
    fs::write(at.join("tracks.csv"), tracks).unwrap();
    let arguments = ["calibrate", "--c3d", "wand.c3d", "--tracks", "tracks.csv", "-o", "cameras.toml"];
    let rest = ["--size", "640x480", "--model", "brown-conrady"];
    let (status, out, error) = pantin(at, &[&arguments[..], &rest].concat());
    assert!(status == 0 && out.contains("200 points in space"), "{out}{error}");
    for (found, truth) in read_cameras(&at.join("cameras.toml")).unwrap().iter().zip(&truth()) {
        assert!(farthest(found, truth) < 1e-6, "{}", farthest(found, truth));
    }
    fs::write(at.join("wrong.csv"), "camera,frame,marker,u,v\nleft,0,W3,1,2\n").unwrap();
    let wrong = ["calibrate", "--c3d", "wand.c3d", "--tracks", "wrong.csv", "-o", "none.toml"];
    refused(at, &[&wrong[..], &rest].concat(), "no marker `W3`, the nearest is");
    assert!(!at.join("none.toml").exists());
}

#[test]
fn wrong_usage_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    fs::write(at.join("p.csv"), "camera,x,y,z,u,v\na,0,0,0,1,1\n").unwrap();
    let base = ["calibrate", "p.csv", "-o", "c.toml", "--size", "640x480"];
    refused(at, &base, "p.csv: camera `a`: 1 different points are too few");
    refused(
        at,
        &[&base[..], &["--hold", "focus"]].concat(),
        "--hold: unknown parameter to hold `focus`, the nearest is `",
    );
    refused(at, &[&base[..], &["--hold", "focus"]].concat(), "(known: aspect, centre, distortion, k2, k3, tangential)");
    refused(at, &[&base[..], &["--pitch", "0"]].concat(), "--pitch is 0");
    refused(at, &[&base[..], &["--marker", "20"]].concat(), "--marker means nothing without --board");
    refused(at, &[&base[..], &["--dictionary", "x"]].concat(), "--dictionary means nothing without --board");
    refused(at, &["calibrate", "none.csv", "-o", "c.toml", "--size", "640x480"], "cannot read none.csv");
    let (status, _, error) = pantin(at, &["calibrate", "p.csv", "-o", "c.toml", "--size", "640"]);
    assert!(status == 2 && error.contains("expected WIDTHxHEIGHT"), "{error}");
    let (status, _, _) = pantin(at, &["calibrate", "p.csv", "-o", "c.toml"]);
    assert_eq!(status, 2);
}

/// A real wand-less case: the beam's reference joints as the beam's cameras see them. The points are real, 2100 places
/// of a man on a beam, all within a metre's breadth; the pixels are the calibration's own, with noise.
#[test]
fn cameras_of_a_real_recording_come_back() {
    let Some(data) = shared("cameras_of_a_real_recording_come_back", "beam") else { return };
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let text = fs::read_to_string(data.join("cameras.toml")).unwrap();
    fs::write(at.join("truth.toml"), format!("{text}\n[metadata]\nunits = \"mm\"\n")).unwrap();
    let truth = read_cameras(&at.join("truth.toml")).unwrap();
    let joints = read_points(&data.join("reference/openpose_body25b_3d_filt6hz.csv")).unwrap();
    let mut random = scene::Random(5);
    let mut noise = || f64::from(random.uniform(-1.0, 1.0) + random.uniform(-1.0, 1.0)) * 0.5;
    let mut table = "camera,x,y,z,u,v\n".to_string();
    let seen: Vec<DVec3> = joints.frames.iter().flatten().flatten().copied().collect();
    for camera in &truth {
        for p in &seen {
            let pixel = camera.project(*p).unwrap() + DVec2::new(noise(), noise());
            writeln!(table, "{},{},{},{},{},{}", camera.name, p.x, p.y, p.z, pixel.x, pixel.y).unwrap();
        }
    }
    fs::write(at.join("points.csv"), table).unwrap();
    let sizes: Vec<String> = truth.iter().map(|c| format!("{}={}x{}", c.name, c.size[0], c.size[1])).collect();
    let mut arguments = vec!["calibrate", "points.csv", "-o", "cameras.toml", "--model", "brown-conrady"];
    sizes.iter().for_each(|size| arguments.extend(["--size", size]));
    let (status, out, error) = pantin(at, &arguments);
    assert_eq!(status, 0, "{error}");
    println!("{out}");
    for (found, truth) in read_cameras(&at.join("cameras.toml")).unwrap().iter().zip(&truth) {
        let apart = |p: &DVec3| found.project(*p).unwrap().distance(truth.project(*p).unwrap());
        let mean = seen.iter().map(apart).sum::<f64>() / seen.len() as f64;
        println!("{}: {mean:.4} px", truth.name);
        // 0.025 to 0.032: of 2100 points with 0.4 px of noise.
        assert!(mean < 0.05, "{}: {mean} px", truth.name);
    }
}

/// A picture of a chessboard, four samples a pixel: white margin, grey room, the square before the first corner black.
fn picture(camera: &Camera, world_from_board: DAffine3, corners: [u32; 2], square: f64) -> image::GrayImage {
    let board_from_world = world_from_board.inverse();
    let squares = DVec2::new(f64::from(corners[0]), f64::from(corners[1])) + 1.0;
    let grey = |pixel: DVec2| -> f64 {
        let (origin, direction) = camera.ray(pixel).unwrap();
        let (origin, direction) =
            (board_from_world.transform_point3(origin), board_from_world.transform_vector3(direction));
        let place = (origin - direction * (origin.z / direction.z)).truncate() / square + 1.0;
        let beyond = (-place).max(place - squares).max_element();
        match (beyond > 0.5, beyond > 0.0) {
            (true, _) => 90.0,
            (false, true) => 235.0,
            _ if (place.x.floor() + place.y.floor()) % 2.0 == 0.0 => 25.0,
            _ => 235.0,
        }
    };
    image::GrayImage::from_fn(camera.size[0], camera.size[1], |x, y| {
        let middle = DVec2::new(x.into(), y.into());
        let samples = [[-0.25, -0.25], [0.25, -0.25], [-0.25, 0.25], [0.25, 0.25]];
        let sum: f64 = samples.iter().map(|&within| grey(middle + DVec2::from_array(within))).sum();
        image::Luma([(0.25 * sum).round() as u8])
    })
}

/// A board is carried through the room and laid on the floor; numbered pictures a camera.
#[test]
fn a_printed_board_becomes_cameras_on_the_floor() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let target = DVec3::new(0.0, 0.0, 700.0);
    let lens = |focal| scene::brown(focal, [640, 480], [-0.12, 0.05, 0.0], [5e-4, -4e-4]);
    let cameras = [
        scene::camera("left", [640, 480], DVec3::new(2400.0, 1300.0, 1700.0), target, lens(700.0)),
        scene::camera("right", [640, 480], DVec3::new(2400.0, -1200.0, 1900.0), target, lens(650.0)),
    ];
    let (corners, square) = ([6, 5], 90.0);
    let middle = DVec3::new(2.5, 2.0, 0.0) * square;
    let placed = |rotation: DMat3, at: DVec3| DAffine3::from_mat3_translation(rotation, at - rotation * middle);
    let mut random = scene::Random(5);
    let mut side = |scale: f32| f64::from(random.uniform(-scale, scale));
    // Upright, its print towards +x, and then lying with its print upwards.
    let facing = DMat3::from_cols(DVec3::Y, DVec3::NEG_Z, DVec3::NEG_X);
    let mut boards: Vec<DAffine3> = (0..11)
        .map(|_| {
            let turn = DMat3::from_rotation_z(side(0.5))
                * DMat3::from_rotation_y(side(0.5))
                * DMat3::from_rotation_x(side(0.6));
            placed(turn * facing, DVec3::new(side(300.0), side(350.0), 750.0 + side(250.0)))
        })
        .collect();
    boards.push(placed(DMat3::from_cols(DVec3::Y, DVec3::X, DVec3::NEG_Z), DVec3::ZERO));
    for camera in &cameras {
        fs::create_dir(at.join(&camera.name)).unwrap();
        for (frame, board) in boards.iter().enumerate() {
            picture(camera, *board, corners, square).save(at.join(format!("{}/{frame:02}.png", camera.name))).unwrap();
        }
    }
    let videos = ["left/%02d.png", "right/%02d.png"];
    let board = ["calibrate", "--board", "chessboard", "--corners", "6x5", "--square", "90"];
    let written = ["-o", "cameras.toml", "--residuals", "residuals"];
    let (status, out, error) = pantin(at, &[&board[..], &videos, &written].concat());
    assert_eq!(status, 0, "{error}");
    assert!(out.contains("left: the board is found in 12 frames") && out.contains("lies in frame 11"), "{out}");
    let found = read_cameras(&at.join("cameras.toml")).unwrap();
    for (found, truth) in found.iter().zip(&cameras) {
        assert_eq!((&found.name, found.size), (&truth.name, truth.size));
        // The world of the board on the floor: its x along its rows.
        let about = DMat3::from_cols(DVec3::Y, DVec3::NEG_X, DVec3::Z);
        let away = (about * found.centre_in_world()).distance(truth.centre_in_world());
        println!("{} stands {away:.1} mm off", truth.name);
        // 22.5 and 15.5 mm from pictures of this board, which do not vary.
        assert!(away < 28.0, "{} stands {away:.1} mm off", truth.name);
        assert!((about * found.centre_in_world() - truth.centre_in_world()).z.abs() < 15.0);
    }
    assert!(fs::read_to_string(at.join("residuals/left.svg")).unwrap().starts_with("<svg"));

    let other = ["-o", "other.toml"];
    let with = |board: &[&str], rest: &[&str]| {
        [board, rest, &other].concat().into_iter().map(String::from).collect::<Vec<_>>()
    };
    for (arguments, expected) in [
        (with(&["calibrate", "--board", "chessboard", "--square", "90"], &videos), "--corners is missing"),
        (with(&["calibrate", "--board", "chessboard", "--corners", "6x5"], &videos), "--square is missing"),
        (
            with(&["calibrate", "--board", "chessboard", "--corners", "6x4", "--square", "9"], &videos),
            "the same upside down",
        ),
        (with(&["calibrate", "--board", "charuco", "--square", "90"], &videos), "--squares is missing"),
        (
            with(&["calibrate", "--board", "charuco", "--squares", "7x6", "--square", "90"], &videos),
            "--marker is missing",
        ),
        (with(&board, &["left/%02d.png", "left/%02d.png"]), "both called `left`"),
        (with(&board, &["left/%02d.png", "none.mp4"]), "there is no file none.mp4"),
        (with(&board, &[&videos[..], &["--floor", "12"]].concat()), "--floor is 12, and the videos have 12 frames"),
        (with(&["calibrate", "--size", "640x480"], &["a.csv", "b.csv"]), "2 tables of points were given, expected one"),
    ] {
        refused(at, &arguments.iter().map(String::as_str).collect::<Vec<_>>(), expected);
    }
    // What is seen only when the pictures were looked at.
    let another = with(&["calibrate", "--board", "chessboard", "--corners", "8x5", "--square", "90"], &videos);
    let (status, _, error) = pantin(at, &another.iter().map(String::as_str).collect::<Vec<_>>());
    assert!(status == 1 && error.contains("camera `left`: the board is found in 0 of 12 pictures"), "{error}");
    assert!(!at.join("other.toml").exists());
}
