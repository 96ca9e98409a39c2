//! Value noise (SPEC B1): a number on each lattice point, a cubic between. In [-1, 1], with more weight on low frequencies
//! than gradient noise has. Rounding and coordinates as there.

use super::gradient::{mix, sides, split};
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
    let [left, right] = sides(lattice, 0, cell).map(|cell| number(lattice.word(lattice.first(cell))));
    mix(left, right, fade(t))
}

/// Value noise over a plane.
#[inline(always)]
pub fn value2<L: Lattice>(lattice: &L, [x, y]: [f32; 2]) -> f32 {
    let ((cx, tx), (cy, ty)) = (split(x), split(y));
    let shares = sides(lattice, 0, cx).map(|cell| lattice.first(cell));
    let fx = fade(tx);
    let [low, high] = sides(lattice, 1, cy).map(|cell| {
        let [left, right] = shares.map(|share| number(lattice.word(lattice.join(share, 1, cell))));
        mix(left, right, fx)
    });
    mix(low, high, fade(ty))
}

/// Value noise in space.
#[inline(always)]
pub fn value3<L: Lattice>(lattice: &L, [x, y, z]: [f32; 3]) -> f32 {
    let ((cx, tx), (cy, ty), (cz, tz)) = (split(x), split(y), split(z));
    let shares = sides(lattice, 0, cx).map(|cell| lattice.first(cell));
    let rows = sides(lattice, 1, cy).map(|cell| shares.map(|share| lattice.join(share, 1, cell)));
    let (fx, fy) = (fade(tx), fade(ty));
    let [near, far] = sides(lattice, 2, cz).map(|cell| {
        let [low, high] = rows.map(|row| {
            let [left, right] = row.map(|share| number(lattice.word(lattice.join(share, 2, cell))));
            mix(left, right, fx)
        });
        mix(low, high, fy)
    });
    mix(near, far, fade(tz))
}

/// Value noise in space and time.
#[inline(always)]
pub fn value4<L: Lattice>(lattice: &L, [x, y, z, w]: [f32; 4]) -> f32 {
    let ((cx, tx), (cy, ty), (cz, tz), (cw, tw)) = (split(x), split(y), split(z), split(w));
    let shares = sides(lattice, 0, cx).map(|cell| lattice.first(cell));
    let rows = sides(lattice, 1, cy).map(|cell| shares.map(|share| lattice.join(share, 1, cell)));
    let layers = sides(lattice, 2, cz);
    let (fx, fy, fz) = (fade(tx), fade(ty), fade(tz));
    let [first, last] = sides(lattice, 3, cw).map(|time| {
        let [near, far] = layers.map(|cell| {
            let [low, high] = rows.map(|row| {
                let [left, right] =
                    row.map(|share| number(lattice.word(lattice.join(lattice.join(share, 2, cell), 3, time))));
                mix(left, right, fx)
            });
            mix(low, high, fy)
        });
        mix(near, far, fz)
    });
    mix(first, last, fade(tw))
}
