//! Value noise (METHOD B1): a number on each lattice point, a cubic between. In [-1, 1], with more weight on low frequencies
//! than gradient noise has. Rounding and coordinates as there.

use super::gradient::{joined, mix, shares, sides, split};
use super::lattice::Lattice;

#[inline(always)]
fn fade(t: f32) -> f32 {
    t * t * (3.0 - 2.0 * t)
}

/// The number of a word, [-1, 1): its upper 24 bits.
#[inline(always)]
fn number(word: u32) -> f32 {
    (word >> 8) as i32 as f32 * (1.0 / 8_388_608.0) - 1.0
}

/// Value noise over a line.
#[inline(always)]
pub fn value1<L: Lattice>(lattice: &L, [x]: [f32; 1]) -> f32 {
    let (cell, t) = split(x);
    let [left, right] = sides(lattice, 0, cell);
    mix(number(lattice.word(lattice.first(left))), number(lattice.word(lattice.first(right))), fade(t))
}

/// Four corners mixed along x and y.
#[inline(always)]
fn face<L: Lattice>(lattice: &L, [a, b, c, d]: [u32; 4], [fx, fy]: [f32; 2]) -> f32 {
    let low = mix(number(lattice.word(a)), number(lattice.word(b)), fx);
    let high = mix(number(lattice.word(c)), number(lattice.word(d)), fx);
    mix(low, high, fy)
}

/// Value noise over a plane.
#[inline(always)]
pub fn value2<L: Lattice>(lattice: &L, [x, y]: [f32; 2]) -> f32 {
    let ((cx, tx), (cy, ty)) = (split(x), split(y));
    face(lattice, shares(lattice, sides(lattice, 0, cx), sides(lattice, 1, cy)), [fade(tx), fade(ty)])
}

/// Value noise in space.
#[inline(always)]
pub fn value3<L: Lattice>(lattice: &L, [x, y, z]: [f32; 3]) -> f32 {
    let ((cx, tx), (cy, ty), (cz, tz)) = (split(x), split(y), split(z));
    let corners = shares(lattice, sides(lattice, 0, cx), sides(lattice, 1, cy));
    let [z0, z1] = sides(lattice, 2, cz);
    let fades = [fade(tx), fade(ty)];
    let near = face(lattice, joined(lattice, corners, 2, z0), fades);
    let far = face(lattice, joined(lattice, corners, 2, z1), fades);
    mix(near, far, fade(tz))
}

/// Value noise in space and time.
#[inline(always)]
pub fn value4<L: Lattice>(lattice: &L, [x, y, z, w]: [f32; 4]) -> f32 {
    let ((cx, tx), (cy, ty), (cz, tz), (cw, tw)) = (split(x), split(y), split(z), split(w));
    let corners = shares(lattice, sides(lattice, 0, cx), sides(lattice, 1, cy));
    let ([z0, z1], [w0, w1]) = (sides(lattice, 2, cz), sides(lattice, 3, cw));
    let (near, far) = (joined(lattice, corners, 2, z0), joined(lattice, corners, 2, z1));
    let (fades, fz) = ([fade(tx), fade(ty)], fade(tz));
    let a = face(lattice, joined(lattice, near, 3, w0), fades);
    let b = face(lattice, joined(lattice, far, 3, w0), fades);
    let c = face(lattice, joined(lattice, near, 3, w1), fades);
    let d = face(lattice, joined(lattice, far, 3, w1), fades);
    mix(mix(a, b, fz), mix(c, d, fz), fade(tw))
}
