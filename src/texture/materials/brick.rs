//! A wall of bricks in running bond, each of its own shade, with rough faces and mortar between.

use serde::{Deserialize, Serialize};

use super::space::{blend, cell_of, lit, step};
use super::{Solid, Space, Staged, Texel};
use crate::texture::shaders::MATERIAL_BRICK;

/// Parameters.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct Brick {
    /// Colour of the brightest bricks, sRGB 0..1.
    pub brick: [f32; 3],
    /// Colour of the darkest.
    pub burnt: [f32; 3],
    /// Colour of the mortar.
    pub mortar: [f32; 3],
    /// Length, height and depth of a brick with its mortar, units of length.
    pub size: [f32; 3],
    /// Width of the joints, units of length.
    pub joint: f32,
    /// How rough faces and edges are, 0 to 1.
    pub roughness: f32,
}

impl Default for Brick {
    fn default() -> Self {
        Self {
            brick: [0.66, 0.28, 0.19],
            burnt: [0.40, 0.15, 0.12],
            mortar: [0.69, 0.66, 0.61],
            size: [0.8, 0.3, 0.8],
            joint: 0.045,
            roughness: 0.5,
        }
    }
}

impl Brick {
    /// Bricks a unit of length. Rows come in pairs, so that the shift of every second one fits the tile.
    fn per_unit(&self, space: &Space<'_>) -> [f32; 3] {
        let size = self.size.map(|s| s.abs().max(1e-3));
        [space.whole(1.0 / size[0], 0, 1.0), space.whole(1.0 / size[1], 1, 2.0), 1.0 / size[2]]
    }
}

impl Solid for Brick {
    fn at(&self, space: &Space<'_>, p: [f32; 3]) -> Texel {
        let per_unit = self.per_unit(space);
        let lengths = per_unit.map(|count| 1.0 / count);
        let wobble = 0.03 * self.roughness * space.fbm(3, 6.0, p);
        let row = (p[1] + wobble) * per_unit[1];
        let shift = if cell_of(row) & 1 == 1 { 0.5 } else { 0.0 };
        let along = (p[0] - wobble) * per_unit[0] + shift;
        let deep = p[2] * per_unit[2] + 0.5;
        let place = [along, row, deep];
        let cell = place.map(cell_of);
        // Distance to the nearest joint, units of length.
        let inside = (0..3)
            .map(|axis| {
                let t = place[axis] - place[axis].floor();
                t.min(1.0 - t) * lengths[axis]
            })
            .fold(f32::MAX, f32::min);
        let half = self.joint.abs() / 2.0;
        let face = step(half * 0.7, half * 1.6, inside);
        let shade = space.cell(cell, space.cells([per_unit[0], per_unit[1]]), 0);
        let rough = space.another(7).fbm(4, 9.0, p);
        let clay = lit(blend(self.burnt, self.brick, shade), 1.0 + self.roughness * 0.45 * rough);
        let sand = lit(self.mortar, 1.0 + self.roughness * 0.3 * space.another(8).fbm(3, 22.0, p));
        let height = (face * (0.75 + 0.15 * shade + 0.2 * self.roughness * rough) + 0.15).clamp(0.0, 1.0);
        Texel { colour: blend(sand, clay, face), height }
    }

    fn staged(&self, space: &Space<'_>) -> Staged {
        let per_unit = self.per_unit(space);
        let lengths = per_unit.map(|count| 1.0 / count);
        let edges = [self.joint.abs() / 2.0, self.roughness];
        let cells = space.cells([per_unit[0], per_unit[1]]);
        Staged {
            kind: MATERIAL_BRICK,
            numbers: [&self.brick[..], &self.burnt, &self.mortar, &per_unit, &lengths, &edges, &cells].concat(),
            sums: vec![
                space.staged_fbm(3, 6.0),
                space.another(7).staged_fbm(4, 9.0),
                space.another(8).staged_fbm(3, 22.0),
            ],
            ..Staged::default()
        }
    }
}
