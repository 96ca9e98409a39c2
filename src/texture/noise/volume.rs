//! Gradient noise measured once over a cube and read from there: what a shader does with a three-dimensional texture.

use rayon::prelude::*;

use super::gradient::{mix, split};
use super::{HashLattice, Lattice, Noise, Periodic, perlin3};

/// Cells of the cube along each axis, after which it repeats itself.
const CELLS: i32 = 16;
/// Samples of a cell along each axis.
const SAMPLES: i32 = 8;
/// Samples of the cube along each axis.
pub const VOLUME_SIDE: usize = (CELLS * SAMPLES) as usize;

/// Samples of noise, x fastest, then y.
#[derive(Clone, PartialEq)]
pub struct Volume {
    samples: Vec<f32>,
}

impl std::fmt::Debug for Volume {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Volume").field("side", &VOLUME_SIDE).finish_non_exhaustive()
    }
}

impl Volume {
    /// The cube of a seed.
    pub fn new(seed: u64) -> Self {
        let lattice = Periodic { lattice: HashLattice::new(seed), period: [CELLS, CELLS, CELLS, 0] };
        let mut samples = vec![0.0; VOLUME_SIDE * VOLUME_SIDE * VOLUME_SIDE];
        samples.par_chunks_mut(VOLUME_SIDE).enumerate().for_each(|(row, out)| {
            let at = |sample: usize| sample as f32 / SAMPLES as f32;
            for (x, out) in out.iter_mut().enumerate() {
                *out = perlin3(&lattice, [at(x), at(row % VOLUME_SIDE), at(row / VOLUME_SIDE)]);
            }
        });
        Self { samples }
    }

    /// The samples, x fastest, then y.
    pub fn samples(&self) -> &[f32] {
        &self.samples
    }

    /// How far a lattice moves the cube: seven bits of samples an axis, x lowest. Lattices of octaves and of spaces read it at places
    /// of their own.
    pub fn shift(lattice: &impl Lattice) -> u32 {
        lattice.word(lattice.first(0)) >> 11
    }
}

/// Noise between the samples of a cube: linear along each axis.
#[derive(Clone, Copy, Debug)]
pub struct Sampled<'a>(pub &'a Volume);

impl Noise<3> for Sampled<'_> {
    #[inline(always)]
    fn at<L: Lattice>(&self, lattice: &L, p: [f32; 3]) -> f32 {
        const LAST: i32 = VOLUME_SIDE as i32 - 1;
        let shift = Volume::shift(lattice) as i32;
        let [(x, tx), (y, ty), (z, tz)] = p.map(|coordinate| split(coordinate * SAMPLES as f32));
        let sides = |cell: i32, bits: i32| {
            [0, 1].map(|side| (cell.wrapping_add(shift >> bits).wrapping_add(side) & LAST) as usize)
        };
        let ([x0, x1], [y0, y1], [z0, z1]) = (sides(x, 0), sides(y, 7), sides(z, 14));
        let face = |z: usize| {
            let sample = |x: usize, y: usize| self.0.samples[(z * VOLUME_SIDE + y) * VOLUME_SIDE + x];
            mix(mix(sample(x0, y0), sample(x1, y0), tx), mix(sample(x0, y1), sample(x1, y1), tx), ty)
        };
        mix(face(z0), face(z1), tz)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_volume_has_the_noise_between_its_samples_and_repeats() {
        let (volume, lattice) = (Volume::new(3), HashLattice::new(8));
        let moved = Volume::shift(&lattice) as i32;
        let periodic = Periodic { lattice: HashLattice::new(3), period: [CELLS, CELLS, CELLS, 0] };
        let mut worst = 0.0_f32;
        for i in 0..4000 {
            let p = [0.731, 0.417, 0.553].map(|step| step * i as f32 - 500.0);
            let sampled = Sampled(&volume).at(&lattice, p);
            let there = |axis: i32| p[axis as usize] + (moved >> (7 * axis) & 127) as f32 / SAMPLES as f32;
            worst = worst.max((sampled - perlin3(&periodic, [there(0), there(1), there(2)])).abs());
            let next = [p[0] + CELLS as f32, p[1], p[2] - CELLS as f32];
            assert!((sampled - Sampled(&volume).at(&lattice, next)).abs() < 1e-3);
        }
        assert!((0.005..0.06).contains(&worst), "{worst}");
    }
}
