//! A camera as a list of numbers that a solver moves, some of them held.

use crate::files::choices;
use crate::geometry::{BrownConrady, Camera, Lens, Tsai, rodrigues_matrix};
use glam::{DAffine3, DMat3, DVec2, DVec3};

choices! {
    /// Which lens a camera gets.
    "lens" pub enum LensModel {
        /// Tsai's, with f, kappa, the centre and s_x.
        "tsai" Tsai,
        /// OpenCV's, with two focal lengths, the principal point, k1 k2 k3 and p1 p2.
        "brown-conrady" BrownConrady,
    }
}

choices! {
    /// What is not estimated but kept at its start: the picture's middle, square pixels, no distortion.
    "parameter to hold" pub enum Held => names: &'static [&'static str] {
        /// s_x, or the ratio fx / fy: 1.
        "aspect" Aspect => &["s_x", "fx/fy"],
        /// The image centre or principal point: the picture's middle.
        "centre" Centre => &["cx", "cy"],
        /// Every distortion coefficient: 0.
        "distortion" Distortion => &["kappa", "k1", "k2", "k3", "p1", "p2"],
        /// k2: 0.
        "k2" K2 => &["k2"],
        /// k3: 0.
        "k3" K3 => &["k3"],
        /// p1 and p2: 0.
        "tangential" Tangential => &["p1", "p2"],
    }
}

/// The numbers of a camera: a small turn (radians, camera axes) after a given rotation, the translation (mm), the lens.
#[derive(Clone, Debug)]
pub(super) struct Parameters {
    pub(super) model: LensModel,
    pub(super) values: Vec<f64>,
    size: [u32; 2],
    /// Side of a pixel, mm; only Tsai's model asks for it.
    pitch: f64,
    rotation: DMat3,
}

impl Parameters {
    /// A start: focal length in pixels, the ratio s_x of the horizontal scale; all else as
    /// [`Held`] says.
    pub(super) fn new(
        model: LensModel,
        size: [u32; 2],
        pitch: f64,
        camera_from_world: DAffine3,
        focal: f64,
        aspect: f64,
    ) -> Self {
        let centre = middle(size);
        let [tx, ty, tz] = camera_from_world.translation.to_array();
        let f = if model == LensModel::Tsai { focal * pitch } else { focal };
        let mut values = vec![0.0, 0.0, 0.0, tx, ty, tz, f, aspect, centre.x, centre.y];
        values.resize(Self::names(model).len(), 0.0);
        Self { model, values, size, pitch, rotation: camera_from_world.matrix3 }
    }

    /// Names of the values.
    pub(super) fn names(model: LensModel) -> &'static [&'static str] {
        match model {
            LensModel::Tsai => &["rx", "ry", "rz", "tx", "ty", "tz", "f", "s_x", "cx", "cy", "kappa"],
            LensModel::BrownConrady => {
                &["rx", "ry", "rz", "tx", "ty", "tz", "fy", "fx/fy", "cx", "cy", "k1", "k2", "k3", "p1", "p2"]
            }
        }
    }

    /// The places of the values that are not held.
    pub(super) fn free(model: LensModel, held: &[Held]) -> Vec<usize> {
        let is_held = |name: &str| held.iter().any(|held| held.names().contains(&name));
        Self::names(model).iter().enumerate().filter(|(_, name)| !is_held(name)).map(|(at, _)| at).collect()
    }

    /// The camera of these numbers.
    pub(super) fn camera(&self, name: &str) -> Camera {
        let v = &self.values;
        let centre = DVec2::new(v[8], v[9]);
        let lens = match self.model {
            LensModel::Tsai => {
                Lens::Tsai(Tsai { f: v[6], kappa: v[10], centre, sx: v[7], pitch: DVec2::splat(self.pitch) })
            }
            LensModel::BrownConrady => Lens::BrownConrady(BrownConrady {
                focal: DVec2::new(v[6] * v[7], v[6]),
                centre,
                radial: [v[10], v[11], v[12]],
                tangential: [v[13], v[14]],
            }),
        };
        let turn = rodrigues_matrix(DVec3::new(v[0], v[1], v[2]));
        let translation = DVec3::new(v[3], v[4], v[5]);
        let camera_from_world = DAffine3::from_mat3_translation(turn * self.rotation, translation);
        Camera { name: name.to_string(), size: self.size, camera_from_world, lens }
    }

    /// Size of the pictures, pixels.
    pub(super) fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Puts the camera somewhere else.
    pub(super) fn place(&mut self, camera_from_world: DAffine3) {
        self.rotation = camera_from_world.matrix3;
        self.values[..3].fill(0.0);
        self.values[3..6].copy_from_slice(&camera_from_world.translation.to_array());
    }

    /// Takes the turn into the rotation, so that the next starts at none.
    pub(super) fn settle(&mut self) {
        let turn = rodrigues_matrix(DVec3::from_slice(&self.values[..3]));
        self.rotation = turn * self.rotation;
        self.values[..3].fill(0.0);
    }
}

/// The middle of a picture, in pixels whose centres are whole numbers.
pub(super) fn middle([width, height]: [u32; 2]) -> DVec2 {
    0.5 * DVec2::new(f64::from(width) - 1.0, f64::from(height) - 1.0)
}
