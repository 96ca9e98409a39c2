//! The pictures of all views, people over the empty room.

use anyhow::Result;

use super::generated::picture_comp;
use crate::gpu::{ComputeStage, Device, Groups, Recorder, Stage};

/// The stage.
#[derive(Debug)]
pub(in crate::synth) struct PictureStage(ComputeStage);

impl PictureStage {
    /// Its name in timings.
    pub(in crate::synth) const NAME: &'static str = "picture";

    /// Compiles it.
    pub(in crate::synth) fn new(device: &Device) -> Result<Self> {
        let stage = Stage { shader: &picture_comp::SHADER, constants: &[] };
        Ok(Self(ComputeStage::new(device, Self::NAME, stage)?))
    }

    /// Records it for so many people, tiles of the view that has most, and views.
    pub(in crate::synth) fn record(
        &self,
        recorder: &mut Recorder,
        bindings: &picture_comp::Bindings<'_>,
        members: u32,
        [tiles, views]: [u32; 2],
    ) -> Result<()> {
        self.0.record(recorder, &bindings.bound(), &picture_comp::Push { members }, Groups::Count([tiles, views, 1]))
    }
}
