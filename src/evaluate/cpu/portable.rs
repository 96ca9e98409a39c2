//! The kernel's operations in plain Rust, for any processor; the compiler makes of them what the target has.

#![allow(clippy::needless_range_loop, reason = "loops over lanes say so, and several rows share the index")]

use super::simd::{Lanes, Simd};

/// No instruction set in particular.
#[derive(Clone, Copy, Debug)]
pub(super) struct Portable;

#[inline(always)]
fn zip(a: Lanes, b: Lanes, f: impl Fn(u32, u32) -> u32) -> Lanes {
    let mut result = Lanes::default();
    for lane in 0..16 {
        result.0[lane] = f(a.0[lane], b.0[lane]);
    }
    result
}

/// `a` where the mask holds, else `b`.
#[inline(always)]
fn select(mask: Lanes, a: Lanes, b: Lanes) -> Lanes {
    zip(zip(a, mask, |a, mask| a & mask), zip(b, mask, |b, mask| b & !mask), |a, b| a | b)
}

impl Simd for Portable {
    type Words = Lanes;
    type Rows = [f64; 16];
    type ShortRows = [f32; 16];
    type Mask = Lanes;
    type Sum = u32;

    #[inline(always)]
    fn load(self, lanes: &Lanes) -> Lanes {
        *lanes
    }
    #[inline(always)]
    fn store(self, words: Lanes, lanes: &mut Lanes) {
        *lanes = words;
    }
    #[inline(always)]
    fn splat(self, value: u32) -> Lanes {
        Lanes([value; 16])
    }
    #[inline(always)]
    fn and(self, a: Lanes, b: Lanes) -> Lanes {
        zip(a, b, |a, b| a & b)
    }
    #[inline(always)]
    fn or(self, a: Lanes, b: Lanes) -> Lanes {
        zip(a, b, |a, b| a | b)
    }
    #[inline(always)]
    fn and_not(self, a: Lanes, b: Lanes) -> Lanes {
        zip(a, b, |a, b| a & !b)
    }
    #[inline(always)]
    fn sub(self, a: Lanes, b: Lanes) -> Lanes {
        zip(a, b, u32::wrapping_sub)
    }
    #[inline(always)]
    fn min(self, a: Lanes, b: Lanes) -> Lanes {
        zip(a, b, |a, b| (a as i32).min(b as i32) as u32)
    }
    #[inline(always)]
    fn max(self, a: Lanes, b: Lanes) -> Lanes {
        zip(a, b, |a, b| (a as i32).max(b as i32) as u32)
    }
    #[inline(always)]
    fn shift_left(self, value: Lanes, count: Lanes) -> Lanes {
        zip(value, count, |value, count| if count < 32 { value << count } else { 0 })
    }
    #[inline(always)]
    fn below(self, a: Lanes, b: Lanes) -> Lanes {
        zip(a, b, |a, b| if a < b { u32::MAX } else { 0 })
    }
    #[inline(always)]
    fn min_where(self, mask: Lanes, a: Lanes, b: Lanes) -> Lanes {
        select(mask, self.min(a, b), a)
    }
    #[inline(always)]
    fn max_where(self, mask: Lanes, a: Lanes, b: Lanes) -> Lanes {
        select(mask, self.max(a, b), a)
    }
    #[inline(always)]
    fn bit(self, mask: Lanes, count: Lanes) -> Lanes {
        self.shift_left(self.and(mask, self.splat(1)), count)
    }
    #[inline(always)]
    fn is_zero(self, words: Lanes) -> bool {
        words.0.iter().fold(0, |all, word| all | word) == 0
    }
    #[inline(always)]
    fn row_words(self, first: u32) -> Lanes {
        let mut rows = Lanes::default();
        for lane in 0..16 {
            rows.0[lane] = first + lane as u32;
        }
        rows
    }
    #[inline(always)]
    fn rows(self, first: u32) -> [f64; 16] {
        std::array::from_fn(|lane| f64::from(first) + lane as f64)
    }
    /// The value is never near an integer, so its floor is the integer nearest to half less; adding 1.5 times 2 to the
    /// power of the mantissa's length leaves that integer in the low bits.
    #[inline(always)]
    fn line(self, rows: [f64; 16], slope: f64, offset: f64) -> Lanes {
        let mut result = Lanes::default();
        for lane in 0..16 {
            let below = (slope * rows[lane] + offset) - 0.5;
            result.0[lane] = (below + 6_755_399_441_055_744.0).to_bits() as u32;
        }
        result
    }
    #[inline(always)]
    fn short_rows(self, first: u32) -> [f32; 16] {
        std::array::from_fn(|lane| first as f32 + lane as f32)
    }
    #[inline(always)]
    fn short_line(self, rows: [f32; 16], slope: f32, offset: f32) -> Lanes {
        let mut result = Lanes::default();
        for lane in 0..16 {
            let below = (slope * rows[lane] + offset) - 0.5;
            result.0[lane] = (below + 12_582_912.0).to_bits().wrapping_sub(12_582_912.0_f32.to_bits());
        }
        result
    }
    #[inline(always)]
    fn no_bits(self) -> u32 {
        0
    }
    #[inline(always)]
    fn count(self, sum: u32, words: Lanes) -> u32 {
        // Two words at a time: a bit count, or what stands for one, is as cheap for 64 bits.
        words
            .0
            .chunks_exact(2)
            .fold(sum, |sum, pair| sum + (u64::from(pair[0]) << 32 | u64::from(pair[1])).count_ones())
    }
    #[inline(always)]
    fn total(self, sum: u32) -> u32 {
        sum
    }
}
