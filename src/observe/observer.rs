//! The frames of a sequence in order, and what is seen in them.

use std::ops::Range;
use std::sync::Arc;
use std::time::Duration;

use anyhow::{Context, Result, bail};

use crate::features::{
    BitImage, Extractor, FeatureSettings, HeldFrame, Likelihood, Observation, ViewFeatures, ViewSource,
};
use crate::gpu::Device;
use crate::sequence::{FrameReader, FrameSet, Sequence, View};

/// Reads frames and makes their features.
///
/// Views whose background is learnt are shown every frame before the range as the empty scene, and every frame in it: their
/// features depend on all of them, whichever are asked for.
pub struct Observer {
    reader: FrameReader,
    extractor: Extractor,
    first: usize,
    learns: bool,
    features: Vec<ViewFeatures>,
}

impl Observer {
    /// For the frames of `range`, of which those before `from` are not asked for.
    ///
    /// # Errors
    /// When the settings make no sense, a plate cannot be read, or decoders cannot be started.
    pub fn new(sequence: &Sequence, settings: FeatureSettings, range: Range<usize>, from: usize) -> Result<Self> {
        let learns = sequence.views.iter().any(View::learns_background);
        let extractor =
            Extractor::new(settings, view_sources(sequence)?).with_context(|| sequence.path.display().to_string())?;
        let reader = sequence.read_frames(if learns { 0 } else { from }..range.end)?;
        Ok(Self { reader, extractor, first: range.start, learns, features: Vec::new() })
    }

    /// The same with views that may take `timeout` for a picture.
    #[must_use]
    pub fn with_stall_timeout(mut self, timeout: Duration) -> Self {
        self.reader = self.reader.with_stall_timeout(timeout);
        self
    }

    /// Has a Vulkan device make the features; to be asked before the first frame.
    ///
    /// # Errors
    /// As [`Extractor::move_to`].
    pub fn move_to(&mut self, device: &Device) -> Result<()> {
        self.extractor.move_to(device)
    }

    /// Has a Vulkan device make the features and hold the observations; to be asked before the first frame. Frames then go through
    /// [`Self::begin`] and [`Self::finish`]. `is_timed` asks for the times of the device's passes.
    ///
    /// # Errors
    /// As [`Extractor::hold_on`].
    pub fn hold_on(&mut self, device: &Device, is_timed: bool) -> Result<()> {
        self.extractor.hold_on(device)?;
        if is_timed {
            self.extractor.measure_passes();
        }
        Ok(())
    }

    /// The next frame; `None` after the last.
    ///
    /// # Errors
    /// As [`FrameReader::next_frame`].
    pub fn read(&mut self) -> Result<Option<FrameSet>> {
        self.reader.next_frame()
    }

    /// What is seen in a frame that was read, one a view; `None` where it only shows the background or is not wanted. Every
    /// frame read has to go through here.
    ///
    /// # Errors
    /// As [`Extractor::extract_into`].
    pub fn features(&mut self, frame: &FrameSet, is_wanted: bool) -> Result<Option<&mut [ViewFeatures]>> {
        if self.is_background(frame)? {
            return Ok(None);
        }
        if is_wanted || self.learns {
            self.extractor.extract_into(&frame.pictures, &frame.masks, &mut self.features)?;
            self.extractor.ignore(&mut self.features, &ignored_pixels(frame))?;
        }
        Ok(is_wanted.then_some(self.features.as_mut_slice()))
    }
}

impl Observer {
    /// Takes a frame that was read for one that shows the background alone, if it is; whether it was. Every frame read has to go through
    /// here or through [`Self::features`].
    ///
    /// # Errors
    /// As [`Extractor::prime`].
    pub fn is_background(&mut self, frame: &FrameSet) -> Result<bool> {
        let is_background = frame.index < self.first;
        if is_background {
            self.extractor.prime(&frame.pictures)?;
        }
        Ok(is_background)
    }

    /// Waits for the memory of the next frame that stays on the device.
    ///
    /// # Errors
    /// As [`Extractor::reserve`].
    pub fn reserve(&mut self) -> Result<()> {
        self.extractor.reserve()
    }

    /// Begins the features of a frame that stays on the device.
    ///
    /// # Errors
    /// As [`Extractor::begin`].
    pub fn begin(&mut self, frame: &FrameSet) -> Result<()> {
        self.extractor.begin(&frame.pictures, &frame.masks, &ignored_pixels(frame))
    }

    /// The frame that was begun, when the device is done with it.
    ///
    /// # Errors
    /// As [`Extractor::finish`].
    pub fn finish(&mut self) -> Result<HeldFrame> {
        self.extractor.finish()
    }

    /// Whether backgrounds are learnt from every frame, wanted or not.
    pub fn learns(&self) -> bool {
        self.learns
    }
}

/// Checks that every background is given or can be learnt before the frames of `range`.
///
/// # Errors
/// When one must be learnt and no frame comes before `range` to learn it from.
pub fn check_background(sequence: &Sequence, range: &Range<usize>) -> Result<()> {
    if let Some(unknown) = sequence.unknown_background().filter(|_| range.start == 0) {
        bail!(
            "{unknown}, and no frame comes before frame 0 to learn the empty scene from: give it one of them, or start later with --frames"
        );
    }
    Ok(())
}

/// The pixels that a frame's views ignore.
fn ignored_pixels(frame: &FrameSet) -> Vec<Option<Arc<BitImage>>> {
    frame.ignored.iter().map(|mask| mask.as_ref().map(|mask| Arc::new(BitImage::of_gray(mask)))).collect()
}

/// Takes the observations out of features, whose other memory is used again.
pub fn take_observations(features: &mut [ViewFeatures]) -> Vec<Observation> {
    let take = |view: &mut ViewFeatures| std::mem::replace(&mut view.observation, Observation::empty(0, 0));
    features.iter_mut().map(take).collect()
}

/// Takes the likelihoods out of features; none where they were not asked for.
pub fn take_likelihoods(features: &mut [ViewFeatures]) -> Vec<Likelihood> {
    features.iter_mut().filter_map(|view| view.likelihood.take()).collect()
}

/// An extractor for each view by itself, which has seen the frames before `first` where its background is learnt.
///
/// # Errors
/// As [`Observer::new`]; when a frame cannot be read.
pub fn view_extractors(sequence: &Sequence, settings: &FeatureSettings, first: usize) -> Result<Vec<Extractor>> {
    let mut extractors = view_sources(sequence)?
        .into_iter()
        .map(|source| Extractor::new(settings.clone(), vec![source]))
        .collect::<Result<Vec<_>>>()
        .with_context(|| sequence.path.display().to_string())?;
    if sequence.views.iter().any(View::learns_background) {
        let mut reader = sequence.read_frames(0..first)?;
        while let Some(frame) = reader.next_frame()? {
            for (extractor, picture) in extractors.iter_mut().zip(&frame.pictures) {
                extractor.prime(std::slice::from_ref(picture))?;
            }
        }
    }
    Ok(extractors)
}

/// What the features must know of each view.
fn view_sources(sequence: &Sequence) -> Result<Vec<ViewSource>> {
    let sources = sequence.backgrounds()?.into_iter().zip(&sequence.sizes);
    Ok(sources.map(|(plate, &[width, height])| ViewSource { width, height, plate }).collect())
}
