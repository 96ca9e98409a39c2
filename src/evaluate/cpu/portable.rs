//! The kernel's operations in plain Rust, for any processor; the compiler makes of them what the target has.

#![allow(clippy::needless_range_loop, reason = "loops over lanes say so, and several rows share the index")]

use super::simd::{Lanes, Ramp, Sides, Simd, Spans};

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
    const SKIPS_EDGES: bool = true;
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
    fn min(self, a: Lanes, b: Lanes) -> Lanes {
        zip(a, b, |a, b| (a as i32).min(b as i32) as u32)
    }
    #[inline(always)]
    fn max(self, a: Lanes, b: Lanes) -> Lanes {
        zip(a, b, |a, b| (a as i32).max(b as i32) as u32)
    }
    #[inline(always)]
    fn sub_to_zero(self, a: Lanes, b: Lanes) -> Lanes {
        zip(a, b, u32::saturating_sub)
    }
    #[inline(always)]
    fn ones_from(self, count: Lanes) -> Lanes {
        zip(count, count, |count, _| if count < 32 { u32::MAX << count } else { 0 })
    }
    #[inline(always)]
    fn shift_left(self, words: Lanes, count: u32) -> Lanes {
        zip(words, words, |word, _| word.checked_shl(count).unwrap_or(0))
    }
    #[inline(always)]
    fn shift_right(self, words: Lanes, count: u32) -> Lanes {
        zip(words, words, |word, _| word.checked_shr(count).unwrap_or(0))
    }
    #[inline(always)]
    fn mask(self, bits: u64) -> Lanes {
        let mut mask = Lanes::default();
        for lane in 0..16 {
            mask.0[lane] = if bits as u32 & 1 << lane != 0 { u32::MAX } else { 0 };
        }
        mask
    }
    #[inline(always)]
    fn add_where(self, mask: Lanes, a: Lanes, b: Lanes, c: Lanes) -> Lanes {
        self.or(a, self.and(mask, self.and_not(b, c)))
    }
    #[inline(always)]
    fn first_rows(self) -> ([f64; 16], [f32; 16]) {
        (std::array::from_fn(|lane| lane as f64), std::array::from_fn(|lane| lane as f32))
    }
    #[inline(always)]
    fn next_rows(self, (rows, short): ([f64; 16], [f32; 16])) -> ([f64; 16], [f32; 16]) {
        let (mut rows, mut short) = (rows, short);
        for lane in 0..16 {
            rows[lane] += 16.0;
            short[lane] += 16.0;
        }
        (rows, short)
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
    fn is_zero(self, words: Lanes) -> bool {
        words.0.iter().fold(0, |all, word| all | word) == 0
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
    fn short_line(self, rows: [f32; 16], slope: f32, offset: f32) -> Lanes {
        let mut result = Lanes::default();
        for lane in 0..16 {
            let below = (slope * rows[lane] + offset) - 0.5;
            result.0[lane] = (below + 12_582_912.0).to_bits().wrapping_sub(12_582_912.0_f32.to_bits());
        }
        result
    }
    #[inline(always)]
    fn least(self, values: &[i32; 16]) -> i32 {
        values.iter().fold(i32::MAX, |least, &value| least.min(value))
    }
    #[inline(always)]
    fn most(self, values: &[i32; 16]) -> i32 {
        values.iter().fold(i32::MIN, |most, &value| most.max(value))
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
    fn spans(self, sides: &Sides, ramp: &Ramp, first: i32, spans: &mut Spans) -> u32 {
        let (mut starts, mut ends) = ([0.0; 8], [0.0; 8]);
        for lane in 0..8 {
            let row = f64::from(first) + lane as f64;
            let at = |line: usize| sides.slopes[line] * row + sides.offsets[line];
            let larger = |a: f64, b: f64| if a > b { a } else { b };
            let smaller = |a: f64, b: f64| if a < b { a } else { b };
            // The floor of the larger is the larger floor.
            starts[lane] = larger(larger(at(0), at(1)), 0.0).floor();
            ends[lane] = smaller(smaller(at(2), at(3)), sides.length).floor();
        }
        let mut some = 0;
        for lane in 0..8 {
            spans.starts[lane] = starts[lane] as i32;
            spans.ends[lane] = ends[lane] as i32;
            some |= u32::from(starts[lane] < ends[lane]) << lane;
        }
        let mut left = some;
        while left != 0 {
            let lane = left.trailing_zeros() as usize & 7;
            left &= left - 1;
            spans.keys[lane] = ramp.key(spans.starts[lane], first + lane as i32);
        }
        some
    }
    #[inline(always)]
    fn nearer(self, keys: &mut [u32], count: usize, ramp: &Ramp, [place, row]: [i32; 2]) {
        let depth = ramp.across * f64::from(row) + ramp.depth;
        for (key, place) in keys[..count].iter_mut().zip(place..) {
            let steps = (ramp.along * f64::from(place) + depth).floor() as i32;
            *key = (*key).min(ramp.base.wrapping_add((steps as u32) << 8));
        }
    }
    #[inline(always)]
    fn total(self, sum: u32) -> u32 {
        sum
    }
}
