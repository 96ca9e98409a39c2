//! The sun's surface, or lava: bright where octaves cross their means.

use serde::{Deserialize, Serialize};

use super::space::blend;
use super::{Solid, Space, Staged, Texel};
use crate::texture::noise::Sum;
use crate::texture::shaders::MATERIAL_LAVA;

/// Parameters; the thesis's values by default.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct Lava {
    /// Colour of the bright veins, sRGB 0..1.
    pub bright: [f32; 3],
    /// Colour of the crust.
    pub dark: [f32; 3],
    /// Factor of the turbulence before it is clamped.
    pub contrast: f32,
    /// Cells of noise a unit of length.
    pub scale: f32,
}

impl Default for Lava {
    fn default() -> Self {
        Self { bright: [0.8, 0.7, 0.0], dark: [0.6, 0.1, 0.0], contrast: 6.0, scale: 1.2 }
    }
}

impl Solid for Lava {
    fn at(&self, space: &Space<'_>, p: [f32; 3]) -> Texel {
        let about_means = space.sum(Sum::Turbulence, 4, [self.scale; 3], p) / 4.0;
        let height = (self.contrast * about_means).clamp(0.0, 1.0);
        Texel { colour: blend(self.bright, self.dark, height), height }
    }

    fn staged(&self, space: &Space<'_>) -> Staged {
        let Self { bright, dark, contrast, scale } = *self;
        Staged {
            kind: MATERIAL_LAVA,
            numbers: [&bright[..], &dark, &[contrast]].concat(),
            sums: vec![space.staged(Sum::Turbulence, 4, [scale; 3])],
            ..Staged::default()
        }
    }
}
