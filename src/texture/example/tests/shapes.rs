//! Patches whose sides differ, the bell and the blend at their borders.

use proptest::prelude::*;

use super::*;
use crate::texture::example::colour::weighted;
use crate::texture::example::sources::Place;

/// The canvas of a texture with all patches placed.
fn placed(example: &RgbImage, settings: Settings) -> Canvas {
    let mut canvas = Canvas::new(Sources::new(&[whole(example)], None, None).unwrap(), settings);
    let [width, height] = settings.patch.map(|side| side as usize);
    for y in (0..canvas.size[1]).step_by(height) {
        for x in (0..canvas.size[0]).step_by(width) {
            canvas.place([x, y], [width, height], settings.overlap as usize).unwrap();
        }
    }
    canvas
}

#[test]
fn patches_have_the_sides_that_are_wanted() {
    let example = example(64, 64);
    for (patch, fit) in [([32, 8], 1.0), ([4, 16], 1.0), ([16, 1], 1.0), ([1, 32], 1.0)] {
        let settings = Settings { size: [64, 48], patch, delta_max: fit, delta_pixel: 1.0, ..SMALL };
        let canvas = placed(&example, settings);
        let [columns, rows] = patch.map(|side| side as usize);
        for (i, owner) in canvas.owners.iter().enumerate() {
            let number = i / 64 / rows * (64 / columns) + i % 64 / columns;
            assert_eq!((owner.patch as usize, owner.area), (number + 1, patch[0] * patch[1]), "{patch:?} pixel {i}");
        }
    }
}

#[test]
fn sides_that_differ_are_halved_together_down_to_pixels() {
    let example = example(40, 40);
    // So little error is allowed that patches fit nowhere but where nothing is around them.
    for (patch, areas) in [([32, 4], &[128, 32, 8, 4, 2, 1][..]), ([1, 8], &[8, 4, 2, 1]), ([8, 8], &[64, 16, 4, 1])] {
        let settings = Settings { size: [64, 48], patch, delta_max: 1e-6, ..SMALL };
        let canvas = placed(&example, settings);
        assert!(canvas.filled.iter().all(|filled| *filled));
        let sizes: std::collections::HashSet<u32> = canvas.owners.iter().map(|owner| owner.area).collect();
        assert!(sizes.iter().all(|area| areas.contains(area)), "{patch:?}: {sizes:?}");
        assert!(sizes.contains(&1) && sizes.contains(&areas[0]), "{patch:?}: {sizes:?}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, ..ProptestConfig::default() })]

    /// No pixel of the example is black, so a pixel that was never filled would show.
    #[test]
    fn any_sides_fill_everything_on_any_number_of_threads(
        sides in [0_u32..7, 0_u32..7],
        size in [1_u32..60, 1_u32..60],
        of_example in [1_u32..50, 1_u32..50],
        delta_max in prop_oneof![Just(0.0_f32), 1e-5_f32..0.02, Just(1.0)],
        tile in any::<bool>(),
        threads in 1_usize..5,
    ) {
        let example = example(of_example[0], of_example[1]);
        let patch = sides.map(|n| 1 << n);
        let settings = Settings { size, patch, delta_max, tile, ..SMALL };
        let one = synthesised(&example, settings);
        prop_assert!(one.picture.pixels().all(|pixel| pixel.0[0] >= 50));
        prop_assert!(one.decomposition.pixels().all(|pixel| pixel.0 != [110; 3]));
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let other = pool.install(|| synthesised(&example, settings));
        prop_assert!(one.picture == other.picture && one.decomposition == other.decomposition);
    }
}

/// Two neighbourhoods: in the first what is far from the middle is as on the canvas, in the second what is near. Evenly the many
/// far ones decide, under the bell the few near ones.
#[test]
fn under_the_bell_near_neighbours_decide() {
    let neighbourhood = |is_near_like: bool, middle: u8| {
        RgbImage::from_fn(7, 7, |x, y| {
            let distance = x.abs_diff(3).max(y.abs_diff(3));
            let is_like = (distance <= 1) == is_near_like;
            Rgb([if distance == 0 {
                middle
            } else if is_like {
                100
            } else {
                180
            }; 3])
        })
    };
    let (far, near) = (neighbourhood(false, 10), neighbourhood(true, 250));
    let found = |taken_out: bool| {
        let sources = Sources::new(&[whole(&far), whole(&near)], None, None).unwrap();
        let mut canvas = Canvas::new(sources, Settings { size: [7, 7], ..SMALL });
        canvas.colours = vec![weighted([100.0; 3]); 49];
        canvas.filled = vec![true; 49];
        if taken_out {
            canvas.synthesise_anew(&[24]).unwrap();
        } else {
            canvas.filled[24] = false;
            canvas.pixel([3, 3]).unwrap();
        }
        canvas.colours[24][0] / weighted([255.0; 3])[0] * 255.0
    };
    assert!((found(false) - 10.0).abs() < 1e-3);
    // A share of 0.15 of the four neighbours' 100 and the rest of 250.
    assert!((found(true) - (0.85 * 250.0 + 0.15 * 100.0)).abs() < 1e-3);
}

#[test]
fn a_pixel_is_blended_with_its_four_neighbours_alone() {
    let picture = RgbImage::from_pixel(9, 9, Rgb([200; 3]));
    let red = |value: f32| weighted([value; 3]);
    for (tile, at, expected) in [
        (false, [4, 4], 200.0 - 0.15 * 75.0),
        (false, [0, 0], 200.0 - 0.15 * 50.0),
        (true, [0, 0], 200.0 - 0.15 * 125.0),
    ] {
        let settings = Settings { size: [9, 9], tile, ..SMALL };
        let mut canvas = Canvas::new(Sources::new(&[whole(&picture)], None, None).unwrap(), settings);
        canvas.filled = vec![true; 81];
        canvas.colours = vec![red(0.0); 81];
        canvas.origins = vec![Some(Place { example: 0, x: 4, y: 4 }); 81];
        let i: usize = at[1] * 9 + at[0];
        // Right and below; above and left where there are such.
        for (j, value) in [(i + 1, 100.0), (i + 9, 200.0), (i.wrapping_sub(1), 0.0), (i.wrapping_sub(9), 200.0)] {
            if let Some(colour) = canvas.colours.get_mut(j) {
                *colour = red(value);
            }
        }
        canvas.synthesise_anew(&[i]).unwrap();
        let found = canvas.colours[i].map(|channel| channel / red(255.0)[0] * 255.0)[0];
        assert!((found - expected).abs() < 1e-3, "{at:?}: {found}, expected {expected}");
    }
}
