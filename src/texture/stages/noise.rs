//! Sums of octaves of noise at a list of points, with the words and values of [`crate::texture::noise`].

use anyhow::{Result, ensure};

use super::generated::noise_comp;
use super::layout;
use crate::gpu::{Buffer, ComputeStage, Device, Groups, Memory, Recorder, Stage};
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

/// The stage for one request, with the request's octaves and tables on the device.
#[derive(Debug)]
pub struct NoiseStage {
    stage: ComputeStage,
    octaves: Buffer,
    tables: Buffer,
    count: u32,
}

impl NoiseStage {
    /// Its name in timings.
    pub const NAME: &'static str = "noise";

    /// Compiles it.
    ///
    /// # Errors
    /// When there are not 1 to 4 dimensions, the octaves make no sense, or the device has no memory.
    pub fn new(device: &Device, request: &NoiseRequest<'_>) -> Result<Self> {
        ensure!((1..=4).contains(&request.dimensions), "noise of {} dimensions, expected 1 to 4", request.dimensions);
        let octaves = request.octaves.checked()?;
        use noise_comp::constants as id;
        let constants = [
            (id::DIMENSIONS, request.dimensions),
            (id::KIND, u32::from(request.kind == NoiseKind::Value)),
            (id::SUM, octaves.sum as u32),
            (id::SOURCE, u32::from(matches!(request.source, NoiseSource::Tables(_)))),
        ];
        let stage = Stage { shader: &noise_comp::SHADER, constants: &constants };
        let stage = ComputeStage::new(device, Self::NAME, stage)?;
        let rows: Vec<layout::Octave> = (0..)
            .zip(octaves.rows(request.tile))
            .map(|(octave, row)| layout::Octave {
                frequency: row.frequency,
                period: row.period,
                amplitude: row.amplitude,
                state: match request.source {
                    NoiseSource::Hash(lattice) => lattice.octave(octave).seed,
                    NoiseSource::Tables(tables) => TableLattice::new(tables).octave(octave).shift,
                },
                ..bytemuck::Zeroable::zeroed()
            })
            .collect();
        let words: Vec<u32> = match request.source {
            NoiseSource::Hash(_) => vec![0],
            NoiseSource::Tables(tables) => tables.order.iter().chain(&tables.words).copied().collect(),
        };
        let buffer = device.buffer::<layout::Octave>("octaves", rows.len(), Memory::Upload)?;
        buffer.write(0, &rows)?;
        let tables = device.buffer::<u32>("noise tables", words.len(), Memory::Upload)?;
        tables.write(0, &words)?;
        Ok(Self { stage, octaves: buffer, tables, count: octaves.count })
    }

    /// Records it: `points` (four coordinates each, the first `dimensions` count) to `values`, and the word of each point's cell
    /// in the first octave to `words`.
    ///
    /// # Errors
    /// When a buffer is too short for `count` points.
    pub fn record(
        &self,
        recorder: &mut Recorder,
        points: &Buffer,
        values: &Buffer,
        words: &Buffer,
        count: u32,
    ) -> Result<()> {
        let bytes = u64::from(count) * 4;
        ensure!(
            points.size() >= 4 * bytes && values.size() >= bytes && words.size() >= bytes,
            "noise at {count} points: a buffer is too short"
        );
        let push = noise_comp::Push { count, octaves: self.count };
        let bindings = noise_comp::Bindings { points, all_octaves: &self.octaves, tables: &self.tables, values, words };
        let groups = Groups::Count([count.div_ceil(noise_comp::SHADER.workgroup_size[0]), 1, 1]);
        self.stage.record(recorder, &bindings.bound(), &push, groups)
    }
}
