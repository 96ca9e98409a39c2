//! What each person takes from the light on the floor.

use anyhow::Result;

use super::generated::occlude_comp;
use super::shadow_groups;
use crate::gpu::{ComputeStage, Device, Groups, Recorder, Stage};

/// The stage.
#[derive(Debug)]
pub(in crate::synth) struct OccludeStage(ComputeStage);

impl OccludeStage {
    /// Its name in timings.
    pub(in crate::synth) const NAME: &'static str = "occlude";

    /// Compiles it.
    pub(in crate::synth) fn new(device: &Device) -> Result<Self> {
        let stage = Stage { shader: &occlude_comp::SHADER, constants: &[] };
        Ok(Self(ComputeStage::new(device, Self::NAME, stage)?))
    }

    /// Records it for so many people.
    pub(in crate::synth) fn record(
        &self,
        recorder: &mut Recorder,
        bindings: &occlude_comp::Bindings<'_>,
        members: u32,
    ) -> Result<()> {
        self.0.record(
            recorder,
            &bindings.bound(),
            &occlude_comp::Push { members },
            Groups::Count(shadow_groups(members)),
        )
    }
}
