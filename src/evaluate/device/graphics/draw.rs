//! The flat model drawn by the graphics pipeline: every part of every image from the projected buffer, four candidates a tile
//! (METHOD A9).

use anyhow::Result;

use super::framebuffer::Framebuffer;
use super::settings::{Channels, Coverage, GraphicsSettings, Packing, Primitives};
use super::tiles::CANDIDATES_A_TILE;
use crate::evaluate::device::scene::{DeviceScene, Share};
use crate::evaluate::device::workspace::Workspace;
use crate::evaluate::shaders::{
    PACK_AT_ONCE, draw_border_geom, draw_border_vert, draw_exact_frag, draw_exact_geom, draw_exact_vert,
    draw_fill_geom, draw_fill_vert, draw_plain_frag, draw_point_vert,
};
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
    /// Whether an instance is four images, of which a pass draws one.
    in_turn: bool,
    primitives: Primitives,
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
    pub(super) fn new(device: &Device, parts: u32, settings: &GraphicsSettings) -> Result<Self> {
        let GraphicsSettings { packing, coverage, primitives, .. } = *settings;
        let by_depth = packing == Packing::Depth;
        let in_turn = by_depth && settings.channels == Channels::InTurn;
        let channels: Vec<Option<u32>> = if in_turn { (0..CANDIDATES_A_TILE).map(Some).collect() } else { vec![None] };
        let packing = if by_depth && !in_turn { PACK_AT_ONCE } else { packing.constant() };
        let mut passes = Vec::new();
        for channel in channels {
            let mut pass = |name: &str, vertices: ShaderStage, fragments: ShaderStage, lines: bool| -> Result<()> {
                let (topology, stages) = match primitives {
                    Primitives::Vertices if lines => (Topology::Lines, vec![vertices, fragments]),
                    Primitives::Vertices => (Topology::Triangles, vec![vertices, fragments]),
                    Primitives::Geometry => (Topology::Points, vec![draw_point_vert::stage(), vertices, fragments]),
                };
                let drawing = Drawing {
                    topology,
                    colour: Some(Format::Rgba8),
                    depth_test: by_depth,
                    depth_write: by_depth,
                    blend: if in_turn { Blend::Replace } else { Blend::Max },
                    channels: channel.map_or(15, |channel| 1 << channel),
                    ..Drawing::default()
                };
                passes.push(Pass { pipeline: device.graphics_pipeline(name, &stages, &drawing)?, lines });
                Ok(())
            };
            let channel = channel.unwrap_or(0);
            let plain = || draw_plain_frag::stage(draw_plain_frag::Constants { packing });
            match coverage {
                Coverage::Exact => {
                    let rectangle = match primitives {
                        Primitives::Vertices => draw_exact_vert::stage(draw_exact_vert::Constants { packing, channel }),
                        Primitives::Geometry => draw_exact_geom::stage(draw_exact_geom::Constants { packing, channel }),
                    };
                    let fragment = draw_exact_frag::stage(draw_exact_frag::Constants { packing });
                    pass("draw parts", rectangle, fragment, false)?;
                }
                Coverage::Hardware => {
                    let (fill, border) = match primitives {
                        Primitives::Vertices => (
                            draw_fill_vert::stage(draw_fill_vert::Constants { packing, channel }),
                            draw_border_vert::stage(draw_border_vert::Constants { packing, channel }),
                        ),
                        Primitives::Geometry => (
                            draw_fill_geom::stage(draw_fill_geom::Constants { packing, channel }),
                            draw_border_geom::stage(draw_border_geom::Constants { packing, channel }),
                        ),
                    };
                    pass("draw fills", fill, plain(), false)?;
                    pass("draw borders", border, plain(), true)?;
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
            in_turn,
            primitives,
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
        let candidates = share.candidates.div_ceil(if self.in_turn { CANDIDATES_A_TILE } else { 1 });
        let side = framebuffer.layout.viewport() as f32;
        // All vertex and geometry stages have the same bindings.
        let bindings = draw_exact_vert::Bindings {
            quads: &workspace.quads,
            placements: &framebuffer.placements,
            tiles: &framebuffer.tiles,
        }
        .bound();
        let by_points = self.primitives == Primitives::Geometry;
        let draws: Vec<Draw<'_>> = self
            .passes
            .iter()
            .map(|pass| Draw {
                pipeline: &pass.pipeline,
                bindings: &bindings,
                push: bytemuck::bytes_of(&push),
                viewport: Viewport { area: [0.0, 0.0, side, side], depth: [0.0, 1.0] },
                scissor: [0, 0, width, height],
                vertices: 0..self.parts
                    * if by_points {
                        1
                    } else if pass.lines {
                        8
                    } else {
                        6
                    },
                instances: 0..candidates * scene.counts.views,
                indices: (!by_points).then_some(if pass.lines { &self.lines } else { &self.triangles }),
                indirect: None,
            })
            .collect();
        recorder.draw("draw", &framebuffer.target(), &draws)
    }
}
