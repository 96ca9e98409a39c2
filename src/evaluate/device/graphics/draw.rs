//! The flat model drawn by the graphics pipeline: every part of every image from the projected buffer, four candidates a tile
//! (SPEC A9).

use anyhow::Result;

use super::framebuffer::Framebuffer;
use super::settings::{Coverage, Packing};
use crate::evaluate::device::scene::{DeviceScene, Share};
use crate::evaluate::device::workspace::Workspace;
use crate::evaluate::shaders::{
    draw_border_vert, draw_exact_frag, draw_exact_vert, draw_fill_vert, draw_plain_frag, layout,
};
use crate::gpu::{
    Blend, Buffer, Clear, Device, Draw, Drawing, Format, Memory, Pipeline, Recorder, Stage, Target, Topology, Viewport,
};

/// A draw of every image: its pipeline, its vertices and the index buffer that joins them.
#[derive(Debug)]
struct Pass {
    pipeline: Pipeline,
    lines: bool,
}

/// The stage.
#[derive(Debug)]
pub(crate) struct DrawStage {
    packing: Packing,
    /// In the order in which they are drawn; with the packing by depth a channel's after the other's.
    passes: Vec<Pass>,
    /// Two triangles a part.
    triangles: Buffer,
    /// Four lines a part.
    lines: Buffer,
    parts: u32,
}

impl DrawStage {
    /// Its name in timings.
    pub(crate) const NAME: &'static str = "draw";

    /// Compiles it for a body of `parts` parts.
    pub(crate) fn new(device: &Device, parts: u32, packing: Packing, coverage: Coverage) -> Result<Self> {
        let drawing = |topology, channel: Option<u32>| Drawing {
            topology,
            colour: Some(Format::Rgba8),
            depth_test: packing == Packing::Depth,
            depth_write: packing == Packing::Depth,
            depth_bias: None,
            cull_clockwise: false,
            blend: if packing == Packing::Max { Blend::Max } else { Blend::Replace },
            channels: channel.map_or(15, |channel| 1 << channel),
        };
        let channels: Vec<Option<u32>> = match packing {
            Packing::Max => vec![None],
            Packing::Depth => (0..4).map(Some).collect(),
        };
        let mut passes = Vec::new();
        for channel in channels {
            let constants = [(0, packing.constant()), (1, channel.unwrap_or(0))];
            let mut pass = |name: &str, vertex, fragment, lines: bool| -> Result<()> {
                let stages = [
                    Stage { shader: vertex, constants: &constants },
                    Stage { shader: fragment, constants: &constants[..1] },
                ];
                let topology = if lines { Topology::Lines } else { Topology::Triangles };
                let pipeline = device.graphics_pipeline(name, &stages, &drawing(topology, channel))?;
                passes.push(Pass { pipeline, lines });
                Ok(())
            };
            match coverage {
                Coverage::Exact => {
                    pass("draw parts", &draw_exact_vert::SHADER, &draw_exact_frag::SHADER, false)?;
                }
                Coverage::Hardware => {
                    pass("draw fills", &draw_fill_vert::SHADER, &draw_plain_frag::SHADER, false)?;
                    pass("draw borders", &draw_border_vert::SHADER, &draw_plain_frag::SHADER, true)?;
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
    pub(crate) fn record(
        &self,
        recorder: &mut Recorder,
        model: &DeviceScene,
        workspace: &Workspace,
        framebuffer: &Framebuffer,
        share: Share,
    ) -> Result<()> {
        let push: layout::Batch = model.batch(share);
        let [width, height] = framebuffer.layout.size;
        let candidates = match self.packing {
            Packing::Max => share.candidates,
            Packing::Depth => share.candidates.div_ceil(4),
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
                instances: 0..candidates * model.counts.views,
                indices: Some(if pass.lines { &self.lines } else { &self.triangles }),
                indirect: None,
            })
            .collect();
        let target = Target {
            colour: (&framebuffer.colour, Clear::Value([0.0; 4])),
            depth: framebuffer.depth.as_ref().map(|depth| (depth, Clear::Value([1.0; 4]))),
            area: [0, 0, width, height],
        };
        recorder.draw(Self::NAME, &target, &draws)
    }
}
