//! Woven cloth: warp and weft over and under each other.

use serde::{Deserialize, Serialize};

use super::space::{cell_of, lit};
use super::{Solid, Space, Staged, Texel};
use crate::arithmetic::sine_of_turns;
use crate::texture::noise::Sum;
use crate::texture::shaders::MATERIAL_FABRIC;

/// Parameters.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct Fabric {
    /// Colour of the threads along y, sRGB 0..1.
    pub warp: [f32; 3],
    /// Colour of the threads along x.
    pub weft: [f32; 3],
    /// Threads a unit of length.
    pub threads: f32,
    /// Threads that a thread passes over at once: 1 plain weave, 2 or more twill.
    pub over: u32,
    /// How much neighbouring threads and places along them differ, 0 to 1.
    pub irregularity: f32,
}

impl Default for Fabric {
    fn default() -> Self {
        Self { warp: [0.24, 0.33, 0.56], weft: [0.72, 0.74, 0.80], threads: 14.0, over: 1, irregularity: 0.4 }
    }
}

impl Fabric {
    /// Threads that a thread passes over at once.
    fn over(&self) -> i32 {
        self.over.clamp(1, 16) as i32
    }

    /// Threads a unit of length, whole weaves a tile.
    fn per_unit(&self, space: &Space<'_>) -> [f32; 2] {
        let round = 2.0 * self.over() as f32;
        [0, 1].map(|axis| space.whole(self.threads, axis, round))
    }

    /// Cells of the fibres' noise a unit of length, of the upper thread.
    fn fibre(&self, warp_above: bool) -> [f32; 3] {
        let fibre = if warp_above { [5.0, 1.2, 1.0] } else { [1.2, 5.0, 1.0] };
        fibre.map(|f| f * self.threads * 0.5)
    }
}

impl Solid for Fabric {
    fn at(&self, space: &Space<'_>, p: [f32; 3]) -> Texel {
        let over = self.over();
        let part_of_over = 1.0 / over as f32;
        let per_unit = self.per_unit(space);
        let cells = space.cells(per_unit);
        // Threads wander a little.
        let wander = 0.18 * self.irregularity * space.fbm(2, 2.5, p);
        // The cloth lies along z too, so that an object's sides are woven as its front is.
        let x = (p[0] + p[2]) * per_unit[0] + wander;
        let y = (p[1] + p[2]) * per_unit[1] - wander;
        let (cx, cy) = (x.floor(), y.floor());
        let (column, row) = (cell_of(x), cell_of(y));
        let phase = column.wrapping_add(row).rem_euclid(2 * over);
        let warp_above = phase < over;
        // Along the upper thread: where it is between the places where it dives.
        let (along, across, colour, thread, axis) = if warp_above {
            let t = (y - cy) + phase as f32;
            (t * part_of_over, x - cx, self.warp, column, 0)
        } else {
            let t = (x - cx) + (phase - over) as f32;
            (t * part_of_over, y - cy, self.weft, row, 1)
        };
        let arch = sine_of_turns(0.5 * along.clamp(0.0, 1.0)).max(0.0).sqrt();
        let side = 2.0 * across - 1.0;
        let profile = (1.0 - side * side).max(0.0).sqrt();
        let height = (0.25 + 0.75 * arch) * profile;
        let mut key = [0, 0, i32::from(!warp_above)];
        key[axis] = thread;
        let own = space.cell(key, cells, 1) - 0.5;
        // Fibres run along the thread, twisted.
        let fibres = space.another(3).sum(Sum::Fbm, 3, self.fibre(warp_above), p);
        let shade = (0.35 + 0.65 * height) * (1.0 + self.irregularity * (0.5 * own + 0.35 * fibres));
        Texel { colour: lit(colour, shade).map(|c| c.clamp(0.0, 1.0)), height: height.clamp(0.0, 1.0) }
    }

    fn finest(&self) -> f32 {
        // Light and dark of a thread.
        2.0 * self.threads
    }

    fn staged(&self, space: &Space<'_>) -> Staged {
        let (per_unit, over) = (self.per_unit(space), self.over() as f32);
        let weave = [over, 1.0 / over, self.irregularity];
        let fibres = space.another(3);
        Staged {
            kind: MATERIAL_FABRIC,
            numbers: [&self.warp[..], &self.weft, &per_unit, &weave, &space.cells(per_unit)].concat(),
            sums: vec![
                space.staged_fbm(2, 2.5),
                fibres.staged(Sum::Fbm, 3, self.fibre(true)),
                fibres.staged(Sum::Fbm, 3, self.fibre(false)),
            ],
            ..Staged::default()
        }
    }
}
