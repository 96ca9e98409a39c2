//! The framebuffer against the observations, whole and segment by segment (SPEC A6, A9, docs/RASTER.md).

use anyhow::Result;

use super::framebuffer::Framebuffer;
use super::settings::{Gathering, Packing};
use crate::evaluate::device::scene::{DeviceScene, Share};
use crate::evaluate::device::workspace::Workspace;
use crate::evaluate::shaders::{
    LABELS, SHORT_CODES, compare_shared_segments_comp, compare_subgroup_segments_comp, compare_texels_segments_comp,
};
use crate::gpu::{Buffer, ComputeStage, Device, Groups, Recorder, Shader, Stage};

/// The stage.
#[derive(Debug)]
pub(crate) struct CompareSegmentsStage {
    stage: ComputeStage,
    /// Workgroups a tile, each of which takes every nth row.
    bands: u32,
}

/// What a framebuffer is compared with segment by segment.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ObservedSegments<'a> {
    /// Weights, the number of each label, observed areas.
    pub(crate) table: &'a Buffer,
    /// The number of every observed pixel, in the order of the model's packed bytes.
    pub(crate) numbers: &'a Buffer,
}

impl CompareSegmentsStage {
    /// Its name in timings.
    pub(crate) const NAME: &'static str = "compare segments";

    /// Compiles it for a number of segments, workgroups a tile, and the largest code that a packing writes: a label or a rank.
    pub(crate) fn new(
        device: &Device,
        gathering: Gathering,
        (packing, largest_code): (Packing, u32),
        segments: u32,
        bands: u32,
    ) -> Result<Self> {
        let shader: &Shader = match gathering {
            Gathering::Texels => &compare_texels_segments_comp::SHADER,
            Gathering::Subgroup => &compare_subgroup_segments_comp::SHADER,
            Gathering::Shared => &compare_shared_segments_comp::SHADER,
        };
        let codes = if largest_code < SHORT_CODES { SHORT_CODES } else { LABELS };
        let constants = &[(0, packing.edge_bit()), (1, codes), (2, segments)];
        Ok(Self { stage: ComputeStage::new(device, Self::NAME, Stage { shader, constants })?, bands })
    }

    /// Records it: the framebuffer and the observations to `workspace.sums` and, added to what is there, `segment_sums`.
    pub(crate) fn record(
        &self,
        recorder: &mut Recorder,
        (model, workspace): (&DeviceScene, &Workspace),
        framebuffer: &Framebuffer,
        observed: ObservedSegments<'_>,
        segment_sums: &Buffer,
        share: Share,
    ) -> Result<()> {
        let push: compare_texels_segments_comp::Push = model.batch(share);
        // All variants have the same bindings.
        let bindings = compare_texels_segments_comp::Bindings {
            placements: &framebuffer.placements,
            tiles: &framebuffer.tiles,
            cameras: &model.cameras,
            pixels: &model.pixels,
            all_sums: &workspace.sums,
            framebuffer: &framebuffer.words,
            table: observed.table,
            quads: &workspace.quads,
            segment_pixels: observed.numbers,
            all_segment_sums: segment_sums,
        };
        let groups = Groups::Count([share.candidates.div_ceil(4) * model.counts.views, self.bands, 1]);
        self.stage.record(recorder, &bindings.bound(), &push, groups)
    }
}
