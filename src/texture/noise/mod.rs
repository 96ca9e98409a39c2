//! Noise (METHOD B1): the same bits for the same argument on every processor, on any number of threads. A device has the same
//! words on lattice points and the same values (docs/TEXTURE.md).

mod gradient;
mod lattice;
mod octaves;
#[cfg(test)]
mod tests;
mod value;
mod volume;
mod ways;

pub use gradient::{perlin1, perlin2, perlin3, perlin4};
pub use lattice::{HashLattice, Lattice, Periodic, TABLE, TableLattice, Tables, mixed};
#[cfg(test)]
pub(super) use octaves::FARTHEST;
pub use octaves::{Kernel, Octaves, Row, Sum};
#[cfg(test)]
pub(super) use tests::hard_coordinates;
pub use value::{value1, value2, value3, value4};
pub use volume::{Sampled, VOLUME_SIDE, Volume};
pub use ways::{NoiseMaker, NoiseWay};

/// A noise of `N` dimensions.
pub trait Noise<const N: usize>: Copy + Send + Sync {
    /// Its value at a point; never NaN for finite coordinates.
    fn at<L: Lattice>(&self, lattice: &L, p: [f32; N]) -> f32;
}

/// Perlin's gradient noise.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Perlin;

/// Value noise.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Value;

macro_rules! noise {
    ($kind:ident, $n:literal, $function:ident) => {
        impl Noise<$n> for $kind {
            #[inline(always)]
            fn at<L: Lattice>(&self, lattice: &L, p: [f32; $n]) -> f32 {
                $function(lattice, p)
            }
        }
    };
}

noise!(Perlin, 1, perlin1);
noise!(Perlin, 2, perlin2);
noise!(Perlin, 3, perlin3);
noise!(Perlin, 4, perlin4);
noise!(Value, 1, value1);
noise!(Value, 2, value2);
noise!(Value, 3, value3);
noise!(Value, 4, value4);
