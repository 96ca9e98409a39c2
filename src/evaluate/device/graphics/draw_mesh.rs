//! The mesh model drawn by the graphics pipeline: triangles with a depth a pixel, then silhouette edges against that depth, four
//! candidates a tile (METHOD A9).

use anyhow::Result;

use super::framebuffer::Framebuffer;
use super::outlines::Outlines;
use super::tiles::CANDIDATES_A_TILE;
use crate::evaluate::device::mesh::{DeviceMesh, MeshWorkspace};
use crate::evaluate::device::scene::{DeviceScene, Share};
use crate::evaluate::shaders::{PACK_DEPTH, draw_plain_frag, mesh_edge_vert, mesh_fill_vert};
use crate::gpu::{Device, Draw, Drawing, Format, Pipeline, Recorder, ShaderStage, Viewport};

/// The pipelines of triangles and silhouette edges, one pair a channel, in the order in which they are drawn: an edge is compared
/// with its own candidate's fills before the next channel's nearer depths cover them.
pub(super) type MeshPipelines = Vec<[Pipeline; 2]>;

/// Compiles them.
pub(super) fn mesh_pipelines(device: &Device) -> Result<MeshPipelines> {
    let pipeline = |name: &str, vertex: ShaderStage, channel: u32, cull_clockwise: bool| {
        let fragment = draw_plain_frag::stage(draw_plain_frag::Constants { packing: PACK_DEPTH });
        let drawing = Drawing {
            colour: Some(Format::Rgba8),
            depth_test: true,
            depth_write: true,
            cull_clockwise,
            channels: 1 << channel,
            ..Drawing::default()
        };
        device.graphics_pipeline(name, &[vertex, fragment], &drawing)
    };
    let channel = |channel| {
        let fill = mesh_fill_vert::stage(mesh_fill_vert::Constants { channel });
        let edge = mesh_edge_vert::stage(mesh_edge_vert::Constants { channel });
        Ok([pipeline("mesh triangles", fill, channel, true)?, pipeline("mesh edges", edge, channel, false)?])
    };
    (0..CANDIDATES_A_TILE).map(channel).collect()
}

/// Records it: `own.seen`, placed, into the framebuffer, whose used area is cleared first.
pub(super) fn draw_mesh(
    recorder: &mut Recorder,
    pipelines: &MeshPipelines,
    (scene, mesh): (&DeviceScene, &DeviceMesh),
    (own, outlines): (&MeshWorkspace, &Outlines),
    framebuffer: &Framebuffer,
    share: Share,
) -> Result<()> {
    outlines.record(recorder, (scene, mesh), own, framebuffer, share)?;
    let push = outlines.push(scene.counts, mesh, share);
    let push = bytemuck::bytes_of(&push);
    let fill = mesh_fill_vert::Bindings {
        vertices: &mesh.vertices.buffer,
        all_seen: &own.seen,
        placements: &framebuffer.placements,
        tiles: &framebuffer.tiles,
    }
    .bound();
    let edge = mesh_edge_vert::Bindings {
        vertices: &mesh.vertices.buffer,
        all_seen: &own.seen,
        placements: &framebuffer.placements,
        tiles: &framebuffer.tiles,
        edges: &mesh.edges.buffer,
        outlines: &outlines.listed,
    }
    .bound();
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
        draws.push(Draw {
            pipeline: edges,
            bindings: &edge,
            indices: None,
            indirect: Some((&outlines.counts, 16 * u64::from(channel))),
            ..fills
        });
    }
    recorder.draw("draw mesh", &framebuffer.target(), &draws)
}
