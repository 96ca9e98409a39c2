//! What a backend draws into the framebuffer: the flat model, or a mesh.

use anyhow::Result;

use super::draw::FlatDrawing;
use super::draw_mesh::{MeshPipelines, draw_mesh, mesh_pipelines};
use super::framebuffer::Framebuffer;
use super::outlines::Outlines;
use super::passes::{place, project_by_feedback};
use super::settings::{Coverage, Packing};
use crate::evaluate::MeshProjector;
use crate::evaluate::device::mesh::{DeviceMesh, MeshWorkspace, skin, skin_stages};
use crate::evaluate::device::passes::{Images, pose, pose_and_project, raster, raster_stage};
use crate::evaluate::device::scene::{DeviceScene, Share};
use crate::evaluate::device::summed::Summed;
use crate::evaluate::device::workspace::Workspace;
use crate::evaluate::shaders::{LABELS, SHORT_CODES, outline_comp};
use crate::gpu::{Buffer, Device, OutOfMemory, Recorder};

/// The stages of one model, and the memory that it alone needs.
#[derive(Debug)]
pub(super) enum Drawn {
    Flat(FlatDrawing),
    Mesh(Box<DrawnMesh>),
}

#[derive(Debug)]
pub(super) struct DrawnMesh {
    mesh: DeviceMesh,
    pipelines: MeshPipelines,
    workspace: MeshWorkspace,
    outlines: Outlines,
}

impl DrawnMesh {
    /// Room for batches of `candidates`, or as many as fit.
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
    /// The flat model of a body of `parts` parts.
    pub(super) fn flat(device: &Device, parts: u32, packing: Packing, coverage: Coverage) -> Result<Self> {
        device.compile(&[raster_stage(device, true, false)])?;
        Ok(Self::Flat(FlatDrawing::new(device, parts, packing, coverage)?))
    }

    /// The mesh of a projector that `scene` was made of.
    pub(super) fn mesh(device: &Device, scene: &DeviceScene, projector: &MeshProjector) -> Result<Self> {
        let mesh = DeviceMesh::new(device, projector)?;
        let [bind, skin] = skin_stages(mesh.skinning);
        device.compile(&[bind, skin, outline_comp::stage()])?;
        let pipelines = mesh_pipelines(device)?;
        let (workspace, outlines) = DrawnMesh::room(scene, &mesh, 1)?;
        Ok(Self::Mesh(Box::new(DrawnMesh { mesh, pipelines, workspace, outlines })))
    }

    /// Makes room for batches of `candidates`, or as many as fit.
    pub(super) fn reserve(&mut self, scene: &DeviceScene, candidates: u32) -> Result<()> {
        if let Self::Mesh(drawn) = self {
            (drawn.workspace, drawn.outlines) = DrawnMesh::room(scene, &drawn.mesh, candidates)?;
        }
        Ok(())
    }

    /// Most candidates of a batch.
    pub(super) fn most(&self) -> u32 {
        match self {
            Self::Flat(_) => u32::MAX,
            Self::Mesh(drawn) => drawn.workspace.batch,
        }
    }

    /// Whether images that fit no tile are scored all the same.
    pub(super) fn scores_what_fits_no_tile(&self) -> bool {
        matches!(self, Self::Flat(_))
    }

    /// How many codes of parts, ranks or labels, a picture may hold, as stages tell them apart: few in registers, many in memory.
    pub(super) fn codes(&self, scene: &DeviceScene, packing: Packing) -> u32 {
        let largest = match (packing, self) {
            (Packing::Max, _) => scene.counts.parts,
            (Packing::Depth, Self::Flat(_)) => scene.labels.iter().copied().max().map_or(0, u32::from),
            (Packing::Depth, Self::Mesh(drawn)) => drawn.mesh.largest_label,
        };
        if largest < SHORT_CODES { SHORT_CODES } else { LABELS }
    }

    /// Records the copies that bring what is drawn to the device.
    pub(super) fn record_upload(&self, recorder: &mut Recorder) -> Result<()> {
        match self {
            Self::Flat(_) => Ok(()),
            Self::Mesh(drawn) => drawn.mesh.record_upload(recorder),
        }
    }

    /// Records everything from `workspace.poses` to the pictures; the flat model's parts are projected by transform feedback into
    /// `captured`, if given.
    pub(super) fn record(
        &self,
        recorder: &mut Recorder,
        (scene, workspace): (&DeviceScene, &Workspace),
        captured: Option<&Buffer>,
        framebuffer: &Framebuffer,
        share: Share,
    ) -> Result<()> {
        match self {
            Self::Flat(draw) => {
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
                let DrawnMesh { mesh, pipelines, workspace: own, outlines } = &**drawn;
                pose(recorder, scene, workspace, share)?;
                skin(recorder, (scene, mesh), (workspace, own), share)?;
                place(recorder, (scene, workspace), framebuffer, 0, share)?;
                draw_mesh(recorder, pipelines, (scene, mesh), (own, outlines), framebuffer, share)
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
            Self::Flat(_) => raster(recorder, scene, summed, Images::Listed(&framebuffer.listed), share),
            Self::Mesh(_) => Ok(()),
        }
    }
}
