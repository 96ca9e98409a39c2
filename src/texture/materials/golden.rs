//! Every material of METHOD B2 at six points beside values that were worked out without this code: by a program of its own, in
//! double precision, from the formulas as METHOD writes them. Its noise follows B1: eight corners of a cell, each with its word
//! (the coordinates' products by three factors, folded once), the direction that the word's thirds and upper bits name, and its
//! weight as a product of quintic fades; its octaves, rings and grain follow B2 line by line, the mid-point surface is a table of
//! 512 x 512 numbers displaced anew, read through the cubic of Catmull and Rom in Horner's form. No function is shared with the
//! library, so a formula that processor and device both have wrong is caught here.

use super::*;

/// Seed of all materials here.
const SEED: u64 = 7;

const POINTS: [[f32; 3]; 6] = [
    [0.31, 0.72, 0.05],
    [-1.43, 2.17, 0.9],
    [3.69, -0.58, -2.21],
    [-0.12, -0.83, 0.44],
    [7.9, 5.3, 1.7],
    [-22.6, 14.1, -9.3],
];

/// A material's red, green, blue and height at each of the points.
#[rustfmt::skip]
const GOLDEN: [(&str, [[f32; 4]; 6]); 7] = [
    ("clouds", [
        [0.73871, 0.73871, 0.80000, 0.92339],
        [0.54950, 0.54950, 0.80000, 0.68687],
        [0.47381, 0.47381, 0.80000, 0.59226],
        [0.60082, 0.60082, 0.80000, 0.75103],
        [0.60419, 0.60419, 0.80000, 0.75524],
        [0.73915, 0.73915, 0.80000, 0.92393],
    ]),
    ("lava", [
        [0.68202, 0.34607, 0.00000, 0.58988],
        [0.68445, 0.35336, 0.00000, 0.57773],
        [0.67826, 0.33479, 0.00000, 0.60868],
        [0.66950, 0.30850, 0.00000, 0.65250],
        [0.69676, 0.39027, 0.00000, 0.51622],
        [0.66398, 0.29194, 0.00000, 0.68010],
    ]),
    ("marble", [
        [0.32166, 0.30169, 0.34147, 0.00272],
        [0.86789, 0.85688, 0.82502, 0.89819],
        [0.50093, 0.48390, 0.50017, 0.29661],
        [0.64658, 0.63193, 0.62910, 0.53538],
        [0.86125, 0.85013, 0.81914, 0.88730],
        [0.61181, 0.59659, 0.59832, 0.47837],
    ]),
    ("granite", [
        [0.68800, 0.68800, 0.68800, 0.68800],
        [0.58089, 0.58089, 0.58089, 0.58089],
        [0.81435, 0.81435, 0.81435, 0.81435],
        [0.56587, 0.56587, 0.56587, 0.56587],
        [0.39836, 0.39836, 0.39836, 0.39836],
        [0.68430, 0.68430, 0.68430, 0.68430],
    ]),
    ("wood", [
        [0.61274, 0.30637, 0.10244, 0.95699],
        [0.61728, 0.30864, 0.10302, 1.00000],
        [0.52817, 0.26409, 0.09015, 0.45572],
        [0.58773, 0.29387, 0.09838, 0.89385],
        [0.58151, 0.29075, 0.09723, 0.90755],
        [0.55926, 0.27963, 0.09423, 0.72785],
    ]),
    ("fractal", [
        [0.47676, 0.71039, 0.31388, 0.49571],
        [0.14101, 0.28556, 0.11954, 0.58803],
        [0.26096, 0.37699, 0.20061, 0.63426],
        [0.12630, 0.31423, 0.56810, 0.40250],
        [0.74989, 0.69968, 0.64107, 0.79592],
        [0.32609, 0.31239, 0.22266, 0.68473],
    ]),
    ("terrain", [
        [0.18992, 0.32163, 0.41326, 0.40250],
        [0.39145, 0.53569, 0.24088, 0.45210],
        [0.09440, 0.23553, 0.40366, 0.40250],
        [0.05221, 0.06396, 0.03811, 0.65237],
        [0.25825, 0.35590, 0.15980, 0.45620],
        [0.28155, 0.49114, 0.64727, 0.40250],
    ]),
];

/// How far a texel may be from its golden value: single precision against double, through slopes of terrain.
const TOLERANCE: f32 = 2e-4;

fn farthest(texel: Texel, golden: [f32; 4]) -> f32 {
    let found = [texel.colour[0], texel.colour[1], texel.colour[2], texel.height];
    found.iter().zip(golden).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max)
}

#[test]
fn materials_have_the_values_of_their_formulas() {
    for (name, rows) in GOLDEN {
        let material = Material::new(name, Parameters::Defaults, SEED, None).unwrap();
        for (p, golden) in POINTS.into_iter().zip(rows) {
            let texel = material.at(p);
            assert!(farthest(texel, golden) < TOLERANCE, "{name} at {p:?}: {texel:?}, by the formula {golden:?}");
        }
    }
}

/// The comparison sees a changed number: another seed, or noise a tenth stronger, is off by far more than the tolerance.
#[test]
fn golden_values_tell_a_change() {
    for (name, rows) in GOLDEN {
        let other = Material::new(name, Parameters::Defaults, SEED + 1, None).unwrap();
        let worst = POINTS.into_iter().zip(rows).map(|(p, golden)| farthest(other.at(p), golden)).fold(0.0, f32::max);
        assert!(worst > 50.0 * TOLERANCE, "{name}: another seed is {worst} off");
    }
    let table = "noisiness = 3.3".parse().unwrap();
    let other = Material::new("wood", Parameters::Table(&table), SEED, None).unwrap();
    let off = POINTS.into_iter().zip(GOLDEN[4].1).filter(|(p, golden)| farthest(other.at(*p), *golden) > TOLERANCE);
    assert_eq!(off.count(), POINTS.len());
}
