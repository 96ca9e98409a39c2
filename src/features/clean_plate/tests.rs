use image::Rgb;

use super::*;

const SIZE: (u32, u32) = (96, 60);

/// Small deterministic noise, -3 to 3.
fn noise(x: u32, y: u32, frame: u32, channel: u32) -> i32 {
    let mut h = x.wrapping_mul(0x9e37_79b1) ^ y.wrapping_mul(0x85eb_ca6b) ^ frame.wrapping_mul(0xc2b2_ae35);
    h = (h ^ channel.wrapping_mul(0x27d4_eb2f)).wrapping_mul(0x2c1b_3c6d);
    h ^= h >> 15;
    h = h.wrapping_mul(0x297a_2d39);
    (h >> 16) as i32 % 4 - (h >> 20) as i32 % 4
}

fn room() -> RgbImage {
    RgbImage::from_fn(SIZE.0, SIZE.1, |x, y| {
        Rgb([(70 + x / 2) as u8, (90 + y / 2) as u8, ((x / 20 + y / 20) % 2 * 30 + 90) as u8])
    })
}

/// The person of the drawn scenes, 12 wide and 40 high, with the left side at `at`: shirt, trousers, and a head of nearly the wall's
/// colour.
fn person(x: u32, y: u32, at: u32) -> Option<[u8; 3]> {
    let inside = (at..at + 12).contains(&x) && (15..55).contains(&y);
    inside.then_some(match y {
        15..22 => [130, 120, 105],
        22..40 => [190, 40, 40],
        _ => [30, 40, 90],
    })
}

/// Pictures in which the person stands where `place` says, if anywhere, in light of `light(frame)`.
fn scene(frames: u32, place: impl Fn(u32) -> Option<u32>, light: impl Fn(u32) -> f32) -> Vec<RgbImage> {
    let room = room();
    let frame = |frame: u32| {
        RgbImage::from_fn(SIZE.0, SIZE.1, |x, y| {
            let seen = place(frame).and_then(|at| person(x, y, at)).unwrap_or(room.get_pixel(x, y).0);
            let lit = |channel: usize| (f32::from(seen[channel]) * light(frame)) as i32;
            Rgb([0, 1, 2].map(|c: usize| (lit(c) + noise(x, y, frame, c as u32)).clamp(0, 255) as u8))
        })
    };
    (0..frames).map(frame).collect()
}

fn learn(pictures: &[RgbImage]) -> LearntPlate {
    let mut passes = 0;
    let plate = LearntPlate::of(pictures, &mut || passes += 1).unwrap();
    assert_eq!(passes, PASSES);
    plate
}

/// The largest difference from the room in columns of the picture.
fn worst(plate: &RgbImage, columns: std::ops::Range<u32>) -> u8 {
    let off = |(x, y, pixel): (u32, u32, &Rgb<u8>)| {
        let known = room().get_pixel(x, y).0;
        columns.contains(&x).then(|| (0..3).map(|c| pixel[c].abs_diff(known[c])).max().unwrap_or(0))
    };
    plate.enumerate_pixels().filter_map(off).max().unwrap()
}

#[test]
fn somebody_who_stands_and_then_walks_leaves_nothing() {
    // She stands at 10 for a third of the time, the first picture among them, and walks away in the rest.
    let pictures = scene(40, |frame| Some(if frame < 12 { 10 } else { 10 + (frame - 12) * 3 }), |_| 1.0);
    let plate = learn(&pictures);
    assert!(worst(&plate.picture, 0..SIZE.0) <= 3, "{}", worst(&plate.picture, 0..SIZE.0));
    assert_eq!((plate.pictures, plate.busy), (40, 40));
    assert_eq!(plate.remarks(), Vec::<String>::new());
    let sure = |x: u32| f32::from(plate.sure.get_pixel(x, 30)[0]) / 255.0;
    assert!(sure(2) > 0.95 && (0.4..0.75).contains(&sure(15)), "{} {}", sure(2), sure(15));
}

#[test]
fn light_that_swings_is_made_good() {
    let pictures = scene(30, |frame| Some(2 * frame), |frame| 1.0 + 0.25 * (frame as f32 * 0.4).sin());
    let plate = learn(&pictures);
    // The plate stands in the light of most pictures; where nobody was, nothing else is seen.
    let [left, right] =
        [4, 90].map(|x| f32::from(plate.picture.get_pixel(x, 30)[0]) / f32::from(room().get_pixel(x, 30)[0]));
    assert!((left / right - 1.0).abs() < 0.05 && plate.doubts.is_empty(), "{left} {right} {:?}", plate.remarks());
}

#[test]
fn a_place_that_is_never_seen_empty_is_said_and_filled_in() {
    // On the spot, in clothes that flutter: the trunk always covers columns 46 to 50.
    let left = |frame: usize| (42.0 + 4.0 * (frame as f32 * 0.7).sin()) as u32;
    let mut pictures = scene(36, |frame| Some(left(frame as usize)), |_| 1.0);
    for (frame, picture) in pictures.iter_mut().enumerate() {
        for (x, y, pixel) in picture.enumerate_pixels_mut() {
            if person(x, y, left(frame)).is_some() {
                let flutter =
                    |step: usize| (40 + (frame * step + 29 * (x - left(frame)) as usize + 7 * y as usize) % 200) as u8;
                *pixel = Rgb([flutter(53), flutter(91), flutter(37)]);
            }
        }
    }
    let plate = learn(&pictures);
    let Some(doubt) = plate.doubts.iter().find(|doubt| doubt.kind == DoubtKind::NeverEmpty) else {
        panic!("{:?}", plate.remarks())
    };
    assert!(
        doubt.bounds.x0 >= 38 && doubt.bounds.x1 <= 60 && doubt.bounds.y0 >= 13 && doubt.bounds.y1 <= 57,
        "{doubt:?}"
    );
    assert!(plate.remarks()[0].contains("hardly ever seen empty in 36 pictures"), "{:?}", plate.remarks());
    let filled = plate.picture.get_pixel(48, 35).0;
    let around = room().get_pixel(48, 35).0;
    assert!((0..3).all(|c| filled[c].abs_diff(around[c]) < 40), "{filled:?} {around:?}");
}

#[test]
fn half_of_the_time_here_and_half_there_is_said() {
    let pictures = scene(24, |frame| Some(if frame < 12 { 20 } else { 70 }), |_| 1.0);
    let plate = learn(&pictures);
    let doubt = plate.doubts.iter().find(|doubt| doubt.kind == DoubtKind::Unclear).unwrap();
    assert!(doubt.bounds.x0 >= 18 && doubt.bounds.x1 <= 84 && doubt.share > 0.08, "{doubt:?}");
    assert!(
        plate.remarks().iter().any(|remark| remark.contains("no look that is there clearly longest")),
        "{:?}",
        plate.remarks()
    );
}

#[test]
fn a_picture_that_never_changes_is_said_to_be_one() {
    let plate = learn(&scene(20, |_| Some(40), |_| 1.0));
    assert_eq!(plate.busy, 0);
    assert!(plate.remarks()[0].contains("nothing moves in 20 pictures"), "{:?}", plate.remarks());
}

#[test]
fn too_few_pictures_and_other_sizes_are_refused() {
    let message = |pictures: &[RgbImage]| LearntPlate::of(pictures, &mut || {}).unwrap_err().to_string();
    assert!(message(&scene(11, |_| None, |_| 1.0)).contains("11 pictures are too few"));
    let mut pictures = scene(12, |_| None, |_| 1.0);
    pictures[7] = RgbImage::new(4, 3);
    assert!(message(&pictures).contains("96x60 and 4x3 pixels"), "{}", message(&pictures));
}
