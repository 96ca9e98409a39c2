//! All stages in order: the pictures of one frame in, the features of every view out.

use std::sync::Arc;

use anyhow::{Result, anyhow, bail};
use image::{GrayImage, RgbImage};
use rayon::prelude::*;

use super::device::DeviceChain;
use super::likelihood::LikelySilhouette;
use super::segment::Segmenter;
use super::view_chain::{ViewChain, ViewSource, same_size};
use super::{BitImage, FeatureSettings, ForegroundKind, HeldFrame, ViewFeatures, ignoring};
use crate::gpu::{Device, PassTiming};

/// The features of all views, frame after frame. Its buffers are made once.
///
/// A view's foreground is, in this order: the frame's mask, as it is; the difference from the plate; what a mixture of
/// Gaussians that learns from every frame without a mask does not explain. The mixture takes its first picture for
/// background whole and averages the first `mixture.warm_up` frames, so it must have seen the scene empty: show it such
/// frames first with [`Extractor::prime`]. A person who was there from the start is learnt as background.
pub struct Extractor {
    settings: FeatureSettings,
    segmenter: Option<Segmenter>,
    /// Makes the likelihoods of each view; empty where nobody asks for them.
    likely: Vec<LikelySilhouette>,
    /// Widths and heights of the views.
    sizes: Vec<(u32, u32)>,
    /// The proximity of each code of a distance map.
    proximity: Vec<u8>,
    chain: Chain,
}

/// Who does the work.
enum Chain {
    Processor(Vec<ViewChain>),
    Device(Box<DeviceChain>),
}

impl Extractor {
    /// Prepares for views of the given sizes and plates, in the order of the cameras.
    ///
    /// # Errors
    /// When a setting makes no sense, there is no view, a view has no or too many pixels, or a plate's size is not its
    /// view's.
    pub fn new(settings: FeatureSettings, views: Vec<ViewSource>) -> Result<Self> {
        settings.check()?;
        if views.is_empty() {
            bail!("features need at least one view, found none");
        }
        let sizes = views.iter().map(|view| (view.width, view.height)).collect();
        let plates = views.iter().filter(|_| settings.needs_likelihoods());
        let likely = plates.map(|view| LikelySilhouette::new(view.plate.clone())).collect();
        let views = views
            .into_iter()
            .enumerate()
            .map(|(at, source)| ViewChain::new(at, source, &settings))
            .collect::<Result<_>>()?;
        let proximity = settings.proximity.table(settings.distance.metric);
        let segmenter = Segmenter::new(&settings.segment)?;
        Ok(Self { settings, segmenter, likely, sizes, proximity, chain: Chain::Processor(views) })
    }

    /// As [`Self::new`] and [`Self::move_to`].
    ///
    /// # Errors
    /// Theirs.
    pub fn on_device(settings: FeatureSettings, views: Vec<ViewSource>, device: &Device) -> Result<Self> {
        let mut extractor = Self::new(settings, views)?;
        extractor.move_to(device)?;
        Ok(extractor)
    }

    /// Leaves everything from the pictures to the packed bytes to a Vulkan device, which gives the same features bit by bit (but
    /// see docs/FEATURES.md on `mixture.adaptation = "density"`); body parts are still told apart by the processor, and likelihoods
    /// are made by it. What was learnt so far is forgotten. Where likelihoods need what a mixture learns, nothing is moved.
    ///
    /// # Errors
    /// When the device fails, has no memory for the views, or cannot bind buffers of their size; the extractor is then as it was.
    pub fn move_to(&mut self, device: &Device) -> Result<()> {
        if self.likely.iter().any(LikelySilhouette::learns) {
            return Ok(());
        }
        self.leave_to(device)
    }

    fn leave_to(&mut self, device: &Device) -> Result<()> {
        if let Chain::Processor(views) = &self.chain {
            let views = views.iter().map(|view| ([view.width, view.height], view.foreground.plate()));
            let chain = DeviceChain::new(device, views, &self.settings, &self.proximity)?;
            self.chain = Chain::Device(Box::new(chain));
        }
        Ok(())
    }

    /// As [`Self::move_to`]; from now on frames are made by [`Self::begin`] and [`Self::finish`], and stay there. Their passes go in beside
    /// those of others ([`Device::beside`]).
    ///
    /// # Errors
    /// As there; also when the settings ask for what the processor finds ([`FeatureSettings::kept_from_device`]).
    pub fn hold_on(&mut self, device: &Device) -> Result<()> {
        if let Some(why) = self.settings.kept_from_device() {
            bail!("observations cannot stay on a device, since {why}");
        }
        self.leave_to(&device.beside())?;
        let known: Vec<_> = self.likely.iter().map(LikelySilhouette::known).collect();
        match &mut self.chain {
            Chain::Device(device) => device.hold(&known),
            Chain::Processor(_) => Err(on_processor()),
        }
    }

    /// Waits for the memory of a frame that stays on the device: one of two, which the frames before have until they are dropped.
    ///
    /// # Errors
    /// Without [`Self::hold_on`].
    pub fn reserve(&mut self) -> Result<()> {
        self.held()?.reserve()
    }

    /// Begins the features of a frame that stays on the device, in the memory of [`Self::reserve`], and returns while the device is at
    /// work. Pixels that are `ignored` count neither for nor against anybody. For likelihoods the processor measures the picture's light, where
    /// a background is learnt after a wait for what the device knows of it.
    ///
    /// # Errors
    /// As [`Self::extract`] and [`Self::ignore`]; also without [`Self::hold_on`], or when the frame before was not finished.
    pub fn begin(
        &mut self,
        pictures: &[RgbImage],
        masks: &[Option<GrayImage>],
        ignored: &[Option<Arc<BitImage>>],
    ) -> Result<()> {
        self.check_frame(pictures, Some(masks))?;
        ignoring::check(ignored, &self.sizes)?;
        let Self { settings, likely, chain, .. } = self;
        let lit = |learnt: &[Option<RgbImage>]| {
            let views = likely.par_iter().zip(pictures).zip(masks).zip(learnt);
            let of_view = |(((likely, picture), mask), learnt): (((&LikelySilhouette, _), &Option<_>), &Option<_>)| {
                if mask.is_some() { None } else { likely.lit(picture, learnt.as_ref(), settings) }
            };
            views.map(of_view).collect()
        };
        match chain {
            Chain::Device(device) => device.begin(pictures, masks, ignored, lit),
            Chain::Processor(_) => Err(on_processor()),
        }
    }

    /// The frame that was begun, when the device is done with it.
    ///
    /// # Errors
    /// When none was begun, or the device fails.
    pub fn finish(&mut self) -> Result<HeldFrame> {
        self.held()?.finish()
    }

    fn held(&mut self) -> Result<&mut DeviceChain> {
        match &mut self.chain {
            Chain::Device(device) => Ok(device),
            Chain::Processor(_) => Err(on_processor()),
        }
    }

    /// From the next frame on the device's passes are timed, where there is a device with timestamps.
    pub fn measure_passes(&mut self) {
        if let Chain::Device(device) = &mut self.chain {
            device.measure_passes();
        }
    }

    /// The device's passes of the last frame; empty where they were not timed.
    ///
    /// # Errors
    /// When the device fails.
    pub fn passes(&self) -> Result<Vec<PassTiming>> {
        match &self.chain {
            Chain::Processor(_) => Ok(Vec::new()),
            Chain::Device(device) => device.passes(),
        }
    }

    /// The settings in use.
    pub fn settings(&self) -> &FeatureSettings {
        &self.settings
    }

    /// Shows one frame of the empty scene to the background models that learn; views with a plate need none.
    ///
    /// # Errors
    /// When there are not as many pictures as views, or one's size is not its view's.
    pub fn prime(&mut self, pictures: &[RgbImage]) -> Result<()> {
        self.check_frame(pictures, None)?;
        let settings = &self.settings;
        match &mut self.chain {
            Chain::Processor(views) => views.par_iter_mut().zip(pictures).for_each(|(view, picture)| {
                view.foreground.learn(picture, settings);
            }),
            Chain::Device(device) => device.prime(pictures)?,
        }
        Ok(())
    }

    /// The features of one frame; `masks[v]`, where there is one, replaces view `v`'s segmentation (pixels of 128 or
    /// brighter are the person).
    ///
    /// # Errors
    /// When there are not as many pictures or masks as views, or one's size is not its view's.
    pub fn extract(&mut self, pictures: &[RgbImage], masks: &[Option<GrayImage>]) -> Result<Vec<ViewFeatures>> {
        let mut features = Vec::new();
        self.extract_into(pictures, masks, &mut features)?;
        Ok(features)
    }

    /// As [`Self::extract`], into features of an earlier frame whose memory is used again.
    ///
    /// # Errors
    /// As [`Self::extract`].
    pub fn extract_into(
        &mut self,
        pictures: &[RgbImage],
        masks: &[Option<GrayImage>],
        features: &mut Vec<ViewFeatures>,
    ) -> Result<()> {
        self.check_frame(pictures, Some(masks))?;
        features.truncate(self.sizes.len());
        for (at, &(width, height)) in self.sizes.iter().enumerate() {
            match features.get(at) {
                Some(old) if (old.silhouette.width(), old.silhouette.height()) == (width, height) => {}
                Some(_) => features[at] = ViewFeatures::empty(width, height),
                None => features.push(ViewFeatures::empty(width, height)),
            }
        }
        features.iter_mut().for_each(|features| features.observation.ignored = None);
        let (settings, proximity) = (&self.settings, &self.proximity[..]);
        let is_likely = settings.foreground == ForegroundKind::Likelihood;
        match &mut self.chain {
            Chain::Processor(views) => {
                let mut likely: Vec<_> = self.likely.iter_mut().map(Some).collect();
                likely.resize_with(views.len(), || None);
                let inputs = views.par_iter_mut().zip(likely).zip(pictures).zip(masks);
                inputs.zip(features.par_iter_mut()).for_each(|((((view, likely), picture), mask), features)| {
                    let mask = mask.as_ref();
                    let is_likely = is_likely && mask.is_none();
                    if is_likely {
                        view.foreground.learn(picture, settings);
                    } else {
                        view.find_silhouette(picture, mask, settings, features);
                    }
                    if let Some(likely) = likely {
                        let learnt = view.foreground.learnt();
                        let likelihood = features.likelihood.get_or_insert_default();
                        likely.find(picture, mask, learnt.as_ref(), settings, likelihood);
                        if is_likely {
                            features.foreground.copy_from(likely.foreground());
                            features.silhouette.copy_from(likely.silhouette());
                        }
                    }
                    features.find_region(settings);
                    view.find_edges(picture, settings, proximity, features);
                });
            }
            Chain::Device(device) if self.likely.is_empty() => device.run(pictures, masks, features)?,
            Chain::Device(device) => {
                let views = self.likely.par_iter_mut().zip(pictures).zip(masks).zip(features.par_iter_mut());
                let found: Vec<_> = views
                    .map(|(((likely, picture), mask), features)| {
                        let likelihood = features.likelihood.get_or_insert_default();
                        likely.find(picture, mask.as_ref(), None, settings, likelihood);
                        mask.clone().or_else(|| is_likely.then(|| likely.silhouette().to_gray()))
                    })
                    .collect();
                device.run(pictures, &found, features)?;
                if is_likely {
                    for ((features, likely), mask) in features.iter_mut().zip(&self.likely).zip(masks) {
                        if mask.is_none() {
                            features.foreground.copy_from(likely.foreground());
                        }
                    }
                }
            }
        }
        if !settings.likelihoods {
            features.iter_mut().for_each(|features| features.likelihood = None);
        }
        let Some(segmenter) = &self.segmenter else {
            features.iter_mut().for_each(|features| features.observation.segmentation = None);
            return Ok(());
        };
        features.par_iter_mut().zip(pictures).try_for_each(|(features, picture)| {
            features.observation.segmentation = Some(segmenter.segment(picture, &features.silhouette)?);
            Ok(())
        })
    }

    /// Has pixels of a frame's features count neither for nor against a candidate, as [`super::Ignoring::apply`].
    ///
    /// # Errors
    /// As there.
    pub fn ignore(&self, features: &mut [ViewFeatures], ignored: &[Option<Arc<BitImage>>]) -> Result<()> {
        ignoring::apply(&self.settings, &self.proximity, features, ignored)
    }

    fn check_frame(&self, pictures: &[RgbImage], masks: Option<&[Option<GrayImage>]>) -> Result<()> {
        let views = self.sizes.len();
        if pictures.len() != views {
            bail!("a frame holds {} pictures, expected one for each of the {views} views", pictures.len());
        }
        if let Some(masks) = masks
            && masks.len() != views
        {
            bail!("a frame holds {} masks or gaps, expected one for each of the {views} views", masks.len());
        }
        for (at, &expected) in self.sizes.iter().enumerate() {
            same_size("picture", at, pictures[at].dimensions(), expected)?;
            if let Some(Some(mask)) = masks.map(|masks| &masks[at]) {
                same_size("mask", at, mask.dimensions(), expected)?;
            }
        }
        Ok(())
    }
}

fn on_processor() -> anyhow::Error {
    anyhow!("the processor makes the features, and no frame stays on a device")
}
