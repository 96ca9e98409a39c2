//! Every image's place in the framebuffer (SPEC A9), and the list of those that do not fit their tile.

use anyhow::Result;

use super::framebuffer::Framebuffer;
use crate::evaluate::device::scene::{DeviceScene, Share};
use crate::evaluate::device::workspace::Workspace;
use crate::evaluate::shaders::{PLACE_GROUP, place_comp};
use crate::gpu::{ComputeStage, Device, Groups, Recorder, Stage};

/// The stage.
#[derive(Debug)]
pub(crate) struct PlaceStage {
    stage: ComputeStage,
}

impl PlaceStage {
    /// Its name in timings.
    pub(crate) const NAME: &'static str = "place";

    /// Compiles it.
    pub(crate) fn new(device: &Device) -> Result<Self> {
        Ok(Self {
            stage: ComputeStage::new(device, Self::NAME, Stage { shader: &place_comp::SHADER, constants: &[] })?,
        })
    }

    /// Records it: `workspace.bounds` and `quads` to the framebuffer's placements and list, and zeros to `workspace.sums`.
    pub(crate) fn record(
        &self,
        recorder: &mut Recorder,
        model: &DeviceScene,
        workspace: &Workspace,
        framebuffer: &Framebuffer,
        share: Share,
    ) -> Result<()> {
        self.record_parts(recorder, (model, workspace), framebuffer, share, model.counts.parts)
    }

    /// Records it for a model that is not drawn from `workspace.quads`, which then hold nothing: from `workspace.bounds` alone.
    pub(crate) fn record_by_bounds(
        &self,
        recorder: &mut Recorder,
        model: &DeviceScene,
        workspace: &Workspace,
        framebuffer: &Framebuffer,
        share: Share,
    ) -> Result<()> {
        self.record_parts(recorder, (model, workspace), framebuffer, share, 0)
    }

    fn record_parts(
        &self,
        recorder: &mut Recorder,
        (model, workspace): (&DeviceScene, &Workspace),
        framebuffer: &Framebuffer,
        share: Share,
        parts: u32,
    ) -> Result<()> {
        let push = place_comp::Push { parts, ..model.batch(share) };
        let images = share.candidates * model.counts.views;
        let empty = &framebuffer.empty_list;
        recorder.copy(Self::NAME, (empty, 0), (&framebuffer.listed, 0), empty.size())?;
        let bindings = place_comp::Bindings {
            all_bounds: &workspace.bounds,
            tiles: &framebuffer.tiles,
            cameras: &model.cameras,
            quads: &workspace.quads,
            placements: &framebuffer.placements,
            all_sums: &workspace.sums,
            listed: &framebuffer.listed,
        };
        self.stage.record(recorder, &bindings.bound(), &push, Groups::Count([images.div_ceil(PLACE_GROUP), 1, 1]))
    }
}
