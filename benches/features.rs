//! The stages of `pantin::features`, ids as their files are named: one view of 640 x 480 pixels each; and the whole extractor
//! with four such views, with every edge operator and metric, and with one view of 1920 x 1080; and on a Vulkan device, where there is
//! one.
#![allow(clippy::unwrap_used, clippy::print_stdout, reason = "a benchmark ends where something fails, and prints")]

mod table;

use std::hint::black_box;

use image::{Rgb, RgbImage};
use pantin::bench::medians;
use pantin::body::Body;
use pantin::features::blobs::Components;
use pantin::features::edges::EdgeDetector;
use pantin::features::mixture::Mixture;
use pantin::features::morphology::{Element, Morphology};
use pantin::features::plate::Plate;
use pantin::features::{
    BitImage, DistanceMap, EdgeSettings, Extractor, FeatureSettings, Metric, Operator, SeenView, Shape, ViewFeatures,
    ViewSource,
};
use pantin::gpu::{Device, DeviceSettings, Instance, Validation, by_name};
use pantin::observe::{Appearance, Lesson, SeenColours};
use table::{Table, in_a_line, is_wanted};

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

fn stages() {
    let settings = FeatureSettings::default();
    let (room, picture) = (room(WIDTH, HEIGHT), picture(WIDTH, HEIGHT));
    let silhouette = BitImage::from_fn(WIDTH, HEIGHT, |x, y| person(x, y, WIDTH, HEIGHT));
    let whole = BitImage::from_fn(WIDTH, HEIGHT, |_, _| true);
    let pixels = (WIDTH * HEIGHT) as usize;
    let plate = Plate::new(room.clone());
    let mut mixture = Mixture::new(settings.mixture, WIDTH, HEIGHT);
    let mut flags = vec![0; pixels];
    mixture.update(&room, &settings.shadow, &mut flags);
    let (mut morphology, mut cleaned) = (Morphology::default(), silhouette.clone());
    let (mut components, mut blobs) = (Components::default(), silhouette.clone());

    let mut table = Table::new("one view of 640 x 480", "pixel");
    table.row("gain", pixels, || plate.gain(black_box(&picture)));
    table.row("mixture", pixels, || mixture.update(black_box(&picture), &settings.shadow, &mut flags));
    table.row("morphology", pixels, || {
        cleaned.clone_from(black_box(&silhouette));
        morphology.open(&mut cleaned, Element { shape: Shape::Disc, radius: 1 });
        morphology.close(&mut cleaned, Element { shape: Shape::Disc, radius: 2 });
    });
    table.row("blobs", pixels, || {
        blobs.clone_from(black_box(&silhouette));
        components.keep_largest(&mut blobs, 4, 60, 0.03);
        components.fill_holes(&mut blobs, 60);
    });
    for operator in Operator::ALL {
        let edge_settings = EdgeSettings { operator, ..settings.edges };
        let (mut detector, mut edges) = (EdgeDetector::default(), BitImage::new(WIDTH, HEIGHT));
        let (picture, whole) = (&picture, &whole);
        table.row(format!("edges, {operator}"), pixels, move || {
            detector.detect(black_box(picture), whole, &edge_settings, &mut edges);
        });
    }
    for metric in Metric::ALL {
        let (mut distance, silhouette) = (DistanceMap::default(), &silhouette);
        table.row(format!("distance, {metric}"), pixels, move || distance.measure(black_box(silhouette), metric, 16));
    }
    table.run();
}

/// Equal views of a size, with plates or without, before a device or none.
struct Views<'a> {
    count: usize,
    size: [u32; 2],
    plate: bool,
    device: Option<&'a Device>,
}

impl Views<'_> {
    /// An extractor that knows the room, and a frame with the person in it, who is found.
    fn extractor(&self, settings: FeatureSettings) -> (Extractor, Vec<RgbImage>) {
        let Self { count, size: [width, height], plate, device } = *self;
        let room = room(width, height);
        let sources = vec![ViewSource { width, height, plate: plate.then(|| room.clone()) }; count];
        let mut extractor = match device {
            Some(device) => Extractor::on_device(settings, sources, device).unwrap(),
            None => Extractor::new(settings, sources).unwrap(),
        };
        let (seen, mut features) = (vec![picture(width, height); count], Vec::<ViewFeatures>::new());
        extractor.prime(&vec![room; count]).unwrap();
        extractor.extract_into(&seen, &vec![None; count], &mut features).unwrap();
        let expected = BitImage::from_fn(width, height, |x, y| person(x, y, width, height)).count();
        let found: Vec<u32> = features.iter().map(|view| view.silhouette.count()).collect();
        let is_found = found.iter().all(|&area| area.abs_diff(expected) < expected / 5);
        assert!(is_found, "person not found: {found:?}, {expected}");
        (extractor, seen)
    }

    /// A row of whole frames.
    fn row(&self, table: &mut Table<'_>, id: &str, settings: FeatureSettings) {
        if is_wanted(id) {
            let (mut extractor, seen) = self.extractor(settings);
            let (masks, mut features) = (vec![None; seen.len()], Vec::<ViewFeatures>::new());
            table.row(id, seen.len(), move || extractor.extract_into(black_box(&seen), &masks, &mut features).unwrap());
        }
    }
}

/// Frames on the processor, and on the first Vulkan device with where its time goes: the median of each pass by its own
/// timestamps.
fn whole_frames() {
    let with = |operator, metric| {
        let mut settings = FeatureSettings::default();
        settings.edges.operator = operator;
        settings.distance.metric = metric;
        settings
    };
    let FeatureSettings { edges: EdgeSettings { operator, .. }, distance, .. } = FeatureSettings::default();
    let usual = || with(operator, distance.metric);
    let (small, large) = ([WIDTH, HEIGHT], [1920, 1080]);
    let views = |count, size, plate| Views { count, size, plate, device: None };
    let mut table = Table::new("whole frames", "view");
    views(4, small, true).row(&mut table, "four views, plate", usual());
    views(4, small, true).row(
        &mut table,
        "four views, plate, likelihoods",
        FeatureSettings { likelihoods: true, ..usual() },
    );
    evidence(&mut table);
    views(4, small, false).row(&mut table, "four views, mixture", usual());
    let dear = with(Operator::Canny, Metric::Euclidean);
    views(4, small, true).row(&mut table, "four views, plate, canny, euclidean", dear);
    views(1, small, true).row(&mut table, "one view, plate", usual());
    views(1, large, true).row(&mut table, "one view of 1920 x 1080, plate", usual());
    views(1, large, false).row(&mut table, "one view of 1920 x 1080, mixture", usual());

    let device =
        Instance::open(Validation::Off).and_then(|instance| Device::open(&instance, DeviceSettings::default()));
    match &device {
        Ok(device) => {
            for (id, operator, plate) in [
                ("device, four views, plate", Operator::Sobel, true),
                ("device, four views, mixture", Operator::Sobel, false),
                ("device, four views, plate, canny", Operator::Canny, true),
            ] {
                let views = Views { count: 4, size: small, plate, device: Some(device) };
                let settings = || with(operator, distance.metric);
                views.row(&mut table, id, settings());
                if is_wanted(id) {
                    println!("{id}: {}", in_a_line(&passes(views.extractor(settings()))));
                }
            }
        }
        Err(error) => println!("SKIPPED frames on a device: {error:#}"),
    }
    table.run();
}

/// A row of the evidence of four views, of a person whose parts have eight colours.
fn evidence(table: &mut Table<'_>) {
    let id = "four views, evidence";
    if !is_wanted(id) {
        return;
    }
    let part = |y: u32| y * 8 / HEIGHT;
    let mut seen = room(WIDTH, HEIGHT);
    let mut drawn = vec![0; (WIDTH * HEIGHT) as usize];
    for ((x, y, pixel), drawn) in seen.enumerate_pixels_mut().zip(&mut drawn) {
        if person(x, y, WIDTH, HEIGHT) {
            *pixel = Rgb([200, 40, 90 + 10 * part(y)].map(|channel| (channel ^ (part(y) * 0x50)) as u8));
            *drawn = 1 + part(y) as u8;
        }
    }
    let settings = FeatureSettings { likelihoods: true, ..FeatureSettings::default() };
    let plate = Some(room(WIDTH, HEIGHT));
    let mut extractor = Extractor::new(settings, vec![ViewSource { width: WIDTH, height: HEIGHT, plate }; 4]).unwrap();
    let features = extractor.extract(&vec![seen; 4], &vec![None; 4]).unwrap();
    let (mut observations, likelihoods): (Vec<_>, Vec<_>) =
        features.into_iter().map(|view| (view.observation, view.likelihood.unwrap())).unzip();
    let mut appearance = Appearance::new(&Body::adult(1750.0).unwrap());
    let seen = SeenView::all(&observations)[0];
    let lesson = Lesson { drawn: &drawn, seen, colours: SeenColours::Likely(&likelihoods[0]) };
    appearance.learn(&[lesson], 1.0).unwrap();
    println!("{id}: {} classes of parts", appearance.classes().count());
    table.row(id, 4, move || appearance.give(black_box(&likelihoods), &mut observations).unwrap());
}

/// The median of each pass on the device, milliseconds.
fn passes((mut extractor, seen): (Extractor, Vec<RgbImage>)) -> Vec<(String, f64)> {
    extractor.measure_passes();
    let (masks, mut features) = (vec![None; seen.len()], Vec::<ViewFeatures>::new());
    let mut runs = Vec::new();
    for _ in 0..5 {
        extractor.extract_into(&seen, &masks, &mut features).unwrap();
        let run = extractor.passes().map(|passes| by_name(&passes)).into_iter().flatten();
        runs.push(run.map(|(name, ms, _)| (name, ms)).collect());
    }
    medians(&runs)
}

fn main() {
    stages();
    whole_frames();
}
