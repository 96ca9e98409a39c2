//! Sums of octaves of noise at a list of points, with the words and values of [`crate::texture::noise`].

use anyhow::{Result, ensure};

use super::generated::noise_comp;
use super::request::{NoiseRequest, Requested};
use crate::gpu::{Buffer, ComputeStage, Device, Groups, Recorder, Stage};

/// The stage for one request, with the request's octaves and tables on the device.
#[derive(Debug)]
pub struct NoiseStage {
    stage: ComputeStage,
    requested: Requested,
}

impl NoiseStage {
    /// Its name in timings.
    pub const NAME: &'static str = "noise";

    /// Compiles it.
    ///
    /// # Errors
    /// When there are not 1 to 4 dimensions, the octaves make no sense, or the device has no memory.
    pub fn new(device: &Device, request: &NoiseRequest<'_>) -> Result<Self> {
        let requested = request.upload(device)?;
        let stage = Stage { shader: &noise_comp::SHADER, constants: &requested.constants };
        Ok(Self { stage: ComputeStage::new(device, Self::NAME, stage)?, requested })
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
        let Requested { octaves, tables, .. } = &self.requested;
        let push = noise_comp::Push { count, octaves: self.requested.count };
        let bindings = noise_comp::Bindings { points, all_octaves: octaves, tables, values, words };
        let groups = Groups::Count([count.div_ceil(noise_comp::SHADER.workgroup_size[0]), 1, 1]);
        self.stage.record(recorder, &bindings.bound(), &push, groups)
    }
}
