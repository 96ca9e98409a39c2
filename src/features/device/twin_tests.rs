//! Each stage alone beside its twin on the processor, bit by bit, on whatever Vulkan device there is, under the validation layer.

#![allow(clippy::unwrap_used, reason = "a test or benchmark stops at the first surprise, and prints")]

use anyhow::Result;
use image::{Rgb, RgbImage};
use proptest::prelude::*;
use proptest::test_runner::{Config, TestRunner};

use super::bounds::{bounds, region};
use super::components::{Keep, components};
use super::edges::{edges, smooth};
use super::foreground::{bridge, difference, mixture, probable, ratios};
use super::morphology::{Operation, closing, morphology, opening};
use super::view::{DeviceView, Input, Plane};
use crate::features::bit_image::any_bit_image;
use crate::features::blobs::Components;
use crate::features::edges::EdgeDetector;
use crate::features::mixture::Mixture;
use crate::features::morphology::{Element, Morphology};
use crate::features::plate::{DifferenceRow, Plate};
use crate::features::shaders::MIXTURE_FIELDS;
use crate::features::shaders::layout::Rates;
use crate::features::{
    Adaptation, BitImage, EdgeSettings, Magnitude, MixtureSettings, Operator, PlateSettings, ShadowSettings, Shape,
};
use crate::gpu::rough::{Change, rough};
use crate::gpu::test_device::device;
use crate::gpu::{Buffer, Capabilities, Device, DeviceSettings, Memory, Recorder, Timing};

/// A view on the device, with ways in and out.
struct Bench {
    device: Device,
    view: DeviceView,
}

impl Bench {
    fn new(device: &Device, width: u32, height: u32) -> Self {
        Self::with(device, [width, height], None, &MixtureSettings::default())
    }

    fn with(device: &Device, size: [u32; 2], plate: Option<&RgbImage>, mixture: &MixtureSettings) -> Self {
        let view = DeviceView::new(device, size, plate, mixture, 16).unwrap();
        Self { device: device.clone(), view }
    }

    fn run(&self, record: impl FnOnce(&mut Recorder) -> Result<()>) {
        let mut recorder = self.device.recorder(Timing::Off).unwrap();
        record(&mut recorder).unwrap();
        recorder.finish().unwrap().run().unwrap();
    }

    fn write<T: bytemuck::Pod>(&self, to: &Buffer, values: &[T]) {
        let staging = self.device.buffer::<u32>("staging", to.size() as usize / 4, Memory::Upload).unwrap();
        staging.write(0, values).unwrap();
        self.run(|recorder| recorder.copy("upload", (&staging, 0), (to, 0), to.size()));
    }

    fn read(&self, from: &Buffer) -> Vec<u32> {
        let staging = self.device.buffer::<u32>("staging", from.size() as usize / 4, Memory::Readback).unwrap();
        self.run(|recorder| recorder.copy("readback", (from, 0), (&staging, 0), from.size()));
        let mut values = vec![0; from.size() as usize / 4];
        staging.read(0, &mut values).unwrap();
        values
    }

    fn put(&self, plane: Plane, image: &BitImage) {
        self.write(self.view.plane(plane), image.words());
    }

    fn get(&self, plane: Plane) -> BitImage {
        let mut image = BitImage::new(self.view.picture.width, self.view.picture.height);
        let words = self.read(self.view.plane(plane));
        image.words_mut().copy_from_slice(bytemuck::cast_slice(&words));
        image
    }

    fn show(&self, picture: &RgbImage) {
        let mut bytes = picture.as_raw().clone();
        bytes.resize(bytes.len().next_multiple_of(4), 0);
        self.write(&self.view.colours, &bytes);
    }
}

/// Runs a test on random cases; device work is too slow for as many as usual.
fn check<S: Strategy>(cases: u32, strategy: &S, test: impl Fn(S::Value) -> Result<(), TestCaseError>) {
    TestRunner::new_with_rng(
        Config { cases, failure_persistence: None, ..Config::default() },
        proptest::test_runner::TestRng::deterministic_rng(proptest::test_runner::RngAlgorithm::ChaCha),
    )
    .run(strategy, test)
    .unwrap();
}

/// Noise of a given density, from 0 to 256.
fn noise(width: u32, height: u32, density: u32, seed: u32) -> BitImage {
    BitImage::from_fn(width, height, |x, y| hash(x, y, seed) >> 24 < density)
}

fn hash(x: u32, y: u32, seed: u32) -> u32 {
    let mut hash = x.wrapping_mul(0x9e37_79b1) ^ y.wrapping_mul(0x85eb_ca6b) ^ seed.wrapping_mul(0xc2b2_ae35);
    hash = (hash ^ hash >> 15).wrapping_mul(0x2c1b_3c6d);
    hash = (hash ^ hash >> 12).wrapping_mul(0x297a_2d39);
    hash ^ hash >> 15
}

#[test]
fn morphology_is_the_processor_s() {
    let Some((device, log)) = device("morphology_is_the_processor_s", DeviceSettings::default()) else { return };
    let radius = prop_oneof![0_u32..9, 14_u32..20, Just(33), Just(127)];
    let shape = prop_oneof![Just(Shape::Square), Just(Shape::Disc)];
    check(24, &(any_bit_image(), radius, shape), |(image, radius, shape)| {
        let element = Element { shape, radius };
        use Plane::{Edges, Foreground, Near, WorkA, WorkB, WorkC};
        let bench = Bench::new(&device, image.width(), image.height());
        bench.put(Foreground, &image);
        let (mut twin, views) = (Morphology::default(), [&bench.view]);
        bench.run(|recorder| {
            morphology(recorder, &views, Operation::Dilate, element, [Foreground, Near])?;
            morphology(recorder, &views, Operation::Erode, element, [Foreground, Edges])?;
            opening(recorder, &views, element, [Foreground, WorkA, WorkB])?;
            closing(recorder, &views, element, [Foreground, WorkA, WorkC])
        });
        let mut expect = |operation: fn(&mut Morphology, &mut BitImage, Element)| {
            let mut expected = image.clone();
            operation(&mut twin, &mut expected, element);
            expected
        };
        prop_assert_eq!(bench.get(Near), expect(Morphology::dilate));
        prop_assert_eq!(bench.get(Edges), expect(Morphology::erode));
        prop_assert_eq!(bench.get(WorkB), expect(Morphology::open));
        prop_assert_eq!(bench.get(WorkC), expect(Morphology::close));
        Ok(())
    });
    drop(device);
    assert_eq!(log.messages(), Vec::<String>::new());
}

#[test]
fn components_are_the_processor_s() {
    let Some((device, log)) = device("components_are_the_processor_s", DeviceSettings::default()) else { return };
    // A long way round: every row of a comb hangs on the next by one pixel.
    let comb = BitImage::from_fn(190, 77, |x, y| y % 2 == 0 || x == if y % 4 == 1 { 189 } else { 0 });
    let mut images: Vec<_> = [20, 100, 128, 160, 240]
        .iter()
        .map(|&density| noise(333, 141, density, density))
        .chain([comb, BitImage::new(40, 9), noise(64, 5, 256, 1), noise(1, 1, 256, 1), noise(1, 200, 150, 3)])
        .collect();
    let mut inverse = images[5].clone();
    inverse.invert();
    images.push(inverse);
    // Squares of equal size: the first in reading order stay.
    images.push(BitImage::from_fn(200, 60, |x, y| x % 20 < 7 && y % 20 < 7));
    let choices = [
        Keep::Touched,
        Keep::Holes(0),
        Keep::Holes(3),
        Keep::Holes(100_000),
        Keep::Largest { count: 4, min_area: 3, min_share: 0.1, max_cover: 1.0 },
        Keep::Largest { count: 2, min_area: 0, min_share: 0.0, max_cover: 0.5 },
        Keep::Largest { count: 4, min_area: 10_000, min_share: 1.0, max_cover: 0.8 },
    ];
    for keep in choices {
        for image in &images {
            let (width, height) = (image.width(), image.height());
            let strong = noise(width, height, 3, 9);
            let bench = Bench::new(&device, width, height);
            bench.put(Plane::WorkA, image);
            bench.put(Plane::Strong, &strong);
            bench.run(|recorder| {
                components(recorder, &[&bench.view], keep, Plane::Strong, [Plane::WorkA, Plane::WorkB])?;
                // Once more over what the first run left behind.
                components(recorder, &[&bench.view], keep, Plane::Strong, [Plane::WorkA, Plane::WorkC])
            });
            let (mut expected, mut twin) = (image.clone(), Components::default());
            match keep {
                Keep::Touched => twin.keep_touched(&mut expected, &strong),
                Keep::Holes(most) => twin.fill_holes(&mut expected, most),
                Keep::Largest { max_cover, .. }
                    if f64::from(expected.count()) > f64::from(max_cover) * f64::from(width * height) =>
                {
                    expected.clear();
                }
                Keep::Largest { count, min_area, min_share, .. } => {
                    twin.keep_largest(&mut expected, count as usize, min_area, min_share);
                }
            }
            assert_eq!(bench.get(Plane::WorkB), expected, "{keep:?}, {width} x {height}");
            assert_eq!(bench.get(Plane::WorkC), expected, "{keep:?}, {width} x {height}, again");
        }
    }
    drop(device);
    assert_eq!(log.messages(), Vec::<String>::new());
}

#[test]
fn bounds_are_the_processor_s() {
    let Some((device, log)) = device("bounds_are_the_processor_s", DeviceSettings::default()) else { return };
    for image in [
        BitImage::new(70, 30),
        BitImage::from_fn(70, 30, |x, y| (x, y) == (69, 0)),
        BitImage::from_fn(170, 130, |x, y| (33..165).contains(&x) && (7..9).contains(&y)),
        noise(170, 130, 1, 4),
    ] {
        let bench = Bench::new(&device, image.width(), image.height());
        bench.put(Plane::Silhouette, &image);
        bench.run(|recorder| bounds(recorder, &[&bench.view], Plane::Silhouette));
        let sides: [u32; 4] = bench.read(&bench.view.sides).try_into().unwrap();
        assert_eq!(region(sides, image.width(), image.height()), image.bounds());
    }
    drop(device);
    assert_eq!(log.messages(), Vec::<String>::new());
}

/// A room, and a picture of it in other light with something in it.
fn plate_and_picture(width: u32, height: u32, seed: u32) -> [RgbImage; 2] {
    let plate = RgbImage::from_fn(width, height, |x, y| {
        Rgb([0, 1, 2].map(|c: u32| (hash(x / 9, y / 7, c) % 230 + hash(x, y, c) % 20) as u8))
    });
    let picture = RgbImage::from_fn(width, height, |x, y| {
        let light = [0.9, 1.05, 0.8][(seed % 3) as usize] * if (x / 30).is_multiple_of(3) { 0.7 } else { 1.0 };
        let seen = plate.get_pixel(x, y).0.map(|value| (f32::from(value) * light).min(255.0) as u8);
        let block = hash(x / 20, y / 20, seed);
        Rgb(if block.is_multiple_of(4) { [block >> 8, block >> 16, block >> 24].map(|v| v as u8) } else { seen })
    });
    [plate, picture]
}

#[test]
fn differences_from_the_plate_are_the_processor_s() {
    let Some((device, log)) = device("differences_from_the_plate_are_the_processor_s", DeviceSettings::default())
    else {
        return;
    };
    for (case, (width, height)) in [(301, 157), (64, 40), (3, 2), (1, 5), (130, 3)].into_iter().enumerate() {
        let [plate, picture] = plate_and_picture(width, height, case as u32);
        let mut twin = Plate::new(plate.clone());
        let bench = Bench::with(&device, [width, height], Some(&plate), &MixtureSettings::default());
        bench.show(&picture);
        for (settings, shadow) in [
            (PlateSettings::default(), ShadowSettings::default()),
            (
                PlateSettings { weak: 5.0, strong: 9.5, faint: 60.0, ..Default::default() },
                ShadowSettings { chroma: 20.0, darkest: 0.7, brightest: 1.0, ..Default::default() },
            ),
            (PlateSettings::default(), ShadowSettings { suppress: false, ..Default::default() }),
        ] {
            bench.run(|recorder| {
                ratios(recorder, &[&bench.view])?;
                difference(recorder, &[&bench.view], &settings, &shadow)
            });
            let gain = twin.gain(&picture);
            assert_eq!(bench.read(&bench.view.light.gains), gain.map(|gain| (gain * 128.0) as u32));
            let [mut weak, mut strong, mut faint] = [0; 3].map(|_| BitImage::new(width, height));
            let mut row = DifferenceRow::new(width as usize);
            for (y, rgb) in picture.as_raw().chunks_exact(width as usize * 3).enumerate() {
                twin.compare_row(y, rgb, gain, &settings, &shadow, &mut row);
                weak.pack_row(y, &row.weak);
                strong.pack_row(y, &row.strong);
                faint.pack_row(y, &row.faint);
            }
            assert!(width < 100 || weak.count() > 0, "nothing differs");
            assert_eq!(bench.get(Plane::Foreground), weak, "{width} x {height}, {settings:?}, {shadow:?}");
            assert_eq!(bench.get(Plane::Strong), strong);
            assert_eq!(bench.get(Plane::Faint), faint);
        }
    }
    drop(device);
    assert_eq!(log.messages(), Vec::<String>::new());
}

#[test]
fn bridges_are_what_a_closing_adds_where_it_differs_faintly() {
    let Some((device, log)) = device("bridges_are_what_a_closing_adds", DeviceSettings::default()) else { return };
    let [from, closed, faint] = [1, 2, 3].map(|seed| noise(130, 21, 90, seed));
    let bench = Bench::new(&device, 130, 21);
    for (plane, image) in [(Plane::WorkA, &from), (Plane::WorkC, &closed), (Plane::Faint, &faint)] {
        bench.put(plane, image);
    }
    bench.run(|recorder| bridge(recorder, &[&bench.view], [Plane::WorkA, Plane::WorkC, Plane::WorkB]));
    let mut expected = closed;
    expected.and(&faint);
    expected.or(&from);
    assert_eq!(bench.get(Plane::WorkB), expected);
    drop((device, bench));
    assert_eq!(log.messages(), Vec::<String>::new());
}

/// A noisy room with a flickering lamp, in light that changes, and from frame 8 on a block that moves.
fn scene(width: u32, height: u32, frame: u32) -> RgbImage {
    let light = if frame > 12 { 0.75 } else { 1.0 };
    RgbImage::from_fn(width, height, |x, y| {
        let base = match (frame >= 8 && (frame * 3..frame * 3 + 12).contains(&x) && y % 16 < 11, x >= width / 2) {
            (true, _) => [210, 60, 40],
            (false, true) if frame.is_multiple_of(3) => [60, 160, 60],
            (false, true) => [60, 60, 160],
            (false, false) => [90 + x % 90, 120, 80 + y % 100],
        };
        Rgb([0, 1, 2].map(|c: u32| ((base[c as usize] + hash(x, y, frame * 3 + c) % 15) as f32 * light) as u8))
    })
}

/// So little that a picture's mixtures need several bands.
fn several_bands(capabilities: &mut Capabilities) {
    capabilities.max_storage = 80_000;
}

/// That the device's mixtures and flags are the processor's over a scene.
fn check_mixtures(device: &Device, size: [u32; 2], settings: MixtureSettings) {
    let [width, height] = size;
    let shadow = ShadowSettings::default();
    let bench = Bench::with(device, size, None, &settings);
    let input = Input::new(device, &bench.view).unwrap();
    let mut twin = Mixture::new(settings, width, height);
    let (mut flags, mut expected) = (vec![0; (width * height) as usize], BitImage::new(width, height));
    let mut found = 0;
    for frame in 0..20 {
        let picture = scene(width, height, frame);
        twin.update(&picture, &shadow, &mut flags);
        flags.chunks_exact(width as usize).enumerate().for_each(|(y, flags)| expected.pack_row(y, flags));
        bench.show(&picture);
        let rates = Rates { alpha: settings.rate(frame), first: u32::from(frame == 0) };
        input.rates.write(0, &[rates]).unwrap();
        bench.run(|recorder| {
            if settings.gain {
                probable(recorder, &[&bench.view], &settings)?;
                ratios(recorder, &[&bench.view])?;
            }
            mixture(recorder, &[&bench.view], &[&input.rates], &settings, &shadow)
        });
        found += expected.count();
        assert_eq!(bench.get(Plane::Foreground), expected, "frame {frame}, {settings:?}");
    }
    assert!(found > 0, "nothing is foreground: {settings:?}");
    for band in bench.view.bands() {
        let state = bench.read(&band.state);
        let pixels = (width * band.rows) as usize;
        for (at, &bits) in state.iter().enumerate() {
            let (k, field) = (at / pixels / MIXTURE_FIELDS as usize, at / pixels % MIXTURE_FIELDS as usize);
            let (x, y) = (at % pixels % width as usize, at % pixels / width as usize + band.first_row as usize);
            assert_eq!(
                bits,
                twin.value(x, y, k, field).to_bits(),
                "component {k}, field {field} at {x}, {y}: {settings:?}"
            );
        }
    }
}

#[test]
fn mixtures_are_the_processor_s() {
    let base = MixtureSettings { warm_up: 6, learning_rate: 0.05, ..Default::default() };
    for (lower, code) in
        [(None, None), (None, Some(rough as Change)), (Some(several_bands as fn(&mut Capabilities)), None)]
    {
        let settings = DeviceSettings { lower, code, ..Default::default() };
        let Some((device, log)) = device("mixtures_are_the_processor_s", settings) else { return };
        for (components, gain, size) in
            [(3, false, [131, 33]), (4, true, [70, 40]), (5, true, [131, 33]), (3, true, [5, 3])]
        {
            let settings = MixtureSettings { components, gain, ..base };
            check_mixtures(&device, [size[0].max(60), size[1].max(20)], settings);
        }
        let strict =
            MixtureSettings { match_sigma: 1.0, background_weight: 0.4, min_sigma: 2.0, initial_sigma: 4.0, ..base };
        check_mixtures(&device, [80, 32], strict);
        let density = MixtureSettings { adaptation: Adaptation::Density, learning_rate: 0.5, ..base };
        check_mixtures(&device, [131, 33], density);
        drop(device);
        assert_eq!(log.messages(), Vec::<String>::new());
    }
}

#[test]
fn canny_is_the_processor_s() {
    let Some((device, log)) = device("canny_is_the_processor_s", DeviceSettings::default()) else { return };
    let [_, picture] = plate_and_picture(201, 99, 5);
    let near = BitImage::from_fn(201, 99, |x, y| x.abs_diff(90).pow(2) + y.abs_diff(45).pow(2) < 6000);
    let bench = Bench::new(&device, 201, 99);
    bench.show(&picture);
    bench.put(Plane::Near, &near);
    for magnitude in [Magnitude::Exact, Magnitude::Sum, Magnitude::Max] {
        for (low, threshold) in [(35, 70), (1, 150), (20, 250), (100, 100)] {
            let settings = EdgeSettings { operator: Operator::Canny, magnitude, low, threshold, ..Default::default() };
            bench.run(|recorder| {
                smooth(recorder, &[&bench.view], true)?;
                edges(recorder, &[&bench.view], &settings)
            });
            let mut expected = BitImage::new(201, 99);
            EdgeDetector::default().detect(&picture, &near, &settings, &mut expected);
            assert!(expected.count() > 0);
            assert_eq!(bench.get(Plane::Edges), expected, "{settings:?}");
        }
    }
    drop((bench, device));
    assert_eq!(log.messages(), Vec::<String>::new());
}
