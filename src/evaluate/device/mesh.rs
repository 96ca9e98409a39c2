//! The mesh model on the device: the mesh itself, the memory that a batch of its candidates works in, and its vertices in every camera.

use anyhow::{Result, ensure};

use super::scene::{Counts, DeviceScene, Share};
use super::workspace::Workspace;
use crate::body::Skinning;
use crate::evaluate::MeshProjector;
use crate::evaluate::shaders::{bind_comp, layout, skin_comp};
use crate::gpu::{Buffer, Device, Dispatch, Groups, Memory, OutOfMemory, Recorder, ShaderStage, StagedBuffer};

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
    /// Bone matrices times inverse bind matrices, `[candidate][bone][row]` vec4.
    pub(crate) skin: Buffer,
    /// Vertices as they are drawn, `[candidate][view][vertex]`.
    pub(crate) seen: Buffer,
}

impl MeshWorkspace {
    /// For batches of `candidates`, or as many as the device binds at once and has memory for, where each asks for `others` bytes
    /// more.
    ///
    /// # Errors
    /// When not even one candidate fits.
    pub(crate) fn new(
        device: &Device,
        counts: Counts,
        mesh: &DeviceMesh,
        (candidates, others): (u32, u64),
    ) -> Result<Self> {
        let Counts { views, bones, .. } = counts;
        let limit = device.capabilities().max_storage;
        let images = u64::from(views);
        let seen = images * u64::from(mesh.vertex_count) * size_of::<layout::Seen>() as u64;
        let skin = u64::from(bones) * 3 * size_of::<[f32; 4]>() as u64;
        // What is drawn into wants memory, too.
        let most_bytes = device.memory_available() / 2 / (seen + skin + others);
        let most = (limit / seen.max(skin)).min(u64::from(Groups::ROW / views)).min(most_bytes);
        let mut batch = u64::from(candidates.max(1)).min(most) as u32;
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
        let vertices = batch as usize * counts.views as usize * mesh.vertex_count as usize;
        Ok(Self {
            batch,
            skin: device.buffer::<[f32; 4]>("skin", batch as usize * counts.bones as usize * 3, Memory::Device)?,
            seen: device.buffer::<layout::Seen>("seen vertices", vertices, Memory::Device)?,
        })
    }
}

/// The push constants of a share of the candidates.
pub(crate) fn mesh_batch(counts: Counts, mesh: &DeviceMesh, share: Share) -> layout::MeshBatch {
    layout::MeshBatch {
        candidates: share.candidates,
        views: counts.views,
        bones: counts.bones,
        vertices: mesh.vertex_count,
        edges: mesh.edge_count,
        most_outlines: 0,
        triangles: mesh.triangle_count,
        first: share.first,
    }
}

/// What [`skin`] runs.
pub(super) fn skin_stages(skinning: Skinning) -> [ShaderStage; 2] {
    [bind_comp::stage(), skin_comp::stage(skin_constants(skinning))]
}

fn skin_constants(skinning: Skinning) -> skin_comp::Constants {
    skin_comp::Constants { is_smooth: u32::from(skinning == Skinning::Smooth) }
}

/// Records every vertex of the mesh of every candidate into every camera (METHOD A4, A2): `workspace.world` to snapped places and depths
/// in `own.seen`, and `workspace.bounds`.
pub(super) fn skin(
    recorder: &mut Recorder,
    (scene, mesh): (&DeviceScene, &DeviceMesh),
    (workspace, own): (&Workspace, &MeshWorkspace),
    share: Share,
) -> Result<()> {
    let push = mesh_batch(scene.counts, mesh, share);
    let skin = skin_comp::Bindings {
        vertices: &mesh.vertices.buffer,
        skin: &own.skin,
        cameras: &scene.cameras.buffer,
        all_seen: &own.seen,
        all_bounds: &workspace.bounds,
    };
    let vertices = Groups::Over([mesh.vertex_count, share.candidates, 1]);
    let bind = bind((scene, mesh), (workspace, own), share);
    recorder.compute("skin", &[bind, skin.dispatch(skin_constants(mesh.skinning), push, vertices)])
}

/// What is done once a bone: `workspace.world` to `own.skin`; and bounds of nothing in `workspace.bounds`.
pub(super) fn bind<'a>(
    (scene, mesh): (&'a DeviceScene, &'a DeviceMesh),
    (workspace, own): (&'a Workspace, &'a MeshWorkspace),
    share: Share,
) -> Dispatch<'a> {
    // Bounds are started by the same invocations.
    let starts = share.candidates * scene.counts.bones.max(scene.counts.views);
    let bind = bind_comp::Bindings {
        world: &workspace.world,
        inverse_bind: &mesh.inverse_bind.buffer,
        cameras: &scene.cameras.buffer,
        skin: &own.skin,
        all_bounds: &workspace.bounds,
    };
    bind.dispatch(mesh_batch(scene.counts, mesh, share), Groups::Over([starts, 1, 1]))
}
