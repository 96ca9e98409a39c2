//! The flat model drawn by the graphics pipeline: every part of every image from the projected buffer, four candidates a tile
//! (METHOD A9).

use anyhow::Result;

use super::framebuffer::Framebuffer;
use super::settings::{Coverage, Packing};
use super::tiles::CANDIDATES_A_TILE;
use crate::evaluate::device::scene::{DeviceScene, Share};
use crate::evaluate::device::workspace::Workspace;
use crate::evaluate::shaders::{draw_border_vert, draw_exact_frag, draw_exact_vert, draw_fill_vert, draw_plain_frag};
use crate::gpu::{
    Blend, Buffer, Device, Draw, Drawing, Format, Memory, Pipeline, Recorder, ShaderStage, Topology, Viewport,
};

/// A draw of every image: its pipeline, its vertices and the index buffer that joins them.
#[derive(Debug)]
struct Pass {
    pipeline: Pipeline,
    lines: bool,
}

/// How a body's parts are drawn.
#[derive(Debug)]
pub(super) struct FlatDrawing {
    packing: Packing,
    /// In the order in which they are drawn; with the packing by depth a channel's after the other's.
    passes: Vec<Pass>,
    /// Two triangles a part.
    triangles: Buffer,
    /// Four lines a part.
    lines: Buffer,
    parts: u32,
}

impl FlatDrawing {
    /// For a body of `parts` parts.
    pub(super) fn new(device: &Device, parts: u32, packing: Packing, coverage: Coverage) -> Result<Self> {
        let channels: Vec<Option<u32>> = match packing {
            Packing::Max => vec![None],
            Packing::Depth => (0..CANDIDATES_A_TILE).map(Some).collect(),
        };
        let by_depth = packing == Packing::Depth;
        let own = packing.constant();
        let mut passes = Vec::new();
        for channel in channels {
            let place = channel.unwrap_or(0);
            let mut pass = |name: &str, stages: [ShaderStage; 2], lines: bool| -> Result<()> {
                let drawing = Drawing {
                    topology: if lines { Topology::Lines } else { Topology::Triangles },
                    colour: Some(Format::Rgba8),
                    depth_test: by_depth,
                    depth_write: by_depth,
                    blend: if by_depth { Blend::Replace } else { Blend::Max },
                    channels: channel.map_or(15, |channel| 1 << channel),
                    ..Drawing::default()
                };
                passes.push(Pass { pipeline: device.graphics_pipeline(name, &stages, &drawing)?, lines });
                Ok(())
            };
            let plain = || draw_plain_frag::stage(draw_plain_frag::Constants { packing: own });
            match coverage {
                Coverage::Exact => {
                    let vertex = draw_exact_vert::Constants { packing: own, channel: place };
                    let fragment = draw_exact_frag::stage(draw_exact_frag::Constants { packing: own });
                    pass("draw parts", [draw_exact_vert::stage(vertex), fragment], false)?;
                }
                Coverage::Hardware => {
                    let fill = draw_fill_vert::Constants { packing: own, channel: place };
                    let border = draw_border_vert::Constants { packing: own, channel: place };
                    pass("draw fills", [draw_fill_vert::stage(fill), plain()], false)?;
                    pass("draw borders", [draw_border_vert::stage(border), plain()], true)?;
                }
            }
        }
        let indices = |name: &str, pattern: &[u32]| {
            let values: Vec<u32> =
                (0..parts).flat_map(|part| pattern.iter().map(move |corner| 4 * part + corner)).collect();
            let buffer = device.buffer::<u32>(name, values.len(), Memory::Upload)?;
            buffer.write(0, &values).map(|()| buffer)
        };
        Ok(Self {
            packing,
            passes,
            triangles: indices("part triangles", &[0, 1, 2, 0, 2, 3])?,
            lines: indices("part lines", &[0, 1, 1, 2, 2, 3, 3, 0])?,
            parts,
        })
    }

    /// Records it: `workspace.quads`, placed, into the framebuffer, whose used area is cleared first.
    pub(super) fn record(
        &self,
        recorder: &mut Recorder,
        (scene, workspace): (&DeviceScene, &Workspace),
        framebuffer: &Framebuffer,
        share: Share,
    ) -> Result<()> {
        let push = scene.batch(share);
        let [width, height] = framebuffer.layout.size;
        let candidates = match self.packing {
            Packing::Max => share.candidates,
            Packing::Depth => share.candidates.div_ceil(CANDIDATES_A_TILE),
        };
        let side = framebuffer.layout.viewport() as f32;
        // All vertex stages have the same bindings.
        let bindings = draw_exact_vert::Bindings {
            quads: &workspace.quads,
            placements: &framebuffer.placements,
            tiles: &framebuffer.tiles,
        }
        .bound();
        let draws: Vec<Draw<'_>> = self
            .passes
            .iter()
            .map(|pass| Draw {
                pipeline: &pass.pipeline,
                bindings: &bindings,
                push: bytemuck::bytes_of(&push),
                viewport: Viewport { area: [0.0, 0.0, side, side], depth: [0.0, 1.0] },
                scissor: [0, 0, width, height],
                vertices: 0..self.parts * if pass.lines { 8 } else { 6 },
                instances: 0..candidates * scene.counts.views,
                indices: Some(if pass.lines { &self.lines } else { &self.triangles }),
                indirect: None,
            })
            .collect();
        recorder.draw("draw", &framebuffer.target(), &draws)
    }
}
