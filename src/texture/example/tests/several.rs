//! Several examples at once.

use super::*;
use crate::texture::example::colour::{Known, weighted};
use crate::texture::example::sources::Place;

fn flat(colour: [u8; 3]) -> RgbImage {
    RgbImage::from_pixel(40, 30, Rgb(colour))
}

#[test]
fn of_two_flat_colours_a_texture_is_one() {
    let (red, blue) = (flat([200, 10, 20]), flat([20, 10, 200]));
    let mut seen = std::collections::HashSet::new();
    for seed in 0..12 {
        for patch in [[16, 16], [8, 4]] {
            let settings = Settings { seed, patch, ..SMALL };
            let picture = synthesise(&[whole(&red), whole(&blue)], None, &settings, None, || ()).unwrap().picture;
            let first = *picture.get_pixel(0, 0);
            assert!(picture.pixels().all(|pixel| *pixel == first), "what was red went on blue");
            seen.insert(first);
        }
    }
    assert_eq!(seen, [Rgb([200, 10, 20]), Rgb([20, 10, 200])].into());
}

#[test]
fn the_best_place_in_any_is_taken_and_of_equals_the_first() {
    let (one, other) = (example(30, 30), flat([255, 255, 0]));
    let known_of = |colour: &dyn Fn(usize, usize) -> [u8; 3]| -> Vec<Known> {
        (0..25)
            .map(|i| Known { x: i % 5, y: i / 5, colour: weighted(colour(i % 5, i / 5).map(f32::from)), weight: 1.0 })
            .collect()
    };
    let of_one = known_of(&|x, y| one.get_pixel(7 + x as u32, 11 + y as u32).0);
    let yellow = known_of(&|_, _| [255, 255, 0]);
    let best = |examples: &[Example<'_>], known: &[Known], guesses: &[Place]| {
        let sources = Sources::new(examples, None, None).unwrap();
        sources.best([5, 5], known, guesses.iter().copied()).unwrap().unwrap().0
    };
    let at = |example, x, y| Place { example, x, y };
    // Guesses that are good, bad, as good as the best but later, and outside change nothing.
    for guesses in [&[][..], &[at(0, 7, 11)], &[at(1, 3, 3), at(0, 29, 29)], &[at(2, 7, 11)], &[at(2, 9, 9)]] {
        let examples = [whole(&one), whole(&other), whole(&one)];
        assert_eq!(best(&examples, &of_one, guesses), at(0, 7, 11));
        assert_eq!(best(&examples, &yellow, guesses), at(1, 0, 0));
        let examples = [whole(&other), whole(&one), whole(&one)];
        assert_eq!(best(&examples, &of_one, guesses), at(1, 7, 11));
        assert_eq!(best(&examples, &yellow, guesses), at(0, 0, 0));
    }
}

#[test]
fn dice_reach_every_example_that_may_be_used() {
    let (one, small, dark) = (example(30, 30), example(4, 4), GrayImage::new(30, 30));
    let ignored = Example { picture: &one, mask: Some(&dark) };
    let drawn = |examples: &[Example<'_>], size: [usize; 2]| -> Vec<u32> {
        let sources = Sources::new(examples, None, None).unwrap();
        let dice = (0..64).map(|i| i * (u32::MAX / 63));
        let mut drawn: Vec<u32> = dice.map(|die| sources.any(size, die).unwrap().example).collect();
        drawn.sort_unstable();
        drawn.dedup();
        drawn
    };
    assert_eq!(drawn(&[whole(&one), whole(&one), whole(&one)], [8, 8]), [0, 1, 2]);
    assert_eq!(drawn(&[whole(&one), whole(&small), whole(&one)], [8, 8]), [0, 2]);
    assert_eq!(drawn(&[ignored, whole(&small), ignored], [3, 3]), [1]);
    assert_eq!(Sources::new(&[ignored, ignored], None, None).unwrap().any([1, 1], 5), None);
}

#[test]
fn many_threads_or_a_device_choose_alike_from_several() {
    let (one, other) = (example(40, 33), example(21, 50));
    let mask = GrayImage::from_fn(40, 33, |x, _| Luma([if x < 9 { 0 } else { 255 }]));
    let examples = [Example { picture: &one, mask: Some(&mask) }, whole(&other)];
    let settings = Settings { patch: [32, 8], delta_max: 0.01, delta_pixel: 0.01, ..SMALL };
    let here = synthesise(&examples, None, &settings, None, || ()).unwrap();
    assert!(here.resynthesised_count > 0);
    for threads in [1, 3] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let again = pool.install(|| synthesise(&examples, None, &settings, None, || ()).unwrap());
        assert!(again.picture == here.picture);
    }
    let name = "many_threads_or_a_device_choose_alike_from_several";
    let Some((device, log)) = device(name, DeviceSettings::default()) else { return };
    let there = synthesise(&examples, None, &settings, Some(&device), || ()).unwrap();
    assert!(here.picture == there.picture && here.decomposition == there.decomposition);
    drop(device);
    assert_eq!(log.messages(), Vec::<String>::new());
}

#[test]
fn examples_that_cannot_be_used_are_named() {
    let (one, dark) = (example(10, 10), GrayImage::new(10, 10));
    let message = |examples: &[Example<'_>]| synthesise(examples, None, &SMALL, None, || ()).unwrap_err().to_string();
    assert!(message(&[]).contains("no example"));
    let ignored = Example { picture: &one, mask: Some(&dark) };
    assert!(message(&[ignored, ignored]).contains("masks are dark all over"));
    let big = RgbImage::new(2048, 1025);
    assert!(message(&[whole(&big), whole(&big)]).contains("pixels together, expected at most 4194304"));
    assert!(synthesise(&[ignored, whole(&one)], None, &SMALL, None, || ()).is_ok());
}
