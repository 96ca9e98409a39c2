//! Clouds: sky seen through four octaves of noise.

use serde::{Deserialize, Serialize};

use super::space::blend;
use super::{Solid, Space, Staged, Texel};
use crate::texture::shaders::MATERIAL_CLOUDS;

/// Parameters; the thesis's values by default.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct Clouds {
    /// Colour of the sky, sRGB 0..1.
    pub sky: [f32; 3],
    /// Colour of the clouds.
    pub cloud: [f32; 3],
    /// Added to the sum of octaves: more is cloudier.
    pub offset: f32,
    /// Factor of the sum.
    pub contrast: f32,
    /// Cells of noise a unit of length.
    pub scale: f32,
}

impl Default for Clouds {
    fn default() -> Self {
        Self { sky: [0.0, 0.0, 0.8], cloud: [0.8; 3], offset: 0.031_25, contrast: 1.5, scale: 1.0 }
    }
}

impl Solid for Clouds {
    fn at(&self, space: &Space<'_>, p: [f32; 3]) -> Texel {
        let sum: f32 = (0..4).map(|k| space.octave(k, self.scale, p)).sum();
        let height = self.contrast * (sum + self.offset);
        Texel { colour: blend(self.sky, self.cloud, height), height }
    }

    fn staged(&self, space: &Space<'_>) -> Staged {
        let Self { sky, cloud, offset, contrast, scale } = *self;
        Staged {
            kind: MATERIAL_CLOUDS,
            numbers: [&sky[..], &cloud, &[offset, contrast]].concat(),
            sums: (0..4).map(|k| space.staged_octave(k, [scale; 3])).collect(),
            ..Staged::default()
        }
    }
}
