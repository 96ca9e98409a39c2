//! The backend that draws in compute: every candidate compared row by row in registers, in the reference's integers, with no
//! framebuffer.

use anyhow::Result;

use super::backend::DeviceBackend;
use super::drawn_mesh::{DrawnMesh, MESH_TILE};
use super::evidence::DeviceEvidence;
use super::open::open_compute_device;
use super::passes::{self, Images, RASTER_TILE, raster_stage};
use super::rasteriser::Rasteriser;
use super::resources::Resources;
use super::scene::{DeviceScene, Share};
use super::segments::DeviceSegments;
use super::summed::Summed;
use super::workspace::Workspace;
use crate::body::{Body, Mesh};
use crate::evaluate::MeshProjector;
use crate::evaluate::evaluator::Footprint;
use crate::evaluate::mesh_projection::bound_to_its_body;
use crate::evaluate::shaders::{
    objective_comp, objective_evidence_comp, objective_segments_comp, pose_comp, project_comp, raster_evidence_comp,
    raster_mesh_evidence_comp, raster_mesh_segments_comp, raster_segments_comp,
};
use crate::geometry::Camera;
use crate::gpu::{Device, Recorder};

/// The evaluator that draws in compute, on a Vulkan device.
pub type Compute = DeviceBackend<ComputeRasteriser>;

/// Draws and compares in one stage, with no picture of a candidate in memory.
#[derive(Debug)]
pub struct ComputeRasteriser {
    has_subgroups: bool,
    /// What is drawn instead of the flat model.
    mesh: Option<Box<DrawnMesh>>,
}

impl Compute {
    /// For a body and its cameras at working size, on the device of [`super::open_device`].
    ///
    /// # Errors
    /// As [`super::open_device`] and [`Self::on`].
    pub fn new(body: &Body, cameras: &[Camera]) -> Result<Self> {
        Self::on(&open_compute_device()?, body, cameras)
    }

    /// On a device.
    ///
    /// # Errors
    /// When a picture has no pixel or is too large, the body has no or too many parts, or the device fails.
    pub fn on(device: &Device, body: &Body, cameras: &[Camera]) -> Result<Self> {
        Self::with(DeviceScene::new(device, body, cameras)?, |_| {
            let raster = raster_stage(device, false, false);
            device.compile(&[raster, pose_comp::stage(), project_comp::stage(), objective_comp::stage()])?;
            Ok(ComputeRasteriser { has_subgroups: device.capabilities().subgroup_arithmetic, mesh: None })
        })
    }

    /// The mesh model of a body, for its cameras at working size; `mesh` is bound to this body.
    ///
    /// # Errors
    /// As [`Self::on`], and when the mesh is bound to another number of bones or too large for the device.
    pub fn of_mesh(device: &Device, body: &Body, mesh: Mesh, cameras: &[Camera]) -> Result<Self> {
        Self::with(DeviceScene::new(device, body, cameras)?, |scene| {
            let mesh = DrawnMesh::new(scene, &MeshProjector::new(body, mesh, cameras)?)?;
            device.compile(&[pose_comp::stage(), objective_comp::stage()])?;
            Ok(ComputeRasteriser { has_subgroups: false, mesh: Some(Box::new(mesh)) })
        })
    }
}

impl Rasteriser for ComputeRasteriser {
    const NAME: &'static str = "compute";

    fn variant(&self) -> &'static str {
        if self.has_subgroups { "subgroup" } else { "shared" }
    }

    fn footprint(&self) -> Footprint {
        // Bits in registers, or keys in shared memory: no pixel of a candidate is written to memory.
        let tile = if self.mesh.is_some() { MESH_TILE } else { RASTER_TILE };
        Footprint { tile, bytes_per_pixel: 0.0 }
    }

    fn reserve(&mut self, scene: &DeviceScene, candidates: u32) -> Result<()> {
        self.mesh.as_mut().map_or(Ok(()), |mesh| mesh.reserve(scene, candidates))
    }

    fn batch(&self, workspace: &Workspace) -> u32 {
        self.mesh.as_ref().map_or(workspace.batch, |mesh| mesh.most().min(workspace.batch))
    }

    fn set_segments(
        &mut self,
        scene: &DeviceScene,
        _workspace: &Workspace,
        segments: Option<&DeviceSegments>,
    ) -> Result<()> {
        if segments.is_none() {
            return Ok(());
        }
        let ignores = scene.counted.is_some();
        let raster = match &self.mesh {
            None => raster_segments_comp::stage(raster_segments_comp::Constants { listed: false, ignores }),
            Some(_) => raster_mesh_segments_comp::stage(raster_mesh_segments_comp::Constants { ignores }),
        };
        scene.device.compile(&[raster, objective_segments_comp::stage()])
    }

    fn set_evidence(
        &mut self,
        scene: &DeviceScene,
        _workspace: &Workspace,
        evidence: Option<&DeviceEvidence>,
    ) -> Result<()> {
        if evidence.is_none() {
            return Ok(());
        }
        let ignores = scene.counted.is_some();
        let raster = match &self.mesh {
            None => raster_evidence_comp::stage(raster_evidence_comp::Constants { listed: false, ignores }),
            Some(_) => raster_mesh_evidence_comp::stage(raster_mesh_evidence_comp::Constants { ignores }),
        };
        scene.device.compile(&[raster, objective_evidence_comp::stage()])
    }

    fn record_upload(&self, recorder: &mut Recorder) -> Result<()> {
        self.mesh.as_ref().map_or(Ok(()), |mesh| mesh.record_upload(recorder))
    }

    fn record_share(
        &self,
        recorder: &mut Recorder,
        resources: &Resources,
        summed: Summed<'_>,
        share: Share,
    ) -> Result<()> {
        let Resources { scene, workspace, .. } = resources;
        if let Some(mesh) = &self.mesh {
            return mesh.record(recorder, (scene, workspace), summed, share);
        }
        passes::project(recorder, scene, workspace, share)?;
        passes::raster(recorder, (scene, workspace), summed, Images::All, share)
    }

    fn check_exchange(&self) -> Result<()> {
        if self.mesh.is_some() { Err(bound_to_its_body()) } else { Ok(()) }
    }
}
