//! The silhouette edges of a batch of the mesh's candidates, listed before they are drawn.

use anyhow::{Result, ensure};

use super::framebuffer::Framebuffer;
use super::tiles::CANDIDATES_A_TILE;
use crate::evaluate::device::mesh::{DeviceMesh, MeshWorkspace, mesh_batch};
use crate::evaluate::device::scene::{Counts, DeviceScene, Share};
use crate::evaluate::shaders::{OUTLINE_VERTICES, layout, outline_comp};
use crate::gpu::{Buffer, Device, Groups, Memory, Recorder};

/// Room for them, and how they are drawn.
#[derive(Debug)]
pub(super) struct Outlines {
    /// Most silhouette edges of one channel.
    most: u32,
    /// `[channel][place]`.
    pub(super) listed: Buffer,
    /// How each channel's are drawn: vertices, 1, 0, 0.
    pub(super) counts: Buffer,
    /// What `counts` begin with before any edge is listed.
    none: Buffer,
}

impl Outlines {
    /// Bytes that a candidate asks for.
    pub(super) fn bytes(counts: Counts, mesh: &DeviceMesh) -> u64 {
        u64::from(counts.views) * u64::from(mesh.edge_count) * size_of::<u32>() as u64
    }

    /// Most candidates whose silhouette edges a device binds at once and 32 bits count, in whole tiles.
    ///
    /// # Errors
    /// When not even one tile's fit.
    pub(super) fn most_candidates(device: &Device, counts: Counts, mesh: &DeviceMesh) -> Result<u32> {
        let limit = device.capabilities().max_storage;
        let a_tile = Self::bytes(counts, mesh) * u64::from(CANDIDATES_A_TILE);
        let countable = u64::from(u32::MAX / OUTLINE_VERTICES) * size_of::<u32>() as u64;
        let tiles = limit.min(countable) / a_tile.max(1);
        ensure!(
            tiles > 0,
            "a mesh of {} edges in {} views does not fit the {limit} bytes that this device binds at once",
            mesh.edge_count,
            counts.views
        );
        Ok(tiles.saturating_mul(u64::from(CANDIDATES_A_TILE)).min(u64::from(u32::MAX)) as u32)
    }

    /// For batches of so many candidates.
    ///
    /// # Errors
    /// When the device has no room.
    pub(super) fn new(device: &Device, counts: Counts, mesh: &DeviceMesh, batch: u32) -> Result<Self> {
        let most = batch.div_ceil(CANDIDATES_A_TILE) * counts.views * mesh.edge_count;
        let words = CANDIDATES_A_TILE as usize * most as usize;
        let none = device.buffer::<u32>("no outlines", 4 * CANDIDATES_A_TILE as usize, Memory::Upload)?;
        none.write(0, &[[0_u32, 1, 0, 0]; CANDIDATES_A_TILE as usize])?;
        Ok(Self {
            most,
            listed: device.buffer::<u32>("outlines", words, Memory::Device)?,
            counts: device.buffer::<u32>("outline counts", 4 * CANDIDATES_A_TILE as usize, Memory::Device)?,
            none,
        })
    }

    /// The push constants of the stages that list and draw them.
    pub(super) fn push(&self, counts: Counts, mesh: &DeviceMesh, share: Share) -> layout::MeshBatch {
        layout::MeshBatch { most_outlines: self.most, ..mesh_batch(counts, mesh, share) }
    }

    /// Records the list of a share's silhouette edges: `own.seen`, placed, to `listed` and `counts`.
    pub(super) fn record(
        &self,
        recorder: &mut Recorder,
        (scene, mesh): (&DeviceScene, &DeviceMesh),
        own: &MeshWorkspace,
        framebuffer: &Framebuffer,
        share: Share,
    ) -> Result<()> {
        recorder.copy("outline", (&self.none, 0), (&self.counts, 0), self.none.size())?;
        let bindings = outline_comp::Bindings {
            edges: &mesh.edges.buffer,
            all_seen: &own.seen,
            placements: &framebuffer.placements,
            outlines: &self.listed,
            counts: &self.counts,
        };
        let images = share.candidates * scene.counts.views;
        let push = self.push(scene.counts, mesh, share);
        recorder.run(bindings.dispatch(push, Groups::Over([mesh.edge_count, images, 1])))
    }
}
