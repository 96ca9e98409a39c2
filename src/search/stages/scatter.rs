//! The start of a swarm: at rest around the frame's centre, or around the best pose so far.

use anyhow::Result;

use super::Extent;
use super::generated::scatter_comp;
use crate::gpu::{ComputeStage, Device, Recorder, Stage};

/// The stage.
#[derive(Debug)]
pub(in crate::search) struct ScatterStage {
    stage: ComputeStage,
}

impl ScatterStage {
    /// Its name in timings.
    pub(in crate::search) const NAME: &'static str = "scatter";

    /// Compiles it.
    pub(in crate::search) fn new(device: &Device) -> Result<Self> {
        let stage = ComputeStage::new(device, Self::NAME, Stage { shader: &scatter_comp::SHADER, constants: &[] })?;
        Ok(Self { stage })
    }

    /// Records it, for every particle, before iteration `iteration` of the frame, which begins stage `stage`.
    pub(in crate::search) fn record(
        &self,
        recorder: &mut Recorder,
        bindings: &scatter_comp::Bindings<'_>,
        extent: Extent,
        stage: u32,
        iteration: u32,
    ) -> Result<()> {
        let push = scatter_comp::Push { particles: extent.candidates, dofs: extent.dofs, stage, iteration };
        let groups = extent.block_groups(recorder.device());
        self.stage.record(recorder, &bindings.bound(), &push, groups)
    }
}
