//! From silhouettes to packed observations on a Vulkan device: all views of a frame in one submission.

use anyhow::Result;
use image::RgbImage;

use super::stages::{DilateStage, DistanceStage, EdgesStage, PackStage, Picture, ReachStage, SmoothStage};
use super::{FeatureSettings, Metric, ViewFeatures};
use crate::gpu::{Buffer, Device, Memory, Recorder, Recording, Timing};

/// The buffers of one view.
#[derive(Debug)]
pub(super) struct DeviceView {
    /// What every pass on it is told.
    pub(super) picture: Picture,
    colours_in: Buffer,
    silhouette_in: Buffer,
    /// Red, green, blue bytes, row-major.
    pub(super) colours: Buffer,
    /// A bit picture.
    pub(super) silhouette: Buffer,
    /// The silhouette dilated.
    pub(super) near: Buffer,
    /// Grey values, a word each.
    pub(super) smoothed: Buffer,
    /// A bit picture.
    pub(super) edges: Buffer,
    /// Vertical distances, a word each.
    pub(super) reach: Buffer,
    /// Distances as [`Metric::code`] writes them, a word each.
    pub(super) codes: Buffer,
    /// Packed bytes, row-major.
    pub(super) packed: Buffer,
    edges_out: Buffer,
    codes_out: Buffer,
    packed_out: Buffer,
}

impl DeviceView {
    /// Buffers for pictures of that size.
    fn new(device: &Device, [width, height]: [u32; 2], limit: u8) -> Result<Self> {
        let (pixels, rows) = (width as usize * height as usize, height as usize);
        // As the words of a `BitImage`, whose rows are whole 64-bit words.
        let stride = 2 * width.div_ceil(64);
        let words = |name: &str, count: usize, memory: Memory| device.buffer::<u32>(name, count, memory);
        let colours = (3 * pixels).div_ceil(4);
        let bits = stride as usize * rows;
        Ok(Self {
            picture: Picture { width, height, stride, limit: u32::from(limit), amount: 0, square: 0 },
            colours_in: words("colours staging", colours, Memory::Upload)?,
            silhouette_in: words("silhouette staging", bits, Memory::Upload)?,
            colours: words("colours", colours, Memory::Device)?,
            silhouette: words("silhouette", bits, Memory::Device)?,
            near: words("near", bits, Memory::Device)?,
            smoothed: words("smoothed", pixels, Memory::Device)?,
            edges: words("edges", bits, Memory::Device)?,
            reach: words("reach", pixels, Memory::Device)?,
            codes: words("codes", pixels, Memory::Device)?,
            packed: words("packed", pixels.div_ceil(4), Memory::Device)?,
            edges_out: words("edges readback", bits, Memory::Readback)?,
            codes_out: words("codes readback", pixels, Memory::Readback)?,
            packed_out: words("packed readback", pixels.div_ceil(4), Memory::Readback)?,
        })
    }
}

/// Edges, distances and packing of all views, recorded once.
#[derive(Debug)]
pub(super) struct DeviceChain {
    views: Vec<DeviceView>,
    recording: Recording,
    metric: Metric,
    limit: u8,
    codes: Vec<u32>,
}

impl DeviceChain {
    /// Records the chain for views of these sizes; `proximity` is the table of the settings.
    ///
    /// # Errors
    /// When the edge operator is Canny's, or the device has no memory for the views.
    pub(super) fn new(
        device: &Device,
        sizes: &[[u32; 2]],
        settings: &FeatureSettings,
        proximity: &[u8],
    ) -> Result<Self> {
        let (metric, limit) = (settings.distance.metric, settings.proximity.limit());
        let views = sizes.iter().map(|&size| DeviceView::new(device, size, limit)).collect::<Result<Vec<_>>>()?;
        let mut recorder = device.recorder(Timing::Off)?;
        let whole = |recorder: &mut Recorder, name: &str, from: &Buffer, to: &Buffer| {
            recorder.copy(name, (from, 0), (to, 0), from.size())
        };
        for view in &views {
            whole(&mut recorder, "upload", &view.colours_in, &view.colours)?;
            whole(&mut recorder, "upload", &view.silhouette_in, &view.silhouette)?;
        }
        SmoothStage::new(device, settings.edges.smooth)?.record(&mut recorder, &views)?;
        DilateStage::new(device)?.record(&mut recorder, &views, settings.dilation())?;
        EdgesStage::new(device, &settings.edges)?.record(&mut recorder, &views)?;
        ReachStage::new(device)?.record(&mut recorder, &views)?;
        DistanceStage::new(device, metric)?.record(&mut recorder, &views)?;
        PackStage::new(device, proximity)?.record(&mut recorder, &views)?;
        for view in &views {
            whole(&mut recorder, "readback", &view.edges, &view.edges_out)?;
            whole(&mut recorder, "readback", &view.codes, &view.codes_out)?;
            whole(&mut recorder, "readback", &view.packed, &view.packed_out)?;
        }
        Ok(Self { views, recording: recorder.finish()?, metric, limit, codes: Vec::new() })
    }

    /// Fills in edges, distances and observations of features that have their silhouettes; one submission and one wait.
    ///
    /// # Errors
    /// When the device fails.
    pub(super) fn run(&mut self, pictures: &[RgbImage], features: &mut [ViewFeatures]) -> Result<()> {
        for ((view, picture), features) in self.views.iter().zip(pictures).zip(features.iter()) {
            view.colours_in.write(0, picture.as_raw().as_slice())?;
            view.silhouette_in.write(0, features.silhouette.words())?;
        }
        self.recording.run()?;
        for (view, features) in self.views.iter().zip(features) {
            view.edges_out.read(0, features.edges.words_mut())?;
            let pixels = view.picture.width as usize * view.picture.height as usize;
            self.codes.resize(pixels, 0);
            view.codes_out.read(0, &mut self.codes)?;
            features.distance.take_codes(
                [view.picture.width, view.picture.height],
                self.metric,
                self.limit,
                &self.codes,
            );
            let observation = &mut features.observation;
            (observation.width, observation.height) = (view.picture.width, view.picture.height);
            observation.bytes.resize(pixels, 0);
            view.packed_out.read(0, &mut observation.bytes)?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests;
