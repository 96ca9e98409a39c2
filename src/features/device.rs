//! From pictures to packed observations on a Vulkan device: all views of a frame in one submission.

mod bounds;
mod cleaning;
mod components;
mod edges;
mod foreground;
mod light_input;
mod likely;
#[cfg(test)]
mod likely_tests;
mod morphology;
mod passes;
mod readback;
#[cfg(test)]
mod tests;
#[cfg(test)]
mod twin_tests;
mod view;

use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::time::Instant;

use anyhow::{Context, Result, bail};
use image::{GrayImage, RgbImage};

use self::light_input::LightInput;
use self::likely::LikelyView;
use self::passes::{record_frame, record_learning, record_priming};
use self::readback::{FeaturesOut, SilhouetteOut, held_views};
use self::view::{Brings, DeviceView, Input};
use super::held::{HeldFrame, HeldLook, HeldView, Lease};
use super::likelihood::{BackgroundColours, Lit};
use super::shaders::layout::Rates;
use super::{BitImage, FeatureSettings, ViewFeatures};
use crate::gpu::{Buffer, Device, Memory, PassTiming, Recorder, Recording, Timing};

/// Everything from the pictures to the packed bytes of all views. What mixtures have learnt stays on the device.
#[derive(Debug)]
pub(super) struct DeviceChain {
    device: Device,
    settings: FeatureSettings,
    /// The 7-bit value of every code of a distance map.
    proximity: Buffer,
    views: Vec<DeviceView>,
    /// What likelihoods are made by in frames that stay; none where they are not made there.
    likely: Vec<LikelyView>,
    timing: Timing,
    /// Frames that go to the host whole.
    frames: Slot<FeaturesOut>,
    /// Frames that stay, which take turns; none before they are asked for.
    held: Option<Held>,
    /// The recording of a frame that is only learnt from.
    priming: Option<Recording>,
    /// How many frames each view's mixture has seen.
    seen: Vec<u32>,
    room: (Vec<u32>, Vec<u8>),
}

/// What a frame has of its own: where its pictures come from, where its packed observations go, what the host is given.
#[derive(Debug)]
struct Slot<Out> {
    inputs: Vec<Input>,
    packed: Vec<HeldView>,
    out: Vec<Out>,
    /// The recording of a frame, and what it expects views to bring.
    recorded: Option<(Vec<Brings>, Recording)>,
    /// What goes ahead of it where likelihoods are of backgrounds that are learnt; none where none is.
    learning: Option<(Vec<Brings>, Option<Recording>)>,
    /// What differs between the views of its frame, where likelihoods are made.
    looks: Vec<HeldLook>,
    ignored: Vec<Option<Arc<BitImage>>>,
}

impl<Out> Slot<Out> {
    fn new(
        device: &Device,
        views: &[DeviceView],
        motion: Option<u32>,
        out: impl Fn(&Device, &DeviceView) -> Result<Out>,
    ) -> Result<Self> {
        Ok(Self {
            inputs: views.iter().map(|view| Input::new(device, view)).collect::<Result<_>>()?,
            packed: held_views(device, views, motion)?,
            out: views.iter().map(|view| out(device, view)).collect::<Result<_>>()?,
            recorded: None,
            learning: None,
            looks: Vec::new(),
            ignored: vec![None; views.len()],
        })
    }
}

impl<Out> Slot<Out> {
    /// Has mixtures make their step where likelihoods need what they know; that is told, of views that learn.
    fn learn(
        &mut self,
        device: &Device,
        (views, likely): (&[DeviceView], &[LikelyView]),
        brings: &[Brings],
        settings: &FeatureSettings,
    ) -> Result<Vec<Option<RgbImage>>> {
        if self.learning.as_ref().is_none_or(|(recorded, _)| recorded != brings) {
            let mut recorder = device.recorder(Timing::Off)?;
            let learns = record_learning(&mut recorder, (views, likely), (&self.inputs, brings), settings)?;
            let recording = if learns { Some(recorder.finish()?) } else { None };
            self.learning = Some((brings.to_vec(), recording));
        }
        if let Some((_, Some(recording))) = &mut self.learning {
            recording.run()?;
        }
        let each = views.iter().zip(likely).zip(brings);
        let read = |((view, likely), brings): ((&DeviceView, &LikelyView), &Brings)| {
            likely.learnt().filter(|_| !brings.mask).map(|learnt| learnt.read(view)).transpose()
        };
        each.map(read).collect()
    }
}

/// Frames that the device holds: while one is searched the next is made in the other memory, from the other end of the uploads.
#[derive(Debug)]
struct Held {
    slots: [Slot<SilhouetteOut>; 2],
    /// Memories that no frame has.
    free: Receiver<usize>,
    given_back: Sender<usize>,
    /// Memory for the next frame.
    reserved: Option<Lease>,
    /// The frame that the device is at work with.
    begun: Option<Lease>,
}

impl Held {
    fn new(device: &Device, views: &[DeviceView], likely: &[LikelyView], motion: u32) -> Result<Self> {
        let slot = || -> Result<_> {
            let motion = (!likely.is_empty()).then_some(motion);
            let mut slot = Slot::new(device, views, motion, SilhouetteOut::new)?;
            for (input, _) in slot.inputs.iter_mut().zip(likely) {
                input.light = Some(LightInput::new(device)?);
            }
            Ok(slot)
        };
        let (given_back, free) = channel();
        (0..2).try_for_each(|place| given_back.send(place))?;
        Ok(Self { slots: [slot()?, slot()?], free, given_back, reserved: None, begun: None })
    }
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
            frames: Slot::new(device, &views, None, FeaturesOut::new)?,
            likely: Vec::new(),
            held: None,
            views,
            timing: Timing::Off,
            priming: None,
            seen,
            room: Default::default(),
        };
        // Compiles every stage, for a first frame in time.
        chain.record(&vec![Brings::default(); chain.views.len()])?;
        Ok(chain)
    }

    /// Has room for frames that stay on the device from now on, and makes their likelihoods where views of that are `known`, one each: the
    /// background's colours where there is a plate.
    ///
    /// # Errors
    /// When it has no memory for them.
    pub(super) fn hold(&mut self, known: &[Option<&BackgroundColours>]) -> Result<()> {
        let each = self.views.iter().zip(known);
        self.likely =
            each.map(|(view, colours)| LikelyView::new(&self.device, view, *colours)).collect::<Result<_>>()?;
        let motion = self.settings.silhouette.motion;
        self.held = Some(Held::new(&self.device, &self.views, &self.likely, motion)?);
        Ok(())
    }

    /// Records a frame in which views bring this, where that is not what is recorded.
    fn record(&mut self, brings: &[Brings]) -> Result<()> {
        let Self { device, views, timing, settings, proximity, frames, .. } = self;
        record_slot(frames, brings, (device, *timing), |recorder, Slot { inputs, packed, out, .. }| {
            record_frame(recorder, (views, &[]), (inputs, brings), settings, proximity, packed)?;
            let mut all = views.iter().zip(out).zip(packed).zip(brings);
            all.try_for_each(|(((view, out), packed), brings)| out.record(recorder, view, packed, brings.mask))
        })
    }

    /// From the next frame on every pass is timed.
    pub(super) fn measure_passes(&mut self) {
        self.timing = Timing::Stamps;
        self.frames.recorded = None;
        self.held.iter_mut().flat_map(|held| &mut held.slots).for_each(|slot| slot.recorded = None);
    }

    /// The passes of the last frame that went to the host; empty where they were not timed.
    ///
    /// # Errors
    /// When the device fails.
    pub(super) fn passes(&self) -> Result<Vec<PassTiming>> {
        self.frames.recorded.as_ref().map_or(Ok(Vec::new()), |(_, recording)| recording.timings())
    }

    /// Learns from a frame of the empty scene; one submission and one wait.
    ///
    /// # Errors
    /// When the device fails.
    pub(super) fn prime(&mut self, pictures: &[RgbImage]) -> Result<()> {
        let Self { device, views, settings, frames, priming, seen, .. } = self;
        let learning: Vec<usize> = (0..views.len()).filter(|&at| views[at].plate().is_none()).collect();
        if learning.is_empty() {
            return Ok(());
        }
        for &at in &learning {
            frames.inputs[at].colours.write(0, pictures[at].as_raw().as_slice())?;
            set_rates(&frames.inputs[at], settings, &mut seen[at])?;
        }
        if priming.is_none() {
            let views: Vec<_> = learning.iter().map(|&at| (&views[at], &frames.inputs[at])).collect();
            let mut recorder = device.recorder(Timing::Off)?;
            record_priming(&mut recorder, &views, settings)?;
            *priming = Some(recorder.finish()?);
        }
        priming.as_mut().map_or(Ok(()), Recording::run)
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
        for (mask, features) in masks.iter().zip(features.iter_mut()) {
            if let Some(mask) = mask {
                features.foreground.copy_from_gray(mask);
                features.silhouette.copy_from(&features.foreground);
            }
        }
        fill(&self.frames.inputs, &self.views, pictures, masks, (&self.settings, &mut self.seen))?;
        let brings = |mask: &Option<GrayImage>| Brings { mask: mask.is_some(), ignored: false };
        self.record(&masks.iter().map(brings).collect::<Vec<_>>())?;
        let Self { views, settings, frames: Slot { recorded, out, .. }, room: (codes, rows), .. } = self;
        recorded.as_mut().map_or(Ok(()), |(_, recording)| recording.run())?;
        let mut all = views.iter().zip(out).zip(masks).zip(features);
        all.try_for_each(|(((view, out), mask), features)| {
            out.read(view, mask.is_some(), settings, (codes, rows), features)
        })
    }

    /// Waits until one of the two memories is free for a frame that stays on the device.
    ///
    /// # Errors
    /// When [`Self::hold`] was not asked for.
    pub(super) fn reserve(&mut self) -> Result<()> {
        let Some(Held { free, given_back, reserved, .. }) = &mut self.held else { return Err(not_held()) };
        if reserved.is_none() {
            let place = free.recv().context("nobody gives memory for frames back")?;
            *reserved = Some(Lease { place, given_back: given_back.clone() });
        }
        Ok(())
    }

    /// Begins with a frame in the memory that is reserved for it, and returns while the device is at work: one submission. Pixels that are
    /// `ignored` count neither for nor against anybody. Where likelihoods are made, `lit` says the lights of the pictures, by the backgrounds
    /// of views that learn them: those take a submission of their own before, which is waited for.
    ///
    /// # Errors
    /// When [`Self::hold`] was not asked for, the frame before was not taken, or the device fails.
    pub(super) fn begin(
        &mut self,
        pictures: &[RgbImage],
        masks: &[Option<GrayImage>],
        ignored: &[Option<Arc<BitImage>>],
        lit: impl FnOnce(&[Option<RgbImage>]) -> Vec<Option<Lit>>,
    ) -> Result<()> {
        self.reserve()?;
        let Self { device, views, likely, timing, settings, proximity, held, seen, .. } = self;
        let Some(Held { slots, reserved, begun, .. }) = held else { return Err(not_held()) };
        if begun.is_some() {
            bail!("a frame was begun before the one before it was taken from the device");
        }
        let Some(lease) = reserved.take() else { return Err(not_held()) };
        let slot = &mut slots[lease.place];
        fill(&slot.inputs, views, pictures, masks, (settings, seen))?;
        for (input, ignored) in slot.inputs.iter().zip(ignored) {
            ignored.as_ref().map_or(Ok(()), |ignored| input.ignored.write(0, ignored.words()))?;
        }
        slot.ignored = ignored.to_vec();
        let brings = |(mask, ignored): (&Option<GrayImage>, &Option<Arc<BitImage>>)| Brings {
            mask: mask.is_some(),
            ignored: ignored.is_some(),
        };
        let brings: Vec<Brings> = masks.iter().zip(ignored).map(brings).collect();
        if !likely.is_empty() {
            let learnt = slot.learn(device, (views, likely), &brings, settings)?;
            let lights = lit(&learnt);
            for (((input, likely), light), learnt) in slot.inputs.iter_mut().zip(&*likely).zip(&lights).zip(&learnt) {
                let Some(light) = light else { continue };
                input.light.as_mut().map_or(Ok(()), |input| input.take(&light.tables))?;
                if let (Some(learnt), Some(colours)) = (learnt, &light.learnt) {
                    likely.take(learnt, colours)?;
                }
            }
            let look = |(brings, light): (&Brings, &Option<Lit>)| HeldLook {
                is_masked: brings.mask,
                is_grey: light.as_ref().is_some_and(|light| light.tables.is_grey),
            };
            slot.looks = brings.iter().zip(&lights).map(look).collect();
        }
        record_slot(slot, &brings, (device, *timing), |recorder, Slot { inputs, packed, out, .. }| {
            record_frame(recorder, (views, likely), (inputs, &brings), settings, proximity, packed)?;
            views.iter().zip(out).try_for_each(|(view, out)| out.record(recorder, view))
        })?;
        slot.recorded.as_mut().map_or(Ok(()), |(_, recording)| recording.submit())?;
        *begun = Some(lease);
        Ok(())
    }

    /// The frame that was begun, when the device is done with it.
    ///
    /// # Errors
    /// When none was begun, or the device fails.
    pub(super) fn finish(&mut self) -> Result<HeldFrame> {
        let Some(Held { slots, begun, .. }) = &mut self.held else { return Err(not_held()) };
        let Some(lease) = begun.take() else { bail!("no frame was begun on the device") };
        let Slot { packed, out, recorded, looks, ignored, .. } = &slots[lease.place];
        let mut passes = Vec::new();
        if let Some((_, recording)) = recorded {
            recording.wait()?;
            passes = recording.passes_run(Instant::now())?;
        }
        self.device.validation_log().check()?;
        let silhouettes =
            self.views.iter().zip(out).map(|(view, out)| out.read(view)).collect::<Result<Vec<BitImage>>>()?;
        Ok(HeldFrame {
            views: packed.clone(),
            silhouettes,
            ignored: ignored.clone(),
            looks: looks.clone(),
            colours: None,
            passes,
            lease,
        })
    }
}

fn not_held() -> anyhow::Error {
    anyhow::anyhow!("the features of frames do not stay on a device: nobody asked for it")
}

/// Records a frame in a slot, unless that is what is recorded there.
fn record_slot<Out>(
    slot: &mut Slot<Out>,
    brings: &[Brings],
    (device, timing): (&Device, Timing),
    record: impl FnOnce(&mut Recorder, &Slot<Out>) -> Result<()>,
) -> Result<()> {
    if slot.recorded.as_ref().is_some_and(|(recorded, _)| recorded == brings) {
        return Ok(());
    }
    let mut recorder = device.recorder(timing)?;
    record(&mut recorder, slot)?;
    slot.recorded = Some((brings.to_vec(), recorder.finish()?));
    Ok(())
}

/// Fills the host's end of a frame; mixtures hear the rates of their steps.
fn fill(
    inputs: &[Input],
    views: &[DeviceView],
    pictures: &[RgbImage],
    masks: &[Option<GrayImage>],
    (settings, seen): (&FeatureSettings, &mut [u32]),
) -> Result<()> {
    for (at, (input, mask)) in inputs.iter().zip(masks).enumerate() {
        input.colours.write(0, pictures[at].as_raw().as_slice())?;
        if let Some(mask) = mask {
            input.mask.write(0, BitImage::of_gray(mask).words())?;
        } else if views[at].plate().is_none() {
            set_rates(input, settings, &mut seen[at])?;
        }
    }
    Ok(())
}

/// Tells a view's mixture the rates of its next step.
fn set_rates(input: &Input, settings: &FeatureSettings, seen: &mut u32) -> Result<()> {
    let alpha = settings.mixture.rate(*seen);
    input.rates.write(0, &[Rates { alpha, first: u32::from(*seen == 0) }])?;
    *seen = seen.saturating_add(1);
    Ok(())
}
