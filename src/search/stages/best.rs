//! Which particles improved, and the swarm's best.

use anyhow::Result;

use super::Extent;
use super::generated::best_comp;
use crate::gpu::{ComputeStage, Device, Groups, Recorder, Stage};

/// The stage.
#[derive(Debug)]
pub(in crate::search) struct BestStage {
    stage: ComputeStage,
}

impl BestStage {
    /// Its name in timings.
    pub(in crate::search) const NAME: &'static str = "best";

    /// Compiles it.
    pub(in crate::search) fn new(device: &Device) -> Result<Self> {
        let stage = ComputeStage::new(device, Self::NAME, Stage { shader: &best_comp::SHADER, constants: &[] })?;
        Ok(Self { stage })
    }

    /// Records it, after the fitness of `iteration`; at a swarm's first one what was found before is forgotten.
    pub(in crate::search) fn record(
        &self,
        recorder: &mut Recorder,
        bindings: &best_comp::Bindings<'_>,
        extent: Extent,
        views: u32,
        iteration: u32,
        is_first: bool,
    ) -> Result<()> {
        let is_first = u32::from(is_first);
        let push = best_comp::Push { particles: extent.candidates, dofs: extent.dofs, views, iteration, is_first };
        self.stage.record(recorder, &bindings.bound(), &push, Groups::Count([1, 1, 1]))
    }
}
