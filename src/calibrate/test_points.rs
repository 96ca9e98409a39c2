//! Cameras and points with a known truth.

use glam::{DAffine3, DMat3, DVec2, DVec3};

use super::pairs::{CameraPairs, Pair};
use crate::geometry::{BrownConrady, Camera, Lens, Tsai};

pub(super) const SIZE: [u32; 2] = [640, 480];

/// A generator for test data: uniform numbers and normal ones.
pub(super) struct Random(pub(super) u64);

impl Random {
    pub(super) fn uniform(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 11) as f64 + 0.5) / (1_u64 << 53) as f64
    }

    pub(super) fn normal(&mut self) -> f64 {
        (-2.0 * self.uniform().ln()).sqrt() * (std::f64::consts::TAU * self.uniform()).cos()
    }
}

pub(super) fn camera(lens: Lens) -> Camera {
    let eye = DVec3::new(3900.0, -1800.0, 1700.0);
    let forward = (DVec3::new(0.0, 100.0, 900.0) - eye).normalize();
    let right = forward.cross(DVec3::Z).normalize();
    let level = DMat3::from_cols(right, forward.cross(right), forward).transpose();
    let rotation = DMat3::from_rotation_z(0.06) * level;
    let camera_from_world = DAffine3::from_mat3_translation(rotation, -(rotation * eye));
    Camera { name: "cam".into(), size: SIZE, camera_from_world, lens }
}

pub(super) fn tsai() -> Camera {
    camera(Lens::Tsai(Tsai {
        f: 8.2,
        kappa: 2.5e-3,
        centre: DVec2::new(325.0, 236.0),
        sx: 1.013,
        pitch: DVec2::splat(0.01),
    }))
}

pub(super) fn brown() -> Camera {
    camera(Lens::BrownConrady(BrownConrady {
        focal: DVec2::new(815.0, 805.0),
        centre: DVec2::new(314.0, 244.0),
        radial: [-0.21, 0.09, 0.0],
        tangential: [1e-3, -7e-4],
    }))
}

/// A wand's markers all over the volume.
pub(super) fn wand(random: &mut Random, count: usize) -> Vec<DVec3> {
    let mut side = || 2400.0 * random.uniform() - 1200.0;
    (0..count).map(|_| DVec3::new(side(), side(), 0.8 * side() + 950.0)).collect()
}

/// A board of 9 x 7 marks, tilted against the view.
pub(super) fn board() -> Vec<DVec3> {
    let (right, up) = (DVec3::new(0.3, 0.95, 0.1).normalize(), DVec3::new(-0.75, 0.15, 0.8).normalize());
    let mark = |at: usize| right * (at % 9) as f64 * 220.0 + up * (at / 9) as f64 * 220.0;
    (0..63).map(|at| DVec3::new(300.0, -800.0, 300.0) + mark(at)).collect()
}

/// What the camera sees of points, with normal noise of `deviation` pixels a coordinate; what is not in the picture is
/// left out.
pub(super) fn seen(camera: &Camera, points: &[DVec3], deviation: f64, random: &mut Random) -> CameraPairs {
    let mut pairs = Vec::new();
    for (at, &point) in points.iter().enumerate() {
        let Some(pixel) = camera.project(point) else { continue };
        let [width, height] = SIZE.map(f64::from);
        if (0.0..width).contains(&pixel.x) && (0.0..height).contains(&pixel.y) {
            let noise = DVec2::new(random.normal(), random.normal()) * deviation;
            pairs.push(Pair { name: format!("point {at}"), point, pixel: pixel + noise });
        }
    }
    CameraPairs { camera: camera.name.clone(), pairs }
}
