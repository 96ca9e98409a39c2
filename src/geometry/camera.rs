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
