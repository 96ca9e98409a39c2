//! Canny's thinned gradients: the first half of the twin of [`crate::features::edges::EdgeDetector`] with that operator; the other
//! is [`super::ComponentsStages`].

use anyhow::Result;

use super::generated::canny_comp;
use super::{Picture, magnitude, record_views, rows};
use crate::features::EdgeSettings;
use crate::features::device::{DeviceView, Plane};
use crate::gpu::{ComputeStage, Device, Recorder, Stage};

/// The stage.
#[derive(Debug)]
pub(in crate::features) struct CannyStage {
    stage: ComputeStage,
    low: i32,
    threshold: i32,
}

impl CannyStage {
    /// Compiles it.
    pub(in crate::features) fn new(device: &Device, settings: &EdgeSettings) -> Result<Self> {
        let constants = [(canny_comp::constants::MAGNITUDE, magnitude(settings.magnitude))];
        let stage = Stage { shader: &canny_comp::SHADER, constants: &constants };
        Ok(Self {
            stage: ComputeStage::new(device, "canny", stage)?,
            low: i32::from(settings.low),
            threshold: i32::from(settings.threshold),
        })
    }

    /// Records it: `smoothed`, where the near plane is set, to those of at least `low` and those of at least `threshold`.
    pub(in crate::features) fn record(
        &self,
        recorder: &mut Recorder,
        views: &[&DeviceView],
        [weak, strong]: [Plane; 2],
    ) -> Result<()> {
        record_views(recorder, &self.stage, views, |view| {
            let bindings = canny_comp::Bindings {
                smoothed: &view.smoothed,
                near: view.plane(Plane::Near),
                weak: view.plane(weak),
                strong: view.plane(strong),
            };
            let push = Picture { amount: self.threshold, low: self.low, ..view.picture };
            (bindings.bound(), push, rows(&view.picture))
        })
    }
}
