//! Cameras in the constants that calibration programs of Tsai's kind print (METHOD A2).

use glam::{DAffine3, DVec2, DVec3};

use super::{Camera, EulerOrder, Lens, Tsai, euler_matrix};

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
