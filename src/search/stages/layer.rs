//! A layer of the annealed filter's particles, chosen and moved.

use anyhow::Result;

use super::Extent;
use super::generated::layer_comp;
use crate::gpu::{ComputeStage, Device, Recorder, Stage};

/// The stage.
#[derive(Debug)]
pub(in crate::search) struct LayerStage {
    stage: ComputeStage,
}

impl LayerStage {
    /// Its name in timings.
    pub(in crate::search) const NAME: &'static str = "layer";

    /// Compiles it.
    pub(in crate::search) fn new(device: &Device) -> Result<Self> {
        let stage = ComputeStage::new(device, Self::NAME, Stage { shader: &layer_comp::SHADER, constants: &[] })?;
        Ok(Self { stage })
    }

    /// Records it, for layer `layer` with `noise` times the frame's spread.
    pub(in crate::search) fn record(
        &self,
        recorder: &mut Recorder,
        bindings: &layer_comp::Bindings<'_>,
        extent: Extent,
        layer: u32,
        noise: f32,
    ) -> Result<()> {
        let push = layer_comp::Push { particles: extent.candidates, dofs: extent.dofs, layer, noise };
        let groups = extent.block_groups(recorder.device());
        self.stage.record(recorder, &bindings.bound(), &push, groups)
    }
}
