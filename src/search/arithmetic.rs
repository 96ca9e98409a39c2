//! Single-precision arithmetic that every device repeats to the bit: additions, multiplications and bit patterns alone, in a
//! fixed order. Divisions, square roots, logarithms and exponentials of a library or a device differ in their last bits, so
//! none is used. `glsl/search/arithmetic.glsl` holds the same operations; the two change together.

/// Running sums of [`Statistics`]; row `i` goes to the sum `i % SUM_LANES`.
const SUM_LANES: usize = 64;
/// Exponents below this count as minus infinity: less than the smallest share, 2^-31, is left.
const LEAST_EXPONENT: f32 = -22.0;

/// 1 / sqrt(x) of a positive normal number, to some 2 units of the last place: a guess from the bits, then Newton's steps,
/// which leave 3e-2, 2e-3, 5e-6 and less than rounding.
#[inline(always)]
fn inverse_root(x: f32) -> f32 {
    let half = 0.5 * x;
    let mut y = f32::from_bits(0x5F37_59DF_u32.wrapping_sub(x.to_bits() >> 1));
    for _ in 0..3 {
        y *= 1.5 - half * y * y;
    }
    y
}

/// Square root of a number of 0 or more.
#[inline(always)]
pub(super) fn root(x: f32) -> f32 {
    x * inverse_root(x)
}

/// 1 / x of a positive normal number.
#[inline(always)]
pub(super) fn reciprocal(x: f32) -> f32 {
    let y = inverse_root(x);
    let r = y * y;
    r + r * (1.0 - x * r)
}

/// Natural logarithm of a normal positive number: exponent and mantissa apart, the mantissa in [sqrt(1/2), sqrt(2)) by
/// `ln m = 2 artanh t`, `t = (m - 1) / (m + 1)`, whose series is cut after t^9 (error below 2^-27).
#[inline(always)]
fn ln(x: f32) -> f32 {
    // Subtracting sqrt(1/2)'s bits makes the exponent field count from there.
    const SQRT_HALF: u32 = 0x3F35_04F3;
    let shifted = x.to_bits().wrapping_sub(SQRT_HALF);
    let exponent = (shifted as i32) >> 23;
    let mantissa = f32::from_bits((shifted & 0x007F_FFFF).wrapping_add(SQRT_HALF));
    let t = (mantissa - 1.0) * reciprocal(mantissa + 1.0);
    let s = t * t;
    let series = 1.0 + s * (1.0 / 3.0 + s * (1.0 / 5.0 + s * (1.0 / 7.0 + s * (1.0 / 9.0))));
    exponent as f32 * std::f32::consts::LN_2 + 2.0 * t * series
}

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

/// e^x of a number of 0 or less; exactly 1 of 0, and exactly 0 of what is below -22 or not a number. The power of two apart,
/// Taylor's series to the 7th power (error below 2^-27).
#[inline(always)]
pub(super) fn exp_of_negative(x: f32) -> f32 {
    /// 1.5 * 2^23: adding it rounds to the nearest integer.
    const ROUND: f32 = 12_582_912.0;
    if x.is_nan() || x < LEAST_EXPONENT {
        return 0.0;
    }
    let n = (x * std::f32::consts::LOG2_E + ROUND) - ROUND;
    // ln 2 in two pieces, the first of which times n is exact.
    let r = (x - n * (355.0 / 512.0)) - n * -2.121_944_4e-4;
    let series = 1.0 / 6.0 + r * (1.0 / 24.0 + r * (1.0 / 120.0 + r * (1.0 / 720.0 + r * (1.0 / 5040.0))));
    let series = 1.0 + r * (1.0 + r * (0.5 + r * series));
    series * f32::from_bits(((n as i32 + 127) as u32) << 23)
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
    fn elementary_functions_are_good_to_single_precision() {
        for step in 0..100_000_u32 {
            let word = step.wrapping_mul(2_654_435_769);
            let u = ((word >> 9) as f32 + 0.5) / 8_388_608.0;
            let exact = f64::from(u).ln();
            assert!((f64::from(ln(u)) - exact).abs() <= 3e-7 * exact.abs().max(1e-3), "ln {u}");
            let angle = std::f64::consts::TAU * (f64::from(word) / 4_294_967_296.0 - 0.125);
            let (sin, cos) = turn(word);
            assert!((f64::from(sin) - angle.sin()).abs() < 3e-7, "sin {angle}");
            assert!((f64::from(cos) - angle.cos()).abs() < 3e-7, "cos {angle}");
            let x = f32::from_bits(0x2000_0000 + word % 0x3F00_0000);
            let exact = f64::from(x).sqrt();
            assert!((f64::from(root(x)) / exact - 1.0).abs() < 3e-7, "sqrt {x}");
            let x = x.clamp(1e-18, 1e18);
            assert!((f64::from(reciprocal(x)) * f64::from(x) - 1.0).abs() < 3e-7, "1 / {x}");
            let x = -22.0 * u;
            assert!((f64::from(exp_of_negative(x)) / f64::from(x).exp() - 1.0).abs() < 4e-7, "exp {x}");
        }
        for word in [0, 1, 511, 512, u32::MAX] {
            let (a, b) = box_muller(word, word);
            assert!(a.is_finite() && b.is_finite() && a.hypot(b) < 5.8);
        }
        assert_eq!((root(0.0), exp_of_negative(0.0), exp_of_negative(-0.0)), (0.0, 1.0, 1.0));
        for x in [-22.01, -1e30, f32::NEG_INFINITY, f32::NAN] {
            assert_eq!(exp_of_negative(x), 0.0);
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
