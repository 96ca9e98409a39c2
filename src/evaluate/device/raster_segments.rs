//! Drawing and comparison segment by segment (docs/RASTER.md, SPEC A6).

use anyhow::Result;

use super::scene::{DeviceScene, Share};
use super::workspace::Workspace;
use crate::evaluate::shaders::raster_segments_comp;
use crate::gpu::{Buffer, ComputeStage, Device, Groups, Recorder, Stage};

/// The stage.
#[derive(Debug)]
pub(crate) struct RasterSegmentsStage {
    stage: ComputeStage,
    /// Whether it takes the images of a list, not all of a batch.
    is_listed: bool,
}

impl RasterSegmentsStage {
    /// Its name in timings.
    pub(crate) const NAME: &'static str = "raster segments";

    /// Compiles it for all images of a batch, or for those of a list.
    pub(crate) fn new(device: &Device, is_listed: bool) -> Result<Self> {
        let shader = &raster_segments_comp::SHADER;
        let constants = &[(0, u32::from(is_listed))];
        Ok(Self { stage: ComputeStage::new(device, Self::NAME, Stage { shader, constants })?, is_listed })
    }

    /// Records it: `workspace.quads` and `bounds` and the observed segments to `workspace.sums` and `segment_sums`. `list` is as
    /// [`super::RasterStage::record_listed`] takes it; any buffer where all images are taken.
    pub(crate) fn record(
        &self,
        recorder: &mut Recorder,
        (model, workspace): (&DeviceScene, &Workspace),
        (table, planes): (&Buffer, &Buffer),
        segment_sums: &Buffer,
        list: &Buffer,
        share: Share,
    ) -> Result<()> {
        let push: raster_segments_comp::Push = model.batch(share);
        let bindings = raster_segments_comp::Bindings {
            cameras: &model.cameras,
            quads: &workspace.quads,
            all_bounds: &workspace.bounds,
            planes: &model.planes,
            list,
            all_sums: &workspace.sums,
            table,
            segment_planes: planes,
            all_segment_sums: segment_sums,
        };
        let groups = if self.is_listed {
            Groups::Indirect(list, 0)
        } else {
            Groups::Count([share.candidates * model.counts.views, 1, 1])
        };
        self.stage.record(recorder, &bindings.bound(), &push, groups)
    }
}
