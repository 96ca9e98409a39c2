//! Sequences with exact truth, drawn from the reference's candidate images: what the tracker sees is what it draws.

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

/// Four cameras on a circle round the z axis.
pub(crate) struct Ring {
    /// Radius of the circle, mm.
    pub(crate) radius: f64,
    /// Its height, mm.
    pub(crate) height: f64,
    /// The height that all of them look at, mm.
    pub(crate) target: f64,
    /// Pictures, pixels.
    pub(crate) size: [u32; 2],
    /// Focal length, pixels.
    pub(crate) focal: f64,
}

impl Ring {
    pub(crate) fn cameras(&self) -> Vec<Camera> {
        (0..4)
            .map(|index| {
                let angle = 0.4 + f64::from(index) * std::f64::consts::FRAC_PI_2;
                let centre = DVec3::new(self.radius * angle.cos(), self.radius * angle.sin(), self.height);
                let forward = (DVec3::new(0.0, 0.0, self.target) - centre).normalize();
                let right = forward.cross(DVec3::Z).normalize();
                let rotation = DMat3::from_cols(right, forward.cross(right), forward).transpose();
                let [width, height] = self.size.map(f64::from);
                Camera {
                    name: format!("cam{index}"),
                    size: self.size,
                    camera_from_world: DAffine3 { matrix3: rotation, translation: -(rotation * centre) },
                    lens: Lens::BrownConrady(BrownConrady {
                        focal: DVec2::splat(self.focal),
                        centre: DVec2::new(0.5 * (width - 1.0), 0.5 * (height - 1.0)),
                        radial: [-0.05, 0.01, 0.0],
                        tangential: [0.001, -0.001],
                    }),
                }
            })
            .collect()
    }
}

/// Writes a sequence of 25 frames a second into a folder: pictures and masks of the poses, calibration, body, first pose, truth.
pub(crate) fn write(folder: &Path, name: &str, body: &Body, cameras: &[Camera], table: &PoseTable) {
    body.save(&folder.join("body.toml"), Overwrite::Refuse).unwrap();
    write_cameras_toml(&folder.join("cameras.toml"), cameras, Overwrite::Refuse).unwrap();
    let start = PoseTable { frames: vec![0], poses: vec![table.poses[0].clone()] };
    start.write(&folder.join("start.csv"), Overwrite::Refuse, body).unwrap();
    table.write(&folder.join("truth_poses.csv"), Overwrite::Refuse, body).unwrap();
    let joints = body.joint_trajectory(table, 25.0).unwrap();
    write_points(&folder.join("truth.csv"), &joints, Overwrite::Refuse).unwrap();
    fs::create_dir(folder.join("frames")).unwrap();
    let reference = Reference::new(body, cameras);
    let mut manifest = format!(
        "name = \"{name}\"\nfps = 25.0\ncameras = \"cameras.toml\"\nbody = \"body.toml\"\n\
         start = \"start.csv\"\ntruth = \"truth.csv\"\n"
    );
    for (view, camera) in cameras.iter().enumerate() {
        let name = &camera.name;
        manifest.push_str(&format!(
            "[[view]]\ncamera = \"{name}\"\nsource = \"frames/{name}_%04d.png\"\nmask = \"frames/{name}_mask_%04d.png\"\n"
        ));
        for (frame, pose) in table.poses.iter().enumerate() {
            let pose: Vec<f32> = pose.iter().map(|value| *value as f32).collect();
            let image = reference.draw(&pose, view);
            let label = |x: u32, y: u32| image.bytes[(y * image.width + x) as usize] & 0x7f;
            let picture = RgbImage::from_fn(image.width, image.height, |x, y| match label(x, y) {
                0 => Rgb([40, 60, 50]),
                label => Rgb([250 - 9 * label, 100 + 30 * (label % 5), 90 + 50 * (label % 3)]),
            });
            let mask =
                GrayImage::from_fn(image.width, image.height, |x, y| Luma([if label(x, y) > 0 { 255 } else { 0 }]));
            picture.save(folder.join(format!("frames/{name}_{frame:04}.png"))).unwrap();
            mask.save(folder.join(format!("frames/{name}_mask_{frame:04}.png"))).unwrap();
        }
    }
    fs::write(folder.join("sequence.toml"), manifest).unwrap();
}
