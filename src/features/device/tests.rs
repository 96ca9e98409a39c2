//! The chain on the device beside the processor's, bit by bit, on whatever Vulkan device there is, under the validation layer.

#![allow(clippy::unwrap_used)]

use image::{GrayImage, Luma, Rgb};

use super::super::{
    DistanceSettings, EdgeSettings, Extractor, Magnitude, Normalisation, Operator, ProximitySettings, ViewSource,
};
use super::*;
use crate::gpu::DeviceSettings;
use crate::gpu::test_device::device;

/// Sizes round whole words, and one smaller than most elements.
const SIZES: [[u32; 2]; 3] = [[131, 97], [64, 40], [3, 2]];

/// Patches of one colour with noise on them.
fn picture([width, height]: [u32; 2], seed: u32) -> RgbImage {
    RgbImage::from_fn(width, height, |x, y| {
        let mut hash = (x / 9 * 31 + y / 7 * 17 + seed).wrapping_mul(0x9e37_79b1);
        hash ^= hash >> 15;
        let noise = (x.wrapping_mul(0x85eb_ca6b) ^ y.wrapping_mul(0xc2b2_ae35) ^ seed).wrapping_mul(0x27d4_eb2f) >> 26;
        Rgb([0, 8, 16].map(|shift: u32| ((hash >> shift & 0xbf) + noise) as u8))
    })
}

/// Two discs; none in the smallest view of even seeds.
fn mask([width, height]: [u32; 2], seed: u32) -> GrayImage {
    GrayImage::from_fn(width, height, |x, y| {
        let disc = |cx: u32, cy: u32, r: u32| x.abs_diff(cx).pow(2) + y.abs_diff(cy).pow(2) < r * r;
        let inside = disc(width / 2, height / 2, 17) || disc(width - 1, 3 + seed, 9);
        Luma([if inside && (width > 3 || !seed.is_multiple_of(2)) { 255 } else { 0 }])
    })
}

#[test]
fn the_device_s_features_are_the_processor_s() {
    let Some((device, log)) = device("the_device_s_features_are_the_processor_s", DeviceSettings::default()) else {
        return;
    };
    let operators = [
        Operator::Sobel,
        Operator::Prewitt,
        Operator::Roberts,
        Operator::LaplaceFour,
        Operator::LaplaceEight,
        Operator::LaplaceProduct,
    ];
    let magnitudes = [Magnitude::Exact, Magnitude::Sum, Magnitude::Max];
    let metrics = [Metric::Chessboard, Metric::CityBlock, Metric::Euclidean, Metric::QuasiEuclidean];
    let normalisations = [Normalisation::Proportional, Normalisation::Exponential, Normalisation::Impulse];
    for case in 0..12 {
        let settings = FeatureSettings {
            edges: EdgeSettings {
                operator: operators[case % 6],
                magnitude: magnitudes[(case + case / 6) % 3],
                smooth: case % 5 != 4,
                // The product of two second differences is small.
                threshold: if case % 6 == 5 { 8 } else { 10 + 15 * (case as i16 % 4) },
                dilate: [7, 1, 13, 3][case % 4],
                ..Default::default()
            },
            distance: DistanceSettings { metric: metrics[(case + case / 4) % 4] },
            proximity: ProximitySettings {
                normalisation: normalisations[case / 2 % 3],
                d_max: [16, 255, 40, 3][case / 3],
                ..Default::default()
            },
            ..Default::default()
        };
        let sources: Vec<_> = SIZES.iter().map(|&[width, height]| ViewSource { width, height, plate: None }).collect();
        let mut host = Extractor::new(settings.clone(), sources.clone()).unwrap();
        let mut chain = Extractor::on_device(settings.clone(), sources, &device).unwrap();
        // Twice: what the first frame left in the buffers must not show.
        for seed in [1, 2] {
            let pictures = SIZES.map(|size| picture(size, seed));
            let masks = SIZES.map(|size| Some(mask(size, seed)));
            let expected = host.extract(&pictures, &masks).unwrap();
            assert!(expected[0].edges.count() > 0, "{settings:?} finds nothing");
            for (found, expected) in chain.extract(&pictures, &masks).unwrap().iter().zip(&expected) {
                assert_eq!(found.edges, expected.edges, "{settings:?}");
                assert_eq!(found.distance.distances(), expected.distance.distances(), "{settings:?}");
                assert_eq!(found.observation, expected.observation, "{settings:?}");
            }
        }
    }
    let canny = FeatureSettings {
        edges: EdgeSettings { operator: Operator::Canny, ..Default::default() },
        ..Default::default()
    };
    let source = ViewSource { width: 4, height: 4, plate: None };
    let refused = Extractor::on_device(canny, vec![source], &device).err().unwrap().to_string();
    assert!(refused.contains("canny"), "{refused}");
    drop(device);
    assert_eq!(log.messages(), Vec::<String>::new());
}
