//! What differs from a plate: the twin of [`crate::features::plate::Plate`].

use anyhow::Result;

use super::generated::{difference_comp, layout};
use super::{record_views, rows};
use crate::features::device::{DeviceView, Plane};
use crate::features::{PlateSettings, ShadowSettings};
use crate::gpu::{ComputeStage, Device, Recorder, Stage};

/// The stage.
#[derive(Debug)]
pub(in crate::features) struct DifferenceStage {
    stage: ComputeStage,
}

impl DifferenceStage {
    /// Compiles it.
    pub(in crate::features) fn new(device: &Device) -> Result<Self> {
        let stage = Stage { shader: &difference_comp::SHADER, constants: &[] };
        Ok(Self { stage: ComputeStage::new(device, "difference", stage)? })
    }

    /// Records it for views with a plate: `colours` against the plate in the light's `gains` to three planes.
    pub(in crate::features) fn record(
        &self,
        recorder: &mut Recorder,
        views: &[&DeviceView],
        settings: &PlateSettings,
        shadow: &ShadowSettings,
    ) -> Result<()> {
        record_views(recorder, &self.stage, views, |view| {
            let bindings = difference_comp::Bindings {
                colours: &view.colours,
                // A view without a plate is not asked for its differences; its own colours would be none.
                plate: view.plate().unwrap_or(&view.colours),
                gains: &view.light.gains,
                weak: view.plane(Plane::Foreground),
                strong: view.plane(Plane::Strong),
                faint: view.plane(Plane::Faint),
            };
            let push = layout::Difference {
                width: view.picture.width,
                stride: view.picture.stride,
                weak_squared: settings.weak * settings.weak,
                strong_squared: settings.strong * settings.strong,
                faint_squared: settings.faint * settings.faint,
                suppress: u32::from(shadow.suppress),
                darkest: shadow.darkest,
                brightest: shadow.brightest,
                chroma_squared: shadow.chroma * shadow.chroma,
            };
            (bindings.bound(), push, rows(&view.picture))
        })
    }
}
