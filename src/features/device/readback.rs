//! Where a frame's packed observations go on the device, and what the host asks to have of a frame.

use anyhow::Result;

use super::bounds::region;
use super::view::{DeviceView, Plane, copy_whole};
use crate::features::held::{HeldLikelihood, HeldView};
use crate::features::{BitImage, FeatureSettings, Region, ViewFeatures};
use crate::geometry::LARGEST_SIDE;
use crate::gpu::{Buffer, Device, Memory, Recorder};

/// The memory of a frame's packed observations, one a view; and of their likelihoods where these are made, with the room round what is
/// found there.
pub(super) fn held_views(device: &Device, views: &[DeviceView], motion: Option<u32>) -> Result<Vec<HeldView>> {
    let likelihood = |view: &DeviceView, motion: u32| -> Result<HeldLikelihood> {
        let pixels = view.picture.width as usize * view.picture.height as usize;
        Ok(HeldLikelihood {
            seen: device.buffer::<u32>("likelihoods", pixels, Memory::Device)?,
            sides: device.buffer::<u32>("likelihoods' bounds", 4, Memory::Device)?,
            motion: motion.min(LARGEST_SIDE),
            empty: device.buffer::<u32>("empty pixels", view.words() as usize, Memory::Device)?,
            empty_out: device.buffer::<u32>("empty pixels readback", view.words() as usize, Memory::Readback)?,
        })
    };
    let of_view = |view: &DeviceView| {
        let [pixels, planes] = view.packed_words();
        Ok(HeldView {
            pixels: device.buffer::<u32>("packed", pixels, Memory::Device)?,
            planes: device.buffer::<u32>("packed planes", planes, Memory::Device)?,
            likelihood: motion.map(|motion| likelihood(view, motion)).transpose()?,
        })
    };
    views.iter().map(of_view).collect()
}

/// The host's copy of a silhouette, all that it is given of a frame that the device holds.
#[derive(Debug)]
pub(super) struct SilhouetteOut(Buffer);

impl SilhouetteOut {
    pub(super) fn new(device: &Device, view: &DeviceView) -> Result<Self> {
        let words = view.words() as usize;
        Ok(Self(device.buffer::<u32>("silhouette readback", words, Memory::Readback)?))
    }

    pub(super) fn record(&self, recorder: &mut Recorder, view: &DeviceView) -> Result<()> {
        copy_whole(recorder, "readback", view.plane(Plane::Silhouette), &self.0)
    }

    pub(super) fn read(&self, view: &DeviceView) -> Result<BitImage> {
        let mut silhouette = BitImage::new(view.picture.width, view.picture.height);
        self.0.read(0, silhouette.words_mut())?;
        Ok(silhouette)
    }
}

/// The host's copies of everything that is found in a view.
#[derive(Debug)]
pub(super) struct FeaturesOut {
    foreground: Buffer,
    silhouette: Buffer,
    sides: Buffer,
    edges: Buffer,
    codes: Buffer,
    packed: Buffer,
}

impl FeaturesOut {
    pub(super) fn new(device: &Device, view: &DeviceView) -> Result<Self> {
        let words = |name: &str, count: usize| device.buffer::<u32>(name, count, Memory::Readback);
        let bits = view.words() as usize;
        Ok(Self {
            foreground: words("foreground readback", bits)?,
            silhouette: words("silhouette readback", bits)?,
            sides: words("bounds readback", 4)?,
            edges: words("edges readback", bits)?,
            codes: words("codes readback", view.picture.width as usize * view.picture.height as usize)?,
            packed: words("packed readback", view.packed_words()[0])?,
        })
    }

    /// Records it; a mask is on the host already.
    pub(super) fn record(
        &self,
        recorder: &mut Recorder,
        view: &DeviceView,
        packed: &HeldView,
        is_masked: bool,
    ) -> Result<()> {
        if !is_masked {
            copy_whole(recorder, "readback", view.plane(Plane::Foreground), &self.foreground)?;
            copy_whole(recorder, "readback", view.plane(Plane::Silhouette), &self.silhouette)?;
        }
        copy_whole(recorder, "readback", &view.sides, &self.sides)?;
        copy_whole(recorder, "readback", view.plane(Plane::Edges), &self.edges)?;
        copy_whole(recorder, "readback", &view.codes, &self.codes)?;
        copy_whole(recorder, "readback", &packed.pixels, &self.packed)
    }

    /// Takes what the device made of a view; `codes` and `rows` are room.
    pub(super) fn read(
        &self,
        view: &DeviceView,
        is_masked: bool,
        settings: &FeatureSettings,
        (codes, rows): (&mut Vec<u32>, &mut Vec<u8>),
        features: &mut ViewFeatures,
    ) -> Result<()> {
        let (width, height) = (view.picture.width, view.picture.height);
        if !is_masked {
            self.foreground.read(0, features.foreground.words_mut())?;
            self.silhouette.read(0, features.silhouette.words_mut())?;
        }
        let mut sides = [0; 4];
        self.sides.read(0, &mut sides)?;
        features.region = region(sides, width, height)
            .map_or(Region::whole(width, height), |bounds| bounds.enlarged(settings.silhouette.motion, width, height));
        self.edges.read(0, features.edges.words_mut())?;
        let pixels = width as usize * height as usize;
        codes.resize(pixels, 0);
        self.codes.read(0, codes)?;
        features.distance.take_codes([width, height], settings.distance.metric, settings.proximity.limit(), codes);
        let observation = &mut features.observation;
        (observation.width, observation.height) = (width, height);
        rows.resize(4 * view.packed_words()[0], 0);
        self.packed.read(0, rows)?;
        observation.bytes.clear();
        let padded = 4 * width.div_ceil(4) as usize;
        rows.chunks_exact(padded).for_each(|row| observation.bytes.extend_from_slice(&row[..width as usize]));
        Ok(())
    }
}
