//! The three ways in which noise reaches a shader (METHOD B2), and the processor with the same values.

use super::{HashLattice, Lattice as _, Octaves, Perlin, Sampled, TableLattice, Tables, Volume};
use crate::files::choices;

choices! {
    /// How noise comes about.
    #[derive(Default)]
    "way of noise" pub enum NoiseWay {
        /// by arithmetic, at each point (the default)
        "arithmetic" #[default] Arithmetic,
        /// from tables of 256 entries, which repeat after 256 cells
        "tables" Tables,
        /// read between the samples of a cube of 16 cells a side, which repeats itself
        "volume" Volume,
    }
}

/// A way with what it reads.
#[derive(Clone, Debug)]
pub enum NoiseMaker {
    /// Nothing.
    Arithmetic,
    /// Tables of a seed.
    Tables(Box<Tables>),
    /// A cube of a seed.
    Volume(Volume),
}

impl NoiseMaker {
    /// What a way reads, of a seed.
    pub fn new(way: NoiseWay, seed: u64) -> Self {
        match way {
            NoiseWay::Arithmetic => Self::Arithmetic,
            NoiseWay::Tables => Self::Tables(Box::new(Tables::new(seed))),
            NoiseWay::Volume => Self::Volume(Volume::new(seed)),
        }
    }

    /// A sum of octaves in space over the lattice of a seed; as [`Octaves::at`], but that a cube heeds no tile.
    #[inline]
    pub fn sum(&self, octaves: &Octaves, lattice: HashLattice, tile: [f32; 3], p: [f32; 3]) -> f32 {
        match self {
            Self::Arithmetic => octaves.at(Perlin, &lattice, tile, p),
            Self::Tables(tables) => octaves.at(Perlin, &shifted(tables, lattice), tile, p),
            Self::Volume(volume) => octaves.at(Sampled(volume), &lattice, tile, p),
        }
    }

    /// What tells a stage the lattice of an octave: its seed, or how far tables or cube are moved.
    pub fn state(&self, lattice: HashLattice, octave: u32) -> u32 {
        match self {
            Self::Arithmetic => lattice.octave(octave).seed,
            Self::Tables(tables) => shifted(tables, lattice).octave(octave).shift,
            Self::Volume(_) => Volume::shift(&lattice.octave(octave)),
        }
    }
}

/// Tables read from where a lattice's seed says.
fn shifted(tables: &Tables, lattice: HashLattice) -> TableLattice<'_> {
    TableLattice { tables, shift: lattice.seed >> 24 }
}
