//! From colour to grey, smoothed: the twin of the edge detector's first step.

use anyhow::Result;

use super::generated::smooth_comp;
use super::{record_views, rows};
use crate::features::device::DeviceView;
use crate::gpu::{ComputeStage, Device, Recorder, Stage};

/// The stage.
#[derive(Debug)]
pub(in crate::features) struct SmoothStage {
    stage: ComputeStage,
}

impl SmoothStage {
    /// Compiles it, to smooth or only to turn grey.
    pub(in crate::features) fn new(device: &Device, smooth: bool) -> Result<Self> {
        let constants = [(smooth_comp::constants::SMOOTH, u32::from(smooth))];
        let stage = Stage { shader: &smooth_comp::SHADER, constants: &constants };
        Ok(Self { stage: ComputeStage::new(device, "smooth", stage)? })
    }

    /// Records it: `colours` to `smoothed`.
    pub(in crate::features) fn record(&self, recorder: &mut Recorder, views: &[&DeviceView]) -> Result<()> {
        record_views(recorder, &self.stage, views, |view| {
            let bindings = smooth_comp::Bindings { colours: &view.colours, smoothed: &view.smoothed };
            (bindings.bound(), view.picture, rows(&view.picture))
        })
    }
}
