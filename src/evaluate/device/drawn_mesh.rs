//! The mesh model drawn and compared in compute, without a framebuffer.

use anyhow::Result;

use super::mesh::{DeviceMesh, MeshWorkspace, mesh_batch, skin, skin_stages};
use super::scene::{DeviceScene, Share};
use super::spans::MOST_ROUNDS;
use super::summed::{Summed, clear_sums};
use super::workspace::Workspace;
use crate::evaluate::MeshProjector;
use crate::evaluate::shaders::{
    MESH_KEYS, MESH_WORDS, raster_mesh_comp, raster_mesh_evidence_comp, raster_mesh_segments_comp,
};
use crate::gpu::{Groups, Recorder};

/// Columns and rows of the widest tile that a workgroup works on at once.
pub(super) const MESH_TILE: [u32; 2] = [32 * MESH_WORDS, MESH_KEYS / (32 * MESH_WORDS)];

/// A mesh, and the memory that its candidates need.
#[derive(Debug)]
pub(super) struct DrawnMesh {
    mesh: DeviceMesh,
    workspace: MeshWorkspace,
    /// Of an image.
    workgroups: u32,
}

impl DrawnMesh {
    /// The mesh of a projector that `scene` was made of.
    ///
    /// # Errors
    /// When it is too large for the device, or the device fails.
    pub(super) fn new(scene: &DeviceScene, projector: &MeshProjector) -> Result<Self> {
        let device = &scene.device;
        let mesh = DeviceMesh::new(device, projector)?;
        let [bind, skin] = skin_stages(mesh.skinning);
        device.compile(&[bind, skin, raster_mesh_comp::stage(raster_mesh_comp::Constants { ignores: false })])?;
        let workspace = MeshWorkspace::new(device, scene.counts, &mesh, (1, 0))?;
        // Some tiles of the largest picture a workgroup, as many as rounds allow where a triangle takes four and an edge two.
        let tiles = |&[width, height]: &[u32; 2]| width.div_ceil(MESH_TILE[0]) * height.div_ceil(MESH_TILE[1]);
        let rounds = (4 * u64::from(mesh.triangle_count) + 2 * u64::from(mesh.edge_count))
            / u64::from(device.capabilities().subgroup_size.max(4));
        let of_one = (MOST_ROUNDS / rounds.max(1)).clamp(1, 4) as u32;
        let workgroups = scene.sizes.iter().map(tiles).max().unwrap_or(1).div_ceil(of_one);
        Ok(Self { mesh, workspace, workgroups })
    }

    /// Makes room for batches of `candidates`, or as many as fit.
    pub(super) fn reserve(&mut self, scene: &DeviceScene, candidates: u32) -> Result<()> {
        self.workspace = MeshWorkspace::new(&scene.device, scene.counts, &self.mesh, (candidates, 0))?;
        Ok(())
    }

    /// Most candidates of a batch.
    pub(super) fn most(&self) -> u32 {
        self.workspace.batch
    }

    /// Records the copies that bring the mesh to the device.
    pub(super) fn record_upload(&self, recorder: &mut Recorder) -> Result<()> {
        self.mesh.record_upload(recorder)
    }

    /// Records drawing and comparison in the reference's integers (docs/RASTER.md, METHOD A6): `workspace.world` to `workspace.sums`,
    /// and to what is summed besides.
    pub(super) fn record(
        &self,
        recorder: &mut Recorder,
        (scene, workspace): (&DeviceScene, &Workspace),
        summed: Summed<'_>,
        share: Share,
    ) -> Result<()> {
        let Self { mesh, workspace: own, .. } = self;
        // Workgroups add to them, and so do batches.
        if share.first == 0 {
            clear_sums(recorder, workspace, summed)?;
        }
        skin(recorder, (scene, mesh), (workspace, own), share)?;
        let push = mesh_batch(scene.counts, mesh, share);
        let groups = Groups::Count([share.candidates * scene.counts.views, self.workgroups, 1]);
        let ignores = scene.counted.is_some();
        let whole = raster_mesh_comp::Bindings {
            cameras: &scene.cameras.buffer,
            all_seen: &own.seen,
            all_bounds: &workspace.bounds,
            planes: &scene.planes.buffer,
            triangles: &mesh.triangles.buffer,
            all_sums: &workspace.sums,
            counted: scene.counted_planes(),
            vertices: &mesh.vertices.buffer,
            edges: &mesh.edges.buffer,
        };
        let raster_mesh_comp::Bindings {
            cameras,
            all_seen,
            all_bounds,
            planes,
            triangles,
            all_sums,
            counted,
            vertices,
            edges,
        } = whole;
        match summed {
            Summed::Nothing => recorder.run(whole.dispatch(raster_mesh_comp::Constants { ignores }, push, groups)),
            Summed::Segments(segments, segment_edges) => {
                let bindings = raster_mesh_segments_comp::Bindings {
                    cameras,
                    all_seen,
                    all_bounds,
                    planes,
                    triangles,
                    all_sums,
                    table: &segments.table.buffer,
                    segment_planes: &segments.planes.buffer,
                    all_segment_sums: &segments.sums,
                    counted,
                    vertices,
                    edges,
                };
                let constants = raster_mesh_segments_comp::Constants { ignores, segment_edges };
                recorder.run(bindings.dispatch(constants, push, groups))
            }
            Summed::Evidence(evidence) => {
                let bindings = raster_mesh_evidence_comp::Bindings {
                    cameras,
                    all_seen,
                    all_bounds,
                    planes,
                    triangles,
                    all_sums,
                    table: &evidence.table.buffer,
                    evidence_planes: &evidence.planes.buffer,
                    all_evidence: &evidence.sums,
                    counted,
                    vertices,
                    edges,
                };
                recorder.run(bindings.dispatch(raster_mesh_evidence_comp::Constants { ignores }, push, groups))
            }
        }
    }
}
