//! What a backend draws into the framebuffer: the flat model, or a mesh.

use anyhow::Result;

use super::draw::DrawStage;
use super::draw_mesh::DrawMeshStage;
use super::framebuffer::Framebuffer;
use super::mesh::{DeviceMesh, MeshWorkspace};
use super::place::PlaceStage;
use super::project_feedback::ProjectFeedbackStage;
use super::settings::{Coverage, Packing};
use super::skin::SkinStage;
use crate::evaluate::MeshProjector;
use crate::evaluate::device::project::ProjectStage;
use crate::evaluate::device::raster::RasterStage;
use crate::evaluate::device::scene::{DeviceScene, Share};
use crate::evaluate::device::workspace::Workspace;
use crate::gpu::{Buffer, Device, Recorder};

/// The stages of one model, and the memory that it alone needs.
#[derive(Debug)]
pub(super) enum Drawn {
    Flat { project: ProjectStage, draw: DrawStage, raster: RasterStage },
    Mesh(Box<DrawnMesh>),
}

#[derive(Debug)]
pub(super) struct DrawnMesh {
    mesh: DeviceMesh,
    skin: SkinStage,
    draw: DrawMeshStage,
    room: MeshWorkspace,
}

impl Drawn {
    /// The flat model of a body of `parts` parts.
    pub(super) fn flat(device: &Device, parts: u32, packing: Packing, coverage: Coverage) -> Result<Self> {
        let (raster, others) = rayon::join(
            || RasterStage::new(device),
            || anyhow::Ok((ProjectStage::new(device)?, DrawStage::new(device, parts, packing, coverage)?)),
        );
        let (project, draw) = others?;
        Ok(Self::Flat { project, draw, raster: raster? })
    }

    /// The mesh of a projector that `model` was made of.
    pub(super) fn mesh(device: &Device, model: &DeviceScene, projector: &MeshProjector) -> Result<Self> {
        let mesh = DeviceMesh::new(device, projector)?;
        Ok(Self::Mesh(Box::new(DrawnMesh {
            skin: SkinStage::new(device, mesh.skinning)?,
            draw: DrawMeshStage::new(device)?,
            room: MeshWorkspace::new(device, model.counts, &mesh, 1)?,
            mesh,
        })))
    }

    /// Makes room for batches of `candidates`, or as many as fit.
    pub(super) fn reserve(&mut self, model: &DeviceScene, candidates: u32) -> Result<()> {
        if let Self::Mesh(drawn) = self {
            drawn.room = MeshWorkspace::new(&model.device, model.counts, &drawn.mesh, candidates)?;
        }
        Ok(())
    }

    /// Most candidates of a batch.
    pub(super) fn most(&self) -> u32 {
        match self {
            Self::Flat { .. } => u32::MAX,
            Self::Mesh(drawn) => drawn.room.batch,
        }
    }

    /// Whether images that fit no tile are scored all the same.
    pub(super) fn scores_what_fits_no_tile(&self) -> bool {
        matches!(self, Self::Flat { .. })
    }

    /// The largest label of what is drawn.
    pub(super) fn largest_label(&self, model: &DeviceScene) -> u32 {
        match self {
            Self::Flat { .. } => model.labels.iter().copied().max().map_or(0, u32::from),
            Self::Mesh(drawn) => drawn.mesh.largest_label,
        }
    }

    /// Records the copies that bring what is drawn to the device.
    pub(super) fn record_upload(&self, recorder: &mut Recorder) -> Result<()> {
        match self {
            Self::Flat { .. } => Ok(()),
            Self::Mesh(drawn) => drawn.mesh.record_upload(recorder),
        }
    }

    /// Records everything from `workspace.world` to the pictures; the flat model's parts are projected by `feedback` and its room, if
    /// given.
    pub(super) fn record(
        &self,
        recorder: &mut Recorder,
        (model, workspace): (&DeviceScene, &Workspace),
        feedback: Option<(&ProjectFeedbackStage, &Buffer)>,
        (place, framebuffer): (&PlaceStage, &Framebuffer),
        share: Share,
    ) -> Result<()> {
        match self {
            Self::Flat { project, draw, .. } => {
                match feedback {
                    Some((feedback, captured)) => feedback.record(recorder, model, workspace, captured, share)?,
                    None => project.record(recorder, model, workspace, share)?,
                }
                place.record(recorder, model, workspace, framebuffer, share)?;
                draw.record(recorder, model, workspace, framebuffer, share)
            }
            Self::Mesh(drawn) => {
                let DrawnMesh { mesh, skin, draw, room } = &**drawn;
                skin.record(recorder, (model, mesh), (workspace, room), share)?;
                place.record_by_bounds(recorder, model, workspace, framebuffer, share)?;
                draw.record(recorder, (model, mesh), room, framebuffer, share)
            }
        }
    }

    /// Records the sums of the images that fit no tile, where it can.
    pub(super) fn record_unplaced(
        &self,
        recorder: &mut Recorder,
        (model, workspace): (&DeviceScene, &Workspace),
        framebuffer: &Framebuffer,
        share: Share,
    ) -> Result<()> {
        match self {
            Self::Flat { raster, .. } => raster.record_listed(recorder, model, workspace, share, &framebuffer.listed),
            Self::Mesh(_) => Ok(()),
        }
    }
}
