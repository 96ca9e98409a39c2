//! Timber: wood as floors and furniture show it. Noise is taken about its mean, so that rings stay about the y axis and follow each
//! other evenly, and the grain is faint.

use serde::Deserialize;

use super::space::blend;
use super::{Solid, Space, Texel};
use crate::texture::shaders::MATERIAL_TIMBER;

/// Parameters; those of the thesis's wood by default.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Timber {
    /// Colour of the early wood, sRGB 0..1.
    pub light: [f32; 3],
    /// Colour of the late wood.
    pub dark: [f32; 3],
    /// Rings a unit of length.
    pub frequency: f32,
    /// How far noise moves the rings, units of length.
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

impl Default for Timber {
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

impl Solid for Timber {
    fn at(&self, space: &Space, p: [f32; 3]) -> Texel {
        let octaves: [f32; 3] = std::array::from_fn(|k| space.stretched_octave(k as u32, self.scale, p));
        let moved = self.noisiness * (octaves[0] - 0.25);
        let (x, z) = (space.across(p[0], 0) + moved, p[2] + self.noisiness * (octaves[1] - 0.125));
        let rings = (x * x + z * z).sqrt() * self.frequency + octaves.iter().sum::<f32>();
        let saw = 2.0 * (rings - rings.floor());
        let ring = if saw > 1.0 { 2.0 - saw } else { saw };
        let colour = blend(self.light, self.dark, ring);
        let grains = p[0] * space.whole(self.grain_scale, 0, 1.0) + p[2] * self.grain_scale + 0.5;
        let grain = grains - grains.floor();
        let strength = octaves[2] * grain;
        let change = if grain < self.grain_threshold { self.light_grains } else { -self.dark_grains } * strength;
        Texel {
            colour: std::array::from_fn(|i| (colour[i] + self.light[i] * change).clamp(0.0, 1.0)),
            height: (1.0 - ring + change).clamp(0.0, 1.0),
        }
    }

    fn numbers(&self) -> Option<(u32, Vec<f32>)> {
        let Self { light, dark, frequency, noisiness, scale, grain_scale, grain_threshold, .. } = *self;
        let grain = [grain_scale, grain_threshold, self.light_grains, self.dark_grains];
        Some((MATERIAL_TIMBER, [&light[..], &dark, &[frequency, noisiness], &scale, &grain].concat()))
    }
}
