//! What a backend draws into the framebuffer: the flat model, or a mesh.

use anyhow::Result;

use super::draw::FlatDrawing;
use super::draw_mesh::{EdgeSource, MeshPipelines, draw_mesh, mesh_pipelines, with_neighbours};
use super::framebuffer::Framebuffer;
use super::outlines::Outlines;
use super::passes::{
    feedback_pipeline, feedback_room, order_stage, place, project_by_feedback, skin_by_feedback, skin_feedback_pipeline,
};
use super::settings::{GraphicsSettings, Packing, Primitives, Projection};
use crate::evaluate::MeshProjector;
use crate::evaluate::device::mesh::{DeviceMesh, MeshWorkspace, skin, skin_stages};
use crate::evaluate::device::passes::{Images, pose, pose_and_project, raster, raster_stage};
use crate::evaluate::device::scene::{DeviceScene, Share};
use crate::evaluate::device::summed::Summed;
use crate::evaluate::device::workspace::Workspace;
use crate::evaluate::shaders::{LABELS, SHORT_CODES, outline_comp, raster_comp, touched_comp};
use crate::gpu::{Buffer, OutOfMemory, Recorder, StagedBuffer};

/// The stages of one model, and the memory that it alone needs.
#[derive(Debug)]
pub(super) enum Drawn {
    Flat {
        draw: FlatDrawing,
        projection: Projection,
        /// Where transform feedback projects to, if it does.
        captured: Option<Buffer>,
    },
    Mesh(Box<DrawnMesh>),
}

#[derive(Debug)]
pub(super) struct DrawnMesh {
    mesh: DeviceMesh,
    projection: Projection,
    pipelines: MeshPipelines,
    workspace: MeshWorkspace,
    edges: EdgeSource,
}

impl DrawnMesh {
    /// Makes room for batches of `candidates`, or as many as fit.
    fn reserve(&mut self, scene: &DeviceScene, candidates: u32) -> Result<()> {
        match &mut self.edges {
            EdgeSource::Listed(outlines) => {
                (self.workspace, *outlines) = Self::room(scene, &self.mesh, candidates)?;
            }
            EdgeSource::Neighbours(_) => {
                self.workspace = MeshWorkspace::new(&scene.device, scene.counts, &self.mesh, (candidates, 0))?;
            }
        }
        Ok(())
    }

    /// Room for batches of `candidates` whose silhouette edges are listed, or as many as fit.
    fn room(scene: &DeviceScene, mesh: &DeviceMesh, candidates: u32) -> Result<(MeshWorkspace, Outlines)> {
        let (device, counts) = (&scene.device, scene.counts);
        let mut candidates = candidates.min(Outlines::most_candidates(device, counts, mesh)?);
        loop {
            let workspace = MeshWorkspace::new(device, counts, mesh, (candidates, Outlines::bytes(counts, mesh)))?;
            candidates = workspace.batch;
            match Outlines::new(device, counts, mesh, candidates) {
                Err(error) if candidates > 1 && error.is::<OutOfMemory>() => candidates = candidates.div_ceil(2),
                outlines => return Ok((workspace, outlines?)),
            }
        }
    }
}

impl Drawn {
    /// The flat model of a scene's body, as a device can ([`GraphicsSettings::on`]).
    pub(super) fn flat(scene: &DeviceScene, settings: &GraphicsSettings) -> Result<Self> {
        let device = &scene.device;
        let listed = raster_comp::Constants { listed: true, ..raster_comp::Constants::default() };
        device.compile(&[raster_stage(device, listed)])?;
        if settings.projection == Projection::Feedback {
            device.compile(&[order_stage(scene)])?;
            feedback_pipeline(device)?;
        }
        let draw = FlatDrawing::new(device, scene.counts.parts, settings)?;
        Ok(Self::Flat { draw, projection: settings.projection, captured: None })
    }

    /// The mesh of a projector that `scene` was made of, as a device can ([`GraphicsSettings::on`]).
    pub(super) fn mesh(scene: &DeviceScene, projector: &MeshProjector, settings: &GraphicsSettings) -> Result<Self> {
        let GraphicsSettings { projection, primitives, .. } = *settings;
        let device = &scene.device;
        let mesh = DeviceMesh::new(device, projector)?;
        let [bind, skin] = skin_stages(mesh.skinning);
        match projection {
            Projection::Compute => device.compile(&[bind, skin])?,
            Projection::Feedback => {
                device.compile(&[bind, touched_comp::stage()])?;
                skin_feedback_pipeline(device, mesh.skinning)?;
            }
        }
        let pipelines = mesh_pipelines(device, primitives)?;
        let (workspace, edges) = match primitives {
            Primitives::Vertices => {
                device.compile(&[outline_comp::stage()])?;
                let (workspace, outlines) = DrawnMesh::room(scene, &mesh, 1)?;
                (workspace, EdgeSource::Listed(outlines))
            }
            Primitives::Geometry => {
                let corners = with_neighbours(projector.mesh())?;
                let corners = StagedBuffer::of(device, "mesh neighbours", &corners)?;
                (MeshWorkspace::new(device, scene.counts, &mesh, (1, 0))?, EdgeSource::Neighbours(corners))
            }
        };
        Ok(Self::Mesh(Box::new(DrawnMesh { mesh, projection, pipelines, workspace, edges })))
    }

    /// Makes room for batches of `candidates`, or as many as fit.
    pub(super) fn reserve(&mut self, scene: &DeviceScene, candidates: u32) -> Result<()> {
        match self {
            Self::Flat { .. } => Ok(()),
            Self::Mesh(drawn) => drawn.reserve(scene, candidates),
        }
    }

    /// Takes a workspace, with what a batch of it needs besides.
    pub(super) fn set_workspace(&mut self, scene: &DeviceScene, workspace: &Workspace) -> Result<()> {
        if let Self::Flat { projection: Projection::Feedback, captured, .. } = self {
            *captured = Some(feedback_room(&scene.device, scene.counts, workspace.batch)?);
        }
        Ok(())
    }

    /// Most candidates of a batch.
    pub(super) fn most(&self) -> u32 {
        match self {
            Self::Flat { .. } => u32::MAX,
            Self::Mesh(drawn) => drawn.workspace.batch,
        }
    }

    /// Whether images that fit no tile are scored all the same.
    pub(super) fn scores_what_fits_no_tile(&self) -> bool {
        matches!(self, Self::Flat { .. })
    }

    /// How many codes of parts, ranks or labels, a picture may hold, as stages tell them apart: few in registers, many in memory.
    pub(super) fn codes(&self, scene: &DeviceScene, packing: Packing) -> u32 {
        let largest = match (packing, self) {
            (Packing::Max, _) => scene.counts.parts,
            (Packing::Depth, Self::Flat { .. }) => scene.labels.iter().copied().max().map_or(0, u32::from),
            (Packing::Depth, Self::Mesh(drawn)) => drawn.mesh.largest_label,
        };
        if largest < SHORT_CODES { SHORT_CODES } else { LABELS }
    }

    /// Records the copies that bring what is drawn to the device.
    pub(super) fn record_upload(&self, recorder: &mut Recorder) -> Result<()> {
        match self {
            Self::Flat { .. } => Ok(()),
            Self::Mesh(drawn) => {
                drawn.mesh.record_upload(recorder)?;
                match &drawn.edges {
                    EdgeSource::Listed(_) => Ok(()),
                    EdgeSource::Neighbours(corners) => corners.record_upload(recorder),
                }
            }
        }
    }

    /// Records everything from `workspace.poses` to the pictures.
    pub(super) fn record(
        &self,
        recorder: &mut Recorder,
        (scene, workspace): (&DeviceScene, &Workspace),
        framebuffer: &Framebuffer,
        share: Share,
    ) -> Result<()> {
        match self {
            Self::Flat { draw, captured, .. } => {
                match captured {
                    Some(captured) => {
                        pose(recorder, scene, workspace, share)?;
                        project_by_feedback(recorder, (scene, workspace), captured, share)?;
                    }
                    None => pose_and_project(recorder, scene, workspace, share)?,
                }
                place(recorder, (scene, workspace), framebuffer, scene.counts.parts, share)?;
                draw.record(recorder, (scene, workspace), framebuffer, share)
            }
            Self::Mesh(drawn) => {
                let DrawnMesh { mesh, projection, pipelines, workspace: own, edges } = &**drawn;
                pose(recorder, scene, workspace, share)?;
                match projection {
                    Projection::Compute => skin(recorder, (scene, mesh), (workspace, own), share)?,
                    Projection::Feedback => skin_by_feedback(recorder, (scene, mesh), (workspace, own), share)?,
                }
                place(recorder, (scene, workspace), framebuffer, 0, share)?;
                draw_mesh(recorder, pipelines, (scene, mesh), (own, edges), framebuffer, share)
            }
        }
    }

    /// Records the sums of the images that fit no tile, where it can.
    pub(super) fn record_unplaced(
        &self,
        recorder: &mut Recorder,
        scene: (&DeviceScene, &Workspace),
        summed: Summed<'_>,
        framebuffer: &Framebuffer,
        share: Share,
    ) -> Result<()> {
        match self {
            Self::Flat { .. } => raster(recorder, scene, summed, Images::Listed(&framebuffer.listed), share),
            Self::Mesh(_) => Ok(()),
        }
    }
}
