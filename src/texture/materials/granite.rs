//! Granite: the highest octave alone, as grey grains.

use serde::{Deserialize, Serialize};

use super::{Solid, Space, Staged, Texel};
use crate::texture::shaders::MATERIAL_GRANITE;

/// Parameters; the thesis's values by default.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct Granite {
    /// Colour of the light grains, sRGB 0..1.
    pub colour: [f32; 3],
    /// Factor of the octave before it is clamped.
    pub contrast: f32,
    /// Cells of the lowest octave a unit of length; the grains are the fourth one.
    pub scale: f32,
}

impl Default for Granite {
    fn default() -> Self {
        Self { colour: [1.0; 3], contrast: 18.0, scale: 3.0 }
    }
}

impl Solid for Granite {
    fn at(&self, space: &Space<'_>, p: [f32; 3]) -> Texel {
        let height = (self.contrast * space.octave(3, self.scale, p)).clamp(0.0, 1.0);
        Texel { colour: self.colour.map(|c| c * height), height }
    }

    fn finest(&self) -> f32 {
        8.0 * self.scale
    }

    fn staged(&self, space: &Space<'_>) -> Staged {
        Staged {
            kind: MATERIAL_GRANITE,
            numbers: [&self.colour[..], &[self.contrast]].concat(),
            sums: vec![space.staged_octave(3, [self.scale; 3])],
            ..Staged::default()
        }
    }
}
