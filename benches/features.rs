//! The stages of `pantin::features`, ids as their files are named: one view of 640 x 480 pixels each; and the whole extractor
//! with four such views, with every edge operator and metric, and with one view of 1920 x 1080; and on a Vulkan device, where there is
//! one.
#![allow(missing_docs, reason = "criterion_group! makes an undocumented function")]
#![allow(clippy::print_stdout, reason = "passes on a device are no criterion measurement")]

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use image::{Rgb, RgbImage};
use pantin::features::blobs::Components;
use pantin::features::edges::EdgeDetector;
use pantin::features::mixture::Mixture;
use pantin::features::morphology::{Element, Morphology};
use pantin::features::plate::Plate;
use pantin::features::{
    BitImage, DistanceMap, EdgeSettings, Extractor, FeatureSettings, Metric, Operator, Shape, ViewFeatures, ViewSource,
};
use pantin::gpu::{Device, DeviceSettings, Instance, Validation, by_name};

const WIDTH: u32 = 640;
const HEIGHT: u32 = 480;

fn room(width: u32, height: u32) -> RgbImage {
    RgbImage::from_fn(width, height, |x, y| {
        let noise = (x.wrapping_mul(2_654_435_761) ^ y.wrapping_mul(2_246_822_519)) >> 28;
        Rgb([(80 + x / 8 % 90 + noise) as u8, (90 + y / 4 % 70 + noise) as u8, ((x / 20 + y / 15) % 2 * 60 + 70) as u8])
    })
}

/// Head, trunk, arms and legs, six tenths of the picture's height.
fn person(x: u32, y: u32, width: u32, height: u32) -> bool {
    // In a picture 270 pixels high.
    let (x, y) = ((x * 270 / height + 240).saturating_sub(width * 135 / height), y * 270 / height);
    let (dx, dy) = (x.abs_diff(240), y.abs_diff(75));
    dx * dx + dy * dy < 120
        || (86..140).contains(&y) && dx < 16
        || (90..98).contains(&y) && dx < 60
        || (140..220).contains(&y) && (3..13).contains(&dx)
}

fn picture(width: u32, height: u32) -> RgbImage {
    let mut picture = room(width, height);
    for (x, y, pixel) in picture.enumerate_pixels_mut() {
        if person(x, y, width, height) {
            *pixel = Rgb([210, (150 + y % 17) as u8, 120]);
        }
    }
    picture
}

fn stages(criterion: &mut Criterion) {
    let settings = FeatureSettings::default();
    let (room, picture) = (room(WIDTH, HEIGHT), picture(WIDTH, HEIGHT));
    let silhouette = BitImage::from_fn(WIDTH, HEIGHT, |x, y| person(x, y, WIDTH, HEIGHT));

    let plate = Plate::new(room.clone());
    criterion.bench_function("gain", |b| b.iter(|| plate.gain(black_box(&picture))));
    let mut mixture = Mixture::new(settings.mixture, WIDTH, HEIGHT);
    let mut flags = vec![0; (WIDTH * HEIGHT) as usize];
    mixture.update(&room, &settings.shadow, &mut flags);
    criterion.bench_function("mixture", |b| {
        b.iter(|| mixture.update(black_box(&picture), &settings.shadow, &mut flags));
    });
    let mut morphology = Morphology::default();
    let mut cleaned = silhouette.clone();
    criterion.bench_function("morphology", |b| {
        b.iter(|| {
            cleaned.clone_from(black_box(&silhouette));
            morphology.open(&mut cleaned, Element { shape: Shape::Disc, radius: 1 });
            morphology.close(&mut cleaned, Element { shape: Shape::Disc, radius: 2 });
        });
    });
    let mut components = Components::default();
    criterion.bench_function("blobs", |b| {
        b.iter(|| {
            cleaned.clone_from(black_box(&silhouette));
            components.keep_largest(&mut cleaned, 4, 60, 0.03);
            components.fill_holes(&mut cleaned, 60);
        });
    });
    let mut detector = EdgeDetector::default();
    let mut edges = BitImage::new(WIDTH, HEIGHT);
    let whole = BitImage::from_fn(WIDTH, HEIGHT, |_, _| true);
    for operator in Operator::ALL {
        let edge_settings = EdgeSettings { operator, ..settings.edges };
        criterion.bench_function(&format!("edges, {operator}"), |b| {
            b.iter(|| detector.detect(black_box(&picture), &whole, &edge_settings, &mut edges));
        });
    }
    edges = silhouette.clone();
    let mut distance = DistanceMap::default();
    for metric in Metric::ALL {
        criterion.bench_function(&format!("distance, {metric}"), |b| {
            b.iter(|| distance.measure(black_box(&edges), metric, 16));
        });
    }
}

/// Whole frames of `views` equal views.
fn frames(criterion: &mut Criterion, id: &str, settings: FeatureSettings, plate: bool, views: usize, size: [u32; 2]) {
    let [width, height] = size;
    let (room, picture) = (room(width, height), picture(width, height));
    let sources = vec![ViewSource { width, height, plate: plate.then(|| room.clone()) }; views];
    let Ok(mut extractor) = Extractor::new(settings, sources) else { unreachable!("the settings are sound") };
    let (empty, seen, masks) = (vec![room; views], vec![picture; views], vec![None; views]);
    let mut features: Vec<ViewFeatures> = Vec::new();
    let primed = extractor.prime(&empty);
    assert!(primed.is_ok() && extractor.extract_into(&seen, &masks, &mut features).is_ok());
    let expected = BitImage::from_fn(width, height, |x, y| person(x, y, width, height)).count();
    let found: Vec<u32> = features.iter().map(|view| view.silhouette.count()).collect();
    assert!(
        found.iter().all(|&area| area.abs_diff(expected) < expected / 5),
        "person not found: {found:?}, {expected}"
    );
    criterion.bench_function(id, |b| b.iter(|| extractor.extract_into(black_box(&seen), &masks, &mut features)));
}

fn whole_frames(criterion: &mut Criterion) {
    let settings = FeatureSettings::default;
    let (small, large) = ([WIDTH, HEIGHT], [1920, 1080]);
    frames(criterion, "four views, plate", settings(), true, 4, small);
    frames(criterion, "four views, mixture", settings(), false, 4, small);
    let mut dear = settings();
    dear.edges.operator = Operator::Canny;
    dear.distance.metric = Metric::Euclidean;
    frames(criterion, "four views, plate, canny, euclidean", dear, true, 4, small);
    frames(criterion, "one view, plate", settings(), true, 1, small);
    frames(criterion, "one view of 1920 x 1080, plate", settings(), true, 1, large);
    frames(criterion, "one view of 1920 x 1080, mixture", settings(), false, 1, large);
}

/// Frames on the first Vulkan device beside the same on the processor, and where the device's time goes: the median of each pass by
/// its own timestamps, printed.
fn device_frames(criterion: &mut Criterion) {
    let opened =
        Instance::open(Validation::Off).and_then(|instance| Device::open(&instance, DeviceSettings::default()));
    let Ok(device) = opened else { return println!("no device: frames on a device are not measured") };
    for (id, operator, plate) in [
        ("device, four views, plate", Operator::Sobel, true),
        ("device, four views, mixture", Operator::Sobel, false),
        ("device, four views, plate, canny", Operator::Canny, true),
    ] {
        let mut settings = FeatureSettings::default();
        settings.edges.operator = operator;
        let (room, picture) = (room(WIDTH, HEIGHT), picture(WIDTH, HEIGHT));
        let sources = vec![ViewSource { width: WIDTH, height: HEIGHT, plate: plate.then(|| room.clone()) }; 4];
        let Ok(mut extractor) = Extractor::on_device(settings, sources, &device) else { unreachable!("it fits") };
        let (empty, seen, masks) = (vec![room; 4], vec![picture; 4], vec![None; 4]);
        let mut features: Vec<ViewFeatures> = Vec::new();
        assert!(extractor.prime(&empty).is_ok());
        criterion.bench_function(id, |b| b.iter(|| extractor.extract_into(black_box(&seen), &masks, &mut features)));
        extractor.measure_passes();
        let mut rounds: Vec<Vec<(String, f64, usize)>> = Vec::new();
        for _ in 0..9 {
            assert!(extractor.extract_into(&seen, &masks, &mut features).is_ok());
            rounds.extend(extractor.passes().map(|passes| by_name(&passes)));
        }
        for (place, (name, ..)) in rounds[0].iter().enumerate() {
            let mut times: Vec<f64> = rounds.iter().map(|round| round[place].1).collect();
            times.sort_by(f64::total_cmp);
            println!("{id}: {name} {:.3} ms", times[times.len() / 2]);
        }
    }
}

criterion_group!(features, stages, whole_frames, device_frames);
criterion_main!(features);
