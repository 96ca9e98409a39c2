#![allow(clippy::unwrap_used, reason = "a test or benchmark stops at the first surprise, and prints")]

use super::*;
use crate::texture::picture::{View, flat};

#[test]
fn every_material_has_contrast_and_follows_its_seed() {
    for kind in MaterialKind::ALL {
        let material = Material::new(kind.name(), Parameters::Defaults, 1, None).unwrap();
        let other = Material::new(kind.name(), Parameters::Defaults, 2, None).unwrap();
        let points = || (0..400).map(|i| [i as f32 * 0.037 - 7.0, (i % 20) as f32 * 0.113, 0.2]);
        let grey = |p| material.at(p).colour.iter().sum::<f32>() / 3.0;
        let low = points().map(grey).fold(f32::MAX, f32::min);
        let high = points().map(grey).fold(f32::MIN, f32::max);
        assert!(high - low > 0.08, "{}: {low} to {high}", kind.name());
        assert!(points().any(|p| material.at(p) != other.at(p)), "{} ignores its seed", kind.name());
    }
}

#[test]
fn the_sun_is_lava() {
    let [sun, lava] = ["sun", "lava"].map(|name| Material::new(name, Parameters::Defaults, 5, None).unwrap());
    assert_eq!(sun.at([0.4, 1.7, -0.3]), lava.at([0.4, 1.7, -0.3]));
}

#[test]
fn texels_stay_in_range_at_any_point() {
    for kind in MaterialKind::ALL {
        for tile in [None, Some([2.0, 3.0])] {
            let material = Material::new(kind.name(), Parameters::Defaults, 1, tile).unwrap();
            for p in [[0.0; 3], [-1e6, 1e6, 3.0], [f32::MAX, f32::MIN, 1e-30], [f32::NAN, f32::INFINITY, -0.0]] {
                let texel = material.at(p);
                let values = [texel.colour[0], texel.colour[1], texel.colour[2], texel.height];
                assert!(values.iter().all(|x| (0.0..=1.0).contains(x)), "{} at {p:?}: {texel:?}", kind.name());
            }
        }
    }
}

/// The step across the seam is no larger than steps inside, for every material.
#[test]
fn tiles_have_no_seam() {
    for kind in MaterialKind::ALL {
        let view = View { size: [160, 96], offset: [0.3, -0.7, 0.1], scale: 4.0 };
        let material = Material::new(kind.name(), Parameters::Defaults, 4, Some(view.extent())).unwrap();
        let [width, height] = view.extent();
        // The same place one tile on: equal, but for points that rounding moves over an edge of a brick, a blade or a thread.
        let unequal = |material: &Material| {
            (0..500)
                .filter(|&i| {
                    let p = [i as f32 * 0.0371 % width, i as f32 * 0.0173 % height, 0.1];
                    let differs = |q| {
                        let (a, b) = (material.at(p).colour, material.at(q).colour);
                        (0..3).map(|c| (a[c] - b[c]).abs()).sum::<f32>() > 0.03
                    };
                    differs([p[0] + width, p[1], p[2]]) || differs([p[0], p[1] - height, p[2]])
                })
                .count()
        };
        assert!(unequal(&material) <= 10, "{}: {} of 500 points", kind.name(), unequal(&material));
        let untiled = Material::new(kind.name(), Parameters::Defaults, 4, None).unwrap();
        assert!(unequal(&untiled) > 60, "{}: {} of 500 points without a tile", kind.name(), unequal(&untiled));
        let picture = flat(&material, &view);
        let column = |a: u32, b: u32| -> f64 {
            let of = |x, y| picture.get_pixel(x, y).0.map(f64::from);
            (0..96).map(|y| (0..3).map(|i| (of(a, y)[i] - of(b, y)[i]).abs()).sum::<f64>()).sum()
        };
        let inside = (0..159).map(|x| column(x, x + 1)).fold(0.0, f64::max);
        assert!(column(159, 0) <= inside * 1.25, "{}: seam {} inside {inside}", kind.name(), column(159, 0));
    }
}

#[test]
fn parameters_come_from_a_file_and_wrong_ones_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("m.toml");
    let message = |text: &str, name: &str| {
        std::fs::write(&path, text).unwrap();
        format!("{:#}", Material::new(name, Parameters::File(&path), 0, None).unwrap_err())
    };
    let error = message("frequenzy = 3.0\n", "marble");
    assert!(error.contains("m.toml, line 1") && error.contains("nearest known key is `frequency`"), "{error}");
    let error = message("scale = inf\n", "marble");
    assert!(error.contains("m.toml: scale = inf, expected a number from -1e6 to 1e6"), "{error}");
    let error = message("[map]\nbands = [{ from = nan, colour = [0, 0, 0] }]\n", "terrain");
    assert!(error.contains("from = NaN"), "{error}");
    let error = message("", "marbel");
    assert!(
        error.contains("unknown material `marbel`, the nearest is `marble` (known: clouds, lava, marble, granite"),
        "{error}"
    );
    std::fs::write(&path, "vein = [1.0, 0.0, 0.0]\nstone = [1.0, 0.0, 0.0]\n").unwrap();
    let red = Material::new("marble", Parameters::File(&path), 0, None).unwrap();
    assert_eq!(red.at([0.3, 0.4, 0.5]).colour, [1.0, 0.0, 0.0]);
    assert!(
        Material::new("marble", Parameters::Defaults, 0, Some([0.0, 1.0]))
            .unwrap_err()
            .to_string()
            .contains("tile of 0 x 1")
    );
}
