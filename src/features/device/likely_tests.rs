//! Likelihoods that stay on the device beside the processor's, bit by bit, under the validation layer; and frames that ignore pixels.

#![allow(clippy::unwrap_used, reason = "a test or benchmark stops at the first surprise, and prints")]

use image::{GrayImage, Rgb};

use super::super::{Extractor, ForegroundKind, Likelihood, PlateSettings, SilhouetteSettings, ViewSource};
use super::tests::{SIZES, fetched, mask, packed, picture, room, settings};
use super::*;
use crate::features::likelihood::ColourBin;
use crate::gpu::DeviceSettings;
use crate::gpu::rough::rough;
use crate::gpu::test_device::device;

/// What the device holds of a likelihood: the density in the lower half of a word, the colour in the upper.
fn words(likelihood: &Likelihood) -> Vec<u32> {
    let word = |(density, colour): (&i16, &ColourBin)| u32::from(*density as u16) | (colour.index() as u32) << 16;
    likelihood.background.iter().zip(&likelihood.colours).map(word).collect()
}

fn grey(picture: &RgbImage) -> RgbImage {
    RgbImage::from_fn(picture.width(), picture.height(), |x, y| Rgb([picture.get_pixel(x, y).0[1]; 3]))
}

/// How the views are seen: all by plates, in colour or in grey; or every other one by masks alone, or by a background that it learns.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Seen {
    InColour,
    InGrey,
    ByMasks,
    Learning,
}

fn sources(seen: Seen) -> Vec<ViewSource> {
    let plate = |at: usize, size| match seen {
        Seen::InColour => Some(room(size, 77)),
        Seen::InGrey => Some(grey(&room(size, 77))),
        Seen::ByMasks | Seen::Learning => at.is_multiple_of(2).then(|| room(size, 77)),
    };
    let each = SIZES.iter().enumerate();
    each.map(|(at, &size)| ViewSource { width: size[0], height: size[1], plate: plate(at, size) }).collect()
}

/// Blobs that stay in pictures so small, in some cases found by likelihood.
fn likely_settings(case: usize) -> FeatureSettings {
    FeatureSettings {
        likelihoods: true,
        foreground: [ForegroundKind::Difference, ForegroundKind::Likelihood][case % 2],
        plate: PlateSettings { gain: case % 3 != 2, ..settings(case).plate },
        silhouette: SilhouetteSettings {
            motion: [16, 3, 0, 1000][case % 4],
            max_cover: 0.75,
            ..settings(case).silhouette
        },
        ..settings(case)
    }
}

fn likelihoods_are_the_processor_s(opened: DeviceSettings, cases: std::ops::Range<usize>) {
    let Some((device, log)) = device("likelihoods_are_the_processor_s", opened) else { return };
    let (mut shadows, mut others, mut found_any) = (0, 0, 0);
    let frames = 4 * cases.len();
    for case in cases {
        let seen = [Seen::InColour, Seen::Learning, Seen::InGrey, Seen::ByMasks][case / 2 % 4];
        let settings = likely_settings(case);
        let mut host = Extractor::new(settings.clone(), sources(seen)).unwrap();
        let mut chain = Extractor::new(settings.clone(), sources(seen)).unwrap();
        chain.hold_on(&device).unwrap();
        for seed in 0..3 {
            let empty = SIZES.map(|size| room(size, 10 + seed));
            host.prime(&empty).unwrap();
            chain.prime(&empty).unwrap();
        }
        // Several: what a frame left in the buffers must not show in the next, and masks come and go.
        for seed in [1, 2, 3, 4] {
            let mut pictures = SIZES.map(|size| picture(size, seed));
            if seen == Seen::InGrey && seed != 3 {
                pictures = pictures.map(|picture| grey(&picture));
            }
            if seed == 4 {
                // So bright that much of the background is white.
                pictures
                    .iter_mut()
                    .flat_map(|picture| picture.iter_mut())
                    .for_each(|value| *value = (u32::from(*value) * 8 / 5).min(255) as u8);
            }
            let masks: [Option<GrayImage>; 4] = [0, 1, 2, 3].map(|at: usize| {
                let is_masked = at % 2 == 1 && seen == Seen::ByMasks || at < 2 && seed == 2;
                is_masked.then(|| mask(SIZES[at], seed))
            });
            let ignored = [0, 1, 2, 3].map(|at: usize| {
                let [width, height] = SIZES[at];
                (seed > 2 && at != 1).then(|| {
                    Arc::new(BitImage::from_fn(width, height, |x, y| (width / 3..width / 2).contains(&x) && y > 1))
                })
            });
            let mut expected = host.extract(&pictures, &masks).unwrap();
            host.ignore(&mut expected, &ignored).unwrap();
            chain.begin(&pictures, &masks, &ignored).unwrap();
            let found = chain.finish().unwrap();
            for (at, expected) in expected.iter().enumerate() {
                let place = format!("view {at}, seed {seed}, {seen:?}, {settings:?}");
                let view = &found.views()[at];
                let (likely, twin) = (view.likelihood.as_ref().unwrap(), expected.likelihood.as_ref().unwrap());
                assert!(fetched(&device, &likely.seen) == words(twin), "{place}");
                let sides: [u32; 4] = fetched(&device, &likely.sides).try_into().unwrap();
                let bounds = bounds::region(sides, twin.width, twin.height);
                let region = bounds.map(|bounds| bounds.enlarged(likely.motion, twin.width, twin.height));
                assert_eq!(region.unwrap_or_default(), twin.region, "{place}");
                let look = HeldLook { is_masked: twin.is_masked, is_grey: twin.is_grey };
                assert_eq!(found.looks()[at], look, "{place}");
                let held = [&view.pixels, &view.planes].map(|buffer| fetched(&device, buffer));
                assert!(held == packed(&expected.observation), "{place}");
                assert_eq!(found.silhouettes()[at], expected.silhouette, "{place}");
                assert_eq!(found.ignored()[at], expected.observation.ignored, "{place}");
                shadows += twin.background.iter().filter(|density| (0..500).contains(*density)).count();
                others += twin.background.iter().filter(|density| **density < 0).count();
            }
            found_any += usize::from(expected.iter().any(|view| view.silhouette.count() > 0));
        }
    }
    assert!(2 * found_any > frames, "somebody is found in {found_any} of {frames} frames");
    assert!(shadows > 1000 && others > 1000, "{shadows} and {others} pixels are doubtful");
    drop(device);
    assert_eq!(log.messages(), Vec::<String>::new());
}

#[test]
fn likelihoods_that_stay_on_the_device_are_the_processor_s() {
    likelihoods_are_the_processor_s(DeviceSettings::default(), 0..16);
}

#[test]
fn likelihoods_of_an_inexact_device_are_the_processor_s() {
    likelihoods_are_the_processor_s(DeviceSettings { code: Some(rough), ..DeviceSettings::default() }, 0..8);
}

#[test]
fn masks_of_ignored_pixels_for_other_views_are_one_sentence() {
    let Some((device, _)) = device("masks_of_ignored_pixels_for_other_views", DeviceSettings::default()) else {
        return;
    };
    let mut chain = Extractor::new(likely_settings(0), sources(Seen::InColour)).unwrap();
    chain.hold_on(&device).unwrap();
    let (pictures, none) = (SIZES.map(|size| picture(size, 1)), [const { None }; 4]);
    let error = chain.begin(&pictures, &none, &[None]).unwrap_err().to_string();
    assert_eq!(error, "4 views were given 1 masks of ignored pixels or gaps, expected one each");
    let mut other = [const { None }; 4];
    other[1] = Some(Arc::new(BitImage::new(7, 5)));
    let error = chain.begin(&pictures, &none, &other).unwrap_err().to_string();
    assert_eq!(error, "the ignored pixels of 7 x 5 were given for an observation of 64 x 40");
}
