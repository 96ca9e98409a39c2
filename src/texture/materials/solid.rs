//! What every material answers: the texel at a point of object space.

use super::Space;
use super::staged::Staged;
use crate::arithmetic::real_power;

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
        // Products with 1 / 12.92 and 1 / 1.055, which every device rounds alike.
        self.colour.map(|c| if c <= 0.040_45 { c * 0.077_399_38 } else { real_power((c + 0.055) * 0.947_867_3, 2.4) })
    }
}

/// Something with a texel at each point of object space.
pub(crate) trait Solid: Send + Sync {
    /// The texel at `p`, object units.
    fn at(&self, space: &Space<'_>, p: [f32; 3]) -> Texel;

    /// Cells of its finest strong detail a unit of length, which pictures hold their samples to; 0 where coarse pixels do it no harm.
    fn finest(&self) -> f32 {
        0.0
    }

    /// The same for stages, numbers and octaves in the order of `glsl/texture/materials.glsl`.
    fn staged(&self, space: &Space<'_>) -> Staged;
}
