//! Up to sixteen candidates of the flat model at a time in every view, from poses to components.

use crate::evaluate::besides::Besides;
use crate::evaluate::components::Components;
use crate::evaluate::projection::Projector;
use crate::evaluate::segments::SegmentSums;

use super::cell::{Cell, SegmentedCell};
use super::front::{Front, QuadChunk};
use super::kernel::Canvas;
use super::planes::Planes;
use super::simd::{Simd, Task};

/// What a worker has summed of up to sixteen candidates.
#[derive(Debug)]
pub(super) struct Sums {
    /// `[candidate][view]`.
    pub(super) components: Vec<Components>,
    /// `[candidate][view][segment]`.
    pub(super) segments: Vec<SegmentSums>,
    /// `[candidate][view]`.
    pub(super) evidence: Vec<i32>,
}

/// Working memory of one worker.
#[derive(Debug)]
pub(super) struct Scratch {
    pub(super) front: Front,
    pub(super) quads: Vec<QuadChunk>,
    pub(super) canvas: Canvas<Cell>,
    /// In place of `canvas` where there are segments.
    pub(super) segmented: Option<Canvas<SegmentedCell>>,
}

/// Up to sixteen poses, and where what they give goes.
pub(super) struct FlatGroup<'a> {
    pub(super) projector: &'a Projector,
    pub(super) planes: &'a [Planes],
    pub(super) poses: &'a [f32],
    pub(super) besides: Besides,
    pub(super) scratch: &'a mut Scratch,
    pub(super) sums: &'a mut Sums,
}

impl Task for FlatGroup<'_> {
    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let Self { projector, planes, poses, besides, scratch, sums } = self;
        scratch.front.pose(&projector.rig, poses);
        let views = planes.len();
        let count = poses.len() / projector.rig.dof_count;
        // A view's planes stay in the cache for all sixteen candidates.
        for (view, (camera, planes)) in projector.cameras.iter().zip(planes).enumerate() {
            for candidate in 0..count {
                scratch.front.project(camera, candidate, &mut scratch.quads);
                let image = candidate * views + view;
                sums.components[image] = match (besides, &mut scratch.segmented) {
                    (Besides::Evidence, _) => {
                        let (components, evidence) = scratch.canvas.compare_evidence(simd, &scratch.quads, planes);
                        sums.evidence[image] = evidence;
                        components
                    }
                    (Besides::Segments | Besides::SegmentEdges, Some(canvas)) => {
                        let segments = planes.segment_areas.len();
                        let (quads, sums) = (&scratch.quads, &mut sums.segments[image * segments..][..segments]);
                        canvas.compare_segments(simd, quads, planes, (sums, besides == Besides::SegmentEdges))
                    }
                    _ => scratch.canvas.compare(simd, &scratch.quads, planes),
                };
            }
        }
    }
}
