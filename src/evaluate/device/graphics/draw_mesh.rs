//! The mesh model drawn by the graphics pipeline: triangles with a depth a pixel, then silhouette edges against that depth, four
//! candidates a tile (SPEC A9).

use anyhow::Result;

use super::framebuffer::Framebuffer;
use super::mesh::{DeviceMesh, MeshWorkspace};
use super::tiles::CANDIDATES_A_TILE;
use crate::evaluate::device::scene::{DeviceScene, Share};
use crate::evaluate::shaders::{MESH_GROUP, PACK_DEPTH, draw_plain_frag, mesh_edge_vert, mesh_fill_vert, outline_comp};
use crate::gpu::{
    Blend, Clear, ComputeStage, Device, Draw, Drawing, Format, Groups, Pipeline, Recorder, Stage, Target, Topology,
    Viewport,
};

/// The stage.
#[derive(Debug)]
pub(crate) struct DrawMeshStage {
    outline: ComputeStage,
    /// Triangles and silhouette edges, one pair a channel, in the order in which they are drawn: an edge is compared with its own
    /// candidate's fills before the next channel's nearer depths cover them.
    channels: Vec<[Pipeline; 2]>,
}

impl DrawMeshStage {
    /// The name in timings of finding the silhouette edges.
    pub(crate) const OUTLINE_NAME: &'static str = "outline";
    /// Its name in timings.
    pub(crate) const NAME: &'static str = "draw mesh";

    /// Compiles it.
    pub(crate) fn new(device: &Device) -> Result<Self> {
        let pipeline = |name: &str, vertex, channel: u32, cull_clockwise: bool| {
            let stages = [
                Stage { shader: vertex, constants: &[(1, channel)] },
                Stage { shader: &draw_plain_frag::SHADER, constants: &[(0, PACK_DEPTH)] },
            ];
            let drawing = Drawing {
                topology: Topology::Triangles,
                colour: Some(Format::Rgba8),
                depth_test: true,
                depth_write: true,
                depth_bias: None,
                cull_clockwise,
                blend: Blend::Replace,
                channels: 1 << channel,
            };
            device.graphics_pipeline(name, &stages, &drawing)
        };
        let channel = |channel| {
            Ok([
                pipeline("mesh triangles", &mesh_fill_vert::SHADER, channel, true)?,
                pipeline("mesh edges", &mesh_edge_vert::SHADER, channel, false)?,
            ])
        };
        Ok(Self {
            outline: ComputeStage::new(
                device,
                Self::OUTLINE_NAME,
                Stage { shader: &outline_comp::SHADER, constants: &[] },
            )?,
            channels: (0..CANDIDATES_A_TILE).map(channel).collect::<Result<_>>()?,
        })
    }

    /// Records it: `room.seen`, placed, into the framebuffer, whose used area is cleared first.
    pub(crate) fn record(
        &self,
        recorder: &mut Recorder,
        (model, mesh): (&DeviceScene, &DeviceMesh),
        room: &MeshWorkspace,
        framebuffer: &Framebuffer,
        share: Share,
    ) -> Result<()> {
        let push = room.push(model.counts, mesh, share);
        let images = share.candidates * model.counts.views;
        let bindings = outline_comp::Bindings {
            edges: &mesh.edges,
            all_seen: &room.seen,
            placements: &framebuffer.placements,
            outlines: &room.outlines,
            counts: &room.counts,
        };
        self.outline.record(
            recorder,
            &bindings.bound(),
            &push,
            Groups::Count([mesh.edge_count.div_ceil(MESH_GROUP), images, 1]),
        )?;
        let push = bytemuck::bytes_of(&push);
        let fill = mesh_fill_vert::Bindings {
            vertices: &mesh.vertices,
            all_seen: &room.seen,
            placements: &framebuffer.placements,
            tiles: &framebuffer.tiles,
        }
        .bound();
        let edge = mesh_edge_vert::Bindings {
            vertices: &mesh.vertices,
            all_seen: &room.seen,
            placements: &framebuffer.placements,
            tiles: &framebuffer.tiles,
            edges: &mesh.edges,
            outlines: &room.outlines,
        }
        .bound();
        let [width, height] = framebuffer.layout.size;
        let side = framebuffer.layout.viewport() as f32;
        let mut draws = Vec::new();
        for (channel, [triangles, edges]) in (0..).zip(&self.channels) {
            let candidates = (share.candidates + CANDIDATES_A_TILE - 1 - channel) / CANDIDATES_A_TILE;
            let fills = Draw {
                pipeline: triangles,
                bindings: &fill,
                push,
                viewport: Viewport { area: [0.0, 0.0, side, side], depth: [0.0, 1.0] },
                scissor: [0, 0, width, height],
                vertices: 0..3 * mesh.triangle_count,
                instances: 0..candidates * model.counts.views,
                indices: Some(&mesh.triangles),
                indirect: None,
            };
            draws.push(fills.clone());
            draws.push(Draw {
                pipeline: edges,
                bindings: &edge,
                indices: None,
                indirect: Some((&room.counts, 16 * u64::from(channel))),
                ..fills
            });
        }
        let target = Target {
            colour: (&framebuffer.colour, Clear::Value([0.0; 4])),
            depth: framebuffer.depth.as_ref().map(|depth| (depth, Clear::Value([1.0; 4]))),
            area: [0, 0, width, height],
        };
        recorder.draw(Self::NAME, &target, &draws)
    }
}
