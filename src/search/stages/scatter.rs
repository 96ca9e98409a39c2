//! The start of a swarm: at rest around the centre.

use anyhow::Result;

use super::Extent;
use super::generated::scatter_comp;
use crate::gpu::{Device, Dispatch, Pipeline, Recorder, Stage};

/// The stage.
#[derive(Debug)]
pub(in crate::search) struct ScatterStage {
    pipeline: Pipeline,
    device: Device,
}

impl ScatterStage {
    /// Its name in timings.
    pub(in crate::search) const NAME: &'static str = "scatter";

    /// Compiles it.
    pub(in crate::search) fn new(device: &Device) -> Result<Self> {
        let pipeline = device.compute_pipeline(Stage { shader: &scatter_comp::SHADER, constants: &[] })?;
        Ok(Self { pipeline, device: device.clone() })
    }

    /// Records it, for every particle.
    pub(in crate::search) fn record(
        &self,
        recorder: &mut Recorder,
        bindings: &scatter_comp::Bindings<'_>,
        extent: Extent,
    ) -> Result<()> {
        let push = scatter_comp::Push { particles: extent.candidates, dofs: extent.dofs };
        recorder.compute(
            Self::NAME,
            &[Dispatch {
                pipeline: &self.pipeline,
                bindings: &bindings.bound(),
                push: bytemuck::bytes_of(&push),
                groups: extent.block_groups(&self.device),
            }],
        )
    }
}
