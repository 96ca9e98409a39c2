#![allow(clippy::unwrap_used, reason = "a test or benchmark stops at the first surprise, and prints")]

use super::*;
use crate::gpu::DeviceSettings;
use crate::gpu::test_device::device;
use crate::texture::materials::Parameters;
use crate::texture::noise::mixed;
use image::{Luma, Rgb, RgbImage};

mod holes;
mod several;
mod shapes;

/// Stripes and dots with a little noise.
fn example(width: u32, height: u32) -> RgbImage {
    RgbImage::from_fn(width, height, |x, y| {
        let noise = mixed(u64::from(y * 4096 + x)) % 20;
        let dot = (x % 12).abs_diff(6).pow(2) + (y % 10).abs_diff(5).pow(2) < 9;
        Rgb([if dot { 200 } else { 60 } + noise as u8, (60 + y % 10 * 6) as u8, (90 + noise) as u8])
    })
}

fn whole(picture: &RgbImage) -> Example<'_> {
    Example { picture, mask: None }
}

fn synthesised(example: &RgbImage, settings: Settings) -> Synthesis {
    let mut steps = 0;
    let synthesis = synthesise(&[whole(example)], None, &settings, None, || steps += 1).unwrap();
    assert_eq!(steps, patch_count(&settings));
    assert_eq!([synthesis.picture.width(), synthesis.picture.height()], settings.size);
    synthesis
}

const SMALL: Settings =
    Settings { size: [70, 50], patch: [16, 16], overlap: 4, delta_max: 0.02, delta_pixel: 0.03, seed: 1, tile: false };

/// Sides of the patches: red of the decomposition tells pixels (1) from whole patches (0).
fn share_of_pixels(synthesis: &Synthesis) -> f64 {
    let red = synthesis.decomposition.pixels().filter(|pixel| pixel.0[0] > 150 && pixel.0[2] < 60).count();
    red as f64 / f64::from(synthesis.picture.width() * synthesis.picture.height())
}

#[test]
fn delta_max_chooses_between_pixels_and_patches() {
    let example = example(40, 40);
    let pixels = synthesised(&example, Settings { delta_max: 0.0, ..SMALL });
    assert_eq!(share_of_pixels(&pixels), 1.0);
    assert_eq!(pixels.resynthesised_count, 0);
    let colours: std::collections::HashSet<_> = example.pixels().collect();
    assert!(pixels.picture.pixels().all(|pixel| colours.contains(pixel)), "a pixel is not of the example");
    let patches = synthesised(&example, Settings { delta_max: 1.0, ..SMALL });
    assert_eq!(share_of_pixels(&patches), 0.0);
    let hybrid = synthesised(&example, Settings { delta_max: 0.004, ..SMALL });
    assert!((0.0..1.0).contains(&share_of_pixels(&hybrid)));
    assert_ne!(hybrid.picture, patches.picture);
}

#[test]
fn pixels_of_the_overlap_that_differ_are_synthesised_anew() {
    let example = example(40, 40);
    let none = synthesised(&example, Settings { delta_max: 1.0, delta_pixel: 1.0, ..SMALL });
    assert_eq!(none.resynthesised_count, 0);
    let many = synthesised(&example, Settings { delta_max: 1.0, delta_pixel: 1e-4, ..SMALL });
    assert!(many.resynthesised_count > 100, "{}", many.resynthesised_count);
    let red = many.resynthesised.pixels().filter(|pixel| pixel.0[0] == 235).count();
    assert_eq!(red, many.resynthesised_count);
}

#[test]
fn the_number_of_threads_changes_nothing_and_the_seed_does() {
    let example = example(33, 48);
    let with = |threads: usize, seed: u64| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| synthesised(&example, Settings { seed, ..SMALL }).picture)
    };
    let one = with(1, 5);
    assert_eq!(one, with(2, 5));
    assert_eq!(one, with(5, 5));
    assert_ne!(one, with(1, 6));
}

#[test]
fn a_device_chooses_what_the_processor_chooses() {
    let name = "a_device_chooses_what_the_processor_chooses";
    let Some((device, log)) = device(name, DeviceSettings::default()) else { return };
    let brick = crate::texture::materials::Material::new("brick", Parameters::Defaults, 1, None).unwrap();
    let wall = RgbImage::from_fn(61, 48, |x, y| {
        Rgb(brick.at([x as f32 * 0.03, y as f32 * 0.03, 0.2]).colour.map(|c| (c * 255.0) as u8))
    });
    let mask = GrayImage::from_fn(61, 48, |x, y| Luma([if x + y < 20 { 0 } else { 255 }]));
    for (example, mask) in [(&example(40, 40), None), (&wall, Some(&mask)), (&example(5, 30), None)] {
        for settings in [
            Settings { delta_max: 1.0, ..SMALL },
            Settings { delta_max: 0.003, tile: true, ..SMALL },
            Settings { size: [20, 16], delta_max: 0.0, ..SMALL },
        ] {
            let examples = [Example { picture: example, mask }];
            let here = synthesise(&examples, None, &settings, None, || ()).unwrap();
            let there = synthesise(&examples, None, &settings, Some(&device), || ()).unwrap();
            assert!(here.picture == there.picture && here.decomposition == there.decomposition, "{settings:?}");
            assert_eq!(here.resynthesised_count, there.resynthesised_count);
        }
    }
    drop(device);
    assert_eq!(log.messages(), Vec::<String>::new());
}

#[test]
fn a_tile_continues_over_its_borders() {
    let example = example(48, 40);
    let settings = Settings { size: [60, 60], tile: true, ..SMALL };
    let picture = synthesised(&example, settings).picture;
    let difference = |a: u32, b: u32| -> i64 {
        (0..60)
            .map(|y| {
                (0..3)
                    .map(|c| i64::from(picture.get_pixel(a, y).0[c].abs_diff(picture.get_pixel(b, y).0[c])))
                    .sum::<i64>()
            })
            .sum()
    };
    let worst = (0..59).map(|x| difference(x, x + 1)).max().unwrap();
    assert!(difference(59, 0) <= worst * 3 / 2, "seam {} inside {worst}", difference(59, 0));
}

#[test]
fn odd_examples_give_sane_textures() {
    for (width, height) in [(1, 1), (1, 9), (64, 3), (7, 7), (20, 33)] {
        for delta_max in [0.0, 0.02, 1.0] {
            let example = example(width, height);
            let settings = Settings { size: [21, 13], delta_max, ..SMALL };
            let picture = synthesised(&example, settings).picture;
            if (width, height) == (1, 1) {
                assert!(picture.pixels().all(|pixel| pixel == example.get_pixel(0, 0)));
            }
            synthesised(&example, Settings { size: [1, 1], tile: true, ..settings });
            synthesised(&example, Settings { size: [5, 40], patch: [8, 8], tile: true, ..settings });
        }
    }
}

#[test]
fn masked_pixels_are_not_used() {
    // The right half is bright and forbidden.
    let example = RgbImage::from_fn(40, 40, |x, y| Rgb([if x < 20 { (x * 3 + y) as u8 } else { 255 }; 3]));
    let mask = GrayImage::from_fn(40, 40, |x, _| Luma([if x < 20 { 255 } else { 0 }]));
    let settings = Settings { delta_pixel: 1.0, ..SMALL };
    let examples = [Example { picture: &example, mask: Some(&mask) }];
    let synthesis = synthesise(&examples, None, &settings, None, || ()).unwrap();
    assert!(synthesis.picture.pixels().all(|pixel| pixel.0[0] < 120));
}

#[test]
fn wrong_settings_are_named() {
    let example = example(10, 10);
    let message = |settings: Settings, mask: Option<&GrayImage>| {
        synthesise(&[Example { picture: &example, mask }], None, &settings, None, || ()).unwrap_err().to_string()
    };
    assert!(message(Settings { size: [0, 5], ..SMALL }, None).contains("a texture of 0 x 5 pixels"));
    assert!(message(Settings { size: [u32::MAX, u32::MAX], ..SMALL }, None).contains("expected 1 to 67108864"));
    assert!(message(Settings { patch: [0, 0], ..SMALL }, None).contains("patches of 0 pixels"));
    let expected = "patches of 24 pixels a side, expected powers of two from 1 to 4096";
    assert!(message(Settings { patch: [24, 24], ..SMALL }, None).contains(expected));
    assert!(
        message(Settings { patch: [16, 20], ..SMALL }, None).contains("patches of 16 x 20 pixels, expected powers")
    );
    assert!(message(Settings { patch: [8192, 16], ..SMALL }, None).contains("patches of 8192 x 16 pixels"));
    assert!(message(Settings { overlap: 2, ..SMALL }, None).contains("overlap by 2 pixels, expected 3 to 1024"));
    assert!(message(Settings { delta_max: f32::NAN, ..SMALL }, None).contains("delta_max is NaN"));
    assert!(message(Settings { delta_pixel: 2.0, ..SMALL }, None).contains("delta_pixel is 2"));
    assert!(
        message(SMALL, Some(&GrayImage::new(9, 10))).contains("mask has 9 x 10 pixels, expected the example's 10 x 10")
    );
    assert!(message(SMALL, Some(&GrayImage::new(10, 10))).contains("dark all over"));
    let empty = synthesise(&[whole(&RgbImage::new(0, 3))], None, &SMALL, None, || ()).unwrap_err().to_string();
    assert!(empty.contains("an example of 0 x 3 pixels"), "{empty}");
}
