//! The mesh model drawn by the graphics pipeline: triangles with a depth a pixel, then silhouette edges against that depth, four
//! candidates a tile (METHOD A9).

use std::collections::HashMap;

use anyhow::{Result, anyhow};

use super::framebuffer::Framebuffer;
use super::outlines::Outlines;
use super::settings::Primitives;
use super::tiles::CANDIDATES_A_TILE;
use crate::body::Mesh;
use crate::evaluate::device::mesh::{DeviceMesh, MeshWorkspace, mesh_batch};
use crate::evaluate::device::scene::{DeviceScene, Share};
use crate::evaluate::shaders::{
    PACK_DEPTH, draw_plain_frag, draw_point_vert, mesh_edge_geom, mesh_edge_vert, mesh_fill_vert,
};
use crate::gpu::{Device, Draw, Drawing, Format, Pipeline, Recorder, ShaderStage, StagedBuffer, Topology, Viewport};

/// The pipelines of triangles and silhouette edges, one pair a channel, in the order in which they are drawn: an edge is compared
/// with its own candidate's fills before the next channel's nearer depths cover them.
pub(super) type MeshPipelines = Vec<[Pipeline; 2]>;

/// Compiles them.
pub(super) fn mesh_pipelines(device: &Device, primitives: Primitives) -> Result<MeshPipelines> {
    let pipeline = |name: &str, (topology, mut stages): (Topology, Vec<ShaderStage>), channel: u32, culls: bool| {
        stages.push(draw_plain_frag::stage(draw_plain_frag::Constants { packing: PACK_DEPTH }));
        let drawing = Drawing {
            topology,
            colour: Some(Format::Rgba8),
            depth_test: true,
            depth_write: true,
            cull_clockwise: culls,
            channels: 1 << channel,
            ..Drawing::default()
        };
        device.graphics_pipeline(name, &stages, &drawing)
    };
    let channel = |channel| {
        let fill = (Topology::Triangles, vec![mesh_fill_vert::stage(mesh_fill_vert::Constants { channel })]);
        let edge = match primitives {
            Primitives::Vertices => {
                (Topology::Triangles, vec![mesh_edge_vert::stage(mesh_edge_vert::Constants { channel })])
            }
            Primitives::Geometry => (
                Topology::TrianglesWithNeighbours,
                vec![draw_point_vert::stage(), mesh_edge_geom::stage(mesh_edge_geom::Constants { channel })],
            ),
        };
        Ok([pipeline("mesh triangles", fill, channel, true)?, pipeline("mesh edges", edge, channel, false)?])
    };
    (0..CANDIDATES_A_TILE).map(channel).collect()
}

/// Six vertices a triangle, as [`Topology::TrianglesWithNeighbours`] takes them.
///
/// # Errors
/// When a side has no neighbour, which a closed mesh does not have.
pub(super) fn with_neighbours(mesh: &Mesh) -> Result<Vec<[u32; 6]>> {
    let mut across: HashMap<[u32; 2], u32> = HashMap::with_capacity(2 * mesh.edges.len());
    for edge in &mesh.edges {
        let [p, q] = edge.ends;
        across.extend([([p, q], edge.opposite[1]), ([q, p], edge.opposite[0])]);
    }
    let third = |from: u32, to: u32| {
        across.get(&[from, to]).copied().ok_or_else(|| anyhow!("the side from vertex {from} to {to} has no neighbour"))
    };
    mesh.triangles.iter().map(|&[a, b, c]| Ok([a, third(a, b)?, b, third(b, c)?, c, third(c, a)?])).collect()
}

/// What finds a mesh's silhouette edges.
#[derive(Debug)]
pub(super) enum EdgeSource {
    /// A compute stage lists them.
    Listed(Outlines),
    /// A geometry stage, from [`with_neighbours`].
    Neighbours(StagedBuffer),
}

/// Records it: `own.seen`, placed, into the framebuffer, whose used area is cleared first.
pub(super) fn draw_mesh(
    recorder: &mut Recorder,
    pipelines: &MeshPipelines,
    (scene, mesh): (&DeviceScene, &DeviceMesh),
    (own, source): (&MeshWorkspace, &EdgeSource),
    framebuffer: &Framebuffer,
    share: Share,
) -> Result<()> {
    let push = match source {
        EdgeSource::Listed(outlines) => {
            outlines.record(recorder, (scene, mesh), own, framebuffer, share)?;
            outlines.push(scene.counts, mesh, share)
        }
        EdgeSource::Neighbours(_) => mesh_batch(scene.counts, mesh, share),
    };
    let push = bytemuck::bytes_of(&push);
    let fill = mesh_fill_vert::Bindings {
        vertices: &mesh.vertices.buffer,
        all_seen: &own.seen,
        placements: &framebuffer.placements,
        tiles: &framebuffer.tiles,
    }
    .bound();
    let edge = match source {
        EdgeSource::Listed(outlines) => {
            let listed = mesh_edge_vert::Bindings {
                vertices: &mesh.vertices.buffer,
                all_seen: &own.seen,
                placements: &framebuffer.placements,
                tiles: &framebuffer.tiles,
                edges: &mesh.edges.buffer,
                outlines: &outlines.listed,
            };
            listed.bound().to_vec()
        }
        // The same as those of the triangles.
        EdgeSource::Neighbours(_) => fill.to_vec(),
    };
    let [width, height] = framebuffer.layout.size;
    let side = framebuffer.layout.viewport() as f32;
    let mut draws = Vec::new();
    for (channel, [triangles, edges]) in (0..).zip(pipelines) {
        let candidates = (share.candidates + CANDIDATES_A_TILE - 1 - channel) / CANDIDATES_A_TILE;
        let fills = Draw {
            pipeline: triangles,
            bindings: &fill,
            push,
            viewport: Viewport { area: [0.0, 0.0, side, side], depth: [0.0, 1.0] },
            scissor: [0, 0, width, height],
            vertices: 0..3 * mesh.triangle_count,
            instances: 0..candidates * scene.counts.views,
            indices: Some(&mesh.triangles.buffer),
            indirect: None,
        };
        draws.push(fills.clone());
        let edges = Draw { pipeline: edges, bindings: &edge, ..fills };
        draws.push(match source {
            EdgeSource::Listed(outlines) => {
                Draw { indices: None, indirect: Some((&outlines.counts, 16 * u64::from(channel))), ..edges }
            }
            EdgeSource::Neighbours(corners) => {
                Draw { vertices: 0..6 * mesh.triangle_count, indices: Some(&corners.buffer), ..edges }
            }
        });
    }
    recorder.draw("draw mesh", &framebuffer.target(), &draws)
}
