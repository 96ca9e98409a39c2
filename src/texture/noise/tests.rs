#![allow(
    clippy::unwrap_used,
    clippy::needless_range_loop,
    reason = "a test or benchmark stops at the first surprise, and prints"
)]

use super::*;

/// Coordinates of every kind: between lattice points, on them, at their edges, negative, huge.
pub(crate) fn hard_coordinates(count: usize, seed: u64) -> Vec<f32> {
    let special = [
        0.0,
        -0.0,
        1.0,
        -1.0,
        0.5,
        -0.5,
        1e-30,
        -1e-30,
        -1e-10,
        0.999_999_94,
        255.999_98,
        256.0,
        -256.5,
        8_388_607.5,
        8_388_608.0,
        -8_388_609.0,
        2_147_483_520.0,
        2_147_483_648.0,
        -2_147_483_648.0,
        -4e9,
        1e20,
        -1e25,
    ];
    (0..count)
        .map(|i| {
            let die = mixed((seed << 32) | i as u64);
            let fraction = (die >> 8) as f32 / 16_777_216.0;
            match die & 7 {
                0 => special[(die >> 8) as usize % special.len()],
                1 => (fraction * 2e3).floor() - 1e3,
                2 => (fraction - 0.5) * 1e7,
                3 => (fraction - 0.5) * 1e10,
                _ => (fraction - 0.5) * 100.0,
            }
        })
        .collect()
}

fn each_noise(p: [f32; 4], lattice: &impl Lattice) -> [f32; 8] {
    let [x, y, z, _] = p;
    [
        perlin1(lattice, [x]),
        perlin2(lattice, [x, y]),
        perlin3(lattice, [x, y, z]),
        perlin4(lattice, p),
        value1(lattice, [x]),
        value2(lattice, [x, y]),
        value3(lattice, [x, y, z]),
        value4(lattice, p),
    ]
}

#[test]
fn values_are_finite_bounded_and_spread() {
    let rows: Vec<Vec<f32>> = (0..4).map(|axis| hard_coordinates(100_000, axis)).collect();
    let tables = Tables::new(1);
    for lattice in 0..3 {
        let (mut low, mut high) = ([f32::MAX; 8], [f32::MIN; 8]);
        for i in 0..rows[0].len() {
            let p = [rows[0][i], rows[1][i], rows[2][i], rows[3][i]];
            let values = match lattice {
                0 => each_noise(p, &HashLattice::new(1)),
                1 => each_noise(p, &TableLattice::new(&tables)),
                _ => each_noise(p, &Periodic { lattice: HashLattice::new(1), period: [7, 1, 0, 3] }),
            };
            for (k, value) in values.into_iter().enumerate() {
                assert!(value.abs() <= 1.1, "noise {k} is {value} at {p:?}");
                low[k] = low[k].min(value);
                high[k] = high[k].max(value);
            }
        }
        assert!(low.iter().zip(&high).all(|(low, high)| *low < -0.5 && *high > 0.5), "{low:?} {high:?}");
    }
}

#[test]
fn cells_are_what_floor_and_saturation_give() {
    for x in hard_coordinates(100_000, 77) {
        let (cell, place) = gradient::split(x);
        assert_eq!((cell, place), (x.floor() as i32, x - x.floor()), "{x}");
    }
}

#[test]
fn gradient_noise_is_zero_on_lattice_points_and_smooth_across_cells() {
    let lattice = HashLattice::new(3);
    for i in -1000..1000_i32 {
        let (x, y) = (i as f32, (i * 7) as f32);
        for value in &each_noise([x, y, x - y, 3.0], &lattice)[..4] {
            assert_eq!(*value, 0.0);
        }
        for edge in [x - 1e-4, x + 1e-4] {
            let here = each_noise([x, 0.3, 0.7, 0.4], &lattice);
            let there = each_noise([edge, 0.3, 0.7, 0.4], &lattice);
            assert!(here.iter().zip(&there).all(|(a, b)| (a - b).abs() < 2e-3), "{here:?} {there:?}");
        }
    }
}

#[test]
fn periodic_noise_repeats_exactly() {
    let lattice = Periodic { lattice: HashLattice::new(9), period: [4, 3, 8, 2] };
    for i in 0..2000 {
        // Multiples of 1/64 keep sums exact.
        let p: [f32; 4] = std::array::from_fn(|axis| (mixed(i * 4 + axis as u64) % 1024) as f32 / 64.0 - 8.0);
        let moved = [p[0] + 4.0, p[1] - 3.0, p[2] + 16.0, p[3] + 2.0];
        assert_eq!(each_noise(p, &lattice), each_noise(moved, &lattice), "{p:?}");
    }
    let octaves = Octaves { count: 5, lacunarity: 2.3, frequency: 1.7, ..Octaves::default() };
    for i in 0..200 {
        let (x, y) = (i as f32 / 64.0, i as f32 / 32.0 - 1.0);
        let tile = [4.0, 2.0, 0.0];
        let here = octaves.at(Perlin, &HashLattice::new(2), tile, [x, y, 0.3]);
        let there = octaves.at(Perlin, &HashLattice::new(2), tile, [x + 4.0, y - 2.0, 0.3]);
        assert!((here - there).abs() < 1e-4, "{here} {there}");
        assert_ne!(here, octaves.at(Perlin, &HashLattice::new(2), tile, [x + 2.0, y, 0.3]));
    }
}

fn same_bits<K: Kernel<N>, const N: usize>(noise: K) {
    let rows: Vec<Vec<f32>> = (0..N as u64).map(|axis| hard_coordinates(9_999, axis)).collect();
    let rows: [&[f32]; N] = std::array::from_fn(|axis| rows[axis].as_slice());
    let lattice = HashLattice::new(11);
    for sum in [Sum::Fbm, Sum::Turbulence, Sum::Ridged] {
        let octaves = Octaves { sum, frequency: 1.3, ..Octaves::default() };
        let mut out = vec![f32::NAN; rows[0].len()];
        octaves.fill(noise, &lattice, rows, &mut out);
        for (i, value) in out.into_iter().enumerate() {
            let p: [f32; N] = std::array::from_fn(|axis| rows[axis][i]);
            let reference = octaves.at(noise, &lattice, [0.0; N], p);
            assert_eq!(value.to_bits(), reference.to_bits(), "{p:?}: {value} {reference}");
        }
    }
}

#[test]
fn vectors_and_threads_give_the_bits_of_one_point() {
    same_bits::<_, 1>(Perlin);
    same_bits::<_, 2>(Perlin);
    same_bits::<_, 3>(Perlin);
    same_bits::<_, 4>(Perlin);
    same_bits::<_, 1>(Value);
    same_bits::<_, 2>(Value);
    same_bits::<_, 3>(Value);
    same_bits::<_, 4>(Value);
}

#[test]
fn octaves_out_of_reach_are_refused() {
    let message = |octaves: Octaves| octaves.checked().unwrap_err().to_string();
    assert!(message(Octaves { count: 0, ..Octaves::default() }).contains("0 octaves"));
    assert!(message(Octaves { gain: f32::NAN, ..Octaves::default() }).contains("gain of noise is NaN"));
    assert!(message(Octaves { lacunarity: -1.0, ..Octaves::default() }).contains("lacunarity"));
    assert!(message(Octaves { lacunarity: 1e4, count: 9, ..Octaves::default() }).contains("1e12"));
    let far = Octaves { count: 32, ..Octaves::default() }.checked().unwrap();
    assert!(far.at(Perlin, &HashLattice::new(0), [0.0; 2], [f32::MAX, f32::MIN]).is_finite());
}
