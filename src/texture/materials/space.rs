//! The space that materials are cut out of: noise of one seed, repeating after a tile where one is wanted.

use super::staged::StagedSum;
use crate::arithmetic::sine_of_turns;
use crate::texture::noise::{HashLattice, NoiseMaker, Octaves, Sum, mixed};
use crate::texture::shaders::layout;

/// Noise is looked up off the plane z = 0, which would be a plane of lattice points for every octave.
const OFF_LATTICE: f32 = 0.37;

/// Seed and tile.
#[derive(Clone, Copy, Debug)]
pub struct Space<'a> {
    seed: u64,
    lattice: HashLattice,
    tile: [f32; 3],
    source: &'a NoiseMaker,
}

impl<'a> Space<'a> {
    /// A space; `tile` is the length after which x and y repeat, object units, if they shall.
    pub fn new(seed: u64, tile: Option<[f32; 2]>, source: &'a NoiseMaker) -> Self {
        let tile = tile.map_or([0.0; 3], |[x, y]| [x, y, 0.0]);
        Self { seed, lattice: HashLattice::new(seed), tile, source }
    }

    /// The tile: lengths along x and y, 0 without one.
    pub fn tile(&self) -> [f32; 2] {
        [self.tile[0], self.tile[1]]
    }

    /// A space with other noise and the same tile.
    pub fn another(&self, number: u64) -> Self {
        let seed = u64::from(mixed(self.seed ^ (number << 40)));
        Self { seed, lattice: HashLattice::new(seed), ..*self }
    }

    /// A sum of octaves at a point, with lengths along the axes multiplied by `scale` first.
    pub fn sum(&self, sum: Sum, count: u32, scale: [f32; 3], p: [f32; 3]) -> f32 {
        let octaves = Octaves { sum, count, ..Octaves::default() };
        let at = |axis: usize| p[axis] * scale[axis];
        self.source.sum(&octaves, self.lattice, self.tile_of(scale), [at(0), at(1), at(2) + OFF_LATTICE])
    }

    /// The tile's lengths, multiplied by a scale.
    fn tile_of(&self, scale: [f32; 3]) -> [f32; 3] {
        std::array::from_fn(|axis| self.tile[axis] * scale[axis].abs())
    }

    /// [`Self::sum`] as stages take it.
    pub(super) fn staged(&self, sum: Sum, count: u32, scale: [f32; 3]) -> StagedSum {
        let octaves = Octaves { count, ..Octaves::default() };
        let [x, y, z] = self.tile_of(scale);
        let first = |row: [f32; 4]| [row[0], row[1], row[2]];
        let octaves = (0..)
            .zip(octaves.rows([x, y, z, 0.0]))
            .map(|(octave, row)| layout::NoiseOctave {
                scale,
                state: self.source.state(self.lattice, octave),
                frequency: first(row.frequency),
                amplitude: row.amplitude,
                period: [row.period[0], row.period[1], row.period[2]],
                ..bytemuck::Zeroable::zeroed()
            })
            .collect();
        StagedSum { sum, octaves }
    }

    /// [`Self::fbm`] as stages take it.
    pub(super) fn staged_fbm(&self, count: u32, scale: f32) -> StagedSum {
        self.staged(Sum::Fbm, count, [scale; 3])
    }

    /// The noise of [`Self::stretched_octave`] as stages take it.
    pub(super) fn staged_octave(&self, k: u32, scale: [f32; 3]) -> StagedSum {
        self.another(u64::from(k) + 1).staged(Sum::Fbm, 1, scale.map(|s| s * (1_u32 << k) as f32))
    }

    /// Signed noise of several octaves, each half of the one before, about [-1, 1].
    pub fn fbm(&self, count: u32, scale: f32, p: [f32; 3]) -> f32 {
        self.sum(Sum::Fbm, count, [scale; 3], p)
    }

    /// The octaves as the thesis stores them: octave k is `(1 + n) / 2^(k + 2)`, so [0, 2^-(k+1)] about its mean.
    pub fn octave(&self, k: u32, scale: f32, p: [f32; 3]) -> f32 {
        self.stretched_octave(k, [scale; 3], p)
    }

    /// [`Self::octave`] with a scale of its own along each axis.
    pub fn stretched_octave(&self, k: u32, scale: [f32; 3], p: [f32; 3]) -> f32 {
        let rise = (1_u32 << k) as f32;
        (1.0 + self.another(u64::from(k) + 1).sum(Sum::Fbm, 1, scale.map(|s| s * rise), p)) / (4.0 * rise)
    }

    /// Cells a unit of length along an axis: `frequency`, or the next one that is whole for the tile, a multiple of `of`.
    pub fn whole(&self, frequency: f32, axis: usize, of: f32) -> f32 {
        let length = self.tile[axis];
        if length > 0.0 { (frequency * length / of).round().max(1.0) * of / length } else { frequency }
    }

    /// How far a point is from x = 0, or from the nearest repetition of it, smoothly.
    pub fn across(&self, x: f32, axis: usize) -> f32 {
        let [half_turns, reach] = self.trunks(axis);
        if half_turns > 0.0 { sine_of_turns(x * half_turns).abs() * reach } else { x.abs() }
    }

    /// Turns a unit of length of [`Self::across`]'s sine, and its height; zeros without a tile.
    pub(super) fn trunks(&self, axis: usize) -> [f32; 2] {
        let length = self.tile[axis];
        if length > 0.0 { [0.5 / length, length / std::f32::consts::PI] } else { [0.0; 2] }
    }

    /// Where a point is from a trunk at x = 0; with a tile how far it is from the nearest repetition of it.
    pub fn from_trunk(&self, x: f32, axis: usize) -> f32 {
        if self.tile[axis] > 0.0 { self.across(x, axis) } else { x }
    }

    /// A number in [0, 1) for a cell; `cells` is how many there are a tile along x and y (0: no tile), after which they repeat.
    pub fn cell(&self, cell: [i32; 3], cells: [f32; 2], die: u64) -> f32 {
        let mut key = self.seed ^ (die << 56);
        for axis in 0..3 {
            let period = if axis < 2 { cells[axis] as i32 } else { 0 };
            let index = i64::from(if period > 0 { cell[axis].rem_euclid(period) } else { cell[axis] });
            key = u64::from(mixed(key ^ index as u64)) | (key << 32) ^ (index as u64) << 48;
        }
        (mixed(key) >> 8) as f32 / 16_777_216.0
    }

    /// Cells a tile for a frequency that [`Space::whole`] gave.
    pub fn cells(&self, frequency: [f32; 2]) -> [f32; 2] {
        [0, 1].map(|axis| (self.tile[axis] * frequency[axis]).round())
    }

    /// Its dice and those of two others, as stages take them.
    pub(super) fn dice(&self) -> [[u32; 2]; 3] {
        [self.seed, self.another(2).seed, self.another(3).seed].map(|seed| [seed as u32, (seed >> 32) as u32])
    }
}

/// Linear between `a` (t = 0) and `b`, with t held in [0, 1].
pub(super) fn blend(a: [f32; 3], b: [f32; 3], t: f32) -> [f32; 3] {
    let t = t.clamp(0.0, 1.0);
    std::array::from_fn(|i| a[i] + (b[i] - a[i]) * t)
}

/// 0 below `low`, 1 above `high`, a cubic between.
pub(super) fn step(low: f32, high: f32, x: f32) -> f32 {
    let t = ((x - low) / (high - low).max(1e-6)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// A colour made lighter or darker.
pub(super) fn lit(colour: [f32; 3], factor: f32) -> [f32; 3] {
    colour.map(|c| c * factor)
}

/// The cell that a coordinate in cells lies in, the last ones of their type beyond it.
pub(super) fn cell_of(x: f32) -> i32 {
    x.floor() as i32
}
