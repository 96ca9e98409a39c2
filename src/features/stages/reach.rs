//! Vertical distances to the nearest edge: the first half of a distance map.

use anyhow::Result;

use super::generated::reach_comp;
use super::{record_views, rows};
use crate::features::device::DeviceView;
use crate::gpu::{Device, Pipeline, Recorder, Stage};

/// The stage.
#[derive(Debug)]
pub(in crate::features) struct ReachStage {
    pipeline: Pipeline,
}

impl ReachStage {
    /// Compiles it.
    pub(in crate::features) fn new(device: &Device) -> Result<Self> {
        let stage = Stage { shader: &reach_comp::SHADER, constants: &[] };
        Ok(Self { pipeline: device.compute_pipeline(stage)? })
    }

    /// Records it: `edges` to `reach`.
    pub(in crate::features) fn record(&self, recorder: &mut Recorder, views: &[DeviceView]) -> Result<()> {
        record_views(recorder, "reach", &self.pipeline, views, |view| {
            let bindings = reach_comp::Bindings { edges: &view.edges, reach: &view.reach };
            (bindings.bound(), view.picture, rows(&view.picture))
        })
    }
}
