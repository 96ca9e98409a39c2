//! Every vertex of the mesh of every candidate into every camera, once (SPEC A4, A2): snapped places and depths.

use anyhow::Result;

use super::mesh::{DeviceMesh, MeshWorkspace};
use crate::body::Skinning;
use crate::evaluate::device::scene::{DeviceScene, Share};
use crate::evaluate::device::workspace::Workspace;
use crate::evaluate::shaders::{MESH_GROUP, bind_comp, skin_comp};
use crate::gpu::{ComputeStage, Device, Groups, Recorder, Stage};

/// The stage.
#[derive(Debug)]
pub(crate) struct SkinStage {
    bind: ComputeStage,
    skin: ComputeStage,
}

impl SkinStage {
    /// Its name in timings.
    pub(crate) const NAME: &'static str = "skin";

    /// Compiles it.
    pub(crate) fn new(device: &Device, skinning: Skinning) -> Result<Self> {
        let is_smooth = u32::from(skinning == Skinning::Smooth);
        Ok(Self {
            bind: ComputeStage::new(device, Self::NAME, Stage { shader: &bind_comp::SHADER, constants: &[] })?,
            skin: ComputeStage::new(
                device,
                Self::NAME,
                Stage { shader: &skin_comp::SHADER, constants: &[(0, is_smooth)] },
            )?,
        })
    }

    /// Records it: `workspace.world` to `room.seen` and `workspace.bounds`; `room.counts` are emptied.
    pub(crate) fn record(
        &self,
        recorder: &mut Recorder,
        (model, mesh): (&DeviceScene, &DeviceMesh),
        (workspace, room): (&Workspace, &MeshWorkspace),
        share: Share,
    ) -> Result<()> {
        let push = room.push(model.counts, mesh, share);
        // Counts and bounds are started by the same invocations.
        let starts = (share.candidates * model.counts.bones.max(model.counts.views)).max(16);
        let bind = bind_comp::Bindings {
            world: &workspace.world,
            inverse_bind: &mesh.inverse_bind,
            cameras: &model.cameras,
            skin: &room.skin,
            all_bounds: &workspace.bounds,
            counts: &room.counts,
        };
        let skin = skin_comp::Bindings {
            vertices: &mesh.vertices,
            skin: &room.skin,
            cameras: &model.cameras,
            all_seen: &room.seen,
            all_bounds: &workspace.bounds,
        };
        let vertex_groups = Groups::Count([mesh.vertex_count.div_ceil(MESH_GROUP), share.candidates, 1]);
        recorder.compute(
            Self::NAME,
            &[
                self.bind.dispatch(&bind.bound(), &push, Groups::Count([starts.div_ceil(MESH_GROUP), 1, 1])),
                self.skin.dispatch(&skin.bound(), &push, vertex_groups),
            ],
        )
    }
}
