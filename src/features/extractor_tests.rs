//! The features of small pictures, view by view.

use std::sync::Arc;

use image::{GrayImage, Luma, Rgb, RgbImage};

use super::{
    BitImage, DistanceMap, Extractor, FeatureSettings, Metric, Observation, Region, Shape, ViewFeatures, ViewSource,
};

fn room(width: u32, height: u32) -> RgbImage {
    RgbImage::from_fn(width, height, |x, y| Rgb([(90 + x % 40) as u8, (110 + y % 30) as u8, 100]))
}

fn person(x: u32, y: u32) -> bool {
    (30..46).contains(&x) && (10..50).contains(&y)
}

fn picture(width: u32, height: u32) -> RgbImage {
    let mut picture = room(width, height);
    for (x, y, pixel) in picture.enumerate_pixels_mut() {
        if person(x, y) {
            *pixel = Rgb([250, 150, 120]);
        } else if (46..60).contains(&x) && (48..52).contains(&y) {
            // A shadow on the floor.
            *pixel = Rgb(pixel.0.map(|v| (f32::from(v) * 0.75) as u8));
        } else if (x, y) == (5, 5) {
            // A speck.
            *pixel = Rgb([255; 3]);
        }
    }
    picture
}

fn source(plate: bool) -> ViewSource {
    ViewSource { width: 90, height: 60, plate: plate.then(|| room(90, 60)) }
}

fn settings() -> FeatureSettings {
    let mut settings = FeatureSettings::default();
    // A square element keeps the test's square person's corners.
    settings.silhouette.element = Shape::Square;
    settings
}

#[test]
fn plate_mixture_and_mask_give_the_same_silhouette() {
    let mut extractor = Extractor::new(settings(), vec![source(true), source(false), source(false)]).unwrap();
    for _ in 0..20 {
        extractor.prime(&[room(90, 60), room(90, 60), room(90, 60)]).unwrap();
    }
    let mask = GrayImage::from_fn(90, 60, |x, y| Luma([if person(x, y) { 200 } else { 90 }]));
    let pictures = [picture(90, 60), picture(90, 60), picture(90, 60)];
    let mut features = extractor.extract(&pictures, &[None, None, Some(mask)]).unwrap();
    let expected = BitImage::from_fn(90, 60, person);
    for (view, features) in features.iter().enumerate() {
        assert_eq!(features.silhouette, expected, "view {view}");
        assert_eq!(features.region, Region { x0: 14, y0: 0, x1: 62, y1: 60 });
        assert_eq!(features.observation.silhouette(), expected);
        assert_eq!(features.observation.proximity().get_pixel(30, 30), &Luma([127]), "on the outline");
        assert_eq!(features.observation.proximity().get_pixel(85, 30), &Luma([0]), "far away");
        assert!(features.edges.get(30, 30) && !features.edges.get(38, 30) && !features.edges.get(5, 5));
    }
    // A pixel more in the mask must show.
    let changed = GrayImage::from_fn(90, 60, |x, y| Luma([if person(x, y) || x == 46 && y == 20 { 128 } else { 0 }]));
    extractor.extract_into(&pictures, &[None, None, Some(changed)], &mut features).unwrap();
    assert_eq!(features[0].silhouette, expected);
    assert_ne!(features[2].silhouette, expected);
    assert_eq!(features[2].observation.area(), expected.count() + 1);
}

#[test]
fn buffers_of_another_frame_leave_no_trace() {
    let mut extractor = Extractor::new(settings(), vec![source(true), source(true)]).unwrap();
    let pictures = [picture(90, 60), picture(90, 60)];
    let fresh = extractor.extract(&pictures, &[None, None]).unwrap();
    let mut used = vec![ViewFeatures::empty(3, 200), ViewFeatures::empty(90, 60), ViewFeatures::empty(1, 1)];
    extractor.extract_into(&[RgbImage::new(90, 60), room(90, 60)], &[None, None], &mut used).unwrap();
    extractor.extract_into(&pictures, &[None, None], &mut used).unwrap();
    assert_eq!(used.len(), 2);
    for (used, fresh) in used.iter().zip(&fresh) {
        assert_eq!(used.observation, fresh.observation);
        assert_eq!((&used.silhouette, used.region), (&fresh.silhouette, fresh.region));
    }
}

#[test]
fn black_pictures_and_empty_scenes_are_nothing_to_see() {
    let black = RgbImage::new(90, 60);
    let source = ViewSource { plate: Some(black.clone()), ..source(true) };
    let mut extractor = Extractor::new(settings(), vec![source]).unwrap();
    let features = extractor.extract(&[black], &[None]).unwrap();
    assert_eq!(features[0].observation, Observation::empty(90, 60));
    assert_eq!(features[0].region, Region::whole(90, 60));
}

#[test]
fn a_camera_that_is_off_sees_nobody() {
    let mut extractor = Extractor::new(settings(), vec![source(true), source(true)]).unwrap();
    let features = extractor.extract(&[RgbImage::new(90, 60), picture(90, 60)], &[None, None]).unwrap();
    assert!(features[0].foreground.count() > 5000, "what was found can still be looked at");
    assert_eq!(features[0].observation, Observation::empty(90, 60));
    assert_eq!(features[1].silhouette, BitImage::from_fn(90, 60, person));
    let mut everything = settings();
    everything.silhouette.max_cover = 1.0;
    let mut extractor = Extractor::new(everything, vec![source(true)]).unwrap();
    assert!(extractor.extract(&[RgbImage::new(90, 60)], &[None]).unwrap()[0].observation.area() > 5000);
}

#[test]
fn a_picture_of_3840_by_2160_is_seen_whole() {
    let (width, height) = (3840, 2160);
    let body = |x: u32, y: u32| (3000..3400).contains(&x) && (400..2100).contains(&y);
    let mut seen = room(width, height);
    for (x, y, pixel) in seen.enumerate_pixels_mut() {
        if body(x, y) {
            *pixel = Rgb([250, 150, 120]);
        }
    }
    let mut settings = settings();
    settings.distance.metric = Metric::Euclidean;
    settings.proximity.d_max = 255;
    let source = ViewSource { width, height, plate: Some(room(width, height)) };
    let features = Extractor::new(settings, vec![source]).unwrap().extract(&[seen], &[None]).unwrap();
    assert_eq!(features[0].silhouette, BitImage::from_fn(width, height, body));
    let distances = features[0].distance.distances();
    let at = |x: u32, y: u32| distances[(y * width + x) as usize];
    // The outermost edge pixels lie one outside the body; the room has a few of its own beside it.
    assert_eq!((at(2999, 1000), at(2000, 1000)), (0.0, 255.0));
    assert!((at(2900, 1000) - 99.0).abs() < 4.0, "{}", at(2900, 1000));
    assert!((at(2979, 389) - 10_f32.hypot(20.0)).abs() < 4.0, "{}", at(2979, 389));
}

#[test]
fn one_pixel_is_a_picture() {
    let source = ViewSource { width: 1, height: 1, plate: Some(RgbImage::new(1, 1)) };
    let mut extractor = Extractor::new(settings(), vec![source]).unwrap();
    let white = GrayImage::from_pixel(1, 1, Luma([255]));
    let features = extractor.extract(&[RgbImage::new(1, 1)], &[Some(white)]).unwrap();
    assert_eq!(features[0].observation.bytes, [0x80]);
}

/// Nothing is seen in ignored pixels, and no edge in them is near a pixel that counts.
#[test]
fn edges_of_what_is_ignored_are_near_nothing() {
    let mut extractor = Extractor::new(settings(), vec![source(true)]).unwrap();
    let mut features = extractor.extract(&[picture(90, 60)], &[None]).unwrap();
    let all = features[0].clone();
    assert!(all.edges.get(46, 20) || all.edges.get(45, 20), "an edge on the right side");
    let ignored = Arc::new(BitImage::from_fn(90, 60, |x, _| (40..50).contains(&x)));
    extractor.ignore(&mut features, &[Some(Arc::clone(&ignored))]).unwrap();
    let found = &features[0];
    assert_eq!(found.observation.area(), all.silhouette.count() - 6 * 40);
    assert_eq!(found.region.x1, 40 + settings().silhouette.motion);
    let mut edges = all.edges.clone();
    edges.and_not(&ignored);
    let mut distance = DistanceMap::default();
    distance.measure(&edges, settings().distance.metric, settings().proximity.limit());
    assert_eq!(found.distance.distances(), distance.distances());
    // Right of what is ignored it was near an edge before.
    let near = |features: &ViewFeatures| features.observation.bytes[20 * 90 + 50] & Observation::PROXIMITY;
    assert!(near(&all) > 90 && near(found) < 50, "{} and {}", near(&all), near(found));
    assert_eq!(found.observation.ignored.as_deref(), Some(&*ignored));
    // The next frame begins anew.
    extractor.extract_into(&[picture(90, 60)], &[None], &mut features).unwrap();
    assert_eq!(features[0].observation, all.observation);
    let error = extractor.ignore(&mut features, &[]).unwrap_err().to_string();
    assert!(error.contains("1 views were given 0 masks"), "{error}");
    let error = extractor.ignore(&mut features, &[Some(Arc::new(BitImage::new(60, 90)))]).unwrap_err().to_string();
    assert!(error.contains("60 x 90") && error.contains("90 x 60"), "{error}");
}

#[test]
fn bad_inputs_are_clear_sentences() {
    let wrong = |settings: FeatureSettings, views: Vec<ViewSource>| {
        format!("{:#}", Extractor::new(settings, views).err().unwrap())
    };
    assert!(wrong(settings(), vec![]).contains("at least one view"));
    let empty = ViewSource { width: 0, height: 60, plate: None };
    assert!(wrong(settings(), vec![source(true), empty]).contains("view 1 is 0 x 60"));
    let huge = ViewSource { width: u32::MAX, height: u32::MAX, plate: None };
    assert!(wrong(settings(), vec![huge]).contains("16384"));
    let plate = ViewSource { plate: Some(room(91, 60)), ..source(true) };
    assert!(wrong(settings(), vec![plate]).contains("plate of view 0 is 91 x 60 pixels, expected 90 x 60"));
    let mut k = settings();
    k.mixture.components = 7;
    assert!(wrong(k, vec![source(true)]).contains("mixture.components is 7"));

    let mut extractor = Extractor::new(settings(), vec![source(true), source(false)]).unwrap();
    let good = room(90, 60);
    let mut failed = |pictures: &[RgbImage], masks: &[Option<GrayImage>]| {
        format!("{:#}", extractor.extract(pictures, masks).unwrap_err())
    };
    assert!(failed(std::slice::from_ref(&good), &[None, None]).contains("1 pictures"));
    assert!(failed(&[good.clone(), good.clone()], &[None]).contains("1 masks"));
    let error = failed(&[good.clone(), room(60, 90)], &[None, None]);
    assert!(error.contains("picture of view 1 is 60 x 90 pixels, expected 90 x 60"), "{error}");
    let error = failed(&[good.clone(), good.clone()], &[Some(GrayImage::new(0, 0)), None]);
    assert!(error.contains("mask of view 0 is 0 x 0"), "{error}");
    assert!(extractor.prime(&[good]).is_err());
}
