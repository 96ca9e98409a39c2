//! One view's likelihoods, and the silhouette of what does not look like background.

use image::{GrayImage, RgbImage};

use super::super::blobs::Components;
use super::super::foreground::clean;
use super::super::light::gains;
use super::super::morphology::Morphology;
use super::super::{BitImage, FeatureSettings, Region};
use super::background::BackgroundColours;
use super::colour::find_bins;
use super::smooth::smooth_rows;
use super::{LightTables, Likelihood, MOST_RATIO};
use crate::features::shaders::LIKELIHOOD_FOREGROUND;

/// Where a view's background comes from.
#[derive(Debug)]
enum Known {
    Plate {
        image: RgbImage,
        colours: Box<BackgroundColours>,
    },
    /// From the mixture that the view learns, when it has learnt.
    Learnt,
}

/// A picture's light, as a device is told of it.
#[derive(Debug)]
pub(crate) struct Lit {
    pub(crate) tables: LightTables,
    /// The background's colours, where it is learnt.
    pub(crate) learnt: Option<BackgroundColours>,
}

/// Makes the likelihoods of one view.
#[derive(Debug)]
pub(crate) struct LikelySilhouette {
    known: Known,
    flags: Vec<u8>,
    foreground: BitImage,
    silhouette: BitImage,
    morphology: Morphology,
    components: Components,
}

impl LikelySilhouette {
    /// For a view with a picture of the empty scene, or one that learns it.
    pub(crate) fn new(plate: Option<RgbImage>) -> Self {
        let known = match plate {
            Some(image) => Known::Plate { colours: Box::new(BackgroundColours::new(&image)), image },
            None => Known::Learnt,
        };
        Self {
            known,
            flags: Vec::new(),
            foreground: BitImage::new(1, 1),
            silhouette: BitImage::new(1, 1),
            morphology: Morphology::default(),
            components: Components::default(),
        }
    }

    /// Whether the background has to come from what the view learns.
    pub(crate) fn learns(&self) -> bool {
        matches!(self.known, Known::Learnt)
    }

    /// The background's colours, where a picture of the empty scene is given.
    pub(crate) fn known(&self) -> Option<&BackgroundColours> {
        match &self.known {
            Known::Plate { colours, .. } => Some(colours),
            Known::Learnt => None,
        }
    }

    /// What a device that makes the likelihoods of a picture is to know of its light; `learnt` is as in [`Self::find`]. None of a view
    /// without a background.
    pub(crate) fn lit(&self, picture: &RgbImage, learnt: Option<&RgbImage>, settings: &FeatureSettings) -> Option<Lit> {
        let tables = |image: &RgbImage, colours: &BackgroundColours| {
            let gain = if settings.plate.gain { gains(picture, image) } else { [1.0; 3] };
            colours.light_tables(picture, image, gain)
        };
        if let Known::Plate { image, colours } = &self.known {
            return Some(Lit { tables: tables(image, colours), learnt: None });
        }
        let colours = BackgroundColours::new(learnt?);
        Some(Lit { tables: tables(learnt?, &colours), learnt: Some(colours) })
    }

    /// The likelihoods of a picture; `learnt` is what a view without a plate knows of its background by now.
    pub(crate) fn find(
        &mut self,
        picture: &RgbImage,
        mask: Option<&GrayImage>,
        learnt: Option<&RgbImage>,
        settings: &FeatureSettings,
        likelihood: &mut Likelihood,
    ) {
        let (gain, motion) = (settings.plate.gain, settings.silhouette.motion);
        let (width, height) = picture.dimensions();
        (likelihood.width, likelihood.height, likelihood.is_masked) = (width, height, mask.is_some());
        likelihood.is_grey = false;
        find_bins(picture.as_raw(), &mut likelihood.colours);
        likelihood.background.resize(likelihood.colours.len(), 0);
        self.foreground.resize(width, height);
        if let Some(mask) = mask {
            for (density, pixel) in likelihood.background.iter_mut().zip(mask.as_raw()) {
                *density = if *pixel >= 128 { -Likelihood::MASKED } else { Likelihood::SURE };
            }
            self.foreground.copy_from_gray(mask);
            self.silhouette.copy_from(&self.foreground);
        } else {
            let by_now;
            let (image, colours) = match (&self.known, learnt) {
                (Known::Plate { image, colours }, _) => (image, colours.as_ref()),
                (Known::Learnt, Some(image)) => {
                    by_now = BackgroundColours::new(image);
                    (image, &by_now)
                }
                (Known::Learnt, None) => {
                    likelihood.background.fill(Likelihood::SURE);
                    likelihood.region = Region::default();
                    self.foreground.clear();
                    self.silhouette.copy_from(&self.foreground);
                    return;
                }
            };
            let gain = if gain { gains(picture, image) } else { [1.0; 3] };
            let overexposed = colours.overexposed(image, gain);
            let colours = overexposed.as_ref().unwrap_or(colours);
            // First as if shadows were as frequent everywhere, then round the person with those counted there.
            likelihood.is_grey = colours.is_grey(picture);
            let mut light = BackgroundColours::light(picture, image, gain, likelihood.is_grey);
            let mut region = Region::whole(width, height);
            for pass in 0..2 {
                colours.judge(picture, light, region, &mut likelihood.background);
                threshold(likelihood, &mut self.flags, &mut self.foreground);
                self.silhouette.copy_from(&self.foreground);
                clean(&mut self.silhouette, settings, &mut self.morphology, &mut self.components);
                let Some(bounds) = self.silhouette.bounds().filter(|_| pass == 0) else { break };
                region = bounds.enlarged(motion, width, height);
                light = colours.shaded(picture, light, region);
            }
        }
        let bounds = self.silhouette.bounds();
        likelihood.region = bounds.map_or_else(Region::default, |bounds| bounds.enlarged(motion, width, height));
    }

    /// What does not look like background in the last picture, or its ready mask.
    pub(crate) fn foreground(&self) -> &BitImage {
        &self.foreground
    }

    /// The same cleaned.
    pub(crate) fn silhouette(&self) -> &BitImage {
        &self.silhouette
    }
}

/// Takes for foreground what is likelier to be of any colour than background; `flags` is room for a row.
fn threshold(likelihood: &Likelihood, flags: &mut Vec<u8>, foreground: &mut BitImage) {
    let width = likelihood.width as usize;
    flags.resize(width, 0);
    let ratio = |y: usize, row: &mut [i16]| unlikely(&likelihood.background[y * width..][..width], row);
    smooth_rows(width, likelihood.height as usize, ratio, |y, sums| {
        flag(sums, flags);
        foreground.pack_row(y, flags);
    });
}

/// By how much pixels are likelier to be of any colour than background, compiled for the wider vectors too.
#[multiversion::multiversion(targets("x86_64+avx2+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
fn unlikely(densities: &[i16], ratios: &mut [i16]) {
    let most = MOST_RATIO as i16;
    ratios.iter_mut().zip(densities).for_each(|(ratio, &density)| *ratio = (-density).clamp(-most, most));
}

/// Which of the smoothed sums, sixteen times the ratio, are large enough, likewise.
#[multiversion::multiversion(targets("x86_64+avx2+avx512f+avx512bw+avx512dq+avx512vl", "x86_64+avx2"))]
fn flag(sums: &[i16], flags: &mut [u8]) {
    let least = 16 * LIKELIHOOD_FOREGROUND as i16;
    flags.iter_mut().zip(sums).for_each(|(flag, &sum)| *flag = u8::from(sum > least));
}
