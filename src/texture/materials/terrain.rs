//! Terrain from above: heights by mid-point displacement or by noise, in colour bands or with isolines.

use std::sync::OnceLock;

use serde::{Deserialize, Serialize};

use super::midpoint::{Displacement, Surface};
use super::space::{blend, lit};
use super::{Solid, Space, Staged, Texel};
use crate::texture::noise::Sum;
use crate::texture::shaders::{MATERIAL_FRACTAL, MATERIAL_OCTAVES, MATERIAL_TERRAIN};

/// A colour from a height on.
#[derive(Clone, Copy, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Band {
    /// Height, 0 to 1.
    pub from: f32,
    /// Colour there, sRGB 0..1.
    pub colour: [f32; 3],
}

/// Looks that both kinds of terrain share.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct Map {
    /// Colours by height, lowest first; between two they are mixed.
    pub bands: Vec<Band>,
    /// Heights below are water: flat.
    pub sea: f32,
    /// Height between isolines; 0 draws none.
    pub isolines: f32,
    /// Width of an isoline, units of length.
    pub line: f32,
    /// How strongly slopes are shaded, 0 to 1.
    pub shading: f32,
}

impl Default for Map {
    fn default() -> Self {
        let band = |from, colour| Band { from, colour };
        Self {
            bands: vec![
                band(0.0, [0.05, 0.12, 0.36]),
                band(0.36, [0.16, 0.40, 0.66]),
                band(0.40, [0.36, 0.60, 0.76]),
                band(0.405, [0.84, 0.78, 0.58]),
                band(0.45, [0.44, 0.60, 0.27]),
                band(0.60, [0.19, 0.41, 0.17]),
                band(0.70, [0.45, 0.39, 0.30]),
                band(0.82, [0.56, 0.53, 0.50]),
                band(0.88, [0.96, 0.97, 1.0]),
            ],
            sea: 0.4025,
            isolines: 0.0,
            line: 0.012,
            shading: 0.8,
        }
    }
}

impl Map {
    /// The colour of a place, from the heights of itself and its neighbours a step to the right (x) and up (y), of which `per_unit` make
    /// a unit of length.
    fn colour(&self, height: f32, right: f32, up: f32, per_unit: f32) -> [f32; 3] {
        let mut colour = self.bands.first().map_or([height; 3], |band| band.colour);
        for pair in self.bands.windows(2) {
            if height >= pair[0].from {
                let t = (height - pair[0].from) / (pair[1].from - pair[0].from).max(1e-6);
                colour = blend(pair[0].colour, pair[1].colour, t);
            }
        }
        let slope = [(right - height) * per_unit, (up - height) * per_unit];
        if height > self.sea {
            // Light from the upper left.
            let light = (slope[0] - slope[1]) * 0.8;
            colour = lit(colour, 1.0 + self.shading * (light / (1.0 + light.abs())));
        }
        if self.isolines > 0.0 {
            let level = height * (1.0 / self.isolines);
            let away = (level - (level + 0.5).floor()).abs() * self.isolines;
            let steepness = (slope[0] * slope[0] + slope[1] * slope[1]).sqrt().max(1e-4);
            let covered = 1.5 - away / (steepness * self.half_line());
            colour = blend(colour, lit(colour, 0.3), covered);
        }
        colour.map(|c| c.clamp(0.0, 1.0))
    }
}

impl Map {
    /// Half of an isoline's width.
    fn half_line(&self) -> f32 {
        0.5 * self.line.max(1e-6)
    }

    /// Its numbers for stages, and its bands.
    fn staged(&self, step: f32) -> ([f32; 8], Vec<f32>) {
        let lines = [if self.isolines > 0.0 { 1.0 / self.isolines } else { 0.0 }, self.isolines, self.half_line()];
        let bands = self.bands.iter().flat_map(|&Band { from, colour: [r, g, b] }| [from, r, g, b]).collect();
        let [inverse, height, half] = lines;
        ([self.sea, inverse, height, half, self.shading, step, 1.0 / step, self.bands.len() as f32], bands)
    }
}

/// Terrain by random mid-point displacement.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct Fractal {
    /// Length after which it repeats, units; a tile's length goes before it.
    pub period: f32,
    /// Levels of displacement: 2^levels points a period, at most 11.
    pub levels: u32,
    /// Displacements shrink by 2^-smoothness from level to level.
    pub smoothness: f32,
    /// Its looks.
    pub map: Map,
}

impl Default for Fractal {
    fn default() -> Self {
        Self { period: 4.0, levels: 9, smoothness: 0.95, map: Map::default() }
    }
}

/// [`Fractal`] with its surface, which a device displaces by itself.
#[derive(Clone, Debug)]
pub(super) struct Displaced {
    parameters: Fractal,
    displacement: Displacement,
    surface: OnceLock<Surface>,
}

impl Fractal {
    pub(super) fn displaced(&self, seed: u64) -> Displaced {
        let displacement = Displacement::new(seed, self.levels, self.smoothness);
        Displaced { parameters: self.clone(), displacement, surface: OnceLock::new() }
    }
}

impl Displaced {
    /// Lengths after which it repeats.
    fn lengths(&self, space: &Space<'_>) -> [f32; 2] {
        space.tile().map(|tile| if tile > 0.0 { tile } else { self.parameters.period.abs().max(1e-3) })
    }
}

/// The way to a neighbour, by the length after which a surface repeats.
fn step_of(length: f32) -> f32 {
    0.004 * length
}

impl Solid for Displaced {
    fn at(&self, space: &Space<'_>, p: [f32; 3]) -> Texel {
        let map = &self.parameters.map;
        let lengths = self.lengths(space);
        let per_unit = lengths.map(|length| 1.0 / length);
        let surface = self.surface.get_or_init(|| Surface::of(&self.displacement));
        // An object's sides show the surface sheared along z.
        let height = |x: f32, y: f32| surface.at((x + 0.7 * p[2]) * per_unit[0], (y + 0.4 * p[2]) * per_unit[1]);
        let step = step_of(lengths[0]);
        let here = height(p[0], p[1]);
        Texel {
            colour: map.colour(here, height(p[0] + step, p[1]), height(p[0], p[1] + step), 1.0 / step),
            height: here.max(map.sea),
        }
    }

    fn staged(&self, space: &Space<'_>) -> Staged {
        let lengths = self.lengths(space);
        let (map, bands) = self.parameters.map.staged(step_of(lengths[0]));
        let place = [self.displacement.side as f32, 1.0 / lengths[0], 1.0 / lengths[1]];
        Staged {
            kind: MATERIAL_FRACTAL,
            numbers: [&map[..], &place].concat(),
            sums: Vec::new(),
            bands,
            surface: Some(self.displacement.clone()),
        }
    }
}

/// Terrain by noise.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct Terrain {
    /// What is summed of the octaves.
    pub sum: Sum,
    /// Octaves, at most 16.
    pub octaves: u32,
    /// Cells of the first octave a unit of length.
    pub scale: f32,
    /// Its looks.
    pub map: Map,
}

impl Default for Terrain {
    fn default() -> Self {
        Self { sum: Sum::Fbm, octaves: 8, scale: 0.8, map: Map { isolines: 0.05, ..Map::default() } }
    }
}

impl Terrain {
    fn octaves(&self) -> u32 {
        self.octaves.clamp(1, MATERIAL_OCTAVES)
    }

    /// The way to a neighbour.
    fn step(&self) -> f32 {
        0.01 / self.scale.abs().max(1e-3)
    }
}

impl Solid for Terrain {
    fn at(&self, space: &Space<'_>, p: [f32; 3]) -> Texel {
        let count = self.octaves();
        let height = |x: f32, y: f32| {
            let sum = space.sum(self.sum, count, [self.scale; 3], [x, y, p[2]]);
            let sum = match self.sum {
                Sum::Fbm => 0.5 + 0.55 * sum,
                Sum::Turbulence => sum,
                Sum::Ridged => 0.5 * sum,
            };
            sum.clamp(0.0, 1.0)
        };
        let step = self.step();
        let here = height(p[0], p[1]);
        Texel {
            colour: self.map.colour(here, height(p[0] + step, p[1]), height(p[0], p[1] + step), 1.0 / step),
            height: here.max(self.map.sea),
        }
    }

    fn staged(&self, space: &Space<'_>) -> Staged {
        let (map, bands) = self.map.staged(self.step());
        let sums = vec![space.staged(self.sum, self.octaves(), [self.scale; 3])];
        Staged { kind: MATERIAL_TERRAIN, numbers: map.to_vec(), sums, bands, surface: None }
    }
}
