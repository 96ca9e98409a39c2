//! The stages of `pantin::features`, ids as their files are named: one view of 480 x 270 pixels each, and the whole
//! extractor with four.
#![allow(missing_docs, reason = "criterion_group! makes an undocumented function")]

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use image::{Rgb, RgbImage};
use pantin::features::blobs::Components;
use pantin::features::edges::EdgeDetector;
use pantin::features::mixture::Mixture;
use pantin::features::morphology::{Element, Morphology};
use pantin::features::plate::Plate;
use pantin::features::{
    BitImage, DistanceMap, Extractor, FeatureSettings, Magnitude, Region, Shape, ViewFeatures, ViewSource,
};

const WIDTH: u32 = 480;
const HEIGHT: u32 = 270;

fn room() -> RgbImage {
    RgbImage::from_fn(WIDTH, HEIGHT, |x, y| {
        let noise = (x.wrapping_mul(2_654_435_761) ^ y.wrapping_mul(2_246_822_519)) >> 28;
        Rgb([(80 + x / 8 % 90 + noise) as u8, (90 + y / 4 + noise) as u8, ((x / 20 + y / 15) % 2 * 60 + 70) as u8])
    })
}

/// Head, trunk, arms and legs, 150 pixels tall.
fn person(x: u32, y: u32) -> bool {
    let (dx, dy) = (x.abs_diff(240), y.abs_diff(75));
    dx * dx + dy * dy < 120
        || (86..140).contains(&y) && dx < 16
        || (90..98).contains(&y) && dx < 60
        || (140..220).contains(&y) && (3..13).contains(&dx)
}

fn picture() -> RgbImage {
    let mut picture = room();
    for (x, y, pixel) in picture.enumerate_pixels_mut() {
        if person(x, y) {
            *pixel = Rgb([210, (150 + y % 17) as u8, 120]);
        }
    }
    picture
}

fn stages(criterion: &mut Criterion) {
    let settings = FeatureSettings::default();
    let (room, picture) = (room(), picture());
    let silhouette = BitImage::from_fn(WIDTH, HEIGHT, person);

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
    let whole = Region::whole(WIDTH, HEIGHT);
    criterion.bench_function("edges", |b| {
        b.iter(|| detector.detect(black_box(&picture), whole, Magnitude::Exact, 70, &mut edges));
    });
    edges = silhouette.clone();
    let mut distance = DistanceMap::default();
    criterion.bench_function("distance", |b| b.iter(|| distance.measure(black_box(&edges), 16)));

    for (id, plate) in [("four views, plate", Some(room.clone())), ("four views, mixture", None)] {
        let views = vec![ViewSource { width: WIDTH, height: HEIGHT, plate }; 4];
        let Ok(mut extractor) = Extractor::new(settings, views) else { unreachable!("the defaults are sound") };
        let empty = [&room, &room, &room, &room].map(Clone::clone);
        let seen = [&picture, &picture, &picture, &picture].map(Clone::clone);
        let masks = [None, None, None, None];
        let mut features: Vec<ViewFeatures> = Vec::new();
        let primed = extractor.prime(&empty);
        assert!(primed.is_ok() && extractor.extract_into(&seen, &masks, &mut features).is_ok());
        let found: Vec<u32> = features.iter().map(|view| view.silhouette.count()).collect();
        assert!(found.iter().all(|&area| area.abs_diff(silhouette.count()) < 400), "person not found: {found:?}");
        criterion.bench_function(id, |b| b.iter(|| extractor.extract_into(black_box(&seen), &masks, &mut features)));
    }
}

criterion_group!(features, stages);
criterion_main!(features);
