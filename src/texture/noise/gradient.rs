//! Perlin's gradient noise in one to four dimensions (METHOD B1): a gradient on each lattice point, the quintic fade
//! between. 0 on every lattice point, about [-1, 1] between. Coordinates of any size are defined; past 2^31 all cells of a
//! direction share their words, and from 2^23 on every coordinate is a lattice point itself.
//!
//! Single precision, each operation rounded on its own in the stated order, so that `glsl/texture/noise.glsl` has the same
//! values. No branches: a loop over points becomes vector code.

use super::lattice::Lattice;

/// A coordinate's cell and the place in it, [0, 1]. Cells saturate at the ends of their type. `floor` and `as` say the same,
/// but keep loops over points scalar; so the whole number comes from the bits.
#[inline(always)]
pub(super) fn split(x: f32) -> (i32, f32) {
    // From here on every number is whole.
    const WHOLE: f32 = 8_388_608.0;
    let bits = x.to_bits();
    let size = f32::from_bits(bits & 0x7FFF_FFFF);
    let negative = bits >> 31 != 0;
    // Below 2^23 an addition rounds, and leaves the integer in the lower bits.
    let shifted = size + WHOLE;
    let rounded = f32::from_bits((shifted - WHOLE).to_bits() | (bits & 0x8000_0000));
    let small = shifted.to_bits().wrapping_sub(WHOLE.to_bits()) as i32;
    // From 2^23 on the significand is shifted, up to 2^31.
    let exponent = (bits >> 23 & 0xFF) as i32 - 150;
    let significand = ((bits & 0x007F_FFFF) | 0x0080_0000) as i32;
    let large = significand.wrapping_shl(exponent as u32);
    let is_small = size < WHOLE;
    let magnitude = if is_small { small } else { large };
    let above = is_small & (rounded > x);
    let cell = (if negative { 0_i32.wrapping_sub(magnitude) } else { magnitude }).wrapping_sub(i32::from(above));
    let end = if negative { i32::MIN } else { i32::MAX };
    let cell = if exponent > 7 { end } else { cell };
    let floor = if above { rounded - 1.0 } else { rounded };
    let floor = if is_small { floor } else { x };
    (cell, x - floor)
}

/// The cells on both sides of a coordinate.
#[inline(always)]
pub(super) fn sides<L: Lattice>(lattice: &L, axis: usize, cell: i32) -> [i32; 2] {
    [lattice.wrapped(axis, cell), lattice.wrapped(axis, cell.wrapping_add(1))]
}

#[inline(always)]
fn fade(t: f32) -> f32 {
    t * t * t * (t * (t * 6.0 - 15.0) + 10.0)
}

#[inline(always)]
pub(super) fn mix(a: f32, b: f32, t: f32) -> f32 {
    a + (b - a) * t
}

/// `value` with its sign turned where the uppermost bit of `word` is set.
#[inline(always)]
fn signed(value: f32, word: u32) -> f32 {
    f32::from_bits(value.to_bits() ^ (word & 0x8000_0000))
}

/// Slopes of [-2, 2).
#[inline(always)]
fn slope1(word: u32, x: f32) -> f32 {
    ((word >> 8) as i32 as f32 * (1.0 / 4_194_304.0) - 2.0) * x
}

/// Eight directions, 22.5 degrees off the axes, of length sqrt(2).
#[inline(always)]
fn slope2(word: u32, x: f32, y: f32) -> f32 {
    let steep = word & 0x2000_0000 != 0;
    let u = if steep { y } else { x };
    let v = if steep { x } else { y };
    signed(u * 1.306_563, word) + signed(v * 0.541_196_1, word << 1)
}

/// The directions to the twelve edges of a cube, each as likely.
#[inline(always)]
fn slope3(word: u32, x: f32, y: f32, z: f32) -> f32 {
    // Which of three pairs of axes: the lower 30 bits by thirds.
    let pair = (word & 0x3FFF_FFFF) as i32;
    let u = if pair < 0x1555_5555 { y } else { x };
    let v = if pair < 0x2AAA_AAAA { z } else { y };
    signed(u, word) + signed(v, word << 1)
}

/// The directions to the 32 edges of a hypercube, scaled by 2/3 for the same range as below four dimensions.
#[inline(always)]
fn slope4(word: u32, x: f32, y: f32, z: f32, w: f32) -> f32 {
    let left_out = (word >> 27) & 3;
    let a = if left_out == 0 { y } else { x };
    let b = if left_out <= 1 { z } else { y };
    let c = if left_out <= 2 { w } else { z };
    (signed(a, word) + signed(b, word << 1) + signed(c, word << 2)) * (2.0 / 3.0)
}

/// Gradient noise over a line.
#[inline(always)]
pub fn perlin1<L: Lattice>(lattice: &L, [x]: [f32; 1]) -> f32 {
    let (cell, tx) = split(x);
    let [x0, x1] = sides(lattice, 0, cell);
    let left = slope1(lattice.word(lattice.first(x0)), tx);
    let right = slope1(lattice.word(lattice.first(x1)), tx - 1.0);
    mix(left, right, fade(tx))
}

// The corners are functions and not closures: those are not always inlined, and one call in a loop over lanes keeps it scalar.

/// Words of the cell's four corners along x and y, before further axes are joined: x0 y0, x1 y0, x0 y1, x1 y1.
#[inline(always)]
pub(super) fn shares<L: Lattice>(lattice: &L, [x0, x1]: [i32; 2], [y0, y1]: [i32; 2]) -> [u32; 4] {
    let (h0, h1) = (lattice.first(x0), lattice.first(x1));
    [lattice.join(h0, 1, y0), lattice.join(h1, 1, y0), lattice.join(h0, 1, y1), lattice.join(h1, 1, y1)]
}

/// Shares joined with a cell of a further axis.
#[inline(always)]
pub(super) fn joined<L: Lattice>(lattice: &L, [a, b, c, d]: [u32; 4], axis: usize, cell: i32) -> [u32; 4] {
    [lattice.join(a, axis, cell), lattice.join(b, axis, cell), lattice.join(c, axis, cell), lattice.join(d, axis, cell)]
}

/// Gradient noise over a plane.
#[inline(always)]
pub fn perlin2<L: Lattice>(lattice: &L, [x, y]: [f32; 2]) -> f32 {
    let ((cx, tx), (cy, ty)) = (split(x), split(y));
    let [a, b, c, d] = shares(lattice, sides(lattice, 0, cx), sides(lattice, 1, cy));
    let (sx, sy) = (tx - 1.0, ty - 1.0);
    let fx = fade(tx);
    let low = mix(slope2(lattice.word(a), tx, ty), slope2(lattice.word(b), sx, ty), fx);
    let high = mix(slope2(lattice.word(c), tx, sy), slope2(lattice.word(d), sx, sy), fx);
    mix(low, high, fade(ty))
}

/// The face of a cell at one side along z.
#[inline(always)]
fn face3<L: Lattice>(lattice: &L, [a, b, c, d]: [u32; 4], [tx, ty, z]: [f32; 3], [fx, fy]: [f32; 2]) -> f32 {
    let (sx, sy) = (tx - 1.0, ty - 1.0);
    let low = mix(slope3(lattice.word(a), tx, ty, z), slope3(lattice.word(b), sx, ty, z), fx);
    let high = mix(slope3(lattice.word(c), tx, sy, z), slope3(lattice.word(d), sx, sy, z), fx);
    mix(low, high, fy)
}

/// Gradient noise in space.
#[inline(always)]
pub fn perlin3<L: Lattice>(lattice: &L, [x, y, z]: [f32; 3]) -> f32 {
    let ((cx, tx), (cy, ty), (cz, tz)) = (split(x), split(y), split(z));
    let face = shares(lattice, sides(lattice, 0, cx), sides(lattice, 1, cy));
    let [z0, z1] = sides(lattice, 2, cz);
    let fades = [fade(tx), fade(ty)];
    let near = face3(lattice, joined(lattice, face, 2, z0), [tx, ty, tz], fades);
    let far = face3(lattice, joined(lattice, face, 2, z1), [tx, ty, tz - 1.0], fades);
    mix(near, far, fade(tz))
}

/// The face of a cell at one side along z and w.
#[inline(always)]
fn face4<L: Lattice>(lattice: &L, [a, b, c, d]: [u32; 4], [tx, ty, z, w]: [f32; 4], [fx, fy]: [f32; 2]) -> f32 {
    let (sx, sy) = (tx - 1.0, ty - 1.0);
    let low = mix(slope4(lattice.word(a), tx, ty, z, w), slope4(lattice.word(b), sx, ty, z, w), fx);
    let high = mix(slope4(lattice.word(c), tx, sy, z, w), slope4(lattice.word(d), sx, sy, z, w), fx);
    mix(low, high, fy)
}

/// Gradient noise in space and time.
#[inline(always)]
pub fn perlin4<L: Lattice>(lattice: &L, [x, y, z, w]: [f32; 4]) -> f32 {
    let ((cx, tx), (cy, ty), (cz, tz), (cw, tw)) = (split(x), split(y), split(z), split(w));
    let face = shares(lattice, sides(lattice, 0, cx), sides(lattice, 1, cy));
    let ([z0, z1], [w0, w1]) = (sides(lattice, 2, cz), sides(lattice, 3, cw));
    let fades = [fade(tx), fade(ty)];
    let (near, far) = (joined(lattice, face, 2, z0), joined(lattice, face, 2, z1));
    let (sz, sw) = (tz - 1.0, tw - 1.0);
    let a = face4(lattice, joined(lattice, near, 3, w0), [tx, ty, tz, tw], fades);
    let b = face4(lattice, joined(lattice, far, 3, w0), [tx, ty, sz, tw], fades);
    let c = face4(lattice, joined(lattice, near, 3, w1), [tx, ty, tz, sw], fades);
    let d = face4(lattice, joined(lattice, far, 3, w1), [tx, ty, sz, sw], fades);
    let fz = fade(tz);
    mix(mix(a, b, fz), mix(c, d, fz), fade(tw))
}
