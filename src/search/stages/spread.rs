//! Weighted mean and deviation of every degree of freedom.

use anyhow::Result;

use super::Extent;
use super::generated::spread_comp;
use crate::gpu::{ComputeStage, Device, Groups, Recorder, Stage};

/// The stage.
#[derive(Debug)]
pub(in crate::search) struct SpreadStage {
    stage: ComputeStage,
}

impl SpreadStage {
    /// Its name in timings.
    pub(in crate::search) const NAME: &'static str = "spread";

    /// Compiles it.
    pub(in crate::search) fn new(device: &Device) -> Result<Self> {
        let stage = ComputeStage::new(device, Self::NAME, Stage { shader: &spread_comp::SHADER, constants: &[] })?;
        Ok(Self { stage })
    }

    /// Records it, over so many rows, for what moved in stage `stage`.
    pub(in crate::search) fn record(
        &self,
        recorder: &mut Recorder,
        bindings: &spread_comp::Bindings<'_>,
        extent: Extent,
        stage: u32,
    ) -> Result<()> {
        let push = spread_comp::Push { count: extent.candidates, dofs: extent.dofs, stage };
        self.stage.record(recorder, &bindings.bound(), &push, Groups::Count([extent.dofs, 1, 1]))
    }
}
