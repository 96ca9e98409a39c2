//! Wood: rings about the y axis, disturbed by noise, with a fine grain.

use serde::{Deserialize, Serialize};

use super::space::blend;
use super::{Solid, Space, Staged, Texel};
use crate::texture::shaders::MATERIAL_WOOD;

/// Parameters; the thesis's values by default.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct Wood {
    /// Colour of the early wood, sRGB 0..1.
    pub light: [f32; 3],
    /// Colour of the late wood.
    pub dark: [f32; 3],
    /// Rings a unit of length.
    pub frequency: f32,
    /// Factor of the noise: how far it moves the rings, units of length, shifts them in their sequence, and lightens grains.
    pub noisiness: f32,
    /// Cells of noise a unit of length, along x, y, z.
    pub scale: [f32; 3],
    /// Grains a unit of length.
    pub grain_scale: f32,
    /// The part of a grain that is light.
    pub grain_threshold: f32,
    /// How much lighter light grains are.
    pub light_grains: f32,
    /// How much darker the others are.
    pub dark_grains: f32,
}

impl Default for Wood {
    fn default() -> Self {
        Self {
            light: [0.6, 0.3, 0.1],
            dark: [0.4, 0.2, 0.07],
            frequency: 4.0,
            noisiness: 3.0,
            scale: [0.5, 0.1, 0.1],
            grain_scale: 27.0,
            grain_threshold: 0.5,
            light_grains: 1.0,
            dark_grains: 0.0,
        }
    }
}

impl Wood {
    /// How far in its year a point lies, by the rings from the middle to it: 0 in early wood, 1 in late.
    pub(super) fn season(rings: f32) -> f32 {
        let saw = 2.0 * (rings - rings.floor());
        if saw > 1.0 { 2.0 - saw } else { saw }
    }

    /// How far in its grain a point lies, in [0, 1).
    pub(super) fn grain(&self, space: &Space<'_>, p: [f32; 3]) -> f32 {
        let grains = p[0] * space.whole(self.grain_scale, 0, 1.0) + p[2] * self.grain_scale + 0.5;
        grains - grains.floor()
    }

    /// As stages take it, wood or timber by `kind`.
    pub(super) fn staged_as(&self, kind: u32, space: &Space<'_>) -> Staged {
        let Self { light, dark, frequency, noisiness, scale, grain_scale, grain_threshold, .. } = *self;
        let grain =
            [space.whole(grain_scale, 0, 1.0), grain_scale, grain_threshold, self.light_grains, self.dark_grains];
        Staged {
            kind,
            numbers: [&light[..], &dark, &[frequency, noisiness], &grain, &space.trunks(0)].concat(),
            sums: (0..3).map(|k| space.staged_octave(k, scale)).collect(),
            ..Staged::default()
        }
    }
}

impl Solid for Wood {
    fn at(&self, space: &Space<'_>, p: [f32; 3]) -> Texel {
        let mut n: [f32; 3] = std::array::from_fn(|k| self.noisiness * space.stretched_octave(k as u32, self.scale, p));
        let (x, z) = (space.from_trunk(p[0], 0) + n[0], p[2] + n[2]);
        let rings = (x * x + z * z).sqrt() * self.frequency + n.iter().sum::<f32>();
        let ring = Self::season(rings);
        let colour = blend(self.light, self.dark, ring);
        let grain = self.grain(space, p);
        n[2] *= grain;
        let (tone, change) = if grain < self.grain_threshold {
            (self.light, self.light_grains * n[2])
        } else {
            (self.dark, -self.dark_grains * n[2])
        };
        Texel {
            colour: std::array::from_fn(|i| (colour[i] + tone[i] * change).clamp(0.0, 1.0)),
            height: (1.0 - ring + change).clamp(0.0, 1.0),
        }
    }

    fn staged(&self, space: &Space<'_>) -> Staged {
        self.staged_as(MATERIAL_WOOD, space)
    }
}
