//! Noise on a device: sums of octaves at points or in a picture, with the words and values of [`super::noise`].

#[cfg(test)]
mod tests;

use anyhow::{Result, ensure};

use super::noise::{HashLattice, Lattice, Octaves, TableLattice, Tables};
use super::shaders::{layout, noise_comp, noise_image_frag, noise_image_vert};
use crate::gpu::{
    Buffer, Clear, Device, Draw, Drawing, Format, Groups, Image, Memory, Recorder, ShaderStage, Target, Viewport,
};

/// Which noise.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoiseKind {
    /// [`super::noise::Perlin`].
    Perlin,
    /// [`super::noise::Value`].
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
pub struct DeviceNoise {
    octaves: Buffer,
    tables: Buffer,
    count: u32,
    constants: noise_comp::Constants,
}

impl DeviceNoise {
    /// Hands the octaves and tables to the device.
    ///
    /// # Errors
    /// When there are not 1 to 4 dimensions, the octaves make no sense, or the device has no memory.
    pub fn new(device: &Device, request: &NoiseRequest<'_>) -> Result<Self> {
        let NoiseRequest { dimensions, kind, source, tile, .. } = *request;
        ensure!((1..=4).contains(&dimensions), "noise of {dimensions} dimensions, expected 1 to 4");
        let octaves = request.octaves.checked()?;
        let rows: Vec<layout::Octave> = (0..)
            .zip(octaves.rows(tile))
            .map(|(octave, row)| layout::Octave {
                frequency: row.frequency,
                period: row.period,
                amplitude: row.amplitude,
                state: match source {
                    NoiseSource::Hash(lattice) => lattice.octave(octave).seed,
                    NoiseSource::Tables(tables) => TableLattice::new(tables).octave(octave).shift,
                },
                ..bytemuck::Zeroable::zeroed()
            })
            .collect();
        let words: Vec<u32> = match source {
            NoiseSource::Hash(_) => vec![0],
            NoiseSource::Tables(tables) => tables.order.iter().chain(&tables.words).copied().collect(),
        };
        let buffer = device.buffer::<layout::Octave>("octaves", rows.len(), Memory::Upload)?;
        buffer.write(0, &rows)?;
        let tables = device.buffer::<u32>("noise tables", words.len(), Memory::Upload)?;
        tables.write(0, &words)?;
        let constants = noise_comp::Constants {
            dimensions,
            kind: u32::from(kind == NoiseKind::Value),
            sum: octaves.sum as u32,
            source: u32::from(matches!(source, NoiseSource::Tables(_))),
        };
        Ok(Self { octaves: buffer, tables, count: octaves.count, constants })
    }

    /// Records a pass: `points` (four coordinates each, the first `dimensions` count) to `values`, and the word of each point's
    /// cell in the first octave to `words`.
    ///
    /// # Errors
    /// When a buffer is too short for `count` points, or the stage does not compile.
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
        let bindings = noise_comp::Bindings { points, all_octaves: &self.octaves, tables: &self.tables, values, words };
        let push = noise_comp::Push { count, octaves: self.count };
        recorder.run(bindings.dispatch(self.constants, push, Groups::Over([count, 1, 1])))
    }

    /// Records a pass that draws: `points`, one a pixel row by row (four coordinates each, the first `dimensions` count), to a
    /// picture of [`Format::R32Float`], by the fragments of a triangle over all of it.
    ///
    /// # Errors
    /// When the picture is of another format, there are fewer points than pixels, or the stages do not compile.
    pub fn record_picture(&self, recorder: &mut Recorder, points: &Buffer, picture: &Image) -> Result<()> {
        let [width, height] = picture.size();
        ensure!(
            picture.format() == Format::R32Float && points.size() >= 16 * u64::from(width) * u64::from(height),
            "noise in a picture of {width} x {height} pixels: it is no float picture, or there are fewer points"
        );
        // Both ways have the constants of octaves.glsl.
        let fragments = ShaderStage { shader: &noise_image_frag::SHADER, ..noise_comp::stage(self.constants) };
        let drawing = Drawing { colour: Some(Format::R32Float), channels: 1, ..Drawing::default() };
        let stages = [noise_image_vert::stage(), fragments];
        let pipeline = recorder.device().graphics_pipeline("noise image", &stages, &drawing)?;
        let push = noise_image_frag::Push { width, octaves: self.count };
        let bindings = noise_image_frag::Bindings { points, all_octaves: &self.octaves, tables: &self.tables };
        recorder.draw(
            "noise image",
            &Target { colour: (picture, Clear::Discard), depth: None, area: [0, 0, width, height] },
            &[Draw {
                pipeline: &pipeline,
                bindings: &bindings.bound(),
                push: bytemuck::bytes_of(&push),
                viewport: Viewport { area: [0.0, 0.0, width as f32, height as f32], depth: [0.0, 1.0] },
                scissor: [0, 0, width, height],
                vertices: 0..3,
                instances: 0..1,
                indices: None,
                indirect: None,
            }],
        )
    }
}
