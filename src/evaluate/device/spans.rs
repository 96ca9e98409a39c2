//! The flat model drawn and compared in two phases: spans first, then pixels.

use anyhow::Result;

use super::raster_kernel::RasterKernel;
use super::scene::{DeviceScene, Share};
use super::summed::{Summed, clear_sums};
use super::workspace::Workspace;
use crate::evaluate::shaders::{raster_spans_comp, raster_spans_evidence_comp, raster_spans_segments_comp};
use crate::gpu::{Groups, Recorder};

/// Records drawing and comparison in the reference's integers (docs/RASTER.md, METHOD A6): `workspace.quads` and `bounds` to
/// `workspace.sums`, and to what is summed besides; by workgroups as `kernel` says.
pub(super) fn raster(
    recorder: &mut Recorder,
    (scene, workspace): (&DeviceScene, &Workspace),
    summed: Summed<'_>,
    kernel: RasterKernel,
    share: Share,
) -> Result<()> {
    let (local_size_x, workgroups) = match kernel {
        RasterKernel::Spans { group, workgroups } => (group, workgroups.max(least_workgroups(scene, group))),
        RasterKernel::Rows(_) => (raster_spans_comp::Constants::default().local_size_x, 1),
    };
    // Workgroups add to them, and so do batches.
    if share.first == 0 {
        clear_sums(recorder, workspace, summed)?;
    }
    let groups = Groups::Count([share.candidates * scene.counts.views, workgroups, 1]);
    let ignores = scene.counted.is_some();
    let whole = raster_spans_comp::Bindings {
        cameras: &scene.cameras.buffer,
        quads: &workspace.quads,
        all_bounds: &workspace.bounds,
        planes: &scene.planes.buffer,
        all_sums: &workspace.sums,
        counted: scene.counted_planes(),
    };
    let raster_spans_comp::Bindings { cameras, quads, all_bounds, planes, all_sums, counted } = whole;
    let push = scene.batch(share);
    match summed {
        Summed::Nothing => {
            recorder.run(whole.dispatch(raster_spans_comp::Constants { ignores, local_size_x }, push, groups))
        }
        Summed::Segments(segments, segment_edges) => {
            let bindings = raster_spans_segments_comp::Bindings {
                cameras,
                quads,
                all_bounds,
                planes,
                all_sums,
                table: &segments.table.buffer,
                segment_planes: &segments.planes.buffer,
                all_segment_sums: &segments.sums,
                counted,
            };
            recorder.run(bindings.dispatch(
                raster_spans_segments_comp::Constants { ignores, segment_edges, local_size_x },
                push,
                groups,
            ))
        }
        Summed::Evidence(evidence) => {
            let bindings = raster_spans_evidence_comp::Bindings {
                cameras,
                quads,
                all_bounds,
                planes,
                all_sums,
                table: &evidence.table.buffer,
                evidence_planes: &evidence.planes.buffer,
                all_evidence: &evidence.sums,
                counted,
            };
            recorder.run(bindings.dispatch(
                raster_spans_evidence_comp::Constants { ignores, local_size_x },
                push,
                groups,
            ))
        }
    }
}

/// Rounds of loops that the subgroups of a workgroup may go through together, with some to spare: lavapipe ends them after 65,535, without
/// a word.
pub(super) const MOST_ROUNDS: u64 = 55_000;

/// So many workgroups an image that none of them goes through more than [`MOST_ROUNDS`].
fn least_workgroups(scene: &DeviceScene, group: u32) -> u32 {
    let blocks = |width: u32| u64::from(width.div_ceil(32) * 32).div_ceil(u64::from(group.max(1)));
    most_rounds(scene, group, |[width, height]| u64::from(height.div_ceil(32)) * blocks(width)).div_ceil(MOST_ROUNDS)
        as u32
}

/// How a scene is drawn where `asked` is: in two phases, which workgroups share, where a picture is so large that row by row one
/// workgroup could go through more rounds than that.
pub(super) fn drawable(scene: &DeviceScene, asked: RasterKernel) -> RasterKernel {
    let RasterKernel::Rows(_) = asked else { return asked };
    let [columns, rows] = asked.tile();
    let chunks = |[width, height]: [u32; 2]| u64::from(height.div_ceil(rows) * width.div_ceil(columns));
    let default = RasterKernel::Spans { group: raster_spans_comp::Constants::default().local_size_x, workgroups: 1 };
    if most_rounds(scene, rows, chunks) > MOST_ROUNDS { default } else { asked }
}

/// The most rounds of a view whose every part is everywhere, by how often an invocation goes through all of them.
fn most_rounds(scene: &DeviceScene, group: u32, times: impl Fn([u32; 2]) -> u64) -> u64 {
    let subgroups = group.div_ceil(scene.device.capabilities().subgroup_size.max(4));
    let times = scene.sizes.iter().map(|size| times(*size)).max().unwrap_or(0);
    times * u64::from(scene.counts.parts + 2) * u64::from(subgroups)
}
