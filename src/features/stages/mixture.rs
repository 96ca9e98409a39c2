//! Mixtures of Gaussians that stay on the device: the twin of [`crate::features::mixture::Mixture`].

use anyhow::Result;

use super::generated::{self, RATIO_GRID, ROW_GROUP, layout, mixture_comp, probable_comp};
use super::record_views;
use crate::features::device::{DeviceView, Plane};
use crate::features::{Adaptation, MixtureSettings, ShadowSettings};
use crate::gpu::{ComputeStage, Device, Recorder, Stage};

/// The stages: the colours by which the light is measured, and the step.
#[derive(Debug)]
pub(in crate::features) struct MixtureStages {
    probable: ComputeStage,
    mixture: ComputeStage,
}

impl MixtureStages {
    /// Compiles them.
    pub(in crate::features) fn new(device: &Device, settings: &MixtureSettings) -> Result<Self> {
        let components = settings.components as u32;
        let adaptation = match settings.adaptation {
            Adaptation::Weight => generated::ADAPTATION_WEIGHT,
            Adaptation::Density => generated::ADAPTATION_DENSITY,
        };
        use mixture_comp::constants as id;
        let probable =
            Stage { shader: &probable_comp::SHADER, constants: &[(probable_comp::constants::COMPONENTS, components)] };
        let constants =
            [(id::COMPONENTS, components), (id::ADAPTATION, adaptation), (id::GAIN, u32::from(settings.gain))];
        let mixture = Stage { shader: &mixture_comp::SHADER, constants: &constants };
        Ok(Self {
            probable: ComputeStage::new(device, "probable", probable)?,
            mixture: ComputeStage::new(device, "mixture", mixture)?,
        })
    }

    /// Records the colours of the most probable components, on the light's `grid`.
    pub(in crate::features) fn record_probable(&self, recorder: &mut Recorder, views: &[&DeviceView]) -> Result<()> {
        for band in 0..most_bands(views) {
            record_views(recorder, &self.probable, &with_band(views, band), |view| {
                let band = &view.bands()[band];
                let bindings = probable_comp::Bindings { state: &band.state, background: &view.light.grid };
                let push = layout::Probable { width: view.picture.width, rows: band.rows, first_row: band.first_row };
                let columns = view.picture.width.div_ceil(RATIO_GRID);
                (bindings.bound(), push, [columns.div_ceil(ROW_GROUP), band.rows.div_ceil(RATIO_GRID), 1])
            })?;
        }
        Ok(())
    }

    /// Records the step: `colours` at the view's `rates` into its bands, what they do not explain to the foreground.
    pub(in crate::features) fn record(
        &self,
        recorder: &mut Recorder,
        views: &[&DeviceView],
        settings: &MixtureSettings,
        shadow: &ShadowSettings,
    ) -> Result<()> {
        for band in 0..most_bands(views) {
            record_views(recorder, &self.mixture, &with_band(views, band), |view| {
                let band = &view.bands()[band];
                let bindings = mixture_comp::Bindings {
                    colours: &view.colours,
                    gains: &view.light.gains,
                    rates: &view.rates,
                    state: &band.state,
                    foreground: view.plane(Plane::Foreground),
                };
                let push = layout::Mixture {
                    width: view.picture.width,
                    rows: band.rows,
                    first_row: band.first_row,
                    stride: view.picture.stride,
                    match_squared: settings.match_sigma * settings.match_sigma,
                    background_weight: settings.background_weight,
                    initial_variance: settings.initial_sigma * settings.initial_sigma,
                    initial_weight: settings.initial_weight,
                    least_variance: settings.min_sigma * settings.min_sigma,
                    suppress: u32::from(shadow.suppress),
                    darkest: shadow.darkest,
                    brightest: shadow.brightest,
                    chroma_squared: shadow.chroma * shadow.chroma,
                };
                (bindings.bound(), push, [push.width.div_ceil(ROW_GROUP), band.rows, 1])
            })?;
        }
        Ok(())
    }
}

fn most_bands(views: &[&DeviceView]) -> usize {
    views.iter().map(|view| view.bands().len()).max().unwrap_or(0)
}

fn with_band<'a>(views: &[&'a DeviceView], band: usize) -> Vec<&'a DeviceView> {
    views.iter().copied().filter(|view| band < view.bands().len()).collect()
}
