//! The passes between bone matrices and a framebuffer: the projection by transform feedback, every image's place.

use anyhow::Result;

use super::framebuffer::Framebuffer;
use crate::body::Skinning;
use crate::evaluate::device::mesh::{DeviceMesh, MeshWorkspace, bind, mesh_batch};
use crate::evaluate::device::passes::image_groups;
use crate::evaluate::device::scene::{Counts, DeviceScene, Share};
use crate::evaluate::device::workspace::Workspace;
use crate::evaluate::shaders::{
    layout, order_comp, place_comp, project_feedback_vert, skin_feedback_vert, touched_comp,
};
use crate::gpu::{
    Binding, Buffer, Device, Draw, Drawing, Feedback, Groups, Memory, Pipeline, Recorder, ShaderStage, Topology,
    Viewport,
};

/// The pipeline whose vertices' outputs [`project_by_feedback`] captures.
pub(super) fn feedback_pipeline(device: &Device) -> Result<Pipeline> {
    capturing(device, "project feedback", project_feedback_vert::stage())
}

/// The pipeline whose vertices' outputs [`skin_by_feedback`] captures.
pub(super) fn skin_feedback_pipeline(device: &Device, skinning: Skinning) -> Result<Pipeline> {
    let is_smooth = u32::from(skinning == Skinning::Smooth);
    capturing(device, "skin feedback", skin_feedback_vert::stage(skin_feedback_vert::Constants { is_smooth }))
}

fn capturing(device: &Device, name: &str, stage: ShaderStage) -> Result<Pipeline> {
    let drawing = Drawing { topology: Topology::Points, channels: 0, ..Drawing::default() };
    device.graphics_pipeline(name, &[stage], &drawing)
}

/// Records so many vertices, `bytes` each, into the first bytes of `captured`.
fn capture(
    recorder: &mut Recorder,
    name: &str,
    pipeline: &Pipeline,
    (bindings, push): (&[Binding<'_>], &[u8]),
    (captured, vertices, bytes): (&Buffer, u32, usize),
) -> Result<()> {
    let draw = Draw {
        pipeline,
        bindings,
        push,
        viewport: Viewport { area: [0.0, 0.0, 1.0, 1.0], depth: [0.0, 1.0] },
        scissor: [0, 0, 1, 1],
        vertices: 0..vertices,
        instances: 0..1,
        indices: None,
        indirect: None,
    };
    let target = Feedback { buffer: captured, offset: 0, size: u64::from(vertices) * bytes as u64 };
    recorder.feedback(name, &target, &[draw])
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
    let bindings = project_feedback_vert::Bindings {
        parts: &scene.parts.buffer,
        cameras: &scene.cameras.buffer,
        world: &workspace.world,
    };
    let pipeline = feedback_pipeline(&scene.device)?;
    let given = (&bindings.bound()[..], bytemuck::bytes_of(&push));
    capture(recorder, "project feedback", &pipeline, given, (captured, vertices, size_of::<layout::Quad>()))?;
    let bindings = order_comp::Bindings {
        cameras: &scene.cameras.buffer,
        captured,
        quads: &workspace.quads,
        all_bounds: &workspace.bounds,
    };
    let constants = order_comp::Constants { local_size_x: scene.groups.project };
    recorder.run(bindings.dispatch(constants, push, image_groups(scene, share)))
}

/// What brings captured parts into order.
pub(super) fn order_stage(scene: &DeviceScene) -> ShaderStage {
    order_comp::stage(order_comp::Constants { local_size_x: scene.groups.project })
}

/// Records every vertex of the mesh of every candidate into every camera by vertices whose outputs transform feedback captures
/// (METHOD A9): the same `own.seen` and `workspace.bounds` as the compute stage's, for measuring one against the other.
pub(super) fn skin_by_feedback(
    recorder: &mut Recorder,
    (scene, mesh): (&DeviceScene, &DeviceMesh),
    (workspace, own): (&Workspace, &MeshWorkspace),
    share: Share,
) -> Result<()> {
    recorder.run(bind((scene, mesh), (workspace, own), share))?;
    let push = mesh_batch(scene.counts, mesh, share);
    let images = share.candidates * scene.counts.views;
    let bindings = skin_feedback_vert::Bindings {
        vertices: &mesh.vertices.buffer,
        skin: &own.skin,
        cameras: &scene.cameras.buffer,
    };
    let pipeline = skin_feedback_pipeline(&scene.device, mesh.skinning)?;
    let given = (&bindings.bound()[..], bytemuck::bytes_of(&push));
    let captured = (&own.seen, images * mesh.vertex_count, size_of::<layout::Seen>());
    capture(recorder, "skin feedback", &pipeline, given, captured)?;
    let bindings =
        touched_comp::Bindings { all_seen: &own.seen, cameras: &scene.cameras.buffer, all_bounds: &workspace.bounds };
    recorder.run(bindings.dispatch(push, Groups::Over([mesh.vertex_count, images, 1])))
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
