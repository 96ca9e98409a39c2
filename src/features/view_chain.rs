//! What the processor does to the pictures of one view: its silhouette, and the edges near it.

use anyhow::{Result, bail};
use image::{GrayImage, RgbImage};

use super::edges::EdgeDetector;
use super::foreground::Foreground;
use super::morphology::Morphology;
use super::{BitImage, FeatureSettings, ViewFeatures};
use crate::geometry::LARGEST_SIDE;

/// What the extractor must know of a view.
#[derive(Clone, Debug)]
pub struct ViewSource {
    /// Width of the working pictures, pixels.
    pub width: u32,
    /// Height of the working pictures, pixels.
    pub height: u32,
    /// A picture of the empty scene, of the same size.
    pub plate: Option<RgbImage>,
}

/// One view's stages, and their buffers.
pub(super) struct ViewChain {
    pub(super) width: u32,
    pub(super) height: u32,
    pub(super) foreground: Foreground,
    near: BitImage,
    morphology: Morphology,
    detector: EdgeDetector,
}

impl ViewChain {
    /// Of the view `at`.
    ///
    /// # Errors
    /// When it has no or too many pixels, or its plate is of another size.
    pub(super) fn new(at: usize, source: ViewSource, settings: &FeatureSettings) -> Result<Self> {
        let (width, height) = (source.width, source.height);
        if width == 0 || height == 0 || width > LARGEST_SIDE || height > LARGEST_SIDE {
            bail!("view {at} is {width} x {height} pixels, expected sides from 1 to {LARGEST_SIDE}");
        }
        if let Some(plate) = &source.plate {
            same_size("background plate", at, plate.dimensions(), (width, height))?;
        }
        Ok(Self {
            width,
            height,
            foreground: Foreground::new(width, height, source.plate, settings),
            near: BitImage::new(width, height),
            morphology: Morphology::default(),
            detector: EdgeDetector::default(),
        })
    }

    /// By its mask where there is one, else by what the background does not explain.
    pub(super) fn find_silhouette(
        &mut self,
        picture: &RgbImage,
        mask: Option<&GrayImage>,
        settings: &FeatureSettings,
        features: &mut ViewFeatures,
    ) {
        match mask {
            Some(mask) => {
                features.foreground.copy_from_gray(mask);
                features.silhouette.copy_from(&features.foreground);
            }
            None => {
                self.foreground.find(picture, settings, &mut features.foreground, &mut features.silhouette);
            }
        }
    }

    /// Near the silhouette, with their proximities.
    pub(super) fn find_edges(
        &mut self,
        picture: &RgbImage,
        settings: &FeatureSettings,
        proximity: &[u8],
        features: &mut ViewFeatures,
    ) {
        self.near.copy_from(&features.silhouette);
        self.morphology.dilate(&mut self.near, settings.dilation());
        self.detector.detect(picture, &self.near, &settings.edges, &mut features.edges);
        features.measure_edges(settings, proximity);
    }
}

/// Holds a picture of view `view` to its size.
///
/// # Errors
/// When it has another one.
pub(super) fn same_size(what: &str, view: usize, found: (u32, u32), expected: (u32, u32)) -> Result<()> {
    if found != expected {
        bail!(
            "the {what} of view {view} is {} x {} pixels, expected {} x {}",
            found.0,
            found.1,
            expected.0,
            expected.1
        );
    }
    Ok(())
}
