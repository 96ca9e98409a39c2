//! Weighted mean and deviation of every degree of freedom.

use anyhow::Result;

use super::Extent;
use super::generated::spread_comp;
use crate::gpu::{Device, Dispatch, Groups, Pipeline, Recorder, Stage};

/// The stage.
#[derive(Debug)]
pub(in crate::search) struct SpreadStage {
    pipeline: Pipeline,
}

impl SpreadStage {
    /// Its name in timings.
    pub(in crate::search) const NAME: &'static str = "spread";

    /// Compiles it.
    pub(in crate::search) fn new(device: &Device) -> Result<Self> {
        let pipeline = device.compute_pipeline(Stage { shader: &spread_comp::SHADER, constants: &[] })?;
        Ok(Self { pipeline })
    }

    /// Records it, over so many rows.
    pub(in crate::search) fn record(
        &self,
        recorder: &mut Recorder,
        bindings: &spread_comp::Bindings<'_>,
        extent: Extent,
    ) -> Result<()> {
        let push = spread_comp::Push { count: extent.candidates, dofs: extent.dofs };
        recorder.compute(
            Self::NAME,
            &[Dispatch {
                pipeline: &self.pipeline,
                bindings: &bindings.bound(),
                push: bytemuck::bytes_of(&push),
                groups: Groups::Count([extent.dofs, 1, 1]),
            }],
        )
    }
}
