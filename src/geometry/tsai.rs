//! Tsai's camera model with one radial coefficient (METHOD A2).

use glam::DVec2;

/// Intrinsics of Tsai's model (METHOD A2): X_u = X_d (1 + kappa r_d^2) on the image plane in mm.
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

impl Tsai {
    /// Normalised undistorted coordinates (x/z, y/z) to normalised distorted ones (X_d / f, Y_d / f). None past the end
    /// of the branch, where 1 + 3 kappa r_d^2 = 0, and for what is not a number.
    pub fn distort(&self, undistorted: DVec2) -> Option<DVec2> {
        // With s = r_d / r_u the cubic reads s + q s^3 = 1. For q < 0 its first root, the one that continues s = 1 at
        // q = 0, exists until q = -4/27; for q > 0 the only real root is meant.
        let q = self.kappa * self.f * self.f * undistorted.length_squared();
        if !q.is_finite() || q < -4.0 / 27.0 {
            return None;
        }
        let root = (3.0 * q.abs()).sqrt();
        let s = if root == 0.0 {
            1.0
        } else if q < 0.0 {
            2.0 / root * ((1.5 * root).min(1.0).asin() / 3.0).sin()
        } else {
            2.0 / root * ((1.5 * root).asinh() / 3.0).sinh()
        };
        // One Newton step takes off the rounding of the closed form; at the branch's end the slope is nothing.
        let slope = 1.0 + 3.0 * q * s * s;
        let s = if slope > 1e-3 { s - (s + q * s * s * s - 1.0) / slope } else { s };
        finite(undistorted * s)
    }

    /// The inverse of [`Self::distort`]: None where 1 + 3 kappa r_d^2 < 0.
    pub fn undistort(&self, distorted: DVec2) -> Option<DVec2> {
        let q = self.kappa * self.f * self.f * distorted.length_squared();
        if q.is_nan() || 1.0 + 3.0 * q < 0.0 {
            return None;
        }
        finite(distorted * (1.0 + q))
    }

    /// Normalised distorted coordinates to pixels.
    pub fn to_pixel(&self, distorted: DVec2) -> DVec2 {
        DVec2::new(self.sx, 1.0) * distorted * self.f / self.pitch + self.centre
    }

    /// Pixels to normalised distorted coordinates.
    pub fn from_pixel(&self, pixel: DVec2) -> DVec2 {
        (pixel - self.centre) * self.pitch / (DVec2::new(self.sx, 1.0) * self.f)
    }
}

fn finite(at: DVec2) -> Option<DVec2> {
    at.is_finite().then_some(at)
}
