use glam::{DAffine3, DMat3, DVec2, DVec3};
use image::{GrayImage, Luma};

use super::super::test_points::Random;
use super::*;
use crate::geometry::{BrownConrady, Camera, Lens, rodrigues_matrix};

const SIZE: [u32; 2] = [800, 600];

fn chessboard() -> Board {
    Board { kind: BoardKind::Chessboard, corners: [6, 5], square: 90.0, markers: None }
}

fn charuco() -> Board {
    let markers = Some((90.0, "DICT_4X4_50".to_string()));
    Board { kind: BoardKind::Charuco, corners: [5, 3], square: 120.0, markers }
}

/// Cameras on one side of the room, two metres up, that look down at its middle.
fn rig(count: usize) -> Vec<Camera> {
    let camera = |index: usize| {
        let angle = (index as f64 - 0.5 * (count as f64 - 1.0)) * 0.6;
        let centre = DVec3::new(-3000.0 * angle.cos(), -3000.0 * angle.sin(), 2000.0 + 100.0 * index as f64);
        let z = (DVec3::new(0.0, 0.0, 500.0) - centre).normalize();
        let x = z.cross(DVec3::Z).normalize();
        let rotation = DMat3::from_cols(x, z.cross(x), z).transpose();
        let lens = BrownConrady {
            focal: DVec2::new(760.0, 758.0) + 20.0 * index as f64,
            centre: DVec2::new(402.0 + index as f64, 296.5),
            radial: [-0.18, 0.06, 0.0],
            tangential: [8e-4, -5e-4],
        };
        Camera {
            name: format!("cam0{}", index + 1),
            size: SIZE,
            camera_from_world: DAffine3::from_mat3_translation(rotation, -(rotation * centre)),
            lens: Lens::BrownConrady(lens),
        }
    };
    (0..count).map(camera).collect()
}

/// World from board: its print towards the cameras, turned by `turn` (radians) and with its middle at `at`.
fn held(board: &Board, turn: DVec3, at: DVec3) -> DAffine3 {
    // Facing -x, upright: x along +y... seen from the cameras, to the right is -y; down is -z.
    let facing = DMat3::from_cols(DVec3::NEG_Y, DVec3::NEG_Z, DVec3::X);
    let rotation = rodrigues_matrix(turn) * facing;
    DAffine3::from_mat3_translation(rotation, at - rotation * board.middle())
}

/// On the floor, print upwards, a little turned.
fn lying(board: &Board) -> DAffine3 {
    let rotation = rodrigues_matrix(DVec3::Z * 0.3) * DMat3::from_cols(DVec3::NEG_Y, DVec3::NEG_X, DVec3::NEG_Z);
    DAffine3::from_mat3_translation(rotation, DVec3::new(100.0, 50.0, 0.0) - rotation * board.middle())
}

fn poses(board: &Board, count: usize) -> Vec<DAffine3> {
    let mut noise = Random(3);
    let mut random = |scale: f64| noise.normal() * scale;
    let mut poses: Vec<DAffine3> = (1..count)
        .map(|_| {
            let turn = DVec3::new(random(0.3), random(0.35), random(0.35));
            held(board, turn, DVec3::new(random(200.0), random(350.0), 900.0 + random(250.0)))
        })
        .collect();
    poses.push(lying(board));
    poses
}

/// What the cameras see, with normal noise; nothing of a board that is not whole in the picture.
fn moments(board: &Board, cameras: &[Camera], poses: &[DAffine3], sigma: f64) -> Vec<BoardMoment> {
    let mut noise = Random(7);
    let mut view = |camera: &Camera, pose: &DAffine3| -> Vec<SeenCorner> {
        let faces = (camera.camera_from_world * *pose).matrix3.z_axis;
        let before = (camera.camera_from_world * *pose).transform_point3(board.middle());
        let corners: Option<Vec<SeenCorner>> = (0..board.corner_count())
            .map(|corner| {
                let pixel = camera.project(pose.transform_point3(board.corner(corner)))?;
                let inside = pixel.cmpge(DVec2::ZERO).all() && pixel.cmplt(DVec2::new(800.0, 600.0)).all();
                inside.then(|| SeenCorner { corner, pixel: pixel + sigma * DVec2::new(noise.normal(), noise.normal()) })
            })
            .collect();
        if faces.dot(before.normalize()) > 0.2 { corners.unwrap_or_default() } else { Vec::new() }
    };
    let moment =
        |(frame, pose)| BoardMoment { frame, views: cameras.iter().map(|camera| view(camera, pose)).collect() };
    poses.iter().enumerate().map(moment).collect()
}

fn names(cameras: &[Camera]) -> Vec<String> {
    cameras.iter().map(|camera| camera.name.clone()).collect()
}

/// The true cameras in the world whose origin lies under the board's middle on the floor.
fn on_floor(cameras: &[Camera], board: &Board) -> Vec<Camera> {
    let pose = lying(board);
    let [x, y, z] = [pose.matrix3.x_axis, pose.matrix3.y_axis, pose.matrix3.z_axis];
    let floor = DAffine3::from_mat3_translation(DMat3::from_cols(x, -y, -z), pose.transform_point3(board.middle()));
    let moved = |camera: &Camera| Camera { camera_from_world: camera.camera_from_world * floor, ..camera.clone() };
    cameras.iter().map(moved).collect()
}

#[test]
fn corners_without_noise_give_the_cameras_back() {
    for board in [chessboard(), charuco()] {
        let cameras = rig(3);
        let seen = moments(&board, &cameras, &poses(&board, 16), 0.0);
        let found = calibrate_board(&board, &names(&cameras), &[SIZE; 3], &seen, &BoardSettings::default()).unwrap();
        assert_eq!(found.left_out, 0);
        for (found, truth) in found.cameras.iter().zip(on_floor(&cameras, &board)) {
            let (Lens::BrownConrady(lens), Lens::BrownConrady(true_lens)) = (found.camera.lens, truth.lens) else {
                panic!("another lens")
            };
            assert!((lens.focal - true_lens.focal).length() < 1e-3, "{lens:?}");
            assert!((lens.centre - true_lens.centre).length() < 1e-3, "{lens:?}");
            assert!((lens.radial[0] - true_lens.radial[0]).abs() < 1e-5, "{lens:?}");
            let away = found.camera.centre_in_world().distance(truth.centre_in_world());
            assert!(away < 1e-2, "{} stands {away} mm off", truth.name);
            let turned = found.camera.camera_from_world.matrix3 - truth.camera_from_world.matrix3;
            assert!(turned.to_cols_array().iter().all(|entry| entry.abs() < 1e-5), "{turned}");
        }
    }
}

#[test]
fn noisy_corners_give_errors_of_the_stated_size() {
    let (board, cameras) = (chessboard(), rig(3));
    let seen = moments(&board, &cameras, &poses(&board, 24), 0.2);
    let found = calibrate_board(&board, &names(&cameras), &[SIZE; 3], &seen, &BoardSettings::default()).unwrap();
    let mut squares = 0.0;
    let mut count = 0.0;
    for (found, truth) in found.cameras.iter().zip(on_floor(&cameras, &board)) {
        assert!((found.noise - 0.2).abs() < 0.02, "noise {}", found.noise);
        let away = found.camera.centre_in_world().distance(truth.centre_in_world());
        println!("{} stands {away:.2} mm off, noise {:.4} px", truth.name, found.noise);
        assert!(away < 15.0, "{} stands {away:.1} mm off", truth.name);
        let Lens::BrownConrady(lens) = truth.lens else { panic!("another lens") };
        for (name, truth) in
            [("fy", lens.focal.y), ("cx", lens.centre.x), ("k1", lens.radial[0]), ("p1", lens.tangential[0])]
        {
            let estimate = found.estimates.iter().find(|estimate| estimate.name == name).unwrap();
            let sigmas = (estimate.value - truth) / estimate.deviation.unwrap();
            assert!(sigmas.abs() < 4.5, "{name} is {sigmas:.1} standard deviations off");
            squares += sigmas * sigmas;
            count += 1.0;
        }
    }
    // Twelve estimates: their squared errors are a standard deviation's square on average.
    let mean: f64 = squares / count;
    println!("{mean:.2} of the stated variance");
    assert!((0.3..2.5).contains(&mean), "{mean}");
    assert_eq!(found.floor.frames, [23]);
}

#[test]
fn a_wrong_board_is_left_out_and_a_floor_frame_can_be_named() {
    let (board, cameras) = (chessboard(), rig(3));
    let mut seen = moments(&board, &cameras, &poses(&board, 16), 0.1);
    for corner in &mut seen[4].views[1] {
        corner.pixel += DVec2::new(25.0, -18.0);
    }
    let calibrated = |thickness: f64| {
        let settings = BoardSettings { floor: Floor::Frame(15), thickness, ..BoardSettings::default() };
        calibrate_board(&board, &names(&cameras), &[SIZE; 3], &seen, &settings).unwrap()
    };
    let (found, flat) = (calibrated(8.0), calibrated(0.0));
    // Of two views that contradict each other either may go, and a board seen by one more pulls that along.
    assert!((1..=4).contains(&found.left_out), "{}", found.left_out);
    assert!(found.cameras.iter().all(|camera| camera.noise < 0.15), "{:?}", found.cameras[1].noise);
    for (found, flat) in found.cameras.iter().zip(&flat.cameras) {
        // The floor lies under the board.
        let higher = found.camera.centre_in_world() - flat.camera.centre_in_world();
        assert!(higher.abs_diff_eq(DVec3::Z * 8.0, 1e-6), "{higher}");
    }
    for (flat, truth) in flat.cameras.iter().zip(on_floor(&cameras, &board)) {
        let away = flat.camera.centre_in_world().distance(truth.centre_in_world());
        println!("{away:.2} mm off, noise {:?} px", found.cameras.iter().map(|c| c.noise).collect::<Vec<_>>());
        // 4.4 to 4.6 mm.
        assert!(away < 8.0, "{away:.1} mm off");
    }
    let settings = BoardSettings { floor: Floor::Frame(31), ..BoardSettings::default() };
    let message = format!("{:#}", calibrate_board(&board, &names(&cameras), &[SIZE; 3], &seen, &settings).unwrap_err());
    assert!(message.contains("not seen in frame 31") && message.contains("is 15"), "{message}");
}

#[test]
fn what_cannot_be_calibrated_says_why() {
    let (board, cameras) = (chessboard(), rig(3));
    let refused = |seen: &[BoardMoment]| {
        let found = calibrate_board(&board, &names(&cameras), &[SIZE; 3], seen, &BoardSettings::default());
        format!("{:#}", found.expect_err("must be refused"))
    };
    let seen = moments(&board, &cameras, &poses(&board, 16), 0.1);
    let upright = refused(&seen[..15]);
    assert!(upright.contains("never seen lying"), "{upright}");
    let few: Vec<BoardMoment> = seen.iter().take(3).cloned().collect();
    assert!(refused(&few).contains("camera `cam01`: the board is found in"), "{}", refused(&few));
    // The third camera sees the board only when no other does.
    let mut apart = seen.clone();
    for (index, moment) in apart.iter_mut().enumerate() {
        let hidden: &[usize] = if index % 3 == 0 { &[0, 1] } else { &[2] };
        hidden.iter().for_each(|&camera| moment.views[camera].clear());
    }
    let message = refused(&apart);
    assert!(message.contains("camera `cam03` never sees the board at a moment"), "{message}");
    // Videos that do not belong together: each lens is found, no two cameras agree on where the board is.
    let mut late = seen.clone();
    for index in 0..seen.len() {
        late[index].views[2] = seen[(index + 5) % seen.len()].views[2].clone();
    }
    let message = refused(&late);
    assert!(message.contains("do the videos begin at the same moment"), "{message}");
    for (change, expected) in [
        (Board { corners: [9, 7], ..board.clone() }, "looks the same upside down"),
        (Board { corners: [9, 1], ..board.clone() }, "9x1 inner corners"),
        (Board { square: 0.0, ..board.clone() }, "a side of 0 mm"),
        (Board { markers: Some((130.0, "DICT_4X4_50".into())), ..charuco() }, "a side of 130 mm"),
        (Board { markers: None, ..charuco() }, "without markers"),
    ] {
        let message = format!("{:#}", change.check().unwrap_err());
        assert!(message.contains(expected), "{message}");
    }
    let unknown = Board { markers: Some((90.0, "DICT_9X9".into())), ..charuco() };
    let message = BoardDetector::new(&unknown).err().map_or(String::new(), |error| format!("{error:#}"));
    assert!(message.contains("unknown dictionary \"DICT_9X9\""), "{message}");
}

/// A picture of a board, 3 x 3 samples a pixel, with noise of 3 grey levels.
fn picture(board: &Board, camera: &Camera, pose: &DAffine3) -> GrayImage {
    let board_from_world = pose.inverse();
    let mut noise = Random(5);
    let sample = |at: DVec2| -> f64 {
        let Some((origin, direction)) = camera.ray(at) else { return 90.0 };
        let (origin, direction) =
            (board_from_world.transform_point3(origin), board_from_world.transform_vector3(direction));
        printed(board, (origin - direction * (origin.z / direction.z)).truncate())
    };
    GrayImage::from_fn(SIZE[0], SIZE[1], |x, y| {
        let samples = (0..9).map(|i| {
            let within = DVec2::new(f64::from(i % 3 - 1), f64::from(i / 3 - 1)) / 3.0;
            sample(DVec2::new(x.into(), y.into()) + within)
        });
        Luma([(samples.sum::<f64>() / 9.0 + 3.0 * noise.normal()).round().clamp(0.0, 255.0) as u8])
    })
}

/// The grey of the print at a place of the board: squares, markers, a white margin of half a square, and the room.
fn printed(board: &Board, at: DVec2) -> f64 {
    let place = at / board.square + 1.0;
    let [columns, rows] = board.corners.map(|count| f64::from(count + 1));
    let beyond = (-place).max(place - DVec2::new(columns, rows)).max_element();
    if beyond > 0.0 {
        return if beyond < 0.5 { 235.0 } else { 90.0 };
    }
    let cell = place.floor().min(DVec2::new(columns - 1.0, rows - 1.0));
    let is_black = (cell.x + cell.y) % 2.0 == 0.0;
    let is_marker = !is_black
        && board.markers.as_ref().is_some_and(|(side, dictionary)| {
            let dictionary = calib_targets_charuco::resolve_dictionary(dictionary).unwrap();
            // Counted row by row over the white squares.
            let before = (0..(cell.y * columns + cell.x) as usize)
                .filter(|square| (square % columns as usize + square / columns as usize) % 2 == 1)
                .count();
            let part = side / board.square;
            let within = (place - cell - 0.5 * (1.0 - part)) / part * 6.0;
            let [u, v] = [within.x.floor(), within.y.floor()];
            let inside = |value: f64, low: f64, high: f64| (low..=high).contains(&value);
            if !inside(u, 0.0, 5.0) || !inside(v, 0.0, 5.0) {
                return false;
            }
            let is_border = !inside(u, 1.0, 4.0) || !inside(v, 1.0, 4.0);
            is_border || (dictionary.codes()[before] >> ((v - 1.0) * 4.0 + u - 1.0) as u64) & 1 == 1
        });
    if is_black || is_marker { 25.0 } else { 235.0 }
}

#[test]
fn corners_are_found_where_they_are_and_counted_as_the_board_counts() {
    let camera = &rig(1)[0];
    for board in [chessboard(), charuco()] {
        let detector = BoardDetector::new(&board).unwrap();
        let upside_down = held(&board, DVec3::X * std::f64::consts::PI, DVec3::new(0.0, 50.0, 800.0));
        let tilted = held(&board, DVec3::new(0.4, 0.3, -0.3), DVec3::new(100.0, -80.0, 900.0));
        for pose in [upside_down, tilted, lying(&board)] {
            let picture = picture(&board, camera, &pose);
            let seen = detector.find(&picture);
            assert_eq!(seen.len(), board.corner_count(), "{:?} at {pose:?}", board.kind);
            let truth = |corner: usize| camera.project(pose.transform_point3(board.corner(corner))).unwrap();
            let offsets: Vec<DVec2> = seen.iter().map(|seen| seen.pixel - truth(seen.corner)).collect();
            let rms = (offsets.iter().map(|o| o.length_squared()).sum::<f64>() / offsets.len() as f64).sqrt();
            let mean = offsets.iter().sum::<DVec2>() / offsets.len() as f64;
            assert!(rms < 0.25 && mean.length() < 0.1, "{:?}: rms {rms:.3}, mean {mean}", board.kind);
        }
        assert!(detector.find(&GrayImage::new(800, 600)).is_empty());
    }
}
