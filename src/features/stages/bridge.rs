//! What a closing adds to a silhouette where the picture differs faintly from the plate.

use anyhow::Result;

use super::generated::{bridge_comp, layout};
use super::{flat_groups, record_views};
use crate::features::device::{DeviceView, Plane};
use crate::gpu::{ComputeStage, Device, Recorder, Stage};

/// The stage.
#[derive(Debug)]
pub(in crate::features) struct BridgeStage {
    stage: ComputeStage,
}

impl BridgeStage {
    /// Compiles it.
    pub(in crate::features) fn new(device: &Device) -> Result<Self> {
        let stage = Stage { shader: &bridge_comp::SHADER, constants: &[] };
        Ok(Self { stage: ComputeStage::new(device, "bridge", stage)? })
    }

    /// Records it: a silhouette and its closing to another plane.
    pub(in crate::features) fn record(
        &self,
        recorder: &mut Recorder,
        views: &[&DeviceView],
        [from, closed, to]: [Plane; 3],
    ) -> Result<()> {
        record_views(recorder, &self.stage, views, |view| {
            let bindings = bridge_comp::Bindings {
                before: view.plane(from),
                closed: view.plane(closed),
                faint: view.plane(Plane::Faint),
                after: view.plane(to),
            };
            (bindings.bound(), layout::Bridge { words: view.words() }, flat_groups(view.words()))
        })
    }
}
