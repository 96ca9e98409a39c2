//! The triangles and silhouette edges of one image, drawn into keys: what is nearest has the smallest (docs/RASTER.md, "Mesh model").
//! Triangles are set up eight at a time (`setup.rs`), drawn by rows, eight rows at a time; no pixel beside them is looked at.

#![allow(clippy::needless_range_loop, reason = "loops over lanes say so, and several rows share the index")]

use super::super::simd::{Ramp, Simd, Spans};
use super::setup::{LANES, Setup, ceil};
use super::surface::{Seen, Surface};

/// What a triangle shows to the camera; two neighbours share a silhouette edge where the sum is [`FRONT`].
const BACK: u8 = 0;
const FRONT: u8 = 1;
const NO_IMAGE: u8 = 2;

/// Nothing is drawn there: farther than anything.
pub(super) const NOTHING: u32 = u32::MAX;

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

/// As many ones as that, at least 1 of 8.
#[inline(always)]
fn ones(count: i32) -> u32 {
    0xff >> (8 - count.min(8))
}
