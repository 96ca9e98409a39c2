//! Skin: mottled red and pale, with freckles and pores.

use serde::{Deserialize, Serialize};

use super::space::{blend, cell_of, lit, step};
use super::{Solid, Space, Staged, Texel};
use crate::texture::shaders::MATERIAL_SKIN;

/// Parameters.
#[derive(Clone, Debug, Deserialize, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct Skin {
    /// Colour of the skin, sRGB 0..1.
    pub base: [f32; 3],
    /// Colour where more blood shines through.
    pub flushed: [f32; 3],
    /// Colour of freckles.
    pub freckle: [f32; 3],
    /// Cells of the mottling a unit of length.
    pub scale: f32,
    /// How strong the mottling is, 0 to 1.
    pub mottling: f32,
    /// The part of freckle places that have one, 0 to 1.
    pub freckles: f32,
    /// Pores a unit of length.
    pub pores: f32,
}

impl Default for Skin {
    fn default() -> Self {
        Self {
            base: [0.90, 0.72, 0.61],
            flushed: [0.80, 0.46, 0.40],
            freckle: [0.58, 0.36, 0.25],
            scale: 1.6,
            mottling: 0.75,
            freckles: 0.25,
            pores: 26.0,
        }
    }
}

/// Cells a unit of length for jittered points of a frequency, and cells a tile.
fn places(space: &Space<'_>, frequency: f32) -> ([f32; 3], [f32; 2]) {
    let per_unit = [space.whole(frequency, 0, 1.0), space.whole(frequency, 1, 1.0), frequency];
    (per_unit, space.cells([per_unit[0], per_unit[1]]))
}

/// Distance in cells from a point to the nearest jittered point of a lattice of space, and a number of that point's own.
fn nearest(space: &Space<'_>, frequency: f32, p: [f32; 3]) -> (f32, f32) {
    let (per_unit, cells) = places(space, frequency);
    let place: [f32; 3] = std::array::from_fn(|axis| p[axis] * per_unit[axis]);
    let base = place.map(f32::floor);
    let (mut closest, mut own) = (f32::MAX, 0.0);
    for index in 0..27_i32 {
        let step = [index % 3 - 1, index / 3 % 3 - 1, index / 9 - 1];
        let corner: [f32; 3] = std::array::from_fn(|axis| base[axis] + step[axis] as f32);
        let cell = corner.map(cell_of);
        let away: [f32; 3] =
            std::array::from_fn(|axis| corner[axis] + space.cell(cell, cells, axis as u64) - place[axis]);
        let square = away[0] * away[0] + away[1] * away[1] + away[2] * away[2];
        if square < closest {
            (closest, own) = (square, space.cell(cell, cells, 3));
        }
    }
    (closest.sqrt(), own)
}

impl Solid for Skin {
    fn at(&self, space: &Space<'_>, p: [f32; 3]) -> Texel {
        let broad = space.fbm(4, self.scale, p);
        let fine = space.another(1).fbm(3, self.scale * 6.0, p);
        let blood = self.mottling * (0.42 + 0.75 * broad + 0.3 * fine);
        let mut colour = blend(self.base, self.flushed, blood);
        let (distance, own) = nearest(&space.another(2), self.pores / 4.0, p);
        if own < self.freckles {
            let size = 0.12 + 0.9 * own;
            let ragged = distance + 0.12 * fine;
            colour = blend(colour, self.freckle, 0.75 * (1.0 - step(size * 0.5, size, ragged)));
        }
        let (distance, own) = nearest(&space.another(3), self.pores, p);
        let pore = 1.0 - step(0.08, 0.34 + 0.15 * own, distance);
        let relief = 1.0 - 0.14 * pore + 0.07 * space.another(4).fbm(2, self.pores * 1.3, p);
        Texel { colour: lit(colour, relief).map(|c| c.clamp(0.0, 1.0)), height: (relief - 0.3).clamp(0.0, 1.0) }
    }

    fn staged(&self, space: &Space<'_>) -> Staged {
        let ((freckles, freckle_cells), (pores, pore_cells)) =
            (places(space, self.pores / 4.0), places(space, self.pores));
        let amounts = [self.mottling, self.freckles];
        Staged {
            kind: MATERIAL_SKIN,
            numbers: [
                &self.base[..],
                &self.flushed,
                &self.freckle,
                &amounts,
                &freckles,
                &freckle_cells,
                &pores,
                &pore_cells,
            ]
            .concat(),
            sums: vec![
                space.staged_fbm(4, self.scale),
                space.another(1).staged_fbm(3, self.scale * 6.0),
                space.another(4).staged_fbm(2, self.pores * 1.3),
            ],
            ..Staged::default()
        }
    }
}
