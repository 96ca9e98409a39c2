//! From pictures to packed observations on a Vulkan device: all views of a frame in one submission.

mod bounds;
mod components;
mod edges;
mod foreground;
mod morphology;
mod passes;
#[cfg(test)]
mod tests;
#[cfg(test)]
mod twin_tests;
mod view;

use anyhow::Result;
use image::{GrayImage, RgbImage};

use self::bounds::region;
use self::passes::{record_frame, record_priming};
use self::view::DeviceView;
use super::shaders::layout::Rates;
use super::{FeatureSettings, Region, ViewFeatures};
use crate::gpu::{Buffer, Device, Memory, PassTiming, Recording, Timing};

/// Everything from the pictures to the packed bytes of all views. What mixtures have learnt stays on the device.
#[derive(Debug)]
pub(super) struct DeviceChain {
    device: Device,
    settings: FeatureSettings,
    /// The 7-bit value of every code of a distance map.
    proximity: Buffer,
    views: Vec<DeviceView>,
    timing: Timing,
    /// The recording of a frame, and which views it expects masks for.
    frame: Option<(Vec<bool>, Recording)>,
    /// The recording of a frame that is only learnt from.
    priming: Option<Recording>,
    /// How many frames each view's mixture has seen.
    seen: Vec<u32>,
    codes: Vec<u32>,
}

impl DeviceChain {
    /// Makes what views of these sizes and plates need; `proximity` is the table of the settings.
    ///
    /// # Errors
    /// When a view is larger than the device binds at once, or it has no memory for the views.
    pub(super) fn new<'a>(
        device: &Device,
        views: impl Iterator<Item = ([u32; 2], Option<&'a RgbImage>)>,
        settings: &FeatureSettings,
        proximity: &[u8],
    ) -> Result<Self> {
        let limit = settings.proximity.limit();
        let views = views
            .map(|(size, plate)| DeviceView::new(device, size, plate, &settings.mixture, limit))
            .collect::<Result<Vec<_>>>()?;
        let seen = vec![0; views.len()];
        let table = device.buffer::<u32>("proximity table", proximity.len().div_ceil(4), Memory::Upload)?;
        table.write(0, proximity)?;
        let mut chain = Self {
            device: device.clone(),
            settings: settings.clone(),
            proximity: table,
            views,
            timing: Timing::Off,
            frame: None,
            priming: None,
            seen,
            codes: Vec::new(),
        };
        // Compiles every stage, for a first frame in time.
        chain.record(vec![false; chain.views.len()])?;
        Ok(chain)
    }

    /// Records a frame in which these views have masks.
    fn record(&mut self, masked: Vec<bool>) -> Result<()> {
        let mut recorder = self.device.recorder(self.timing)?;
        record_frame(&mut recorder, &self.views, &masked, &self.settings, &self.proximity)?;
        self.frame = Some((masked, recorder.finish()?));
        Ok(())
    }

    /// From the next frame on every pass is timed.
    pub(super) fn measure_passes(&mut self) {
        (self.timing, self.frame) = (Timing::Stamps, None);
    }

    /// The passes of the last frame; empty where they were not timed.
    ///
    /// # Errors
    /// When the device fails.
    pub(super) fn passes(&self) -> Result<Vec<PassTiming>> {
        self.frame.as_ref().map_or(Ok(Vec::new()), |(_, recording)| recording.timings())
    }

    /// Learns from a frame of the empty scene; one submission and one wait.
    ///
    /// # Errors
    /// When the device fails.
    pub(super) fn prime(&mut self, pictures: &[RgbImage]) -> Result<()> {
        let learning: Vec<usize> = (0..self.views.len()).filter(|&at| self.views[at].plate().is_none()).collect();
        if learning.is_empty() {
            return Ok(());
        }
        for &at in &learning {
            self.views[at].colours.staging.write(0, pictures[at].as_raw().as_slice())?;
            self.set_rates(at)?;
        }
        if self.priming.is_none() {
            let views: Vec<_> = learning.iter().map(|&at| &self.views[at]).collect();
            let mut recorder = self.device.recorder(Timing::Off)?;
            record_priming(&mut recorder, &views, &self.settings)?;
            self.priming = Some(recorder.finish()?);
        }
        self.priming.as_mut().map_or(Ok(()), Recording::run)
    }

    /// The features of a frame; one submission and one wait. Which views have masks is recorded, so that frames which take turns
    /// with and without cost a recording each.
    ///
    /// # Errors
    /// When the device fails.
    pub(super) fn run(
        &mut self,
        pictures: &[RgbImage],
        masks: &[Option<GrayImage>],
        features: &mut [ViewFeatures],
    ) -> Result<()> {
        for (at, (mask, features)) in masks.iter().zip(features.iter_mut()).enumerate() {
            let view = &self.views[at];
            view.colours.staging.write(0, pictures[at].as_raw().as_slice())?;
            if let Some(mask) = mask {
                features.foreground.copy_from_gray(mask);
                features.silhouette.copy_from(&features.foreground);
                view.mask_in.write(0, features.silhouette.words())?;
            } else if view.plate().is_none() {
                self.set_rates(at)?;
            }
        }
        let masked: Vec<bool> = masks.iter().map(Option::is_some).collect();
        if self.frame.as_ref().is_none_or(|(recorded, _)| *recorded != masked) {
            self.record(masked)?;
        }
        if let Some((_, recording)) = &mut self.frame {
            recording.run()?;
        }
        for (at, (mask, features)) in masks.iter().zip(features).enumerate() {
            self.read(at, mask.is_some(), features)?;
        }
        Ok(())
    }

    /// Tells a view's mixture the rates of its next step.
    fn set_rates(&mut self, at: usize) -> Result<()> {
        let (rates, seen) = (&self.views[at].rates, &mut self.seen[at]);
        let alpha = self.settings.mixture.rate(*seen);
        rates.write(0, &[Rates { alpha, first: u32::from(*seen == 0) }])?;
        *seen = seen.saturating_add(1);
        Ok(())
    }

    /// Takes what the device made of a view.
    fn read(&mut self, at: usize, is_masked: bool, features: &mut ViewFeatures) -> Result<()> {
        let view = &self.views[at];
        let (width, height) = (view.picture.width, view.picture.height);
        if !is_masked {
            view.foreground_out.read(0, features.foreground.words_mut())?;
            view.silhouette_out.read(0, features.silhouette.words_mut())?;
        }
        let mut sides = [0; 4];
        view.sides_out.read(0, &mut sides)?;
        features.region = region(sides, width, height).map_or(Region::whole(width, height), |bounds| {
            bounds.enlarged(self.settings.silhouette.motion, width, height)
        });
        view.edges_out.read(0, features.edges.words_mut())?;
        let pixels = width as usize * height as usize;
        self.codes.resize(pixels, 0);
        view.codes_out.read(0, &mut self.codes)?;
        let (metric, limit) = (self.settings.distance.metric, self.settings.proximity.limit());
        features.distance.take_codes([width, height], metric, limit, &self.codes);
        let observation = &mut features.observation;
        (observation.width, observation.height) = (width, height);
        observation.bytes.resize(pixels, 0);
        view.packed_out.read(0, &mut observation.bytes)
    }
}
