//! Timber: wood as floors and furniture show it. Noise is taken about its mean, so that rings stay about the y axis and follow each
//! other evenly, and the grain is faint.

use serde::{Deserialize, Serialize};

use super::space::blend;
use super::{Solid, Space, Staged, Texel, Wood};
use crate::texture::shaders::MATERIAL_TIMBER;

/// Parameters: those of wood, of which `noisiness` is how far noise moves the rings, units of length, and nothing else.
#[derive(Clone, Debug, Default, Deserialize, Serialize)]
#[serde(transparent)]
pub struct Timber(pub Wood);

impl Solid for Timber {
    fn at(&self, space: &Space<'_>, p: [f32; 3]) -> Texel {
        let wood = &self.0;
        let octaves: [f32; 3] = std::array::from_fn(|k| space.stretched_octave(k as u32, wood.scale, p));
        let moved = wood.noisiness * (octaves[0] - 0.25);
        let (x, z) = (space.across(p[0], 0) + moved, p[2] + wood.noisiness * (octaves[1] - 0.125));
        let rings = (x * x + z * z).sqrt() * wood.frequency + octaves.iter().sum::<f32>();
        let ring = Wood::season(rings);
        let colour = blend(wood.light, wood.dark, ring);
        let grain = wood.grain(space, p);
        let strength = octaves[2] * grain;
        let change = if grain < wood.grain_threshold { wood.light_grains } else { -wood.dark_grains } * strength;
        Texel {
            colour: std::array::from_fn(|i| (colour[i] + wood.light[i] * change).clamp(0.0, 1.0)),
            height: (1.0 - ring + change).clamp(0.0, 1.0),
        }
    }

    fn staged(&self, space: &Space<'_>) -> Staged {
        self.0.staged_as(MATERIAL_TIMBER, space)
    }
}
