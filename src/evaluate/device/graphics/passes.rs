//! The passes between bone matrices and a framebuffer: the projection by transform feedback, every image's place.

use anyhow::Result;

use super::framebuffer::Framebuffer;
use crate::evaluate::device::passes::image_groups;
use crate::evaluate::device::scene::{Counts, DeviceScene, Share};
use crate::evaluate::device::workspace::Workspace;
use crate::evaluate::shaders::{layout, order_comp, place_comp, project_feedback_vert};
use crate::gpu::{Buffer, Device, Draw, Drawing, Feedback, Groups, Memory, Pipeline, Recorder, Topology, Viewport};

/// The pipeline whose vertices' outputs [`project_by_feedback`] captures.
pub(super) fn feedback_pipeline(device: &Device) -> Result<Pipeline> {
    let drawing = Drawing { topology: Topology::Points, channels: 0, ..Drawing::default() };
    device.graphics_pipeline("project feedback", &[project_feedback_vert::stage()], &drawing)
}

/// Room for the parts that [`project_by_feedback`] captures of a batch of `candidates`.
pub(super) fn feedback_room(device: &Device, counts: Counts, candidates: u32) -> Result<Buffer> {
    let quads = candidates as usize * counts.views as usize * counts.parts as usize;
    device.buffer::<layout::Quad>("captured quads", quads, Memory::Device)
}

/// Records the projection by vertices whose outputs transform feedback captures, and what brings them into order (METHOD A9):
/// `workspace.world` through `captured` to the same `workspace.quads` and `workspace.bounds` as the compute stage's, for measuring
/// one against the other.
pub(super) fn project_by_feedback(
    recorder: &mut Recorder,
    (scene, workspace): (&DeviceScene, &Workspace),
    captured: &Buffer,
    share: Share,
) -> Result<()> {
    let push = scene.batch(share);
    let vertices = share.candidates * scene.counts.views * scene.counts.parts;
    let size = u64::from(vertices) * size_of::<layout::Quad>() as u64;
    let bindings = project_feedback_vert::Bindings {
        parts: &scene.parts.buffer,
        cameras: &scene.cameras.buffer,
        world: &workspace.world,
    };
    recorder.feedback(
        "project feedback",
        &Feedback { buffer: captured, offset: 0, size },
        &[Draw {
            pipeline: &feedback_pipeline(&scene.device)?,
            bindings: &bindings.bound(),
            push: bytemuck::bytes_of(&push),
            viewport: Viewport { area: [0.0, 0.0, 1.0, 1.0], depth: [0.0, 1.0] },
            scissor: [0, 0, 1, 1],
            vertices: 0..vertices,
            instances: 0..1,
            indices: None,
            indirect: None,
        }],
    )?;
    let bindings = order_comp::Bindings {
        cameras: &scene.cameras.buffer,
        captured,
        quads: &workspace.quads,
        all_bounds: &workspace.bounds,
    };
    recorder.run(bindings.dispatch(push, image_groups(scene, share)))
}

/// Records every image's place in the framebuffer (METHOD A9), and the list of those that do not fit their tile: `workspace.bounds`
/// and `parts` quads an image, 0 where it is not drawn from them, to placements and list, and zeros to `workspace.sums`.
pub(super) fn place(
    recorder: &mut Recorder,
    (scene, workspace): (&DeviceScene, &Workspace),
    framebuffer: &Framebuffer,
    parts: u32,
    share: Share,
) -> Result<()> {
    let empty = &framebuffer.empty_list;
    recorder.copy("place", (empty, 0), (&framebuffer.listed, 0), empty.size())?;
    let bindings = place_comp::Bindings {
        all_bounds: &workspace.bounds,
        tiles: &framebuffer.tiles,
        cameras: &scene.cameras.buffer,
        quads: &workspace.quads,
        placements: &framebuffer.placements,
        all_sums: &workspace.sums,
        listed: &framebuffer.listed,
    };
    let push = place_comp::Push { parts, ..scene.batch(share) };
    recorder.run(bindings.dispatch(push, Groups::Over([share.candidates * scene.counts.views, 1, 1])))
}
