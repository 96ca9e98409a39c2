//! How much brighter a picture is than its background, channel by channel: the twin of the ratios of `features::light`.

use anyhow::Result;

use super::generated::{RATIO_GRID, ROW_GROUP, gain_comp, layout, ratios_comp};
use super::{flat_groups, record_views};
use crate::features::device::DeviceView;
use crate::gpu::{ComputeStage, Device, Recorder, Stage};

/// Pixels of the grid that an invocation counts.
const PIXELS_EACH: u32 = 16;

/// The stages: ratios counted, then their median.
#[derive(Debug)]
pub(in crate::features) struct RatiosStages {
    ratios: ComputeStage,
    gain: ComputeStage,
}

impl RatiosStages {
    /// Compiles them.
    pub(in crate::features) fn new(device: &Device) -> Result<Self> {
        let ratios = Stage { shader: &ratios_comp::SHADER, constants: &[] };
        let gain = Stage { shader: &gain_comp::SHADER, constants: &[] };
        Ok(Self {
            ratios: ComputeStage::new(device, "ratios", ratios)?,
            gain: ComputeStage::new(device, "gain", gain)?,
        })
    }

    /// Records them: `colours` against the light's `grid` to its `gains`.
    pub(in crate::features) fn record(&self, recorder: &mut Recorder, views: &[&DeviceView]) -> Result<()> {
        for view in views {
            recorder.fill("ratios", &view.light.counts, 0)?;
        }
        record_views(recorder, &self.ratios, views, |view| {
            let light = &view.light;
            let bindings =
                ratios_comp::Bindings { colours: &view.colours, background: &light.grid, counts: &light.counts };
            let (width, height) = (view.picture.width, view.picture.height);
            let pixels = width.div_ceil(RATIO_GRID) * height.div_ceil(RATIO_GRID);
            let lanes = pixels.div_ceil(PIXELS_EACH * ROW_GROUP) * ROW_GROUP;
            (bindings.bound(), layout::Ratios { width, height }, flat_groups(lanes))
        })?;
        record_views(recorder, &self.gain, views, |view| {
            let bindings = gain_comp::Bindings { counts: &view.light.counts, gains: &view.light.gains };
            (bindings.bound(), (), [1; 3])
        })
    }
}
