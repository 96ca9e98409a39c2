//! A small sequence with exact truth, drawn from the reference's candidate images: what the tracker sees is what it draws.

use std::fs;
use std::path::Path;

use glam::{DAffine3, DMat3, DVec2, DVec3};
use image::{GrayImage, Luma, Rgb, RgbImage};
use pantin::body::{Body, PoseTable};
use pantin::evaluate::Reference;
use pantin::files::Overwrite;
use pantin::geometry::{BrownConrady, Camera, Lens};
use pantin::motion::write_points;
use pantin::sequence::write_cameras_toml;

/// Frames of the sequence.
pub const FRAMES: usize = 6;
const SIZE: [u32; 2] = [160, 120];

/// Four cameras round the origin, four metres away.
pub fn cameras() -> Vec<Camera> {
    (0..4)
        .map(|index| {
            let angle = 0.4 + f64::from(index) * std::f64::consts::FRAC_PI_2;
            let centre = DVec3::new(4000.0 * angle.cos(), 4000.0 * angle.sin(), 1300.0);
            let forward = (DVec3::new(0.0, 0.0, 900.0) - centre).normalize();
            let right = forward.cross(DVec3::Z).normalize();
            let rotation = DMat3::from_cols(right, forward.cross(right), forward).transpose();
            Camera {
                name: format!("cam{index}"),
                size: SIZE,
                camera_from_world: DAffine3 { matrix3: rotation, translation: -(rotation * centre) },
                lens: Lens::BrownConrady(BrownConrady {
                    focal: DVec2::splat(190.0),
                    centre: DVec2::new(79.5, 59.5),
                    radial: [-0.05, 0.01, 0.0],
                    tangential: [0.001, -0.001],
                }),
            }
        })
        .collect()
}

/// The true poses: a step forward with an arm going up.
pub fn poses(body: &Body) -> PoseTable {
    let names = body.dof_names();
    let index = |name: &str| names.iter().position(|dof| dof == name).unwrap();
    let pose = |frame: usize| {
        let t = frame as f64;
        let mut pose = body.standing_pose();
        pose[index("pelvis.tx")] += 15.0 * t;
        pose[index("left_hip.ry")] -= 0.05 * t;
        pose[index("right_hip.ry")] += 0.04 * t;
        pose[index("left_knee.ry")] += 0.06 * t;
        pose[index("right_shoulder.ry")] -= 0.08 * t;
        body.clamp_to_limits(&mut pose);
        pose
    };
    PoseTable { frames: (0..FRAMES).collect(), poses: (0..FRAMES).map(pose).collect() }
}

/// Writes the sequence into a folder.
pub fn write(folder: &Path) {
    let body = Body::adult(1750.0).unwrap();
    let cameras = cameras();
    let table = poses(&body);
    body.save(&folder.join("body.toml"), Overwrite::Refuse).unwrap();
    write_cameras_toml(&folder.join("cameras.toml"), &cameras, Overwrite::Refuse).unwrap();
    let start = PoseTable { frames: vec![0], poses: vec![table.poses[0].clone()] };
    start.write(&folder.join("start.csv"), Overwrite::Refuse, &body).unwrap();
    table.write(&folder.join("truth_poses.csv"), Overwrite::Refuse, &body).unwrap();
    let joints = body.joint_trajectory(&table, 25.0).unwrap();
    write_points(&folder.join("truth.csv"), &joints, Overwrite::Refuse).unwrap();
    fs::create_dir(folder.join("frames")).unwrap();
    let reference = Reference::new(&body, &cameras);
    let mut manifest = "name = \"step\"\nfps = 25.0\ncameras = \"cameras.toml\"\nbody = \"body.toml\"\n\
                        start = \"start.csv\"\ntruth = \"truth.csv\"\n"
        .to_string();
    for (view, camera) in cameras.iter().enumerate() {
        let name = &camera.name;
        manifest.push_str(&format!(
            "[[view]]\ncamera = \"{name}\"\nsource = \"frames/{name}_%04d.png\"\nmask = \"frames/{name}_mask_%04d.png\"\n"
        ));
        for (frame, pose) in table.poses.iter().enumerate() {
            let pose: Vec<f32> = pose.iter().map(|value| *value as f32).collect();
            let image = reference.draw(&pose, view);
            let label = |x: u32, y: u32| image.bytes[(y * SIZE[0] + x) as usize] & 0x7f;
            let picture = RgbImage::from_fn(SIZE[0], SIZE[1], |x, y| match label(x, y) {
                0 => Rgb([40, 60, 50]),
                label => Rgb([250 - 9 * label, 100 + 30 * (label % 5), 90 + 50 * (label % 3)]),
            });
            let mask = GrayImage::from_fn(SIZE[0], SIZE[1], |x, y| Luma([if label(x, y) > 0 { 255 } else { 0 }]));
            picture.save(folder.join(format!("frames/{name}_{frame:04}.png"))).unwrap();
            mask.save(folder.join(format!("frames/{name}_mask_{frame:04}.png"))).unwrap();
        }
    }
    fs::write(folder.join("sequence.toml"), manifest).unwrap();
}
