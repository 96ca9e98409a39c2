//! Up to sixteen candidates at a time in every view, from poses to components.

use crate::evaluate::besides::Besides;
use crate::evaluate::components::Components;
use crate::evaluate::projection::Projector;
use crate::evaluate::segments::SegmentSums;

use super::front::{Front, QuadChunk};
use super::kernel::{Canvas, Cell, SegmentedCell};
use super::planes::Planes;
use super::simd::Simd;

/// Working memory of one worker.
#[derive(Debug)]
pub(super) struct Scratch {
    pub(super) front: Front,
    pub(super) quads: Vec<QuadChunk>,
    pub(super) canvas: Canvas<Cell>,
    pub(super) components: Vec<Components>,
    /// In place of `canvas` where there are segments.
    pub(super) segmented: Option<Canvas<SegmentedCell>>,
    /// `[candidate][view][segment]`.
    pub(super) segment_sums: Vec<SegmentSums>,
    /// `[candidate][view]`.
    pub(super) evidence: Vec<i32>,
}

/// Evaluates them with the operations of `simd`; inlined into a function that is compiled for these.
#[inline(always)]
pub(super) fn evaluate_group<S: Simd>(
    simd: S,
    projector: &Projector,
    planes: &[Planes],
    poses: &[f32],
    besides: Besides,
    scratch: &mut Scratch,
) {
    scratch.front.pose(&projector.rig, poses);
    let views = planes.len();
    let count = poses.len() / projector.rig.dof_count;
    // A view's planes stay in the cache for all sixteen candidates.
    for (view, (camera, planes)) in projector.cameras.iter().zip(planes).enumerate() {
        for candidate in 0..count {
            scratch.front.project(camera, candidate, &mut scratch.quads);
            let image = candidate * views + view;
            scratch.components[image] = match (besides, &mut scratch.segmented) {
                (Besides::Evidence, _) => {
                    let (components, evidence) = scratch.canvas.compare_evidence(simd, &scratch.quads, planes);
                    scratch.evidence[image] = evidence;
                    components
                }
                (Besides::Segments, Some(canvas)) => {
                    let segments = planes.segment_areas.len();
                    let sums = &mut scratch.segment_sums[image * segments..][..segments];
                    canvas.compare_segments(simd, &scratch.quads, planes, sums)
                }
                (Besides::Nothing | Besides::Segments, _) => scratch.canvas.compare(simd, &scratch.quads, planes),
            };
        }
    }
}
