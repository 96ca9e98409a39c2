//! A filter's weights and their running sums.

use anyhow::Result;

use super::Extent;
use super::generated::weigh_comp;
use crate::gpu::{ComputeStage, Device, Groups, Recorder, Stage};

/// The stage.
#[derive(Debug)]
pub(in crate::search) struct WeighStage {
    stage: ComputeStage,
}

impl WeighStage {
    /// Its name in timings.
    pub(in crate::search) const NAME: &'static str = "weigh";

    /// Compiles it.
    pub(in crate::search) fn new(device: &Device) -> Result<Self> {
        let stage = ComputeStage::new(device, Self::NAME, Stage { shader: &weigh_comp::SHADER, constants: &[] })?;
        Ok(Self { stage })
    }

    /// Records it, for fitness of all particles; the sharpness bound stays if `survival` is 0, and otherwise becomes what leaves
    /// this share of the particles.
    pub(in crate::search) fn record(
        &self,
        recorder: &mut Recorder,
        bindings: &weigh_comp::Bindings<'_>,
        extent: Extent,
        survival: f32,
    ) -> Result<()> {
        let push = weigh_comp::Push { count: extent.candidates, dofs: extent.dofs, survival };
        self.stage.record(recorder, &bindings.bound(), &push, Groups::Count([1, 1, 1]))
    }
}
