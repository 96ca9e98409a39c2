//! The filter's weights and their running sums.

use anyhow::Result;

use super::Extent;
use super::generated::weigh_comp;
use crate::gpu::{Device, Dispatch, Groups, Pipeline, Recorder, Stage};

/// The stage.
#[derive(Debug)]
pub(in crate::search) struct WeighStage {
    pipeline: Pipeline,
}

impl WeighStage {
    /// Its name in timings.
    pub(in crate::search) const NAME: &'static str = "weigh";

    /// Compiles it.
    pub(in crate::search) fn new(device: &Device) -> Result<Self> {
        let pipeline = device.compute_pipeline(Stage { shader: &weigh_comp::SHADER, constants: &[] })?;
        Ok(Self { pipeline })
    }

    /// Records it, for fitness of all particles; `sharpness` is 1 / (2 sigma^2).
    pub(in crate::search) fn record(
        &self,
        recorder: &mut Recorder,
        bindings: &weigh_comp::Bindings<'_>,
        extent: Extent,
        sharpness: f32,
    ) -> Result<()> {
        let push = weigh_comp::Push { count: extent.candidates, dofs: extent.dofs, sharpness };
        recorder.compute(
            Self::NAME,
            &[Dispatch {
                pipeline: &self.pipeline,
                bindings: &bindings.bound(),
                push: bytemuck::bytes_of(&push),
                groups: Groups::Count([1, 1, 1]),
            }],
        )
    }
}
