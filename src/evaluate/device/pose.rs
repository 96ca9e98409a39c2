//! Poses to bone matrices (SPEC A3).

use anyhow::Result;

use super::scene::{DeviceScene, Share};
use super::workspace::Workspace;
use crate::evaluate::shaders::pose_comp;
use crate::gpu::{ComputeStage, Device, Groups, Recorder, Stage};

/// The stage.
#[derive(Debug)]
pub(crate) struct PoseStage {
    stage: ComputeStage,
}

impl PoseStage {
    /// Its name in timings.
    pub(crate) const NAME: &'static str = "pose";

    /// Compiles it.
    pub(crate) fn new(device: &Device) -> Result<Self> {
        Ok(Self { stage: ComputeStage::new(device, Self::NAME, Stage { shader: &pose_comp::SHADER, constants: &[] })? })
    }

    /// Records it: `workspace.poses` to `workspace.world`.
    pub(crate) fn record(
        &self,
        recorder: &mut Recorder,
        model: &DeviceScene,
        workspace: &Workspace,
        share: Share,
    ) -> Result<()> {
        let push: pose_comp::Push = model.batch(share);
        let bindings = pose_comp::Bindings { bones: &model.bones, poses: &workspace.poses, world: &workspace.world };
        self.stage.record(
            recorder,
            &bindings.bound(),
            &push,
            Groups::Count([share.candidates.div_ceil(pose_comp::SHADER.workgroup_size[0]), 1, 1]),
        )
    }
}
