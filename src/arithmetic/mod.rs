//! Single-precision functions that every processor and device repeats to the bit: additions, multiplications and bit patterns
//! alone, in a fixed order, nothing fused. Square roots, logarithms and exponentials of a library or a device differ in their last
//! bits. `glsl/arithmetic/elementary.glsl` holds the same operations; the two change together.

/// Exponents below this count as minus infinity: less than 2^-31 is left.
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
pub(crate) fn root(x: f32) -> f32 {
    x * inverse_root(x)
}

/// 1 / x of a positive normal number.
#[inline(always)]
pub(crate) fn reciprocal(x: f32) -> f32 {
    let y = inverse_root(x);
    let r = y * y;
    r + r * (1.0 - x * r)
}

/// Natural logarithm of a normal positive number: exponent and mantissa apart, the mantissa in [sqrt(1/2), sqrt(2)) by
/// `ln m = 2 artanh t`, `t = (m - 1) / (m + 1)`, whose series is cut after t^9 (error below 2^-27).
#[inline(always)]
pub(crate) fn ln(x: f32) -> f32 {
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

/// e^x of a number of 0 or less; exactly 1 of 0, and exactly 0 of what is below -22 or not a number. The power of two apart,
/// Taylor's series to the 7th power (error below 2^-27).
#[inline(always)]
pub(crate) fn exp_of_negative(x: f32) -> f32 {
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

/// x^exponent of a number above 0 and at most 1, and a positive exponent.
#[inline(always)]
pub(crate) fn real_power(x: f32, exponent: f32) -> f32 {
    exp_of_negative(exponent * ln(x))
}

/// Sine of an angle in turns, of any size: folded to a quarter of a turn about 0, Taylor's series to the 13th power there (error
/// below 2^-30).
#[inline(always)]
pub(crate) fn sine_of_turns(turns: f32) -> f32 {
    let rest = turns - (turns + 0.5).floor();
    let folded = if rest > 0.25 {
        0.5 - rest
    } else if rest < -0.25 {
        -0.5 - rest
    } else {
        rest
    };
    let s = folded * folded;
    let series = 81.605_25 + s * (-76.705_86 + s * (42.058_693 + s * (-15.094_642 + s * 3.819_952_5)));
    folded * (6.283_185_5 + s * (-41.341_7 + s * series))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sines_and_powers_are_good_to_single_precision() {
        for step in 0..100_000_u32 {
            let word = step.wrapping_mul(2_654_435_769);
            let turns = (word >> 8) as f32 / 1_048_576.0 - 8.0;
            let exact = (f64::from(turns) * std::f64::consts::TAU).sin();
            assert!((f64::from(sine_of_turns(turns)) - exact).abs() < 4e-7, "sine of {turns} turns");
            let x = ((word >> 9) as f32 + 1.0) / 8_388_608.0;
            for exponent in [2.4_f32, 1.0 / 2.4] {
                let exact = f64::from(x).powf(f64::from(exponent));
                assert!((f64::from(real_power(x, exponent)) - exact).abs() < 1e-6 * exact + 3e-10, "{x}^{exponent}");
            }
        }
        assert_eq!([0.0, 0.5, -0.5, 1e9].map(sine_of_turns), [0.0; 4]);
        assert_eq!(real_power(1.0, 2.4), 1.0);
    }

    #[test]
    fn elementary_functions_are_good_to_single_precision() {
        for step in 0..100_000_u32 {
            let word = step.wrapping_mul(2_654_435_769);
            let u = ((word >> 9) as f32 + 0.5) / 8_388_608.0;
            let exact = f64::from(u).ln();
            assert!((f64::from(ln(u)) - exact).abs() <= 3e-7 * exact.abs().max(1e-3), "ln {u}");
            let x = f32::from_bits(0x2000_0000 + word % 0x3F00_0000);
            let exact = f64::from(x).sqrt();
            assert!((f64::from(root(x)) / exact - 1.0).abs() < 3e-7, "sqrt {x}");
            let x = x.clamp(1e-18, 1e18);
            assert!((f64::from(reciprocal(x)) * f64::from(x) - 1.0).abs() < 3e-7, "1 / {x}");
            let x = -22.0 * u;
            assert!((f64::from(exp_of_negative(x)) / f64::from(x).exp() - 1.0).abs() < 4e-7, "exp {x}");
        }
        assert_eq!((root(0.0), exp_of_negative(0.0), exp_of_negative(-0.0)), (0.0, 1.0, 1.0));
        for x in [-22.01, -1e30, f32::NEG_INFINITY, f32::NAN] {
            assert_eq!(exp_of_negative(x), 0.0);
        }
    }
}
