//! Grass: blades, each a tapered stroke over those behind it.

use serde::{Deserialize, Serialize};

use super::space::{blend, cell_of, lit};
use super::{Solid, Space, Staged, Texel};
use crate::arithmetic::sine_of_turns;
use crate::texture::shaders::MATERIAL_GRASS;

/// Parameters.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct Grass {
    /// Colour at the ground, sRGB 0..1.
    pub root: [f32; 3],
    /// Colour of fresh tips.
    pub tip: [f32; 3],
    /// Colour of dry tips.
    pub dry: [f32; 3],
    /// Cells of blades a unit of length.
    pub density: f32,
    /// Length of a blade, cells, at most 2.
    pub length: f32,
    /// Width of a blade at its root, cells.
    pub width: f32,
    /// How far blades lean from y, radians.
    pub lean: f32,
}

impl Default for Grass {
    fn default() -> Self {
        Self {
            root: [0.10, 0.20, 0.06],
            tip: [0.52, 0.72, 0.24],
            dry: [0.76, 0.71, 0.38],
            density: 7.0,
            length: 1.8,
            width: 0.24,
            lean: 0.7,
        }
    }
}

/// Blades that grow in a cell.
const BLADES: u64 = 6;
/// Turns a radian.
const TURNS: f32 = 0.159_154_94;

impl Solid for Grass {
    fn at(&self, space: &Space<'_>, p: [f32; 3]) -> Texel {
        let per_unit = [0, 1].map(|axis| space.whole(self.density, axis, 1.0));
        let cells = space.cells(per_unit);
        let (x, y) = (p[0] * per_unit[0], p[1] * per_unit[1]);
        let layer = cell_of(p[2] * self.density / 4.0);
        let (cx, cy) = (x.floor(), y.floor());
        let length = self.length.clamp(0.0, 2.0);
        // Uppermost blade so far: its order, the place along it, the place across it, its cell and number.
        let mut best: Option<(f32, f32, f32, [i32; 3], u64)> = None;
        for dy in -2..=1_i32 {
            for dx in -2..=2_i32 {
                let cell = [cell_of(x).wrapping_add(dx), cell_of(y).wrapping_add(dy), layer];
                for blade in 0..BLADES {
                    let die = |number: u64| space.cell(cell, cells, 8 * blade + number);
                    let root = [cx + dx as f32 + die(0), cy + dy as f32 + die(1)];
                    let angle = (2.0 * die(2) - 1.0) * self.lean;
                    let reach = length * (0.5 + 0.5 * die(3));
                    let (from_x, from_y) = (x - root[0], y - root[1]);
                    let turns = angle * TURNS;
                    let (sin, cos) = (sine_of_turns(turns), sine_of_turns(turns + 0.25));
                    let along = (from_x * sin + from_y * cos) / reach.max(1e-3);
                    if !(0.0..=1.0).contains(&along) {
                        continue;
                    }
                    // Blades bend to the side they lean to.
                    let bend = 0.35 * angle * along * along * reach;
                    let across = from_x * cos - from_y * sin - bend;
                    let half = 0.5 * self.width * (1.0 - along * along);
                    let order = die(4);
                    if across.abs() <= half && best.is_none_or(|(uppermost, ..)| order > uppermost) {
                        best = Some((order, along, across, cell, blade));
                    }
                }
            }
        }
        let patch = 0.5 + 0.5 * space.fbm(3, 0.8, p);
        let Some((order, along, across, cell, blade)) = best else {
            return Texel { colour: lit(self.root, 0.5 + 0.4 * patch), height: 0.0 };
        };
        let dryness = (space.cell(cell, cells, 8 * blade + 5) - 0.75 + 0.5 * (patch - 0.5)) * 3.0;
        let green = blend(self.tip, self.dry, dryness);
        let colour = blend(self.root, green, 0.2 + 0.45 * order + 0.45 * along);
        // A blade is folded along its middle: one half is lighter.
        let fold = if across > 0.0 { 1.1 } else { 0.88 };
        Texel {
            colour: lit(colour, fold * (0.8 + 0.35 * patch)).map(|c| c.min(1.0)),
            height: 0.2 + 0.5 * order + 0.3 * along,
        }
    }

    fn staged(&self, space: &Space<'_>) -> Staged {
        let per_unit = [0, 1].map(|axis| space.whole(self.density, axis, 1.0));
        let blades = [self.density, self.length.clamp(0.0, 2.0), self.width, self.lean];
        Staged {
            kind: MATERIAL_GRASS,
            numbers: [&self.root[..], &self.tip, &self.dry, &per_unit, &space.cells(per_unit), &blades].concat(),
            sums: vec![space.staged_fbm(3, 0.8)],
            ..Staged::default()
        }
    }
}
