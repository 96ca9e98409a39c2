//! The backend that draws in compute: every candidate compared row by row in registers, in the reference's integers, with no
//! framebuffer.

use anyhow::Result;

use super::backend::DeviceBackend;
use super::drawn_mesh::{DrawnMesh, MESH_TILE};
use super::evidence::DeviceEvidence;
use super::open::open_compute_device;
use super::passes::{self, Images, raster_stage};
use super::raster_kernel::RasterKernel;
use super::rasteriser::Rasteriser;
use super::resources::Resources;
use super::scene::{DeviceScene, Share};
use super::segments::DeviceSegments;
use super::spans;
use super::stage_groups::StageGroups;
use super::summed::Summed;
use super::tuning::fastest_kernel;
use super::workspace::Workspace;
use crate::body::{Body, Mesh};
use crate::evaluate::MeshProjector;
use crate::evaluate::evaluator::Footprint;
use crate::evaluate::mesh_projection::bound_to_its_body;
use crate::evaluate::shaders::{
    objective_comp, objective_evidence_comp, objective_segments_comp, pose_comp, raster_comp, raster_evidence_comp,
    raster_mesh_evidence_comp, raster_mesh_segments_comp, raster_segments_comp, raster_spans_comp,
    raster_spans_evidence_comp, raster_spans_segments_comp,
};
use crate::geometry::Camera;
use crate::gpu::{Device, Recorder, ShaderStage};

/// The evaluator that draws in compute, on a Vulkan device.
pub type Compute = DeviceBackend<ComputeRasteriser>;

/// Draws and compares in one stage, with no picture of a candidate in memory.
#[derive(Debug)]
pub struct ComputeRasteriser {
    has_subgroups: bool,
    /// How the flat model is drawn.
    kernel: RasterKernel,
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
        Self::with_groups(device, body, cameras, StageGroups::default())
    }

    /// As [`Self::on`], by workgroups of other sizes.
    pub(crate) fn with_groups(device: &Device, body: &Body, cameras: &[Camera], groups: StageGroups) -> Result<Self> {
        Self::with(DeviceScene::new(device, body, cameras)?.with_groups(groups)?, |scene| {
            let kernel = spans::drawable(scene, RasterKernel::usual(device.capabilities()));
            let mut stages = passes::pose_and_project_stages(scene);
            stages.extend([flat_stage(device, kernel), objective_comp::stage()]);
            device.compile(&stages)?;
            Ok(ComputeRasteriser { has_subgroups: device.capabilities().subgroup_arithmetic, kernel, mesh: None })
        })
    }

    /// On a device, drawn so. The bits are the same, the time is not.
    ///
    /// # Errors
    /// As [`Self::on`], and when the device allows no workgroups so large.
    pub fn with_kernel(device: &Device, body: &Body, cameras: &[Camera], kernel: RasterKernel) -> Result<Self> {
        let mut compute = Self::on(device, body, cameras)?;
        compute.set_kernel(kernel)?;
        Ok(compute)
    }

    /// Draws the flat model from now on the way that this device was measured to be fastest with, or is measured now on poses like
    /// those to come, where it was not yet and keeps its pipelines ([`crate::gpu::DeviceSettings::pipeline_cache`]). The bits are the
    /// same, the time is not.
    ///
    /// # Errors
    /// When the device fails.
    pub fn tune(&mut self, poses: &[f32]) -> Result<()> {
        if self.rasteriser.mesh.is_some() || poses.len() < self.resources.scene.counts.dofs as usize {
            return Ok(());
        }
        self.set_kernel(fastest_kernel(&self.resources.scene, poses)?)
    }

    /// How it draws the flat model.
    pub fn kernel(&self) -> RasterKernel {
        self.rasteriser.kernel
    }

    fn set_kernel(&mut self, kernel: RasterKernel) -> Result<()> {
        let scene = &self.resources.scene;
        kernel.check(scene.device.capabilities().max_workgroup)?;
        let kernel = spans::drawable(scene, kernel);
        scene.device.compile(&[flat_stage(&scene.device, kernel)])?;
        self.rasteriser.kernel = kernel;
        self.forget_runs();
        Ok(())
    }

    /// The mesh model of a body, for its cameras at working size; `mesh` is bound to this body.
    ///
    /// # Errors
    /// As [`Self::on`], and when the mesh is bound to another number of bones or too large for the device.
    pub fn of_mesh(device: &Device, body: &Body, mesh: Mesh, cameras: &[Camera]) -> Result<Self> {
        Self::with(DeviceScene::new(device, body, cameras)?, |scene| {
            let mesh = DrawnMesh::new(scene, &MeshProjector::new(body, mesh, cameras)?)?;
            device.compile(&[pose_comp::stage(), objective_comp::stage()])?;
            let mesh = Some(Box::new(mesh));
            Ok(ComputeRasteriser { has_subgroups: false, kernel: RasterKernel::ROWS, mesh })
        })
    }
}

/// The stage that draws and compares whole silhouettes so.
fn flat_stage(device: &Device, kernel: RasterKernel) -> ShaderStage {
    match kernel {
        RasterKernel::Rows(way) => {
            let constants = raster_comp::Constants {
                listed: false,
                ignores: false,
                local_size_x: way.group,
                words: way.words,
                keeps_edges: way.keeps_edges,
                edges_kept: way.edges_kept(),
            };
            raster_stage(device, constants)
        }
        RasterKernel::Spans { group, .. } => {
            raster_spans_comp::stage(raster_spans_comp::Constants { ignores: false, local_size_x: group })
        }
    }
}

impl Rasteriser for ComputeRasteriser {
    const NAME: &'static str = "compute";

    fn variant(&self) -> &'static str {
        match (self.kernel, self.has_subgroups) {
            (RasterKernel::Spans { .. }, _) => "spans",
            (RasterKernel::Rows(_), true) => "subgroup",
            (RasterKernel::Rows(_), false) => "shared",
        }
    }

    fn footprint(&self) -> Footprint {
        // Bits in registers, or keys in shared memory: no pixel of a candidate is written to memory.
        let tile = if self.mesh.is_some() { MESH_TILE } else { self.kernel.tile() };
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
            None => match self.kernel {
                RasterKernel::Rows(way) => raster_segments_comp::stage(raster_segments_comp::Constants {
                    listed: false,
                    ignores,
                    segment_edges: false,
                    local_size_x: way.group,
                    words: way.words,
                    keeps_edges: way.keeps_edges,
                    edges_kept: way.edges_kept(),
                }),
                RasterKernel::Spans { group, .. } => {
                    raster_spans_segments_comp::stage(raster_spans_segments_comp::Constants {
                        ignores,
                        segment_edges: false,
                        local_size_x: group,
                    })
                }
            },
            Some(_) => {
                let constants = raster_mesh_segments_comp::Constants { ignores, segment_edges: false };
                raster_mesh_segments_comp::stage(constants)
            }
        };
        let objective = objective_segments_comp::Constants { segment_edges: false };
        scene.device.compile(&[raster, objective_segments_comp::stage(objective)])
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
            None => match self.kernel {
                RasterKernel::Rows(way) => raster_evidence_comp::stage(raster_evidence_comp::Constants {
                    listed: false,
                    ignores,
                    local_size_x: way.group,
                    words: way.words,
                    keeps_edges: way.keeps_edges,
                    edges_kept: way.edges_kept(),
                }),
                RasterKernel::Spans { group, .. } => {
                    raster_spans_evidence_comp::stage(raster_spans_evidence_comp::Constants {
                        ignores,
                        local_size_x: group,
                    })
                }
            },
            Some(_) => raster_mesh_evidence_comp::stage(raster_mesh_evidence_comp::Constants { ignores }),
        };
        scene.device.compile(&[raster, objective_evidence_comp::stage()])
    }

    fn record_upload(&self, recorder: &mut Recorder, _is_handed: bool) -> Result<()> {
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
            passes::pose(recorder, scene, workspace, share)?;
            return mesh.record(recorder, (scene, workspace), summed, share);
        }
        passes::pose_and_project(recorder, scene, workspace, share)?;
        match self.kernel {
            RasterKernel::Rows(way) => passes::raster(recorder, (scene, workspace), summed, Images::All(way), share),
            RasterKernel::Spans { .. } => spans::raster(recorder, (scene, workspace), summed, self.kernel, share),
        }
    }

    fn check_exchange(&self) -> Result<()> {
        if self.mesh.is_some() { Err(bound_to_its_body()) } else { Ok(()) }
    }
}
