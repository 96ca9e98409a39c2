//! The chain on the device beside the processor's, bit by bit, on whatever Vulkan device there is, under the validation layer.

#![allow(clippy::unwrap_used, reason = "a test or benchmark stops at the first surprise, and prints")]

use image::{GrayImage, Luma, Rgb};

use super::super::{
    DistanceSettings, EdgeSettings, Extractor, Magnitude, Metric, MixtureSettings, Normalisation, Observation,
    Operator, PlateSettings, ProximitySettings, Shape, SilhouetteSettings, ViewSource,
};
use super::*;
use crate::gpu::rough::rough;
use crate::gpu::test_device::device;
use crate::gpu::{Capabilities, DeviceSettings};

/// Sizes round whole words, and one smaller than most elements.
pub(super) const SIZES: [[u32; 2]; 4] = [[131, 97], [64, 40], [3, 2], [150, 60]];

/// Views in which every pixel counts.
const NONE_IGNORED: [Option<Arc<BitImage>>; 4] = [const { None }; 4];

/// Patches of one colour with noise on them.
pub(super) fn room([width, height]: [u32; 2], seed: u32) -> RgbImage {
    RgbImage::from_fn(width, height, |x, y| {
        let mut hash = (x / 9 * 31 + y / 7 * 17 + 5).wrapping_mul(0x9e37_79b1);
        hash ^= hash >> 15;
        let noise = (x.wrapping_mul(0x85eb_ca6b) ^ y.wrapping_mul(0xc2b2_ae35) ^ seed).wrapping_mul(0x27d4_eb2f) >> 28;
        Rgb([0, 8, 16].map(|shift: u32| ((hash >> shift & 0xbf) + noise) as u8))
    })
}

/// Two discs; none in the smallest view of even seeds.
pub(super) fn inside([width, height]: [u32; 2], seed: u32, x: u32, y: u32) -> bool {
    let disc = |cx: u32, cy: u32, r: u32| x.abs_diff(cx).pow(2) + y.abs_diff(cy).pow(2) < r * r;
    (disc(width / 2, height / 2, 17) || disc(width - 1, 3 + seed, 9)) && (width > 3 || !seed.is_multiple_of(2))
}

/// The room with the discs in colours of their own, and specks, in slightly other light.
pub(super) fn picture(size: [u32; 2], seed: u32) -> RgbImage {
    let mut picture = room(size, seed);
    for (x, y, pixel) in picture.enumerate_pixels_mut() {
        if inside(size, seed, x, y) || (x * 7 + y * 13 + seed).is_multiple_of(101) {
            *pixel = Rgb([200 - (x % 40) as u8, (y * 3 % 250) as u8, 30 + (seed * 9) as u8]);
        } else {
            *pixel = Rgb(pixel.0.map(|value| (f32::from(value) * 0.93) as u8));
        }
    }
    picture
}

pub(super) fn mask(size: [u32; 2], seed: u32) -> GrayImage {
    GrayImage::from_fn(size[0], size[1], |x, y| Luma([if inside(size, seed, x, y) { 255 } else { 0 }]))
}

fn assert_same(found: &[ViewFeatures], expected: &[ViewFeatures], settings: &FeatureSettings) {
    for (view, (found, expected)) in found.iter().zip(expected).enumerate() {
        assert_eq!(found.foreground, expected.foreground, "view {view}, {settings:?}");
        assert_eq!(found.silhouette, expected.silhouette, "view {view}, {settings:?}");
        assert_eq!(found.region, expected.region, "view {view}, {settings:?}");
        assert_eq!(found.edges, expected.edges, "view {view}, {settings:?}");
        assert_eq!(found.distance.distances(), expected.distance.distances(), "view {view}, {settings:?}");
        assert_eq!(found.observation, expected.observation, "view {view}, {settings:?}");
    }
}

/// Views with and without plates.
fn sources() -> Vec<ViewSource> {
    let plate = |at: usize, size| at.is_multiple_of(2).then(|| room(size, 77));
    let each = SIZES.iter().enumerate();
    each.map(|(at, &size)| ViewSource { width: size[0], height: size[1], plate: plate(at, size) }).collect()
}

pub(super) fn settings(case: usize) -> FeatureSettings {
    let (operators, magnitudes, metrics) = (Operator::ALL, Magnitude::ALL, Metric::ALL);
    let normalisations = [Normalisation::Proportional, Normalisation::Exponential, Normalisation::Impulse];
    FeatureSettings {
        mixture: MixtureSettings { components: 3 + case % 3, gain: case % 2 == 1, warm_up: 4, ..Default::default() },
        plate: PlateSettings { gain: case % 3 != 2, bridge: [15, 1, 7][case % 3], ..Default::default() },
        silhouette: SilhouetteSettings {
            element: [Shape::Disc, Shape::Square][case % 2],
            open: [3, 1, 5][case % 3],
            close: [5, 9, 1][case / 2 % 3],
            blobs: 1 + case % 4,
            min_area: 3,
            max_cover: [0.75, 0.3][case / 3 % 2],
            ..Default::default()
        },
        edges: EdgeSettings {
            operator: operators[case % 7],
            magnitude: magnitudes[(case + case / 7) % 3],
            smooth: case % 5 != 4,
            // The product of two second differences is small.
            threshold: if case % 7 == 5 { 8 } else { 10 + 15 * (case as i16 % 4) },
            low: 9,
            dilate: [7, 1, 13, 3][case % 4],
        },
        distance: DistanceSettings { metric: metrics[(case + case / 4) % 4] },
        proximity: ProximitySettings {
            normalisation: normalisations[case / 2 % 3],
            d_max: [16, 255, 40, 3][case / 4],
            ..Default::default()
        },
        ..Default::default()
    }
}

#[test]
fn the_device_s_features_are_the_processor_s() {
    features_are_the_processor_s(DeviceSettings::default(), 0..14);
}

#[test]
fn an_inexact_device_s_features_are_the_processor_s() {
    features_are_the_processor_s(DeviceSettings { code: Some(rough), ..DeviceSettings::default() }, 3..10);
}

fn features_are_the_processor_s(opened: DeviceSettings, cases: std::ops::Range<usize>) {
    let Some((device, log)) = device("features_are_the_processor_s", opened) else { return };
    for case in cases {
        let settings = settings(case);
        let mut host = Extractor::new(settings.clone(), sources()).unwrap();
        let mut chain = Extractor::on_device(settings.clone(), sources(), &device).unwrap();
        for seed in 0..3 {
            let empty = SIZES.map(|size| room(size, 10 + seed));
            host.prime(&empty).unwrap();
            chain.prime(&empty).unwrap();
        }
        let mut found = Vec::new();
        // Several: what a frame left in the buffers must not show in the next, and masks come and go.
        for seed in [1, 2, 3, 4] {
            let pictures = SIZES.map(|size| picture(size, seed));
            let masks = [0, 1, 2, 3]
                .map(|at: usize| (seed == 1 || seed == 3 && at.is_multiple_of(3)).then(|| mask(SIZES[at], seed)));
            let expected = host.extract(&pictures, &masks).unwrap();
            assert!(expected[0].edges.count() > 0, "{settings:?} finds nothing");
            assert!(expected[3].silhouette.count() > 0, "{settings:?} finds nothing");
            chain.extract_into(&pictures, &masks, &mut found).unwrap();
            assert_same(&found, &expected, &settings);
        }
    }
    drop(device);
    assert_eq!(log.messages(), Vec::<String>::new());
}

/// What a view's held buffers hold.
pub(super) fn fetched(device: &Device, buffer: &Buffer) -> Vec<u32> {
    let words = (buffer.size() / 4) as usize;
    let seen = device.buffer::<u32>("seen", words, Memory::Readback).unwrap();
    let mut recorder = device.recorder(Timing::Off).unwrap();
    recorder.copy("fetch", (buffer, 0), (&seen, 0), buffer.size()).unwrap();
    recorder.finish().unwrap().run().unwrap();
    let mut found = vec![0; words];
    seen.read(0, &mut found).unwrap();
    found
}

/// Bytes of rows that are padded to whole words, and bit planes of 32 pixels each.
pub(super) fn packed(observation: &Observation) -> [Vec<u32>; 2] {
    let (mut pixels, mut planes) = (Vec::new(), Vec::new());
    for row in observation.bytes.chunks_exact(observation.width as usize) {
        let word = |four: &[u8]| four.iter().rev().fold(0, |word, byte| word << 8 | u32::from(*byte));
        pixels.extend(row.chunks(4).map(word));
        for group in row.chunks(32) {
            let plane =
                |plane: u32| (0..).zip(group).fold(0, |word, (at, byte)| word | (u32::from(*byte) >> plane & 1) << at);
            planes.extend((0..8).map(plane));
        }
    }
    [pixels, planes]
}

/// Frames that stay on the device are those that come to the host; the third waits for the memory of the first.
#[test]
fn frames_that_stay_on_the_device_are_the_processor_s() {
    let one: fn(&mut Capabilities) = |capabilities| capabilities.second_queue = false;
    for lower in [None, Some(one)] {
        let opened = DeviceSettings { lower, ..DeviceSettings::default() };
        let Some((device, log)) = device("frames_that_stay_on_the_device", opened) else { return };
        let mut host = Extractor::new(settings(3), sources()).unwrap();
        let mut chain = Extractor::new(settings(3), sources()).unwrap();
        let (pictures, masks) = (SIZES.map(|size| picture(size, 1)), [const { None }; 4]);
        let error = chain.begin(&pictures, &masks, &NONE_IGNORED).unwrap_err().to_string();
        assert!(error.contains("the processor makes the features"), "{error}");
        chain.hold_on(&device).unwrap();
        chain.measure_passes();
        for seed in 0..3 {
            let empty = SIZES.map(|size| room(size, 10 + seed));
            host.prime(&empty).unwrap();
            chain.prime(&empty).unwrap();
        }
        let error = chain.finish().unwrap_err().to_string();
        assert_eq!(error, "no frame was begun on the device");
        let mut kept = Vec::new();
        for seed in [1, 2, 3, 4, 5] {
            let pictures = SIZES.map(|size| picture(size, seed));
            let masks = [0, 1, 2, 3]
                .map(|at: usize| (seed == 1 || seed == 3 && at.is_multiple_of(3)).then(|| mask(SIZES[at], seed)));
            let expected = host.extract(&pictures, &masks).unwrap();
            if kept.len() == 2 {
                drop(kept.remove(0));
            }
            chain.begin(&pictures, &masks, &NONE_IGNORED).unwrap();
            if seed == 1 {
                let error = chain.begin(&pictures, &masks, &NONE_IGNORED).unwrap_err().to_string();
                assert!(error.contains("before the one before it was taken"), "{error}");
            }
            let found = chain.finish().unwrap();
            kept.push((found, expected));
            // What the frame before left is still there while this one is made.
            for (found, expected) in &kept {
                for (view, expected) in expected.iter().enumerate() {
                    let of_view = &found.views()[view];
                    let held = [&of_view.pixels, &of_view.planes].map(|buffer| fetched(&device, buffer));
                    assert!(held == packed(&expected.observation), "view {view}, seed {seed}");
                    assert_eq!(found.silhouettes()[view], expected.silhouette, "view {view}, seed {seed}");
                }
            }
            let mut other = packed(&kept[0].1[0].observation);
            other[1][9] ^= 1;
            assert!(other != packed(&kept[0].1[0].observation), "a bit more would show");
            if device.capabilities().timestamps {
                assert!(kept[0].0.passes().iter().any(|pass| pass.name == "pack"));
            }
        }
        assert_ne!(kept[0].0.place(), kept[1].0.place());
        drop((kept, chain, device));
        assert_eq!(log.messages(), Vec::<String>::new());
    }
}

#[test]
fn what_the_processor_finds_keeps_frames_from_the_device() {
    let Some((device, _)) = device("what_the_processor_finds_keeps_frames", DeviceSettings::default()) else { return };
    let skin = "[[segment]]\nname = 'skin'\nlabels = [1]\nweight = 1.0\ncue = 'skin'";
    let parts = FeatureSettings::from_table(&skin.parse().unwrap(), "sequence.toml").unwrap();
    let error = Extractor::new(parts, sources()).unwrap().hold_on(&device).unwrap_err().to_string();
    assert_eq!(error, "observations cannot stay on a device, since body parts are told apart");
}

#[test]
fn a_picture_of_3840_by_2160_is_the_processor_s() {
    let Some((device, log)) = device("a_picture_of_3840_by_2160_is_the_processor_s", DeviceSettings::default()) else {
        return;
    };
    let (size, mut settings) = ([3840, 2160], FeatureSettings::default());
    settings.edges.operator = Operator::Canny;
    let source = ViewSource { width: size[0], height: size[1], plate: Some(room(size, 77)) };
    let (pictures, masks) = ([picture(size, 4)], [None]);
    let expected = Extractor::new(settings.clone(), vec![source.clone()]).unwrap().extract(&pictures, &masks).unwrap();
    let mut chain = Extractor::on_device(settings.clone(), vec![source], &device).unwrap();
    assert!(expected[0].edges.count() > 0 && expected[0].silhouette.count() > 0);
    assert_same(&chain.extract(&pictures, &masks).unwrap(), &expected, &settings);
    drop((chain, device));
    assert_eq!(log.messages(), Vec::<String>::new());
}

#[test]
fn passes_are_timed_when_asked() {
    let Some((device, _)) = device("passes_are_timed_when_asked", DeviceSettings::default()) else { return };
    let mut chain = Extractor::on_device(settings(6), sources(), &device).unwrap();
    let (pictures, masks) = (SIZES.map(|size| picture(size, 1)), [const { None }; 4]);
    chain.extract(&pictures, &masks).unwrap();
    assert_eq!(chain.passes().unwrap(), []);
    chain.measure_passes();
    chain.extract(&pictures, &masks).unwrap();
    if device.capabilities().timestamps {
        let passes = chain.passes().unwrap();
        for name in ["upload", "difference", "mixture", "components_join", "canny", "pack", "readback"] {
            assert!(passes.iter().any(|pass| pass.name == name), "{name} is not among the passes");
        }
    }
}

#[test]
fn a_view_that_does_not_fit_is_one_sentence_and_the_processor_goes_on() {
    fn little(capabilities: &mut Capabilities) {
        capabilities.max_storage = 10_000;
    }
    let lowered = DeviceSettings { lower: Some(little), ..Default::default() };
    let Some((device, log)) = device("a_view_that_does_not_fit", lowered) else { return };
    let mut extractor = Extractor::new(settings(0), sources()).unwrap();
    let refused = extractor.move_to(&device).unwrap_err().to_string();
    assert!(refused.contains("bytes, more than the 10000 that this device binds at once"), "{refused}");
    let (pictures, masks) = (SIZES.map(|size| picture(size, 1)), [const { None }; 4]);
    let found = extractor.extract(&pictures, &masks).unwrap();
    let expected = Extractor::new(settings(0), sources()).unwrap().extract(&pictures, &masks).unwrap();
    assert_same(&found, &expected, extractor.settings());
    drop(device);
    assert_eq!(log.messages(), Vec::<String>::new());
}
