//! What a search computes in single precision, of [`crate::arithmetic`] alone, so that every device repeats it to the bit.
//! `glsl/search/arithmetic.glsl` holds the same operations; the two change together.

use crate::arithmetic::{ln, reciprocal, root};

/// Running sums of [`Statistics`]; row `i` goes to the sum `i % SUM_LANES`.
const SUM_LANES: usize = 64;

/// Sine and cosine of `2 pi word / 2^32` less an eighth of a turn: the top two bits pick the quarter, the next 24 an angle
/// within +-pi/4 of its middle, by Taylor's series to the 9th and 8th power (errors below 2^-25).
#[inline(always)]
fn turn(word: u32) -> (f32, f32) {
    let quarter = word >> 30;
    let fraction = ((word >> 6) & 0x00FF_FFFF) as i32 as f32 * (1.0 / 16_777_216.0) - 0.5;
    let x = fraction * std::f32::consts::FRAC_PI_2;
    let s = x * x;
    let sin = x * (1.0 + s * (-1.0 / 6.0 + s * (1.0 / 120.0 + s * (-1.0 / 5040.0 + s * (1.0 / 362_880.0)))));
    let cos = 1.0 + s * (-0.5 + s * (1.0 / 24.0 + s * (-1.0 / 720.0 + s * (1.0 / 40_320.0))));
    // A quarter turn swaps the two; signs follow from the quarter's bits without a branch.
    let (a, b) = if quarter & 1 == 0 { (sin, cos) } else { (cos, sin) };
    let sin_sign = (quarter & 2) << 30;
    let cos_sign = ((quarter ^ (quarter >> 1)) & 1) << 31;
    (f32::from_bits(a.to_bits() ^ sin_sign), f32::from_bits(b.to_bits() ^ cos_sign))
}

/// Two independent normal numbers from two words, by Box and Muller's transform: `r = sqrt(-2 ln u)`, then `r cos t` and
/// `r sin t`, with `u = (w0 / 2^9 + 1/2) / 2^23` (integer division; never 0, so at most 5.77 standard deviations) and
/// `t = 2 pi w1 / 2^32` less an eighth of a turn.
#[inline(always)]
pub(super) fn box_muller(w0: u32, w1: u32) -> (f32, f32) {
    let u = ((w0 >> 9) as i32 as f32 + 0.5) * (1.0 / 8_388_608.0);
    let radius = root(-2.0 * ln(u));
    let (sin, cos) = turn(w1);
    (radius * cos, radius * sin)
}

/// Weighted mean and standard deviation of every degree of freedom over rows.
pub(super) struct Statistics {
    pub(super) mean: Vec<f32>,
    pub(super) deviation: Vec<f32>,
}

impl Statistics {
    /// Of rows of `reference`'s length. They are taken relative to `reference`, a row amid them, so that single precision
    /// keeps the digits that matter. The weights are 0 or more, and not all of them 0.
    pub(super) fn of(rows: &[f32], weights: &[f32], reference: &[f32]) -> Self {
        let dofs = reference.len();
        let total = tree(lanes(1, weights, |_, weight, sums| sums[0] += weight), 1);
        let inverse = reciprocal(total[0]);
        let sums = lanes(dofs, weights, |index, weight, sums| {
            let row = &rows[index * dofs..(index + 1) * dofs];
            for ((sum, x), reference) in sums.iter_mut().zip(row).zip(reference) {
                *sum += weight * (x - reference);
            }
        });
        let shift: Vec<f32> = tree(sums, dofs).into_iter().map(|sum| sum * inverse).collect();
        let squares = lanes(dofs, weights, |index, weight, sums| {
            let row = &rows[index * dofs..(index + 1) * dofs];
            for (((sum, x), reference), shift) in sums.iter_mut().zip(row).zip(reference).zip(&shift) {
                let off = (x - reference) - shift;
                *sum += weight * (off * off);
            }
        });
        Self {
            mean: reference.iter().zip(&shift).map(|(reference, shift)| reference + shift).collect(),
            deviation: tree(squares, dofs).into_iter().map(|square| root(square * inverse)).collect(),
        }
    }
}

/// Sum of the squares of `values`.
pub(super) fn sum_of_squares(values: &[f32]) -> f32 {
    tree(lanes(1, values, |_, value, sums| sums[0] += value * value), 1)[0]
}

/// `SUM_LANES` rows of `width` sums, to which `add` adds index by index.
fn lanes(width: usize, weights: &[f32], mut add: impl FnMut(usize, f32, &mut [f32])) -> Vec<f32> {
    let mut sums = vec![0.0; SUM_LANES * width];
    for (index, &weight) in weights.iter().enumerate() {
        let lane = index % SUM_LANES;
        add(index, weight, &mut sums[lane * width..(lane + 1) * width]);
    }
    sums
}

/// Adds the upper half of the rows to the lower half until one is left, as a workgroup does.
fn tree(mut sums: Vec<f32>, width: usize) -> Vec<f32> {
    let mut half = SUM_LANES / 2;
    while half > 0 {
        let (low, high) = sums.split_at_mut(half * width);
        for (low, high) in low.iter_mut().zip(high) {
            *low += *high;
        }
        half /= 2;
    }
    sums.truncate(width);
    sums
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turns_are_good_to_single_precision() {
        for step in 0..100_000_u32 {
            let word = step.wrapping_mul(2_654_435_769);
            let angle = std::f64::consts::TAU * (f64::from(word) / 4_294_967_296.0 - 0.125);
            let (sin, cos) = turn(word);
            assert!((f64::from(sin) - angle.sin()).abs() < 3e-7, "sin {angle}");
            assert!((f64::from(cos) - angle.cos()).abs() < 3e-7, "cos {angle}");
        }
        for word in [0, 1, 511, 512, u32::MAX] {
            let (a, b) = box_muller(word, word);
            assert!(a.is_finite() && b.is_finite() && a.hypot(b) < 5.8);
        }
    }

    #[test]
    fn statistics_agree_with_double_precision() {
        for count in [1, 2, 63, 64, 65, 1000] {
            let (dofs, mut rows, mut weights) = (3, Vec::new(), Vec::new());
            for index in 0..count {
                let wave = (index as f32 * 0.7).sin();
                rows.extend([2500.0 + wave, -3.0 * wave, 0.125]);
                weights.push(if index % 5 == 3 { 0.0 } else { 0.2 + 0.1 * (index % 7) as f32 });
            }
            let found = Statistics::of(&rows, &weights, &rows[..dofs]);
            let total: f64 = weights.iter().map(|weight| f64::from(*weight)).sum();
            for d in 0..dofs {
                let column =
                    || weights.iter().zip(rows.chunks(dofs)).map(|(w, row)| (f64::from(*w), f64::from(row[d])));
                let mean = column().map(|(w, x)| w * x).sum::<f64>() / total;
                let variance = column().map(|(w, x)| w * (x - mean).powi(2)).sum::<f64>() / total;
                assert!((f64::from(found.mean[d]) - mean).abs() <= 2e-7 * mean.abs() + 1e-6, "{count} rows, mean {d}");
                assert!((f64::from(found.deviation[d]) - variance.sqrt()).abs() < 1e-5, "{count} rows, deviation {d}");
            }
            assert_eq!(found.deviation[2], 0.0);
        }
    }
}
