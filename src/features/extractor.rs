//! All stages in order: the pictures of one frame in, the features of every view out.

use std::sync::Arc;

use anyhow::{Result, anyhow, bail};
use image::{GrayImage, RgbImage};
use rayon::prelude::*;

use super::device::DeviceChain;
use super::edges::EdgeDetector;
use super::foreground::Foreground;
use super::likelihood::LikelySilhouette;
use super::morphology::Morphology;
use super::segment::Segmenter;
use super::{BitImage, FeatureSettings, ForegroundKind, HeldFrame, ViewFeatures, ignoring};
use crate::geometry::LARGEST_SIDE;
use crate::gpu::{Device, PassTiming};

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

struct View {
    width: u32,
    height: u32,
    foreground: Foreground,
    near: BitImage,
    morphology: Morphology,
    detector: EdgeDetector,
}

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
    Processor(Vec<View>),
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
            .map(|(at, source)| View::new(at, source, &settings))
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

fn same_size(what: &str, view: usize, found: (u32, u32), expected: (u32, u32)) -> Result<()> {
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

impl View {
    fn new(at: usize, source: ViewSource, settings: &FeatureSettings) -> Result<Self> {
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

    fn find_silhouette(
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

    fn find_edges(
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

#[cfg(test)]
mod tests {
    use super::super::{Observation, Region};
    use super::*;
    use image::{Luma, Rgb};

    fn room(width: u32, height: u32) -> RgbImage {
        RgbImage::from_fn(width, height, |x, y| Rgb([(90 + x % 40) as u8, (110 + y % 30) as u8, 100]))
    }

    fn person(x: u32, y: u32) -> bool {
        (30..46).contains(&x) && (10..50).contains(&y)
    }

    fn picture(width: u32, height: u32) -> RgbImage {
        let mut picture = room(width, height);
        for (x, y, pixel) in picture.enumerate_pixels_mut() {
            if person(x, y) {
                *pixel = Rgb([250, 150, 120]);
            } else if (46..60).contains(&x) && (48..52).contains(&y) {
                // A shadow on the floor.
                *pixel = Rgb(pixel.0.map(|v| (f32::from(v) * 0.75) as u8));
            } else if (x, y) == (5, 5) {
                // A speck.
                *pixel = Rgb([255; 3]);
            }
        }
        picture
    }

    fn source(plate: bool) -> ViewSource {
        ViewSource { width: 90, height: 60, plate: plate.then(|| room(90, 60)) }
    }

    fn settings() -> FeatureSettings {
        let mut settings = FeatureSettings::default();
        // A square element keeps the test's square person's corners.
        settings.silhouette.element = super::super::Shape::Square;
        settings
    }

    #[test]
    fn plate_mixture_and_mask_give_the_same_silhouette() {
        let mut extractor = Extractor::new(settings(), vec![source(true), source(false), source(false)]).unwrap();
        for _ in 0..20 {
            extractor.prime(&[room(90, 60), room(90, 60), room(90, 60)]).unwrap();
        }
        let mask = GrayImage::from_fn(90, 60, |x, y| Luma([if person(x, y) { 200 } else { 90 }]));
        let pictures = [picture(90, 60), picture(90, 60), picture(90, 60)];
        let mut features = extractor.extract(&pictures, &[None, None, Some(mask)]).unwrap();
        let expected = BitImage::from_fn(90, 60, person);
        for (view, features) in features.iter().enumerate() {
            assert_eq!(features.silhouette, expected, "view {view}");
            assert_eq!(features.region, Region { x0: 14, y0: 0, x1: 62, y1: 60 });
            assert_eq!(features.observation.silhouette(), expected);
            assert_eq!(features.observation.proximity().get_pixel(30, 30), &Luma([127]), "on the outline");
            assert_eq!(features.observation.proximity().get_pixel(85, 30), &Luma([0]), "far away");
            assert!(features.edges.get(30, 30) && !features.edges.get(38, 30) && !features.edges.get(5, 5));
        }
        // A pixel more in the mask must show.
        let changed =
            GrayImage::from_fn(90, 60, |x, y| Luma([if person(x, y) || x == 46 && y == 20 { 128 } else { 0 }]));
        extractor.extract_into(&pictures, &[None, None, Some(changed)], &mut features).unwrap();
        assert_eq!(features[0].silhouette, expected);
        assert_ne!(features[2].silhouette, expected);
        assert_eq!(features[2].observation.area(), expected.count() + 1);
    }

    #[test]
    fn buffers_of_another_frame_leave_no_trace() {
        let mut extractor = Extractor::new(settings(), vec![source(true), source(true)]).unwrap();
        let pictures = [picture(90, 60), picture(90, 60)];
        let fresh = extractor.extract(&pictures, &[None, None]).unwrap();
        let mut used = vec![ViewFeatures::empty(3, 200), ViewFeatures::empty(90, 60), ViewFeatures::empty(1, 1)];
        extractor.extract_into(&[RgbImage::new(90, 60), room(90, 60)], &[None, None], &mut used).unwrap();
        extractor.extract_into(&pictures, &[None, None], &mut used).unwrap();
        assert_eq!(used.len(), 2);
        for (used, fresh) in used.iter().zip(&fresh) {
            assert_eq!(used.observation, fresh.observation);
            assert_eq!((&used.silhouette, used.region), (&fresh.silhouette, fresh.region));
        }
    }

    #[test]
    fn black_pictures_and_empty_scenes_are_nothing_to_see() {
        let black = RgbImage::new(90, 60);
        let source = ViewSource { plate: Some(black.clone()), ..source(true) };
        let mut extractor = Extractor::new(settings(), vec![source]).unwrap();
        let features = extractor.extract(&[black], &[None]).unwrap();
        assert_eq!(features[0].observation, Observation::empty(90, 60));
        assert_eq!(features[0].region, Region::whole(90, 60));
    }

    #[test]
    fn a_camera_that_is_off_sees_nobody() {
        let mut extractor = Extractor::new(settings(), vec![source(true), source(true)]).unwrap();
        let features = extractor.extract(&[RgbImage::new(90, 60), picture(90, 60)], &[None, None]).unwrap();
        assert!(features[0].foreground.count() > 5000, "what was found can still be looked at");
        assert_eq!(features[0].observation, Observation::empty(90, 60));
        assert_eq!(features[1].silhouette, BitImage::from_fn(90, 60, person));
        let mut everything = settings();
        everything.silhouette.max_cover = 1.0;
        let mut extractor = Extractor::new(everything, vec![source(true)]).unwrap();
        assert!(extractor.extract(&[RgbImage::new(90, 60)], &[None]).unwrap()[0].observation.area() > 5000);
    }

    #[test]
    fn a_picture_of_3840_by_2160_is_seen_whole() {
        let (width, height) = (3840, 2160);
        let body = |x: u32, y: u32| (3000..3400).contains(&x) && (400..2100).contains(&y);
        let mut seen = room(width, height);
        for (x, y, pixel) in seen.enumerate_pixels_mut() {
            if body(x, y) {
                *pixel = Rgb([250, 150, 120]);
            }
        }
        let mut settings = settings();
        settings.distance.metric = super::super::Metric::Euclidean;
        settings.proximity.d_max = 255;
        let source = ViewSource { width, height, plate: Some(room(width, height)) };
        let features = Extractor::new(settings, vec![source]).unwrap().extract(&[seen], &[None]).unwrap();
        assert_eq!(features[0].silhouette, BitImage::from_fn(width, height, body));
        let distances = features[0].distance.distances();
        let at = |x: u32, y: u32| distances[(y * width + x) as usize];
        // The outermost edge pixels lie one outside the body; the room has a few of its own beside it.
        assert_eq!((at(2999, 1000), at(2000, 1000)), (0.0, 255.0));
        assert!((at(2900, 1000) - 99.0).abs() < 4.0, "{}", at(2900, 1000));
        assert!((at(2979, 389) - 10_f32.hypot(20.0)).abs() < 4.0, "{}", at(2979, 389));
    }

    #[test]
    fn one_pixel_is_a_picture() {
        let source = ViewSource { width: 1, height: 1, plate: Some(RgbImage::new(1, 1)) };
        let mut extractor = Extractor::new(settings(), vec![source]).unwrap();
        let white = GrayImage::from_pixel(1, 1, Luma([255]));
        let features = extractor.extract(&[RgbImage::new(1, 1)], &[Some(white)]).unwrap();
        assert_eq!(features[0].observation.bytes, [0x80]);
    }

    /// Nothing is seen in ignored pixels, and no edge in them is near a pixel that counts.
    #[test]
    fn edges_of_what_is_ignored_are_near_nothing() {
        let mut extractor = Extractor::new(settings(), vec![source(true)]).unwrap();
        let mut features = extractor.extract(&[picture(90, 60)], &[None]).unwrap();
        let all = features[0].clone();
        assert!(all.edges.get(46, 20) || all.edges.get(45, 20), "an edge on the right side");
        let ignored = Arc::new(BitImage::from_fn(90, 60, |x, _| (40..50).contains(&x)));
        extractor.ignore(&mut features, &[Some(Arc::clone(&ignored))]).unwrap();
        let found = &features[0];
        assert_eq!(found.observation.area(), all.silhouette.count() - 6 * 40);
        assert_eq!(found.region.x1, 40 + settings().silhouette.motion);
        let mut edges = all.edges.clone();
        edges.and_not(&ignored);
        let mut distance = super::super::DistanceMap::default();
        distance.measure(&edges, settings().distance.metric, settings().proximity.limit());
        assert_eq!(found.distance.distances(), distance.distances());
        // Right of what is ignored it was near an edge before.
        let near = |features: &ViewFeatures| features.observation.bytes[20 * 90 + 50] & Observation::PROXIMITY;
        assert!(near(&all) > 90 && near(found) < 50, "{} and {}", near(&all), near(found));
        assert_eq!(found.observation.ignored.as_deref(), Some(&*ignored));
        // The next frame begins anew.
        extractor.extract_into(&[picture(90, 60)], &[None], &mut features).unwrap();
        assert_eq!(features[0].observation, all.observation);
        let error = extractor.ignore(&mut features, &[]).unwrap_err().to_string();
        assert!(error.contains("1 views were given 0 masks"), "{error}");
        let error = extractor.ignore(&mut features, &[Some(Arc::new(BitImage::new(60, 90)))]).unwrap_err().to_string();
        assert!(error.contains("60 x 90") && error.contains("90 x 60"), "{error}");
    }

    #[test]
    fn bad_inputs_are_clear_sentences() {
        let wrong = |settings: FeatureSettings, views: Vec<ViewSource>| {
            format!("{:#}", Extractor::new(settings, views).err().unwrap())
        };
        assert!(wrong(settings(), vec![]).contains("at least one view"));
        let empty = ViewSource { width: 0, height: 60, plate: None };
        assert!(wrong(settings(), vec![source(true), empty]).contains("view 1 is 0 x 60"));
        let huge = ViewSource { width: u32::MAX, height: u32::MAX, plate: None };
        assert!(wrong(settings(), vec![huge]).contains("16384"));
        let plate = ViewSource { plate: Some(room(91, 60)), ..source(true) };
        assert!(wrong(settings(), vec![plate]).contains("plate of view 0 is 91 x 60 pixels, expected 90 x 60"));
        let mut k = settings();
        k.mixture.components = 7;
        assert!(wrong(k, vec![source(true)]).contains("mixture.components is 7"));

        let mut extractor = Extractor::new(settings(), vec![source(true), source(false)]).unwrap();
        let good = room(90, 60);
        let mut failed = |pictures: &[RgbImage], masks: &[Option<GrayImage>]| {
            format!("{:#}", extractor.extract(pictures, masks).unwrap_err())
        };
        assert!(failed(std::slice::from_ref(&good), &[None, None]).contains("1 pictures"));
        assert!(failed(&[good.clone(), good.clone()], &[None]).contains("1 masks"));
        let error = failed(&[good.clone(), room(60, 90)], &[None, None]);
        assert!(error.contains("picture of view 1 is 60 x 90 pixels, expected 90 x 60"), "{error}");
        let error = failed(&[good.clone(), good.clone()], &[Some(GrayImage::new(0, 0)), None]);
        assert!(error.contains("mask of view 0 is 0 x 0"), "{error}");
        assert!(extractor.prime(&[good]).is_err());
    }
}
