//! What noise is wanted, and how stages get to know it.

use anyhow::{Result, ensure};

use super::generated::noise_comp::constants as id;
use super::layout;
use crate::gpu::{Buffer, Device, Memory};
use crate::texture::noise::{HashLattice, Lattice, Octaves, TableLattice, Tables};

/// Which noise.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoiseKind {
    /// [`crate::texture::noise::Perlin`].
    Perlin,
    /// [`crate::texture::noise::Value`].
    Value,
}

/// Where the lattice's words come from.
#[derive(Clone, Copy, Debug)]
pub enum NoiseSource<'a> {
    /// Arithmetic.
    Hash(HashLattice),
    /// Tables.
    Tables(&'a Tables),
}

/// What is summed.
#[derive(Clone, Copy, Debug)]
pub struct NoiseRequest<'a> {
    /// 1 to 4.
    pub dimensions: u32,
    /// Which noise.
    pub kind: NoiseKind,
    /// Its octaves.
    pub octaves: Octaves,
    /// The lattice.
    pub source: NoiseSource<'a>,
    /// Lengths after which the sum repeats itself, 0 along axes where it does not.
    pub tile: [f32; 4],
}

/// A request on the device.
#[derive(Debug)]
pub(super) struct Requested {
    pub(super) octaves: Buffer,
    pub(super) tables: Buffer,
    /// Octaves.
    pub(super) count: u32,
    /// Specialisation constants of the stages.
    pub(super) constants: [(u32, u32); 4],
}

impl NoiseRequest<'_> {
    /// Hands the octaves and tables to the device.
    ///
    /// # Errors
    /// When there are not 1 to 4 dimensions, the octaves make no sense, or the device has no memory.
    pub(super) fn upload(&self, device: &Device) -> Result<Requested> {
        ensure!((1..=4).contains(&self.dimensions), "noise of {} dimensions, expected 1 to 4", self.dimensions);
        let octaves = self.octaves.checked()?;
        let constants = [
            (id::DIMENSIONS, self.dimensions),
            (id::KIND, u32::from(self.kind == NoiseKind::Value)),
            (id::SUM, octaves.sum as u32),
            (id::SOURCE, u32::from(matches!(self.source, NoiseSource::Tables(_)))),
        ];
        let rows: Vec<layout::Octave> = (0..)
            .zip(octaves.rows(self.tile))
            .map(|(octave, row)| layout::Octave {
                frequency: row.frequency,
                period: row.period,
                amplitude: row.amplitude,
                state: match self.source {
                    NoiseSource::Hash(lattice) => lattice.octave(octave).seed,
                    NoiseSource::Tables(tables) => TableLattice::new(tables).octave(octave).shift,
                },
                ..bytemuck::Zeroable::zeroed()
            })
            .collect();
        let words: Vec<u32> = match self.source {
            NoiseSource::Hash(_) => vec![0],
            NoiseSource::Tables(tables) => tables.order.iter().chain(&tables.words).copied().collect(),
        };
        let buffer = device.buffer::<layout::Octave>("octaves", rows.len(), Memory::Upload)?;
        buffer.write(0, &rows)?;
        let tables = device.buffer::<u32>("noise tables", words.len(), Memory::Upload)?;
        tables.write(0, &words)?;
        Ok(Requested { octaves: buffer, tables, count: octaves.count, constants })
    }
}
