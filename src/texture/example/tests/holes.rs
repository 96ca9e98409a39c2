//! An example whose holes are filled in.

use proptest::prelude::*;

use super::*;

/// Dark within a rectangle.
fn hole(size: (u32, u32), from: [u32; 2], sides: [u32; 2]) -> GrayImage {
    GrayImage::from_fn(size.0, size.1, |x, y| {
        let is_in = (0..2).all(|axis| (from[axis]..from[axis] + sides[axis]).contains(&[x, y][axis]));
        Luma([if is_in { 0 } else { 255 }])
    })
}

fn filled(examples: &[Example<'_>], holes: &GrayImage, settings: Settings) -> Synthesis {
    let settings = Settings { size: holes.dimensions().into(), ..settings };
    synthesise(examples, Some(holes), &settings, None, || ()).unwrap()
}

/// The example with its hole painted over, so that nothing can be copied from there.
fn painted(example: &RgbImage, holes: &GrayImage) -> RgbImage {
    RgbImage::from_fn(example.width(), example.height(), |x, y| {
        if holes.get_pixel(x, y).0[0] < 128 { Rgb([255, 0, 255]) } else { *example.get_pixel(x, y) }
    })
}

/// Stripes and checks that go on exactly: the hole's content is known.
#[test]
fn what_repeats_goes_on_through_a_hole() {
    let stripes = RgbImage::from_fn(64, 64, |x, y| Rgb([if x % 8 < 4 { 220 } else { 30 }, 80, (y % 4 * 40) as u8]));
    let holes = hole((64, 64), [24, 20], [13, 17]);
    let spoilt = painted(&stripes, &holes);
    for (patch, delta_max) in [([32, 32], 0.04), ([16, 16], 0.001), ([8, 32], 0.001), ([16, 4], 0.04), ([16, 16], 0.0)]
    {
        let synthesis = filled(&[whole(&spoilt)], &holes, Settings { patch, delta_max, ..SMALL });
        assert!(synthesis.picture == stripes, "{patch:?} {delta_max}");
        for (x, y, pixel) in synthesis.decomposition.enumerate_pixels() {
            assert_eq!(pixel.0 == [110; 3], holes.get_pixel(x, y).0[0] == 255, "{x} {y}");
        }
    }
}

#[test]
fn a_flat_colour_fills_from_where_it_is() {
    let red = RgbImage::from_pixel(40, 40, Rgb([200, 20, 20]));
    let blue = RgbImage::from_pixel(40, 40, Rgb([20, 20, 200]));
    let holes = hole((40, 40), [10, 10], [20, 20]);
    let spoilt = painted(&red, &holes);
    // Red goes on red, though blue is there too.
    let both = filled(&[whole(&spoilt), whole(&blue)], &holes, SMALL);
    assert!(both.picture == red);
    // Where the first example may not be used the hole can only become blue.
    let dark = GrayImage::new(40, 40);
    let ignored = Example { picture: &spoilt, mask: Some(&dark) };
    let settings = Settings { delta_max: 1.0, delta_pixel: 1.0, ..SMALL };
    let other = filled(&[ignored, whole(&blue)], &holes, settings);
    for (x, y, pixel) in other.picture.enumerate_pixels() {
        // At its border it fades into the red over the overlap of 4.
        let inside = [x, y].map(|c| c.abs_diff(10).min(c.abs_diff(29)) >= 4 && (10..30).contains(&c));
        if inside == [true; 2] {
            assert_eq!(pixel.0, [20, 20, 200], "{x} {y}");
        } else if holes.get_pixel(x, y).0[0] == 255 {
            assert_eq!(pixel.0, [200, 20, 20], "{x} {y}");
        }
    }
    // 1 - 1 / 5 of the difference beside the border, 1 - 2 / 5 of it next to that.
    assert_eq!([10, 11].map(|x| other.picture.get_pixel(x, 20).0), [[164, 20, 56], [128, 20, 92]]);
    // Nothing of it known at all: the other example alone says what is there.
    let all = filled(&[whole(&spoilt), whole(&blue)], &dark, SMALL);
    assert!(all.picture == blue);
    // Nothing to fill.
    let none = filled(&[whole(&spoilt)], &GrayImage::from_pixel(40, 40, Luma([255])), SMALL);
    assert!(none.picture == spoilt && none.resynthesised_count == 0);
}

/// Pixels of the hole beside known ones that disagree with the patch are synthesised anew; the known ones stay.
#[test]
fn beside_what_is_kept_the_hole_gives_way() {
    let example = example(60, 50);
    let holes = hole((60, 50), [20, 18], [20, 20]);
    let spoilt = painted(&example, &holes);
    let settings = Settings { delta_max: 1.0, delta_pixel: 1e-3, ..SMALL };
    let synthesis = filled(&[whole(&spoilt)], &holes, settings);
    assert!(synthesis.resynthesised_count > 20, "{}", synthesis.resynthesised_count);
    for (x, y, pixel) in synthesis.resynthesised.enumerate_pixels() {
        if holes.get_pixel(x, y).0[0] == 255 {
            assert_ne!(pixel.0, [235, 40, 30], "{x} {y}");
            assert_eq!(synthesis.picture.get_pixel(x, y), example.get_pixel(x, y));
        } else {
            assert_ne!(synthesis.picture.get_pixel(x, y).0, [255, 0, 255]);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, ..ProptestConfig::default() })]

    #[test]
    fn known_pixels_stay_on_any_number_of_threads(
        size in [1_u32..50, 1_u32..50],
        sides in [0_u32..6, 0_u32..6],
        share in 0_u32..95,
        blocks in 1_u32..9,
        delta_max in prop_oneof![Just(0.0_f32), 1e-4_f32..0.02, Just(1.0)],
        delta_pixel in 1e-4_f32..0.1,
        tile in any::<bool>(),
        threads in 1_usize..5,
        seed in any::<u64>(),
    ) {
        let example = example(size[0], size[1]);
        let holes = GrayImage::from_fn(size[0], size[1], |x, y| {
            let word = mixed(u64::from(y / blocks * 4096 + x / blocks) ^ seed) % 100;
            Luma([if word < share && (x, y) != (0, 0) { 127 } else { 128 }])
        });
        let spoilt = painted(&example, &holes);
        let patch = sides.map(|n| 1 << n);
        let settings = Settings { patch, delta_max, delta_pixel, tile, seed, ..SMALL };
        let one = filled(&[whole(&spoilt)], &holes, settings);
        for (x, y, pixel) in one.picture.enumerate_pixels() {
            if holes.get_pixel(x, y).0[0] == 128 {
                prop_assert_eq!(pixel, example.get_pixel(x, y));
            } else {
                // Blue of the example is 90 to 109, at most 20 moved; the paint's 255 would show.
                prop_assert!((70..130).contains(&pixel.0[2]), "{} {}: {:?}", x, y, pixel);
            }
        }
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let other = pool.install(|| filled(&[whole(&spoilt)], &holes, settings));
        prop_assert!(one.picture == other.picture && one.resynthesised == other.resynthesised);
    }
}

#[test]
fn a_device_fills_holes_as_the_processor_does() {
    let name = "a_device_fills_holes_as_the_processor_does";
    let Some((device, log)) = device(name, DeviceSettings::default()) else { return };
    let (one, other) = (example(50, 44), example(30, 30));
    let holes = hole((50, 44), [14, 12], [22, 19]);
    let spoilt = painted(&one, &holes);
    let examples = [whole(&spoilt), whole(&other)];
    for (patch, delta_max) in [([16, 16], 0.04), ([8, 32], 0.005), ([16, 16], 0.0)] {
        let settings = Settings { size: [50, 44], patch, delta_max, delta_pixel: 0.003, ..SMALL };
        let here = synthesise(&examples, Some(&holes), &settings, None, || ()).unwrap();
        let there = synthesise(&examples, Some(&holes), &settings, Some(&device), || ()).unwrap();
        assert!(here.picture == there.picture && here.decomposition == there.decomposition, "{settings:?}");
    }
    drop(device);
    assert_eq!(log.messages(), Vec::<String>::new());
}

#[test]
fn wrong_holes_are_named() {
    let one = example(10, 10);
    let message = |holes: &GrayImage, mask: Option<&GrayImage>, size: [u32; 2]| {
        let examples = [Example { picture: &one, mask }];
        synthesise(&examples, Some(holes), &Settings { size, ..SMALL }, None, || ()).unwrap_err().to_string()
    };
    let (bright, dark) = (GrayImage::from_pixel(10, 10, Luma([255])), GrayImage::new(10, 10));
    assert!(
        message(&GrayImage::new(10, 9), None, [10, 10])
            .contains("picture of holes has 10 x 9 pixels, expected the example's 10 x 10")
    );
    assert!(message(&dark, None, [10, 10]).contains("nothing of the example is known"));
    assert!(message(&bright, Some(&dark), [10, 10]).contains("no pixel of them may be used"));
    let left = hole((10, 10), [0, 0], [5, 10]);
    let right = hole((10, 10), [5, 0], [5, 10]);
    assert!(message(&left, Some(&right), [10, 10]).contains("no pixel of them may be used"));
    assert!(
        message(&bright, None, [20, 10]).contains("a texture of 20 x 10 pixels, expected the 10 x 10 of the example")
    );
}
