//! What drawing triangles needs, worked out for eight at a time.

#![allow(clippy::needless_range_loop, reason = "loops over lanes say so, and several rows share the index")]

use super::super::simd::Sides;
use super::eight::{Eight, Mask};
use super::surface::{Seen, Surface};

/// Triangles that are set up at a time.
pub(super) const LANES: usize = 8;

/// The first pixel whose centre is at or after a place.
#[inline(always)]
pub(super) fn ceil(at: i32) -> i32 {
    (at + 255) >> 8
}

type Row = [f64; LANES];
type Whole = [i32; LANES];

/// What drawing eight triangles needs. A triangle is drawn in lines: rows, or columns where it is a tall sliver. Lines and places along
/// them count from the first pixel of what of a triangle's surroundings is in the region.
#[derive(Clone, Copy, Debug, Default)]
#[repr(align(64))]
pub(super) struct Setup {
    /// The first pixel, from the region's.
    pub(super) first: [Whole; 2],
    /// The size along lines and the number of lines.
    length: Row,
    pub(super) lines: Whole,
    /// Not 0 where lines are columns.
    pub(super) is_tall: [u64; LANES],
    /// The lines of [`Sides`].
    slopes: [Row; 4],
    offsets: [Row; 4],
    /// Depth along a line, from line to line, and at the first pixel.
    pub(super) along: Row,
    pub(super) across: Row,
    pub(super) depth: Row,
    pub(super) base: [u32; LANES],
    /// Not 0 where these are so small that depths in double precision are exact.
    pub(super) is_exact: [u64; LANES],
    /// What depths are made from where they are not.
    pub(super) wide: [Wide; LANES],
}

/// The depth of a pixel's centre is that of `base` and, rounded down, `(right x + down y + start) / whole`; numerators without what is
/// beyond 64 bits.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Wide {
    right: i64,
    down: i64,
    start: i64,
    whole: i64,
    /// The numerators in double precision.
    about: [f64; 3],
    base: u32,
}

/// A side of eight triangles: the vector from its first end to its last, and twice the area of the triangle that it makes with the centre
/// of the first pixel.
struct Side {
    dx: Eight,
    dy: Eight,
    area: Eight,
}

impl Side {
    #[inline(always)]
    fn new(from: [Eight; 2], to: [Eight; 2], centre: [Eight; 2]) -> Self {
        let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
        Self { dx, dy, area: dx * (centre[1] - from[1]) - dy * (centre[0] - from[0]) }
    }

    /// Its slope and offset among the lines of [`Sides`], and whether it is before what it bounds, or behind.
    #[inline(always)]
    fn bound(&self, is_tall: Mask) -> (Eight, Eight, [Mask; 2]) {
        let zero = Eight::of(0.0);
        // On the left, or on a horizontal top.
        let takes = self.dy.is_less(zero).or(self.dy.is_equal(zero).and(zero.is_less(self.dx)));
        let least = takes.pick(zero, Eight::of(1.0));
        // The area that a step along a line and one to the next line adds.
        let (right, down) = (self.dy * Eight::of(-256.0), self.dx * Eight::of(256.0));
        let (along, across) = (is_tall.pick(down, right), is_tall.pick(right, down));
        let inverse = Eight::of(1.0) / along;
        let slope = zero - across * inverse;
        let offset = (along - (self.area - least) - Eight::of(0.5)) * inverse;
        (slope, offset, [zero.is_less(along), along.is_less(zero)])
    }
}

impl Setup {
    /// The lines of a triangle.
    #[inline(always)]
    pub(super) fn sides(&self, lane: usize) -> Sides {
        // One by one: a closure is not always compiled for the instruction set.
        let ([a, b, c, d], [e, f, g, h]) = (&self.slopes, &self.offsets);
        Sides {
            slopes: [a[lane], b[lane], c[lane], d[lane]],
            offsets: [e[lane], f[lane], g[lane], h[lane]],
            length: self.length[lane],
        }
    }

    /// Sets up the triangles `kept`, at most [`LANES`], for what of them is in the region from its first pixel to behind its last.
    #[inline(always)]
    pub(super) fn fill(&mut self, surface: &Surface, seen: &Seen, kept: &[u32], region: [[i32; 2]; 2]) {
        // Clockwise to the eye: `x[corner]`, `y[corner]`, `n[corner]`.
        let (mut x, mut y, mut n) = ([[0; LANES]; 3], [[0; LANES]; 3], [[0; LANES]; 3]);
        for (lane, &number) in kept.iter().enumerate() {
            let triangle = &surface.triangles[number as usize];
            let [a, b, c] = triangle.corners;
            for (corner, vertex) in [a, c, b].into_iter().enumerate() {
                [x[corner][lane], y[corner][lane]] = seen.places[vertex as usize];
                n[corner][lane] = seen.depths[vertex as usize][0];
            }
            self.base[lane] = ((n[0][lane] as u32) << 8) | triangle.low;
        }
        self.compute(&x, &y, &n, region);
        for lane in 0..kept.len() {
            if self.is_exact[lane] == 0 {
                let corner = |corner: usize| [x[corner][lane], y[corner][lane], n[corner][lane]];
                let first = [0, 1].map(|axis| self.first[axis][lane] + region[0][axis]);
                self.wide[lane] = Wide::new([0, 1, 2].map(corner), first, self.base[lane]);
            }
        }
    }

    #[inline(always)]
    fn compute(&mut self, x: &[Whole; 3], y: &[Whole; 3], n: &[Whole; 3], [low, high]: [[i32; 2]; 2]) {
        let (mut extent, mut size, mut centre) = ([[0; LANES]; 2], [[0; LANES]; 2], [[0; LANES]; 2]);
        for (axis, [a, b, c]) in [x, y].into_iter().enumerate() {
            for lane in 0..LANES {
                let least = a[lane].min(b[lane]).min(c[lane]);
                let most = a[lane].max(b[lane]).max(c[lane]);
                let first = ceil(least).max(low[axis]);
                extent[axis][lane] = most.wrapping_sub(least);
                size[axis][lane] = ceil(most).min(high[axis]) - first;
                centre[axis][lane] = first.wrapping_mul(256);
                self.first[axis][lane] = first - low[axis];
            }
        }
        let a = [Eight::whole(&x[0]), Eight::whole(&y[0])];
        let b = [Eight::whole(&x[1]), Eight::whole(&y[1])];
        let c = [Eight::whole(&x[2]), Eight::whole(&y[2])];
        let centre = [Eight::whole(&centre[0]), Eight::whole(&centre[1])];
        let (of_a, of_b, of_c) = (Side::new(b, c, centre), Side::new(c, a, centre), Side::new(a, b, centre));
        let whole = of_a.area + of_b.area + of_c.area;

        let [width, height] = [Eight::whole(&size[0]), Eight::whole(&size[1])];
        // Of less than two pixels a row and more rows than are drawn at a time.
        let is_thin = whole.is_less(height * Eight::of(262_144.0)).and(Eight::of(8.0).is_less(height));
        let is_tall = is_thin.and(width.is_less(height));
        self.is_tall = is_tall.0;
        self.length = is_tall.pick(height, width).0;
        for lane in 0..LANES {
            self.lines[lane] = if self.is_tall[lane] == 0 { size[1][lane] } else { size[0][lane] };
        }

        let [a, b, c] = [of_a.bound(is_tall), of_b.bound(is_tall), of_c.bound(is_tall)];
        // There are one or two of either.
        for side in 0..2 {
            let [is_a, is_b, is_c] = [a.2[side], b.2[side], c.2[side]];
            self.slopes[2 * side] = is_a.pick(a.0, is_b.pick(b.0, c.0)).0;
            self.offsets[2 * side] = is_a.pick(a.1, is_b.pick(b.1, c.1)).0;
            self.slopes[2 * side + 1] = is_c.pick(c.0, is_b.pick(b.0, a.0)).0;
            self.offsets[2 * side + 1] = is_c.pick(c.1, is_b.pick(b.1, a.1)).0;
        }

        let na = Eight::whole(&n[0]);
        let (nb, nc) = (Eight::whole(&n[1]) - na, Eight::whole(&n[2]) - na);
        let inverse = Eight::of(0.5) / whole;
        let right = (of_b.dy * nb + of_c.dy * nc) * Eight::of(-512.0) * inverse;
        let down = (of_b.dx * nb + of_c.dx * nc) * Eight::of(512.0) * inverse;
        self.along = is_tall.pick(down, right).0;
        self.across = is_tall.pick(right, down).0;
        let start = (of_b.area * nb + of_c.area * nc) * Eight::of(2.0) + whole + Eight::of(0.5);
        self.depth = (start * inverse).0;
        let range = nb.size().larger(nc.size()).larger(Eight::of(1.0));
        let product = Eight::whole(&extent[0]) * Eight::whole(&extent[1]) * range;
        self.is_exact = product.is_less(Eight::of(EXACT)).0;
    }
}

/// Below this product of width, height and range of depths the depths of a triangle are exact in double precision (docs/RASTER.md).
pub(super) const EXACT: f64 = (1_u64 << 45) as f64;

impl Wide {
    #[cold]
    fn new(corners: [[i32; 3]; 3], first: [i32; 2], base: u32) -> Self {
        let [a, b, c] = corners.map(|corner| corner.map(i64::from));
        let centre = first.map(|pixel| 256 * i64::from(pixel));
        let side = |from: [i64; 3], to: [i64; 3]| {
            let (dx, dy) = (to[0] - from[0], to[1] - from[1]);
            (dx, dy, dx * (centre[1] - from[1]) - dy * (centre[0] - from[0]))
        };
        let [(_, _, of_a), (bx, by, of_b), (cx, cy, of_c)] = [side(b, c), side(c, a), side(a, b)];
        let (mb, mc) = (b[2] - a[2], c[2] - a[2]);
        let whole = of_a + of_b + of_c;
        let right = -512 * (by * mb + cy * mc);
        let down = 512 * (bx * mb + cx * mc);
        let share = 2.0 * (of_b as f64 * mb as f64 + of_c as f64 * mc as f64) + whole as f64;
        let start = of_b.wrapping_mul(mb).wrapping_add(of_c.wrapping_mul(mc)).wrapping_mul(2).wrapping_add(whole);
        Self { right, down, start, whole: 2 * whole, about: [right as f64, down as f64, share], base }
    }

    /// The key of a pixel: about right, and corrected by what is left over.
    #[inline(always)]
    pub(super) fn key(&self, x: i32, y: i32) -> u32 {
        let [right, down, first] = self.about;
        let about = ((right * f64::from(x) + down * f64::from(y) + first) / self.whole as f64) as i64;
        let exact = self.right.wrapping_mul(x.into()).wrapping_add(self.down.wrapping_mul(y.into()));
        let left = exact.wrapping_add(self.start).wrapping_sub(about.wrapping_mul(self.whole));
        let steps = about + left.div_euclid(self.whole);
        self.base.wrapping_add((steps as u32) << 8)
    }
}
