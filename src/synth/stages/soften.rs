//! The factors of light on the floor, softened.

use anyhow::Result;

use super::generated::soften_comp;
use super::shadow_groups;
use crate::gpu::{ComputeStage, Device, Groups, Recorder, Stage};

/// The stage.
#[derive(Debug)]
pub(in crate::synth) struct SoftenStage(ComputeStage);

impl SoftenStage {
    /// Its name in timings.
    pub(in crate::synth) const NAME: &'static str = "soften";

    /// Compiles it.
    pub(in crate::synth) fn new(device: &Device) -> Result<Self> {
        let stage = Stage { shader: &soften_comp::SHADER, constants: &[] };
        Ok(Self(ComputeStage::new(device, Self::NAME, stage)?))
    }

    /// Records it for so many people.
    pub(in crate::synth) fn record(
        &self,
        recorder: &mut Recorder,
        bindings: &soften_comp::Bindings<'_>,
        members: u32,
    ) -> Result<()> {
        self.0.record(recorder, &bindings.bound(), &(), Groups::Count(shadow_groups(members)))
    }
}
