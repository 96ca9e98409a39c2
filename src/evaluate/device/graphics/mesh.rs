//! The mesh model on the device: the mesh itself, and the memory that a batch of its candidates works in.

use anyhow::{Result, ensure};

use super::tiles::CANDIDATES_A_TILE;
use crate::body::Skinning;
use crate::evaluate::MeshProjector;
use crate::evaluate::device::scene::{Counts, Share};
use crate::evaluate::shaders::{OUTLINE_VERTICES, layout};
use crate::gpu::{Buffer, Device, Groups, Memory, OutOfMemory, Recorder, StagedBuffer};

/// A mesh on the device; the device sees it when the passes of [`Self::record_upload`] have run.
#[derive(Debug)]
pub(crate) struct DeviceMesh {
    pub(crate) vertex_count: u32,
    pub(crate) triangle_count: u32,
    pub(crate) edge_count: u32,
    pub(crate) largest_label: u32,
    pub(crate) skinning: Skinning,
    pub(crate) vertices: StagedBuffer,
    /// Three indices a triangle.
    pub(crate) triangles: StagedBuffer,
    pub(crate) edges: StagedBuffer,
    /// Three rows a bone, in the order of the bone matrices.
    pub(crate) inverse_bind: StagedBuffer,
}

impl DeviceMesh {
    /// Puts a mesh there.
    ///
    /// # Errors
    /// When the device has no room.
    pub(crate) fn new(device: &Device, projector: &MeshProjector) -> Result<Self> {
        let mesh = projector.mesh();
        let vertices: Vec<layout::MeshVertex> = mesh
            .vertices
            .iter()
            .map(|vertex| layout::MeshVertex {
                position: vertex.position.to_array(),
                label: u32::from(vertex.label),
                weights: vertex.weights,
                bones: vertex.bones.map(|bone| projector.place_in_rig[usize::from(bone)] as u32),
            })
            .collect();
        let edges: Vec<layout::MeshEdge> =
            mesh.edges.iter().map(|edge| layout::MeshEdge { ends: edge.ends, opposite: edge.opposite }).collect();
        Ok(Self {
            vertex_count: vertices.len() as u32,
            triangle_count: mesh.triangles.len() as u32,
            edge_count: edges.len() as u32,
            largest_label: vertices.iter().map(|vertex| vertex.label).max().unwrap_or(0),
            skinning: mesh.skinning,
            vertices: StagedBuffer::of(device, "mesh vertices", &vertices)?,
            triangles: StagedBuffer::of(device, "mesh triangles", &mesh.triangles)?,
            edges: StagedBuffer::of(device, "mesh edges", &edges)?,
            inverse_bind: StagedBuffer::of(device, "inverse bind", &projector.inverse_bind)?,
        })
    }

    /// Records the copies of everything to the device's own memory.
    pub(crate) fn record_upload(&self, recorder: &mut Recorder) -> Result<()> {
        let Self { vertices, triangles, edges, inverse_bind, .. } = self;
        [vertices, triangles, edges, inverse_bind].into_iter().try_for_each(|staged| staged.record_upload(recorder))
    }
}

/// Memory that a batch of the mesh's candidates works in.
#[derive(Debug)]
pub(crate) struct MeshWorkspace {
    /// Most candidates of a batch.
    pub(crate) batch: u32,
    /// Most silhouette edges of one channel.
    pub(crate) most_outlines: u32,
    /// Bone matrices times inverse bind matrices, `[candidate][bone][row]` vec4.
    pub(crate) skin: Buffer,
    /// Vertices as they are drawn, `[candidate][view][vertex]`.
    pub(crate) seen: Buffer,
    /// Silhouette edges, `[channel][place]`.
    pub(crate) outlines: Buffer,
    /// How each channel's silhouette edges are drawn: vertices, 1, 0, 0.
    pub(crate) counts: Buffer,
}

impl MeshWorkspace {
    /// For batches of `candidates`, or as many as the device binds at once and has memory for.
    ///
    /// # Errors
    /// When not even one candidate fits.
    pub(crate) fn new(device: &Device, counts: Counts, mesh: &DeviceMesh, candidates: u32) -> Result<Self> {
        let Counts { views, bones, .. } = counts;
        let limit = device.capabilities().max_storage;
        let images = u64::from(views);
        let seen = images * u64::from(mesh.vertex_count) * size_of::<layout::Seen>() as u64;
        let skin = u64::from(bones) * 3 * size_of::<[f32; 4]>() as u64;
        let outlines = images * u64::from(mesh.edge_count) * size_of::<u32>() as u64;
        // The framebuffer wants memory, too.
        let most_bytes = device.memory_available() / 2 / (seen + skin + outlines);
        let most = (limit / seen.max(skin)).min(u64::from(Groups::ROW / views)).min(most_bytes);
        // Words of the silhouette edges, of whole tiles; numbers of edges and counts of vertices fit 32 bits.
        let a_tile = images * u64::from(mesh.edge_count) * u64::from(CANDIDATES_A_TILE);
        let countable = u64::from(u32::MAX / OUTLINE_VERTICES) / a_tile;
        let tiles = (limit / 4 / a_tile).min(countable);
        let mut batch = u64::from(candidates.max(1)).min(most).min(tiles * u64::from(CANDIDATES_A_TILE)) as u32;
        ensure!(
            batch > 0,
            "a mesh of {} vertices in {views} views does not fit the {limit} bytes that this device binds at once",
            mesh.vertex_count
        );
        loop {
            match Self::with_batch(device, counts, mesh, batch) {
                Err(error) if batch > 1 && error.is::<OutOfMemory>() => batch = batch.div_ceil(2),
                done => return done,
            }
        }
    }

    fn with_batch(device: &Device, counts: Counts, mesh: &DeviceMesh, batch: u32) -> Result<Self> {
        let images = batch as usize * counts.views as usize;
        let most_outlines = batch.div_ceil(CANDIDATES_A_TILE) * counts.views * mesh.edge_count;
        Ok(Self {
            batch,
            most_outlines,
            skin: device.buffer::<[f32; 4]>("skin", batch as usize * counts.bones as usize * 3, Memory::Device)?,
            seen: device.buffer::<layout::Seen>(
                "seen vertices",
                images * mesh.vertex_count as usize,
                Memory::Device,
            )?,
            outlines: device.buffer::<u32>(
                "outlines",
                CANDIDATES_A_TILE as usize * most_outlines as usize,
                Memory::Device,
            )?,
            counts: device.buffer::<u32>("outline counts", 4 * CANDIDATES_A_TILE as usize, Memory::Device)?,
        })
    }

    /// The push constants of a share of the candidates.
    pub(crate) fn push(&self, counts: Counts, mesh: &DeviceMesh, share: Share) -> layout::MeshBatch {
        layout::MeshBatch {
            candidates: share.candidates,
            views: counts.views,
            bones: counts.bones,
            vertices: mesh.vertex_count,
            edges: mesh.edge_count,
            most_outlines: self.most_outlines,
        }
    }
}
