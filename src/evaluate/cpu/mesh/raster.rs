//! The triangles and silhouette edges of one image, drawn into keys: what is nearest has the smallest (docs/RASTER.md, "Mesh model").
//! Triangles are set up eight at a time, drawn by rows, eight rows at a time; no pixel beside them is looked at.

#![allow(clippy::needless_range_loop, reason = "loops over lanes say so, and several rows share the index")]

use crate::body::Mesh;

use super::super::simd::{Ramp, Sides, Simd, Spans};
use super::eight::{Eight, Mask};

/// The vertices in one view.
#[derive(Clone, Debug, Default)]
pub(super) struct Seen {
    /// Positions in 1/256 pixel; 0 without an image.
    pub(super) places: Vec<[i32; 2]>,
    /// The numbers of their depths, as corners of triangles and as ends of silhouette edges; [`Seen::NO_IMAGE`] without an image.
    pub(super) depths: Vec<[i32; 2]>,
    /// Whether every one has an image.
    pub(super) is_whole: bool,
}

impl Seen {
    pub(super) const NO_IMAGE: i32 = -1;
}

/// The surface of a mesh as it is drawn.
#[derive(Clone, Debug)]
pub(super) struct Surface {
    triangles: Vec<Triangle>,
    edges: Vec<Edge>,
}

#[derive(Clone, Copy, Debug)]
struct Triangle {
    corners: [u32; 3],
    /// The last byte of its keys.
    low: u32,
}

#[derive(Clone, Copy, Debug)]
struct Edge {
    /// Its triangles.
    sides: [u32; 2],
    ends: [u32; 2],
    low: u32,
}

/// The last byte of a key: the smaller, the sooner at equal depth.
fn low(byte: u8) -> u32 {
    u32::from(!byte)
}

impl Surface {
    pub(super) fn new(mesh: &Mesh) -> Self {
        let label = |vertex: u32| mesh.vertices[vertex as usize].label;
        let mut of_side = std::collections::HashMap::new();
        let mut triangles = Vec::with_capacity(mesh.triangles.len());
        for (number, &corners) in (0..).zip(&mesh.triangles) {
            let [a, b, c] = corners;
            of_side.extend([([a, b], number), ([b, c], number), ([c, a], number)]);
            triangles.push(Triangle { corners, low: low(label(a)) });
        }
        let edge = |ends: [u32; 2]| {
            let [p, q] = ends;
            // A mesh is closed: both are there.
            Some(Edge { sides: [*of_side.get(&[p, q])?, *of_side.get(&[q, p])?], ends, low: low(label(p) | 0x80) })
        };
        let edges = mesh.edges.iter().filter_map(|found| edge(found.ends)).collect();
        Self { triangles, edges }
    }
}

/// What a triangle shows to the camera; two neighbours share a silhouette edge where the sum is [`FRONT`].
const BACK: u8 = 0;
const FRONT: u8 = 1;
const NO_IMAGE: u8 = 2;

/// Nothing is drawn there: farther than anything.
pub(super) const NOTHING: u32 = u32::MAX;

/// Triangles that are set up at a time.
const LANES: usize = 8;

/// The keys of an image, and the room to draw it in.
#[derive(Clone, Debug)]
pub(super) struct Canvas {
    /// Rows of the region that anything is drawn in, `stride` apart.
    keys: Vec<u32>,
    stride: usize,
    low: [i32; 2],
    /// Columns and rows.
    size: [usize; 2],
    /// What each triangle shows.
    shown: Vec<u8>,
    /// Triangles that show their outside and may have a pixel.
    kept: Vec<u32>,
    /// Silhouette edges.
    outline: Vec<u32>,
    setup: Box<Setup>,
}

/// Keys behind a row and behind the last one that are read and written as they are.
const MARGIN: usize = 8;

impl Canvas {
    /// For pictures of at most so many pixels.
    pub(super) fn new(surface: &Surface, width: usize, height: usize) -> Self {
        Self {
            keys: vec![NOTHING; (width + 2 * MARGIN) * height + MARGIN],
            stride: 0,
            low: [0; 2],
            size: [0; 2],
            shown: vec![BACK; surface.triangles.len()],
            kept: vec![0; surface.triangles.len() + 1],
            outline: vec![0; surface.edges.len() + 1],
            setup: Box::default(),
        }
    }

    /// The first pixel of the region, and its rows, left to right; pixels without anything are [`NOTHING`].
    pub(super) fn region(&mut self) -> ([usize; 2], impl Iterator<Item = &mut [u32]>) {
        let [width, height] = self.size;
        let rows = self.keys.chunks_exact_mut(self.stride.max(1)).take(height).map(move |row| &mut row[..width]);
        (self.low.map(|low| low as usize), rows)
    }

    /// Draws a mesh into the region `low` to before `high` of a picture, which holds all that is in the picture.
    #[inline(always)]
    pub(super) fn draw<S: Simd>(&mut self, simd: S, surface: &Surface, seen: &Seen, [low, high]: [[i32; 2]; 2]) {
        self.low = low;
        self.size = [0, 1].map(|axis| usize::try_from(high[axis] - low[axis]).unwrap_or(0));
        if self.size.contains(&0) {
            self.size = [0; 2];
            return;
        }
        self.stride = self.size[0].next_multiple_of(MARGIN);
        let used = self.stride * self.size[1] + MARGIN;
        self.keys[..used].fill(NOTHING);
        let kept = self.choose(surface, seen, high);
        for first in (0..kept).step_by(LANES) {
            let count = LANES.min(kept - first);
            self.setup.fill(surface, seen, &self.kept[first..][..count], [low, high]);
            for lane in 0..count {
                self.paint(simd, lane);
            }
        }
        let outline = self.choose_outline(surface);
        for place in 0..outline {
            let edge = surface.edges[self.outline[place] as usize];
            let [p, q] = edge.ends;
            let (p, q) = (p as usize, q as usize);
            let ends = [(seen.places[p], seen.depths[p][1]), (seen.places[q], seen.depths[q][1])];
            self.paint_edge(ends, edge.low);
        }
    }

    /// Says what each triangle shows and keeps those that have to be drawn; returns how many.
    #[inline(always)]
    fn choose(&mut self, surface: &Surface, seen: &Seen, high: [i32; 2]) -> usize {
        // Slices of one's own are not looked up again after every number that is written.
        let (places, is_whole, chosen) = (&seen.places[..], seen.is_whole, &mut self.kept[..]);
        let mut fronts = 0;
        for ((number, triangle), shown) in (0..).zip(&surface.triangles).zip(&mut self.shown[..]) {
            let [a, b, c] = triangle.corners;
            let (a, b, c) = (places[a as usize], places[b as usize], places[c as usize]);
            let (ax, ay) = (i64::from(a[0]), i64::from(a[1]));
            let (bx, by) = (i64::from(b[0]) - ax, i64::from(b[1]) - ay);
            let (cx, cy) = (i64::from(c[0]) - ax, i64::from(c[1]) - ay);
            let mut shows = u8::from(bx * cy - by * cx < 0);
            if !is_whole && triangle.corners.iter().any(|&corner| seen.depths[corner as usize][0] < 0) {
                shows = NO_IMAGE;
            }
            *shown = shows;
            chosen[fronts] = number;
            fronts += usize::from(shows == FRONT);
        }
        // Of these the ones that may have a pixel's centre in the region.
        let mut kept = 0;
        let low = self.low;
        for place in 0..fronts {
            let number = chosen[place];
            let [a, b, c] = surface.triangles[number as usize].corners;
            let (a, b, c) = (places[a as usize], places[b as usize], places[c as usize]);
            let mut has_centres = true;
            for axis in 0..2 {
                let first = ceil(a[axis].min(b[axis]).min(c[axis])).max(low[axis]);
                let end = ceil(a[axis].max(b[axis]).max(c[axis])).min(high[axis]);
                has_centres &= first < end;
            }
            chosen[kept] = number;
            kept += usize::from(has_centres);
        }
        kept
    }

    #[inline(always)]
    fn choose_outline(&mut self, surface: &Surface) -> usize {
        let (shown, outline) = (&self.shown[..], &mut self.outline[..]);
        let mut count = 0;
        for (number, edge) in (0..).zip(&surface.edges) {
            let [left, right] = edge.sides;
            outline[count] = number;
            count += usize::from(shown[left as usize] + shown[right as usize] == FRONT);
        }
        count
    }

    /// Draws a triangle that is set up.
    #[inline(always)]
    fn paint<S: Simd>(&mut self, simd: S, lane: usize) {
        let (setup, keys) = (&*self.setup, &mut self.keys[..]);
        let is_tall = setup.is_tall[lane] != 0;
        let [step, stride] = if is_tall { [self.stride, 1] } else { [1, self.stride] };
        let first = setup.first[1][lane] as usize * self.stride + setup.first[0][lane] as usize;
        if setup.is_exact[lane] == 0 {
            self.paint_wide(simd, lane, first, [step, stride]);
            return;
        }
        let sides = setup.sides(lane);
        let ramp = Ramp {
            along: setup.along[lane],
            across: setup.across[lane],
            depth: setup.depth[lane],
            base: setup.base[lane],
        };
        let mut spans = Spans::default();
        let lines = setup.lines[lane];
        for block in (0..lines).step_by(8) {
            let mut some = simd.spans(&sides, &ramp, block, &mut spans) & ones(lines - block);
            while some != 0 {
                let line = (some.trailing_zeros() & 7) as usize;
                some &= some - 1;
                let (start, end) = (spans.starts[line], spans.ends[line]);
                let at = first + (block as usize + line) * stride + start as usize * step;
                let key = &mut keys[at];
                *key = (*key).min(spans.keys[line]);
                if end - start == 1 {
                    continue;
                }
                let line = block + line as i32;
                if is_tall {
                    for place in start + 1..end {
                        let key = &mut keys[at + (place - start) as usize * step];
                        *key = (*key).min(ramp.key(place, line));
                    }
                } else {
                    simd.nearer(&mut keys[at..], (end - start) as usize, &ramp, [start, line]);
                }
            }
        }
    }

    /// The same where depths need more than double precision.
    #[inline(always)]
    fn paint_wide<S: Simd>(&mut self, simd: S, lane: usize, first: usize, [step, stride]: [usize; 2]) {
        let (sides, wide) = (self.setup.sides(lane), self.setup.wide[lane]);
        let (is_tall, lines) = (self.setup.is_tall[lane] != 0, self.setup.lines[lane]);
        let mut spans = Spans::default();
        for block in (0..lines).step_by(8) {
            let some = simd.spans(&sides, &Ramp::default(), block, &mut spans) & ones(lines - block);
            for line in (0..8).filter(|line| some >> line & 1 != 0) {
                for place in spans.starts[line]..spans.ends[line] {
                    let at = first + (block as usize + line) * stride + place as usize * step;
                    let line = block + line as i32;
                    let key = if is_tall { wide.key(line, place) } else { wide.key(place, line) };
                    self.keys[at] = self.keys[at].min(key);
                }
            }
        }
    }

    /// Draws a silhouette edge between places of some depth.
    #[inline(always)]
    fn paint_edge(&mut self, [(p, depth), (q, last_depth)]: [([i32; 2], i32); 2], low: u32) {
        let from = [(p[0] + 128) >> 8, (p[1] + 128) >> 8];
        let to = [(q[0] + 128) >> 8, (q[1] + 128) >> 8];
        let d = [to[0] - from[0], to[1] - from[1]];
        let long = usize::from(d[0].abs() < d[1].abs());
        let (short, steps) = (1 - long, d[long].abs());
        // From the region's first pixel.
        if steps == 0 {
            let [x, y] = [from[0] - self.low[0], from[1] - self.low[1]];
            if (0..self.size[0] as i32).contains(&x) && (0..self.size[1] as i32).contains(&y) {
                let key = &mut self.keys[y as usize * self.stride + x as usize];
                *key = (*key).min((depth as u32) << 8 | low);
            }
            return;
        }
        let (from, sign) = ([from[0] - self.low[0], from[1] - self.low[1]], if d[long] < 0 { -1 } else { 1 });
        // The steps that are inside along the longer side.
        let last = self.size[long] as i32 - 1;
        let (first, last) = if sign > 0 {
            ((-from[long]).max(0), (last - from[long]).min(steps))
        } else {
            ((from[long] - last).max(0), from[long].min(steps))
        };
        // To the nearest, a tie upwards; numerators are below 2^42, so that half a unit more than a tie's outweighs all rounding.
        let half = 1.0 / f64::from(2 * steps);
        let aside = (f64::from(2 * d[short]) * half, (f64::from(steps) + 0.5) * half);
        let deeper = (2.0 * f64::from(last_depth - depth) * half, (f64::from(steps) + 0.5) * half);
        let strides = if long == 0 { [1, self.stride] } else { [self.stride, 1] };
        for step in first..=last {
            let along = f64::from(step);
            let off = from[short] + (aside.0 * along + aside.1).floor() as i32;
            if off < 0 || off >= self.size[short] as i32 {
                continue;
            }
            let depth = depth + (deeper.0 * along + deeper.1).floor() as i32;
            let at = (from[long] + sign * step) as usize * strides[0] + off as usize * strides[1];
            self.keys[at] = self.keys[at].min((depth as u32) << 8 | low);
        }
    }
}

/// The first pixel whose centre is at or after a place.
#[inline(always)]
fn ceil(at: i32) -> i32 {
    (at + 255) >> 8
}

type Row = [f64; LANES];
type Whole = [i32; LANES];

/// What drawing eight triangles needs. A triangle is drawn in lines: rows, or columns where it is a tall sliver. Lines and places along
/// them count from the first pixel of what of a triangle's surroundings is in the region.
#[derive(Clone, Copy, Debug, Default)]
#[repr(align(64))]
struct Setup {
    /// The first pixel, from the region's.
    first: [Whole; 2],
    /// The size along lines and the number of lines.
    length: Row,
    lines: Whole,
    /// Not 0 where lines are columns.
    is_tall: [u64; LANES],
    /// The lines of [`Sides`].
    slopes: [Row; 4],
    offsets: [Row; 4],
    /// Depth along a line, from line to line, and at the first pixel.
    along: Row,
    across: Row,
    depth: Row,
    base: [u32; LANES],
    /// Not 0 where these are so small that depths in double precision are exact.
    is_exact: [u64; LANES],
    /// What depths are made from where they are not.
    wide: [Wide; LANES],
}

/// The depth of a pixel's centre is that of `base` and, rounded down, `(right x + down y + start) / whole`; numerators without what is
/// beyond 64 bits.
#[derive(Clone, Copy, Debug, Default)]
struct Wide {
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

/// As many ones as that, at least 1 of 8.
#[inline(always)]
fn ones(count: i32) -> u32 {
    0xff >> (8 - count.min(8))
}

impl Setup {
    #[inline(always)]
    fn sides(&self, lane: usize) -> Sides {
        // One by one: a closure is not always compiled for the instruction set.
        let ([a, b, c, d], [e, f, g, h]) = (&self.slopes, &self.offsets);
        Sides {
            slopes: [a[lane], b[lane], c[lane], d[lane]],
            offsets: [e[lane], f[lane], g[lane], h[lane]],
            length: self.length[lane],
        }
    }

    #[inline(always)]
    fn fill(&mut self, surface: &Surface, seen: &Seen, kept: &[u32], region: [[i32; 2]; 2]) {
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
}

impl Wide {
    /// The key of a pixel: about right, and corrected by what is left over.
    #[inline(always)]
    fn key(&self, x: i32, y: i32) -> u32 {
        let [right, down, first] = self.about;
        let about = ((right * f64::from(x) + down * f64::from(y) + first) / self.whole as f64) as i64;
        let exact = self.right.wrapping_mul(x.into()).wrapping_add(self.down.wrapping_mul(y.into()));
        let left = exact.wrapping_add(self.start).wrapping_sub(about.wrapping_mul(self.whole));
        let steps = about + left.div_euclid(self.whole);
        self.base.wrapping_add((steps as u32) << 8)
    }
}
