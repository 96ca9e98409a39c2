//! Perlin's gradient noise in one to four dimensions (SPEC B1): a gradient on each lattice point, the quintic fade
//! between. 0 on every lattice point, about [-1, 1] between. Coordinates of any size are defined; past 2^31 all cells of a
//! direction share their words, and from 2^23 on every coordinate is a lattice point itself.
//!
//! Single precision, each operation rounded on its own in the stated order, so that `glsl/texture/noise.glsl` has the same
//! values. No branches: a loop over points becomes vector code.

use super::lattice::Lattice;

/// A coordinate's cell and the place in it, [0, 1]. Cells saturate at the ends of their type.
#[inline(always)]
pub(super) fn split(x: f32) -> (i32, f32) {
    let floor = x.floor();
    (floor as i32, x - floor)
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

/// Gradient noise over a plane.
#[inline(always)]
pub fn perlin2<L: Lattice>(lattice: &L, [x, y]: [f32; 2]) -> f32 {
    let ((cx, tx), (cy, ty)) = (split(x), split(y));
    let ([x0, x1], [y0, y1]) = (sides(lattice, 0, cx), sides(lattice, 1, cy));
    let (h0, h1) = (lattice.first(x0), lattice.first(x1));
    let at = |share: u32, cell: i32, x: f32, y: f32| slope2(lattice.word(lattice.join(share, 1, cell)), x, y);
    let (sx, sy) = (tx - 1.0, ty - 1.0);
    let fx = fade(tx);
    let low = mix(at(h0, y0, tx, ty), at(h1, y0, sx, ty), fx);
    let high = mix(at(h0, y1, tx, sy), at(h1, y1, sx, sy), fx);
    mix(low, high, fade(ty))
}

/// Gradient noise in space.
#[inline(always)]
pub fn perlin3<L: Lattice>(lattice: &L, [x, y, z]: [f32; 3]) -> f32 {
    let ((cx, tx), (cy, ty), (cz, tz)) = (split(x), split(y), split(z));
    let ([x0, x1], [y0, y1], [z0, z1]) = (sides(lattice, 0, cx), sides(lattice, 1, cy), sides(lattice, 2, cz));
    let (h0, h1) = (lattice.first(x0), lattice.first(x1));
    let (sx, sy) = (tx - 1.0, ty - 1.0);
    let (fx, fy) = (fade(tx), fade(ty));
    let (h00, h10) = (lattice.join(h0, 1, y0), lattice.join(h1, 1, y0));
    let (h01, h11) = (lattice.join(h0, 1, y1), lattice.join(h1, 1, y1));
    let layer = |cell: i32, z: f32| {
        let at = |share: u32, x: f32, y: f32| slope3(lattice.word(lattice.join(share, 2, cell)), x, y, z);
        let low = mix(at(h00, tx, ty), at(h10, sx, ty), fx);
        let high = mix(at(h01, tx, sy), at(h11, sx, sy), fx);
        mix(low, high, fy)
    };
    mix(layer(z0, tz), layer(z1, tz - 1.0), fade(tz))
}

/// Gradient noise in space and time.
#[inline(always)]
pub fn perlin4<L: Lattice>(lattice: &L, [x, y, z, w]: [f32; 4]) -> f32 {
    let ((cx, tx), (cy, ty), (cz, tz), (cw, tw)) = (split(x), split(y), split(z), split(w));
    let ([x0, x1], [y0, y1]) = (sides(lattice, 0, cx), sides(lattice, 1, cy));
    let ([z0, z1], [w0, w1]) = (sides(lattice, 2, cz), sides(lattice, 3, cw));
    let (h0, h1) = (lattice.first(x0), lattice.first(x1));
    let (sx, sy) = (tx - 1.0, ty - 1.0);
    let (fx, fy, fz) = (fade(tx), fade(ty), fade(tz));
    let (h00, h10) = (lattice.join(h0, 1, y0), lattice.join(h1, 1, y0));
    let (h01, h11) = (lattice.join(h0, 1, y1), lattice.join(h1, 1, y1));
    let solid = |last: i32, w: f32| {
        let layer = |cell: i32, z: f32| {
            let at = |share: u32, x: f32, y: f32| {
                slope4(lattice.word(lattice.join(lattice.join(share, 2, cell), 3, last)), x, y, z, w)
            };
            let low = mix(at(h00, tx, ty), at(h10, sx, ty), fx);
            let high = mix(at(h01, tx, sy), at(h11, sx, sy), fx);
            mix(low, high, fy)
        };
        mix(layer(z0, tz), layer(z1, tz - 1.0), fz)
    };
    mix(solid(w0, tw), solid(w1, tw - 1.0), fade(tw))
}
