//! Every part of every candidate into every camera, once (SPEC A4, A2): snapped corners, nearest parts first.

use anyhow::Result;

use super::scene::{DeviceScene, Share};
use super::workspace::Workspace;
use crate::evaluate::shaders::{PROJECT_GROUP, project_comp};
use crate::gpu::{ComputeStage, Device, Groups, Recorder, Stage};

/// The stage.
#[derive(Debug)]
pub(crate) struct ProjectStage {
    stage: ComputeStage,
}

impl ProjectStage {
    /// Its name in timings.
    pub(crate) const NAME: &'static str = "project";

    /// Compiles it.
    pub(crate) fn new(device: &Device) -> Result<Self> {
        Ok(Self {
            stage: ComputeStage::new(device, Self::NAME, Stage { shader: &project_comp::SHADER, constants: &[] })?,
        })
    }

    /// Records it: `workspace.world` to `workspace.quads` and `workspace.bounds`.
    pub(crate) fn record(
        &self,
        recorder: &mut Recorder,
        model: &DeviceScene,
        workspace: &Workspace,
        share: Share,
    ) -> Result<()> {
        let push: project_comp::Push = model.batch(share);
        let images_a_group = PROJECT_GROUP / model.counts.parts;
        let images = share.candidates * model.counts.views;
        let bindings = project_comp::Bindings {
            parts: &model.parts,
            cameras: &model.cameras,
            world: &workspace.world,
            quads: &workspace.quads,
            all_bounds: &workspace.bounds,
        };
        self.stage.record(recorder, &bindings.bound(), &push, Groups::Count([images.div_ceil(images_a_group), 1, 1]))
    }
}
