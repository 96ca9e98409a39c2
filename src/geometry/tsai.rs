//! Tsai's camera model with one radial coefficient (SPEC A2).

use glam::{DAffine3, DVec2, DVec3};

use super::{Camera, EulerOrder, Lens, euler_matrix};

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

/// The constants of Tsai's model as calibration programs print them: six of the sensor, nine of the camera.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TsaiConstants {
    /// Focal length, mm.
    pub f: f64,
    /// Radial coefficient, 1/mm^2.
    pub kappa: f64,
    /// Image centre C_x, pixels.
    pub cx: f64,
    /// Image centre C_y, pixels.
    pub cy: f64,
    /// Horizontal scale s_x.
    pub sx: f64,
    /// Sensor elements in a row, N_cx.
    pub ncx: f64,
    /// Pixels in a row, N_fx.
    pub nfx: f64,
    /// Width of a sensor element, mm.
    pub dx: f64,
    /// Height of a sensor element, mm.
    pub dy: f64,
    /// Rotation about x, radians; the whole is R = R_z R_y R_x, camera from world.
    pub rx: f64,
    /// Rotation about y, radians.
    pub ry: f64,
    /// Rotation about z, radians.
    pub rz: f64,
    /// Translation in the camera's frame, mm.
    pub tx: f64,
    /// Translation in the camera's frame, mm.
    pub ty: f64,
    /// Translation in the camera's frame, mm.
    pub tz: f64,
}

impl TsaiConstants {
    /// The camera of these constants: P_c = R P_w + T with R = R_z(rz) R_y(ry) R_x(rx).
    pub fn camera(&self, name: &str, size: [u32; 2]) -> Camera {
        let rotation = euler_matrix(DVec3::new(self.rx, self.ry, self.rz), EulerOrder::Zyx);
        let lens = Tsai {
            f: self.f,
            kappa: self.kappa,
            centre: DVec2::new(self.cx, self.cy),
            sx: self.sx,
            // The ratio first: where N_cx = N_fx the pitch is then exactly d_x.
            pitch: DVec2::new(self.dx * (self.ncx / self.nfx), self.dy),
        };
        Camera {
            name: name.to_string(),
            size,
            camera_from_world: DAffine3::from_mat3_translation(rotation, DVec3::new(self.tx, self.ty, self.tz)),
            lens: Lens::Tsai(lens),
        }
    }

    /// The constants of a camera with Tsai's lens, None for another lens. The sensor's width in elements is not known
    /// any more: N_cx = N_fx = the picture's width, and d_x is the effective pitch.
    pub fn of(camera: &Camera) -> Option<Self> {
        let Lens::Tsai(lens) = camera.lens else { return None };
        let m = camera.camera_from_world.matrix3;
        // R_z R_y R_x has -sin(ry) in its lower left corner and cos(ry) times the other two pairs beside it.
        let cos_ry = m.x_axis.x.hypot(m.x_axis.y);
        let ry = (-m.x_axis.z).atan2(cos_ry);
        // Looking straight along the gimbal's lock only rx - rz or rx + rz is determined: rz takes all of it.
        let (rx, rz) = if cos_ry > 1e-9 {
            (m.y_axis.z.atan2(m.z_axis.z), m.x_axis.y.atan2(m.x_axis.x))
        } else {
            (0.0, (-m.y_axis.x).atan2(m.y_axis.y))
        };
        let width = f64::from(camera.size[0]);
        let [tx, ty, tz] = camera.camera_from_world.translation.to_array();
        Some(Self {
            f: lens.f,
            kappa: lens.kappa,
            cx: lens.centre.x,
            cy: lens.centre.y,
            sx: lens.sx,
            ncx: width,
            nfx: width,
            dx: lens.pitch.x,
            dy: lens.pitch.y,
            rx,
            ry,
            rz,
            tx,
            ty,
            tz,
        })
    }
}

fn finite(at: DVec2) -> Option<DVec2> {
    at.is_finite().then_some(at)
}
