//! Numbers that depend on their counters alone: the same pattern and noise in any order on any machine.

/// A well mixed 32-bit number from a 64-bit counter (two rounds of multiply and shift).
pub(super) fn hash(counter: u64) -> u32 {
    let mut x = counter ^ 0x6a09_e667_f3bc_c908;
    x = (x ^ (x >> 32)).wrapping_mul(0xd6e8_feb8_6659_fd93);
    x = (x ^ (x >> 32)).wrapping_mul(0xd6e8_feb8_6659_fd93);
    (x ^ (x >> 32)) as u32
}

/// A number in [0, 1) for a cell of an integer lattice.
pub(super) fn cell(x: i64, y: i64, layer: u64) -> f64 {
    let counter = (x as u64).wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ (y as u64).wrapping_mul(0xc2b2_ae3d_27d4_eb4f);
    f64::from(hash(counter.wrapping_add(layer.wrapping_mul(0x1656_67b1_9e37_79f9)))) / 4_294_967_296.0
}

/// Smooth noise in [0, 1] over the plane, one feature a unit: lattice values mixed with a cubic fade.
pub(super) fn smooth_noise(x: f64, y: f64, layer: u64) -> f64 {
    let (cx, cy) = (x.floor(), y.floor());
    let fade = |t: f64| t * t * (3.0 - 2.0 * t);
    let (fx, fy) = (fade(x - cx), fade(y - cy));
    let (ix, iy) = (cx as i64, cy as i64);
    let mix = |a: f64, b: f64, t: f64| a + (b - a) * t;
    mix(
        mix(cell(ix, iy, layer), cell(ix.wrapping_add(1), iy, layer), fx),
        mix(cell(ix, iy.wrapping_add(1), layer), cell(ix.wrapping_add(1), iy.wrapping_add(1), layer), fx),
        fy,
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbouring_counters_are_unlike_and_even() {
        let mean = (0..100_000u64).map(|i| f64::from(hash(i)) / 4_294_967_296.0).sum::<f64>() / 1e5;
        assert!((mean - 0.5).abs() < 0.005, "{mean}");
        let flips: u32 = (0..10_000u64).map(|i| (hash(i) ^ hash(i + 1)).count_ones()).sum();
        assert!((f64::from(flips) / 10_000.0 - 16.0).abs() < 0.2, "half of the bits change: {flips}");
    }

    #[test]
    fn smooth_noise_is_continuous_over_cells() {
        for i in 0..50 {
            let x = f64::from(i) - 25.0;
            assert!((smooth_noise(x - 1e-9, 0.3, 1) - smooth_noise(x + 1e-9, 0.3, 1)).abs() < 1e-6);
        }
    }
}
