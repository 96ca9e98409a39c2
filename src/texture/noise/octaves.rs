//! Sums of octaves (METHOD B1): fbm, turbulence, ridged; one point at a time, or many, in vectors and threads, with the same
//! values to the bit.

use anyhow::{Result, bail};
use rayon::prelude::*;

use super::lattice::{HashLattice, Lattice, Periodic};
use super::{Noise, Perlin, Value};
use crate::files::choices;

/// Coordinates beyond this count as this: no octave of a finite point overflows.
pub(crate) const FARTHEST: f32 = 1e25;
/// Highest frequency that octaves may reach.
const HIGHEST_FREQUENCY: f64 = 1e12;
/// Points that the loops over lanes work on at a time.
const LANES: usize = 64;
/// Points of a task of [`Octaves::fill`].
const TASK: usize = 64 * LANES;

choices! {
    /// What is summed of each octave's noise n.
    "sum" pub enum Sum {
        /// n.
        "fbm" Fbm,
        /// |n|.
        "turbulence" Turbulence,
        /// (1 - |n|)^2.
        "ridged" Ridged,
    }
}

/// `sum over k < count of gain^k noise(lacunarity^k frequency p)`.
#[derive(Clone, Copy, Debug, PartialEq, serde::Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Octaves {
    /// What is summed.
    pub sum: Sum,
    /// How many octaves.
    pub count: u32,
    /// Cells a unit of length, of the first octave.
    pub frequency: f32,
    /// Each octave's frequency over that of the one before.
    pub lacunarity: f32,
    /// Each octave's amplitude over that of the one before.
    pub gain: f32,
}

/// One octave of a sum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Row {
    /// Cells a unit of length, per axis.
    pub frequency: [f32; 4],
    /// Cells after which it repeats itself, per axis; 0 where it does not.
    pub period: [i32; 4],
    /// Its factor in the sum.
    pub amplitude: f32,
}

impl Default for Octaves {
    fn default() -> Self {
        Self { sum: Sum::Fbm, count: 4, frequency: 1.0, lacunarity: 2.0, gain: 0.5 }
    }
}

#[inline(always)]
fn part_of(sum: Sum, n: f32) -> f32 {
    match sum {
        Sum::Fbm => n,
        Sum::Turbulence => n.abs(),
        Sum::Ridged => (1.0 - n.abs()) * (1.0 - n.abs()),
    }
}

/// Written so that it is two instructions; NaN stays.
#[inline(always)]
pub(super) fn bounded(x: f32) -> f32 {
    let x = if x > FARTHEST { FARTHEST } else { x };
    if x < -FARTHEST { -FARTHEST } else { x }
}

impl Octaves {
    /// Octaves that can be summed.
    ///
    /// # Errors
    /// When there are none or more than 32, or a number is not finite, or the highest frequency is beyond 1e12.
    pub fn checked(self) -> Result<Self> {
        if !(1..=32).contains(&self.count) {
            bail!("noise of {} octaves: expected 1 to 32", self.count);
        }
        for (name, value) in [("frequency", self.frequency), ("lacunarity", self.lacunarity), ("gain", self.gain)] {
            if !value.is_finite() || value < 0.0 {
                bail!("the {name} of noise is {value}, expected a number from 0 on");
            }
        }
        let rise = f64::from(self.lacunarity).max(1.0).powi(self.count as i32 - 1);
        let highest = f64::from(self.frequency).max(1.0) * rise;
        let largest = f64::from(self.gain).max(1.0).powi(self.count as i32 - 1);
        if highest.max(largest) > HIGHEST_FREQUENCY {
            bail!(
                "octaves of noise rise to the frequency or amplitude {:e}, expected at most 1e12",
                highest.max(largest)
            );
        }
        Ok(self)
    }

    /// The octaves one by one, over a `tile` (units of length; 0 along axes that do not repeat): there each octave's frequency is
    /// rounded to whole cells a tile.
    pub fn rows(&self, tile: [f32; 4]) -> impl Iterator<Item = Row> + use<> {
        let Self { count, lacunarity, gain, .. } = *self;
        let (mut frequency, mut amplitude) = (self.frequency, 1.0);
        (0..count).map(move |_| {
            let mut row = Row { frequency: [frequency; 4], period: [0; 4], amplitude };
            for (axis, length) in tile.into_iter().enumerate() {
                if length > 0.0 {
                    let cells = (frequency * length).round().clamp(1.0, 1e9);
                    row.period[axis] = cells as i32;
                    row.frequency[axis] = cells / length;
                }
            }
            frequency *= lacunarity;
            amplitude *= gain;
            row
        })
    }

    /// The sum at a point; it repeats itself after a `tile`, as in [`Octaves::rows`].
    pub fn at<K, const N: usize, L: Lattice>(&self, noise: K, lattice: &L, tile: [f32; N], p: [f32; N]) -> f32
    where
        K: Noise<N>,
    {
        let p = p.map(bounded);
        let tile = std::array::from_fn(|axis| tile.get(axis).copied().unwrap_or(0.0));
        let mut total = 0.0;
        for (octave, row) in self.rows(tile).enumerate() {
            let q = std::array::from_fn(|axis| p[axis] * row.frequency[axis]);
            let lattice = lattice.octave(octave as u32);
            let value = if row.period == [0; 4] {
                noise.at(&lattice, q)
            } else {
                noise.at(&Periodic { lattice, period: row.period }, q)
            };
            total += part_of(self.sum, value) * row.amplitude;
        }
        total
    }

    /// The sums at many points, by all threads: `points[axis]` and `out` are of one length. The bits of [`Octaves::at`].
    ///
    /// # Panics
    /// Never; points and results past the shortest row are left alone.
    pub fn fill<K: Kernel<N>, const N: usize>(
        &self,
        _: K,
        lattice: &HashLattice,
        points: [&[f32]; N],
        out: &mut [f32],
    ) {
        let length = points.iter().map(|row| row.len()).min().unwrap_or(0).min(out.len());
        if length <= TASK {
            K::block(self, *lattice, points, &mut out[..length]);
            return;
        }
        out[..length].par_chunks_mut(TASK).enumerate().for_each(|(task, out)| {
            let from = task * TASK;
            K::block(self, *lattice, points.map(|row| &row[from..from + out.len()]), out);
        });
    }
}

/// A noise that [`Octaves::fill`] has vector code for.
pub trait Kernel<const N: usize>: Noise<N> {
    /// [`Octaves::fill`] by one thread; rows of `out`'s length.
    fn block(octaves: &Octaves, lattice: HashLattice, points: [&[f32]; N], out: &mut [f32]);
}

/// The loop over lanes: octaves outside, so that an octave's numbers are uniform; the loop over lanes inside.
#[inline(always)]
fn sum_lanes<K: Noise<N>, const N: usize>(
    noise: K,
    octaves: &Octaves,
    lattice: HashLattice,
    points: [&[f32]; N],
    out: &mut [f32],
) {
    let mut p = [[0.0; LANES]; N];
    for (chunk, out) in out.chunks_mut(LANES).enumerate() {
        for axis in 0..N {
            let row = &points[axis][chunk * LANES..chunk * LANES + out.len()];
            p[axis][..row.len()].copy_from_slice(row);
            for x in &mut p[axis] {
                *x = bounded(*x);
            }
        }
        let mut total = [0.0; LANES];
        let (mut frequency, mut amplitude) = (octaves.frequency, 1.0);
        for octave in 0..octaves.count {
            let lattice = lattice.octave(octave);
            let mut values = [0.0; LANES];
            for lane in 0..LANES {
                let mut q = [0.0; N];
                for axis in 0..N {
                    q[axis] = p[axis][lane] * frequency;
                }
                values[lane] = noise.at(&lattice, q);
            }
            for lane in 0..LANES {
                total[lane] += part_of(octaves.sum, values[lane]) * amplitude;
            }
            frequency *= octaves.lacunarity;
            amplitude *= octaves.gain;
        }
        out.copy_from_slice(&total[..out.len()]);
    }
}

macro_rules! kernel {
    ($noise:ident, $n:literal, $name:ident) => {
        #[multiversion::multiversion(targets(
            "x86_64+avx2+avx512f+avx512bw+avx512dq+avx512vl",
            "x86_64+avx2",
            "x86_64+sse4.1"
        ))]
        fn $name(octaves: &Octaves, lattice: HashLattice, points: [&[f32]; $n], out: &mut [f32]) {
            sum_lanes($noise, octaves, lattice, points, out);
        }

        impl Kernel<$n> for $noise {
            fn block(octaves: &Octaves, lattice: HashLattice, points: [&[f32]; $n], out: &mut [f32]) {
                $name(octaves, lattice, points, out);
            }
        }
    };
}

kernel!(Perlin, 1, perlin1_block);
kernel!(Perlin, 2, perlin2_block);
kernel!(Perlin, 3, perlin3_block);
kernel!(Perlin, 4, perlin4_block);
kernel!(Value, 1, value1_block);
kernel!(Value, 2, value2_block);
kernel!(Value, 3, value3_block);
kernel!(Value, 4, value4_block);
