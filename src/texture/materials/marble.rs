//! Marble: layers bent by turbulence.

use std::f32::consts::TAU;

use serde::{Deserialize, Serialize};

use super::space::blend;
use super::{Solid, Space, Staged, Texel};
use crate::arithmetic::sine_of_turns;
use crate::texture::noise::Sum;
use crate::texture::shaders::MATERIAL_MARBLE;

/// Parameters; frequencies are the thesis's by default.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct Marble {
    /// Colour of the veins, sRGB 0..1.
    pub vein: [f32; 3],
    /// Colour between them.
    pub stone: [f32; 3],
    /// Radians of the layers a unit of y.
    pub frequency: f32,
    /// Radians that turbulence bends them.
    pub bend: f32,
    /// Cells of noise a unit of length.
    pub scale: f32,
}

impl Default for Marble {
    fn default() -> Self {
        Self { vein: [0.32, 0.3, 0.34], stone: [0.93, 0.92, 0.88], frequency: 6.0, bend: 12.0, scale: 1.0 }
    }
}

impl Marble {
    /// Turns of the layers a unit of y, and those that turbulence bends them.
    fn turns(&self, space: &Space<'_>) -> [f32; 2] {
        [space.whole(self.frequency / TAU, 1, 1.0), self.bend / TAU]
    }
}

impl Solid for Marble {
    fn at(&self, space: &Space<'_>, p: [f32; 3]) -> Texel {
        let turbulence = space.sum(Sum::Turbulence, 4, [self.scale; 3], p) / 4.0;
        let [waves, bend] = self.turns(space);
        let height = 0.5 * sine_of_turns(waves * p[1] + bend * turbulence) + 0.5;
        Texel { colour: blend(self.vein, self.stone, height), height }
    }

    fn staged(&self, space: &Space<'_>) -> Staged {
        Staged {
            kind: MATERIAL_MARBLE,
            numbers: [&self.vein[..], &self.stone, &self.turns(space)].concat(),
            sums: vec![space.staged(Sum::Turbulence, 4, [self.scale; 3])],
            ..Staged::default()
        }
    }
}
