//! A batch of the filter's particles, chosen and moved.

use anyhow::Result;

use super::Extent;
use super::generated::propagate_comp;
use crate::gpu::{ComputeStage, Device, Recorder, Stage};

/// The stage.
#[derive(Debug)]
pub(in crate::search) struct PropagateStage {
    stage: ComputeStage,
}

impl PropagateStage {
    /// Its name in timings.
    pub(in crate::search) const NAME: &'static str = "propagate";

    /// Compiles it.
    pub(in crate::search) fn new(device: &Device) -> Result<Self> {
        let stage = ComputeStage::new(device, Self::NAME, Stage { shader: &propagate_comp::SHADER, constants: &[] })?;
        Ok(Self { stage })
    }

    /// Records it, for the candidates from particle `first` on, of `count`.
    pub(in crate::search) fn record(
        &self,
        recorder: &mut Recorder,
        bindings: &propagate_comp::Bindings<'_>,
        extent: Extent,
        [first, count]: [u32; 2],
    ) -> Result<()> {
        let push = propagate_comp::Push { first, batch: extent.candidates, count, dofs: extent.dofs };
        let groups = extent.block_groups(recorder.device());
        self.stage.record(recorder, &bindings.bound(), &push, groups)
    }
}
