//! Eight numbers in double precision, one a triangle. Written as loops over lanes that the compiler makes vector instructions of, whatever
//! the instruction set.

#![allow(clippy::needless_range_loop, reason = "loops over lanes say so, and several rows share the index")]

use std::ops::{Add, Div, Mul, Sub};

const LANES: usize = 8;

/// Eight numbers.
#[derive(Clone, Copy)]
pub(super) struct Eight(pub(super) [f64; LANES]);

/// Eight truths: all bits, or none.
#[derive(Clone, Copy)]
pub(super) struct Mask(pub(super) [u64; LANES]);

#[inline(always)]
fn zip<A: Copy, B: Copy, R: Copy + Default>(a: [A; LANES], b: [B; LANES], f: impl Fn(A, B) -> R) -> [R; LANES] {
    let mut result = [R::default(); LANES];
    for lane in 0..LANES {
        result[lane] = f(a[lane], b[lane]);
    }
    result
}

#[inline(always)]
fn truth(holds: bool) -> u64 {
    u64::from(holds).wrapping_neg()
}

impl Eight {
    #[inline(always)]
    pub(super) fn of(value: f64) -> Self {
        Self([value; LANES])
    }

    #[inline(always)]
    pub(super) fn whole(values: &[i32; LANES]) -> Self {
        let mut result = [0.0; LANES];
        for lane in 0..LANES {
            result[lane] = f64::from(values[lane]);
        }
        Self(result)
    }

    /// Without its sign.
    #[inline(always)]
    pub(super) fn size(self) -> Self {
        Self(zip(self.0, self.0, |value, _| value.abs()))
    }

    #[inline(always)]
    pub(super) fn larger(self, other: Self) -> Self {
        Self(zip(self.0, other.0, |a, b| if a > b { a } else { b }))
    }

    #[inline(always)]
    pub(super) fn is_less(self, other: Self) -> Mask {
        Mask(zip(self.0, other.0, |a, b| truth(a < b)))
    }

    #[inline(always)]
    pub(super) fn is_equal(self, other: Self) -> Mask {
        Mask(zip(self.0, other.0, |a, b| truth(a == b)))
    }
}

impl Mask {
    #[inline(always)]
    pub(super) fn and(self, other: Self) -> Self {
        Self(zip(self.0, other.0, |a, b| a & b))
    }

    #[inline(always)]
    pub(super) fn or(self, other: Self) -> Self {
        Self(zip(self.0, other.0, |a, b| a | b))
    }

    /// The first where it holds, else the second.
    #[inline(always)]
    pub(super) fn pick(self, a: Eight, b: Eight) -> Eight {
        let a = zip(self.0, a.0, |mask, value| mask & value.to_bits());
        let b = zip(self.0, b.0, |mask, value| !mask & value.to_bits());
        Eight(zip(a, b, |a, b| f64::from_bits(a | b)))
    }
}

impl Add for Eight {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        Self(zip(self.0, other.0, |a, b| a + b))
    }
}

impl Sub for Eight {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        Self(zip(self.0, other.0, |a, b| a - b))
    }
}

impl Mul for Eight {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        Self(zip(self.0, other.0, |a, b| a * b))
    }
}

impl Div for Eight {
    type Output = Self;
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        Self(zip(self.0, other.0, |a, b| a / b))
    }
}
