//! Cameras: where they stand and how their lens maps (SPEC A2).

use glam::{DAffine3, DVec2, DVec3};

/// A calibrated camera.
#[derive(Clone, Debug, PartialEq)]
pub struct Camera {
    /// Its name, as files and columns carry it.
    pub name: String,
    /// Picture size in pixels, width then height.
    pub size: [u32; 2],
    /// Maps a point in the world (mm) to the camera's frame (mm): x right, y down, z along the view.
    pub camera_from_world: DAffine3,
    /// From the camera's frame to pixels.
    pub lens: Lens,
}

/// A lens model.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Lens {
    /// Tsai's model with one radial coefficient.
    Tsai(Tsai),
    /// The model of OpenCV, Pose2Sim, anipose and Qualisys files.
    BrownConrady(BrownConrady),
}

/// Intrinsics of Tsai's model (SPEC A2): X_u = X_d (1 + kappa r_d^2) on the image plane in mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tsai {
    /// Focal length, mm.
    pub f: f64,
    /// Radial coefficient, 1/mm^2.
    pub kappa: f64,
    /// Image centre, pixels.
    pub centre: DVec2,
    /// Horizontal scale.
    pub sx: f64,
    /// Effective pixel pitch, mm: d_x N_cx / N_fx and d_y.
    pub pitch: DVec2,
}

/// Intrinsics of the Brown-Conrady model: pixels from the distorted normalised coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BrownConrady {
    /// Focal lengths, pixels.
    pub focal: DVec2,
    /// Principal point, pixels.
    pub centre: DVec2,
    /// Radial coefficients k1 k2 k3.
    pub radial: [f64; 3],
    /// Tangential coefficients p1 p2.
    pub tangential: [f64; 2],
}

impl Camera {
    /// The camera's centre in the world, mm.
    pub fn centre_in_world(&self) -> DVec3 {
        -(self.camera_from_world.matrix3.transpose() * self.camera_from_world.translation)
    }
}

impl BrownConrady {
    /// The squared undistorted radius (normalised coordinates) where r (1 + k1 r^2 + k2 r^4 + k3 r^6) stops being
    /// monotone; infinity where it never does. A point beyond has no image.
    pub fn max_radius_squared(&self) -> f64 {
        let [k1, k2, k3] = self.radial;
        let slope = |t: f64| 1.0 + t * (3.0 * k1 + t * (5.0 * k2 + t * 7.0 * k3));
        let mut t = 0.0;
        while t < 100.0 {
            let next = t + 0.01;
            if slope(next) <= 0.0 {
                let (mut low, mut high) = (t, next);
                for _ in 0..60 {
                    let middle = 0.5 * (low + high);
                    if slope(middle) > 0.0 { low = middle } else { high = middle }
                }
                return low;
            }
            t = next;
        }
        f64::INFINITY
    }
}
