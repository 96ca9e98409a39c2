//! The passes that both ways to draw are made of: poses to parts in every camera, drawing without a framebuffer, sums to fitness.

use anyhow::Result;

use super::raster_kernel::RowWay;
use super::scene::{DeviceScene, Share};
use super::summed::Summed;
use super::workspace::Workspace;
use crate::evaluate::device_evaluator::{ScoredBy, Scoring};
use crate::evaluate::objective::Objective;
use crate::evaluate::shaders::{
    PROJECT_GROUP, layout, objective_comp, objective_evidence_comp, objective_segments_comp, pose_comp,
    pose_project_comp, project_comp, raster_comp, raster_evidence_comp, raster_segments_comp, raster_shared_comp,
};
use crate::gpu::{Buffer, Device, Groups, Recorder, ShaderStage};

/// Which images of a share are drawn.
#[derive(Clone, Copy, Debug)]
pub(super) enum Images<'a> {
    /// All, drawn so.
    All(RowWay),
    /// Those of a list: how many there are, 1, 1, and their numbers, (candidate - first) * views + view.
    Listed(&'a Buffer),
}

/// Records poses to bone matrices (METHOD A3): `workspace.poses` to `workspace.world`.
pub(super) fn pose(recorder: &mut Recorder, scene: &DeviceScene, workspace: &Workspace, share: Share) -> Result<()> {
    let bindings = pose_comp::Bindings { bones: &scene.bones.buffer, poses: &workspace.poses, world: &workspace.world };
    recorder.run(bindings.dispatch(scene.batch(share), Groups::Over([share.candidates, 1, 1])))
}

/// Records every part of every candidate into every camera (METHOD A4, A2): `workspace.world` to snapped corners, nearest parts
/// first, in `workspace.quads`, and `workspace.bounds`.
pub(super) fn project(recorder: &mut Recorder, scene: &DeviceScene, workspace: &Workspace, share: Share) -> Result<()> {
    let bindings = project_comp::Bindings {
        parts: &scene.parts.buffer,
        cameras: &scene.cameras.buffer,
        world: &workspace.world,
        quads: &workspace.quads,
        all_bounds: &workspace.bounds,
    };
    let constants = project_comp::Constants { local_size_x: scene.groups.project };
    recorder.run(bindings.dispatch(constants, scene.batch(share), image_groups(scene, share)))
}

/// Records both for the flat model, `workspace.poses` to `workspace.quads` and `workspace.bounds`: in one pass where that suits the device,
/// with nothing in `workspace.world`.
pub(super) fn pose_and_project(
    recorder: &mut Recorder,
    scene: &DeviceScene,
    workspace: &Workspace,
    share: Share,
) -> Result<()> {
    if let Some(constants) = posed_together(scene) {
        return pose_project(recorder, (scene, workspace), constants, share);
    }
    pose(recorder, scene, workspace, share)?;
    project(recorder, scene, workspace, share)
}

/// The one pass, in a workgroup of that room.
pub(super) fn pose_project(
    recorder: &mut Recorder,
    (scene, workspace): (&DeviceScene, &Workspace),
    constants: pose_project_comp::Constants,
    share: Share,
) -> Result<()> {
    let bindings = pose_project_comp::Bindings {
        parts: &scene.parts.buffer,
        cameras: &scene.cameras.buffer,
        quads: &workspace.quads,
        all_bounds: &workspace.bounds,
        bones: &scene.bones.buffer,
        poses: &workspace.poses,
    };
    recorder.run(bindings.dispatch(constants, scene.batch(share), image_groups(scene, share)))
}

/// The room of a workgroup that poses and projects in one pass; none where two passes suit the device better. Invocations of a workgroup
/// wait for each other dearly on a processor: 20 ms where the two passes take 7 (docs/PERFORMANCE.md).
fn posed_together(scene: &DeviceScene) -> Option<pose_project_comp::Constants> {
    room_for_bones(scene).filter(|_| scene.device.capabilities().wide)
}

/// The room of a workgroup for the bones of the candidates that its images are of, wherever it begins among them; none where it has not
/// so much.
pub(super) fn room_for_bones(scene: &DeviceScene) -> Option<pose_project_comp::Constants> {
    /// What bringing parts into order takes: five words an invocation.
    const ORDER: u32 = 5 * 4 * PROJECT_GROUP;
    let group = scene.groups.project;
    let images = group / scene.counts.parts;
    let candidates = (images - 1).div_ceil(scene.counts.views) + 1;
    let posed_rows = candidates.checked_mul(scene.counts.bones)?.checked_mul(3)?;
    let bytes = posed_rows.checked_mul(size_of::<[f32; 4]>() as u32)?;
    let room = scene.device.capabilities().shared_memory.saturating_sub(ORDER);
    (bytes <= room).then_some(pose_project_comp::Constants { posed_rows, local_size_x: group })
}

/// The stages of [`pose_and_project`], to be compiled ahead of their first use.
pub(super) fn pose_and_project_stages(scene: &DeviceScene) -> Vec<ShaderStage> {
    match posed_together(scene) {
        Some(constants) => vec![pose_project_comp::stage(constants)],
        None => vec![pose_comp::stage(), project_stage(scene)],
    }
}

/// The workgroups of a stage that takes whole images, a part an invocation.
pub(super) fn image_groups(scene: &DeviceScene, share: Share) -> Groups<'static> {
    let images = share.candidates * scene.counts.views;
    Groups::Count([images.div_ceil(scene.groups.project / scene.counts.parts), 1, 1])
}

/// What projects, by the workgroups of a scene.
pub(super) fn project_stage(scene: &DeviceScene) -> ShaderStage {
    project_comp::stage(project_comp::Constants { local_size_x: scene.groups.project })
}

/// The stage that draws and compares whole silhouettes without a framebuffer, with sums over subgroups where the device has them.
pub(super) fn raster_stage(device: &Device, constants: raster_comp::Constants) -> ShaderStage {
    let stage = raster_comp::stage(constants);
    if device.capabilities().subgroup_arithmetic {
        stage
    } else {
        ShaderStage { shader: &raster_shared_comp::SHADER, ..stage }
    }
}

/// Records drawing and comparison without a framebuffer, in the reference's integers (docs/RASTER.md, METHOD A6): `workspace.quads`
/// and `bounds` to `workspace.sums`, and to what is summed besides.
pub(super) fn raster(
    recorder: &mut Recorder,
    (scene, workspace): (&DeviceScene, &Workspace),
    summed: Summed<'_>,
    images: Images<'_>,
    share: Share,
) -> Result<()> {
    let (listed, way, list, groups) = match images {
        // The list is not read.
        Images::All(way) => {
            (false, way, &scene.cameras.buffer, Groups::Count([share.candidates * scene.counts.views, 1, 1]))
        }
        Images::Listed(list) => (true, RowWay::usual(scene.device.capabilities()), list, Groups::Indirect(list, 0)),
    };
    let RowWay { group: local_size_x, words, keeps_edges } = way;
    let (ignores, edges_kept) = (scene.counted.is_some(), way.edges_kept());
    let whole = raster_comp::Bindings {
        cameras: &scene.cameras.buffer,
        quads: &workspace.quads,
        all_bounds: &workspace.bounds,
        planes: &scene.planes.buffer,
        list,
        all_sums: &workspace.sums,
        counted: scene.counted_planes(),
    };
    let raster_comp::Bindings { cameras, quads, all_bounds, planes, list, all_sums, counted } = whole;
    match summed {
        Summed::Nothing => {
            let constants = raster_comp::Constants { listed, ignores, local_size_x, words, keeps_edges, edges_kept };
            let dispatch = whole.dispatch(constants, scene.batch(share), groups);
            recorder.compute("raster", &[dispatch.by(raster_stage(&scene.device, constants).shader)])
        }
        Summed::Segments(segments, segment_edges) => {
            let bindings = raster_segments_comp::Bindings {
                cameras,
                quads,
                all_bounds,
                planes,
                list,
                all_sums,
                table: &segments.table.buffer,
                segment_planes: &segments.planes.buffer,
                all_segment_sums: &segments.sums,
                counted,
            };
            recorder.run(bindings.dispatch(
                raster_segments_comp::Constants {
                    listed,
                    ignores,
                    segment_edges,
                    local_size_x,
                    words,
                    keeps_edges,
                    edges_kept,
                },
                scene.batch(share),
                groups,
            ))
        }
        Summed::Evidence(own) => {
            let bindings = raster_evidence_comp::Bindings {
                cameras,
                quads,
                all_bounds,
                planes,
                list,
                all_sums,
                table: &own.table.buffer,
                evidence_planes: &own.planes.buffer,
                all_evidence: &own.sums,
                counted,
            };
            recorder.run(bindings.dispatch(
                raster_evidence_comp::Constants { listed, ignores, local_size_x, words, keeps_edges, edges_kept },
                scene.batch(share),
                groups,
            ))
        }
    }
}

/// The objective (METHOD A7) of the first `candidates` of a run, in one go however many batches they took: `workspace.sums`, and what is
/// summed besides, to `fitness`, single precision, one a candidate.
pub(super) fn objective<'a>(
    (scene, workspace): (&'a DeviceScene, &'a Workspace),
    summed: Summed<'a>,
    (objective, candidates): (&Objective, u32),
    fitness: &'a Buffer,
) -> Scoring<'a> {
    let (_, terms, over) = objective.kind.formula();
    let scoring = layout::Scoring {
        candidates,
        views: scene.counts.views,
        terms: terms as u32,
        over: over as u32,
        beta: objective.beta,
        w1: objective.w1,
        w2: objective.w2,
    };
    let (push, groups) = (layout::Objective { scoring }, Groups::Over([candidates, 1, 1]));
    let (cameras, all_sums) = (&scene.cameras.buffer, &workspace.sums);
    match summed {
        Summed::Nothing => {
            let bindings = objective_comp::Bindings { cameras, all_sums, fitness };
            Scoring { by: ScoredBy::Silhouettes, dispatch: bindings.dispatch(push, groups) }
        }
        Summed::Segments(segments, segment_edges) => {
            let (table, all_segment_sums) = (&segments.table.buffer, &segments.sums);
            let bindings = objective_segments_comp::Bindings { cameras, all_sums, fitness, table, all_segment_sums };
            let constants = objective_segments_comp::Constants { segment_edges };
            Scoring { by: ScoredBy::Segments, dispatch: bindings.dispatch(constants, push, groups) }
        }
        Summed::Evidence(own) => {
            let (table, all_evidence) = (&own.table.buffer, &own.sums);
            let bindings = objective_evidence_comp::Bindings { all_sums, fitness, table, all_evidence };
            Scoring { by: ScoredBy::Evidence, dispatch: bindings.dispatch(push, groups) }
        }
    }
}
