//! Vertical distances to the nearest edge: the first half of a distance map.

use anyhow::Result;

use super::generated::reach_comp;
use super::{record_views, rows};
use crate::features::device::{DeviceView, Plane};
use crate::gpu::{ComputeStage, Device, Recorder, Stage};

/// The stage.
#[derive(Debug)]
pub(in crate::features) struct ReachStage {
    stage: ComputeStage,
}

impl ReachStage {
    /// Compiles it.
    pub(in crate::features) fn new(device: &Device) -> Result<Self> {
        let stage = Stage { shader: &reach_comp::SHADER, constants: &[] };
        Ok(Self { stage: ComputeStage::new(device, "reach", stage)? })
    }

    /// Records it: `edges` to `reach`.
    pub(in crate::features) fn record(&self, recorder: &mut Recorder, views: &[&DeviceView]) -> Result<()> {
        record_views(recorder, &self.stage, views, |view| {
            let bindings = reach_comp::Bindings { edges: view.plane(Plane::Edges), reach: &view.reach };
            (bindings.bound(), view.picture, rows(&view.picture))
        })
    }
}
