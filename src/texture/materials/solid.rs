//! What every material answers: the texel at a point of object space.

use super::Space;

/// What a material is at a point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Texel {
    /// Colour as a screen shows it, sRGB, 0 to 1.
    pub colour: [f32; 3],
    /// Height of the surface, 0 to 1: bumps, or what the material mixes its colours by.
    pub height: f32,
}

impl Texel {
    /// The colour as light adds up: linear, 0 to 1.
    pub fn linear(&self) -> [f32; 3] {
        self.colour.map(|c| if c <= 0.040_45 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) })
    }
}

/// Something with a texel at each point of object space.
pub(crate) trait Solid: Send + Sync {
    /// The texel at `p`, object units.
    fn at(&self, space: &Space, p: [f32; 3]) -> Texel;

    /// Cells of its finest strong detail a unit of length, which pictures hold their samples to; 0 where coarse pixels do it no harm.
    fn finest(&self) -> f32 {
        0.0
    }

    /// Its kind (`MATERIAL_*`) and numbers in the order of `glsl/texture/materials.glsl`, where stages have it.
    fn numbers(&self) -> Option<(u32, Vec<f32>)> {
        None
    }
}
