//! Which particles improved, and the swarm's best.

use anyhow::Result;

use super::Extent;
use super::generated::best_comp;
use crate::gpu::{Device, Dispatch, Groups, Pipeline, Recorder, Stage};

/// The stage.
#[derive(Debug)]
pub(in crate::search) struct BestStage {
    pipeline: Pipeline,
}

impl BestStage {
    /// Its name in timings.
    pub(in crate::search) const NAME: &'static str = "best";

    /// Compiles it.
    pub(in crate::search) fn new(device: &Device) -> Result<Self> {
        let pipeline = device.compute_pipeline(Stage { shader: &best_comp::SHADER, constants: &[] })?;
        Ok(Self { pipeline })
    }

    /// Records it, after the fitness of `iteration`.
    pub(in crate::search) fn record(
        &self,
        recorder: &mut Recorder,
        bindings: &best_comp::Bindings<'_>,
        extent: Extent,
        views: u32,
        iteration: u32,
    ) -> Result<()> {
        let push = best_comp::Push { particles: extent.candidates, dofs: extent.dofs, views, iteration };
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
