//! The outlines of sixteen parts as linear functions of the image row, ready for the kernel (docs/RASTER.md).
//!
//! Every pixel bound of the raster rule is floor of a rational with a denominator D, linear in the row. Adding half a D-th
//! to the numerator keeps the exact value at least 1/(2D) away from an integer; the error stays below a seventh of a D-th.
//!
//! Columns and rows count from the part itself, so how exact they are depends on its size, not on the picture's: corners
//! are within 32768 pixels, and within 542 where no edge is longer than [`NEAR`] across or down. Fill, D = 256 dY: slope
//! and offset have numerators below 2^45 and 2^47.1 and errors of 2^-52 of those, so at most 0.06/D in all; in a near
//! outline the reciprocal is good to 2^-47, but the numerators are below 2^33 and 2^34.3: 2^-12/D. Borders, D = 2 dY, in
//! single precision: numerators below 2^18.1 and 2^19.1 with errors of 2^-23, results below 542, at most 0.15/D.

#![allow(clippy::needless_range_loop, reason = "loops over lanes say so, and several rows share the index")]

use super::front::{LANES, QuadChunk};
use super::planes::{CELL_COLUMNS, CELL_ROWS};

/// Linear bounds of sixteen parts: `field[edge][part]`. Columns count from the part's `origin`, rows from the first row of
/// the first cell it lies in, so that the numbers are as small as the part.
#[derive(Clone, Debug)]
#[repr(align(64))]
pub(super) struct OutlineChunk {
    /// Fill: the first pixel at or right of the crossing is floor(slope * row + offset).
    pub(super) fill_slope: [[f64; LANES]; 4],
    pub(super) fill_offset: [[f64; LANES]; 4],
    /// Fill: rows whose pixel centres the edge crosses.
    pub(super) fill_rows: [RowRange; 4],
    /// Border: in a row the line covers from floor(slope * row + from) to before floor(slope * row + to).
    pub(super) line_slope: [[f64; LANES]; 4],
    pub(super) line_from: [[f64; LANES]; 4],
    pub(super) line_to: [[f64; LANES]; 4],
    /// The same in single precision. Only one of the two forms is filled in, this one where `is_near`.
    pub(super) short_slope: [[f32; LANES]; 4],
    pub(super) short_from: [[f32; LANES]; 4],
    pub(super) short_to: [[f32; LANES]; 4],
    /// Whether single precision is exact for the borders of all parts that show.
    pub(super) is_near: bool,
    /// Border: rows.
    pub(super) line_rows: [RowRange; 4],
    /// Border: columns of its ends, first and past the last, from the origin on.
    pub(super) line_left: [[i32; LANES]; 4],
    pub(super) line_right: [[i32; LANES]; 4],
    /// Picture column of the columns' zero: `left` where the part is narrow, else the first one of the cell of `left`.
    pub(super) origin: [i32; LANES],
    /// Whether the part begins inside of the picture and is at most 32 pixels wide, in an outline that is near.
    pub(super) is_narrow: [u32; LANES],
    /// Bounding box of each part in pixels, clipped to the picture: half open; inside out when there is nothing to draw.
    pub(super) left: [i32; LANES],
    pub(super) right: [i32; LANES],
    pub(super) top: [i32; LANES],
    pub(super) bottom: [i32; LANES],
}

/// Consecutive rows of sixteen parts, half open.
#[derive(Clone, Copy, Debug, Default)]
#[repr(align(64))]
pub(super) struct RowRange {
    first: [i32; LANES],
    end: [i32; LANES],
    /// The first 64 rows as bits.
    bits: [u64; LANES],
}

impl RowRange {
    #[inline(always)]
    fn set_bits(&mut self) {
        for lane in 0..LANES {
            self.bits[lane] = ones_from(self.first[lane]) & !ones_from(self.end[lane]);
        }
    }

    /// 64 rows of a part as bits, from row `row` on.
    #[inline(always)]
    pub(super) fn bits_from(&self, part: usize, row: u32) -> u64 {
        if row == 0 { self.bits[part] } else { self.late_bits(part, row as i32) }
    }

    /// Few parts are that tall.
    #[cold]
    fn late_bits(&self, part: usize, row: i32) -> u64 {
        ones_from(self.first[part] - row) & !ones_from(self.end[part] - row)
    }
}

/// The bits at and above `bit`.
#[inline(always)]
fn ones_from(bit: i32) -> u64 {
    let bit = bit.max(0) as u64;
    if bit < 64 { u64::MAX << bit } else { 0 }
}

impl Default for OutlineChunk {
    fn default() -> Self {
        Self {
            fill_slope: [[0.0; LANES]; 4],
            fill_offset: [[0.0; LANES]; 4],
            fill_rows: [RowRange::default(); 4],
            line_slope: [[0.0; LANES]; 4],
            line_from: [[0.0; LANES]; 4],
            line_to: [[0.0; LANES]; 4],
            short_slope: [[0.0; LANES]; 4],
            short_from: [[0.0; LANES]; 4],
            short_to: [[0.0; LANES]; 4],
            is_near: false,
            line_rows: [RowRange::default(); 4],
            line_left: [[0; LANES]; 4],
            line_right: [[0; LANES]; 4],
            origin: [0; LANES],
            is_narrow: [0; LANES],
            left: [0; LANES],
            right: [0; LANES],
            top: [0; LANES],
            bottom: [0; LANES],
        }
    }
}

/// The longest side, in pixels across or down, of a part whose borders single precision draws exactly.
const NEAR: i32 = 255;

impl OutlineChunk {
    /// The outlines of a chunk of quads in a picture of `width` x `height`.
    #[inline(always)]
    pub(super) fn build(&mut self, quads: &QuadChunk, width: i32, height: i32) {
        let (mut pixel_x, mut pixel_y) = (to_pixels(&quads.x), to_pixels(&quads.y));
        let (x_extent, y_extent) = (Extent::of(&pixel_x), Extent::of(&pixel_y));
        let mut longest = 0;
        for lane in 0..LANES {
            let (left, right) = (x_extent.least[lane].max(0), (x_extent.most[lane] + 1).min(width));
            let (top, bottom) = (y_extent.least[lane].max(0), (y_extent.most[lane] + 1).min(height));
            let shown = (quads.drawn[lane] != 0) & (left < right) & (top < bottom);
            self.left[lane] = if shown { left } else { width };
            self.right[lane] = if shown { right } else { 0 };
            self.top[lane] = if shown { top } else { height };
            self.bottom[lane] = if shown { bottom } else { 0 };
            let side = x_extent.longest_side[lane].max(y_extent.longest_side[lane]);
            longest = longest.max(if shown { side } else { 0 });
        }
        self.is_near = longest <= NEAR;
        let may_be_narrow = if self.is_near { CELL_COLUMNS as i32 } else { 0 };
        let mut base = [0; LANES];
        let mut end = [0; LANES];
        for lane in 0..LANES {
            let (least, most) = (x_extent.least[lane], x_extent.most[lane]);
            let is_narrow = (least >= 0) & (most - least < may_be_narrow);
            self.is_narrow[lane] = u32::from(is_narrow);
            let left = least.max(0);
            self.origin[lane] = if is_narrow { left } else { left & -(CELL_COLUMNS as i32) };
            base[lane] = y_extent.least[lane].max(0) & -(CELL_ROWS as i32);
            end[lane] = height - base[lane];
        }
        let (mut x, mut y) = (quads.x, quads.y);
        shift(&mut x, &self.origin, 8);
        shift(&mut y, &base, 8);
        shift(&mut pixel_x, &self.origin, 0);
        shift(&mut pixel_y, &base, 0);
        for edge in 0..4 {
            let next = (edge + 1) % 4;
            self.build_fill(edge, [&x[edge], &y[edge], &x[next], &y[next]], &end);
            let ends = [&pixel_x[edge], &pixel_y[edge], &pixel_x[next], &pixel_y[next]];
            if self.is_near {
                self.build_line::<f32>(edge, ends, &end);
            } else {
                self.build_line::<f64>(edge, ends, &end);
            }
        }
    }

    #[inline(always)]
    fn build_fill(&mut self, edge: usize, [x0, y0, x1, y1]: [&[i32; LANES]; 4], height: &[i32; LANES]) {
        let mut rise = [0; LANES];
        for lane in 0..LANES {
            let (top_y, bottom_y) = (y0[lane].min(y1[lane]), y0[lane].max(y1[lane]));
            rise[lane] = (bottom_y - top_y).max(1);
            // Rows whose centre 256 row lies in [top_y, bottom_y).
            self.fill_rows[edge].first[lane] = (top_y + 255) >> 8;
            self.fill_rows[edge].end[lane] = ((bottom_y + 255) >> 8).min(height[lane]);
        }
        self.fill_rows[edge].set_bits();
        let inverses = if self.is_near { near_inverses(&rise) } else { inverses(&rise) };
        for lane in 0..LANES {
            // ceil(X(row) / 256) with X the crossing, over the denominator 256 dy.
            let run = x1[lane] - x0[lane];
            let (dx, dy) = (f64::from(if y0[lane] <= y1[lane] { run } else { -run }), f64::from(rise[lane]));
            let numerator = f64::from(x0[lane]) * dy - dx * f64::from(y0[lane]) + (256.0 * dy - 1.0) + 0.5;
            self.fill_slope[edge][lane] = dx * inverses[lane];
            self.fill_offset[edge][lane] = numerator * (inverses[lane] * (1.0 / 256.0));
        }
    }

    #[inline(always)]
    fn build_line<R: Real>(&mut self, edge: usize, [x0, y0, x1, y1]: [&[i32; LANES]; 4], height: &[i32; LANES]) {
        for lane in 0..LANES {
            let (left, right) = (x0[lane].min(x1[lane]), x0[lane].max(x1[lane]));
            let (top, bottom) = (y0[lane].min(y1[lane]), y0[lane].max(y1[lane]));
            self.line_rows[edge].first[lane] = top;
            self.line_rows[edge].end[lane] = (bottom + 1).min(height[lane]);
            self.line_left[edge][lane] = left.max(0);
            self.line_right[edge][lane] = right + 1;
        }
        self.line_rows[edge].set_bits();
        let (slopes, froms, tos) = R::coefficients(self, edge);
        for lane in 0..LANES {
            let (left, right) = (x0[lane].min(x1[lane]), x0[lane].max(x1[lane]));
            let (top, bottom) = (y0[lane].min(y1[lane]), y0[lane].max(y1[lane]));
            let (dx, dy) = (right - left, bottom - top);
            let rises = (x1[lane] - x0[lane] < 0) != (y1[lane] - y0[lane] < 0);

            // All bounds over the denominator 2 dy, from the end with the smaller row.
            let start = R::from_pixel(if rises { right } else { left });
            let run = R::from_pixel(if rises { -dx } else { dx });
            let rise = R::from_pixel(dy.max(1));
            let inverse = R::HALF / rise;
            // 2 dy times the exact column at row 0.
            let at_row_0 = (rise * start - run * R::from_pixel(top)) * R::TWO;
            // Steep: the nearest column, a tie to the larger: floor(exact + 1/2).
            let nearest = at_row_0 + rise + R::HALF;
            // Flat: the columns whose nearest row is this one. Falling to the right they begin at the ceiling of the
            // crossing with row - 1/2; rising, after the floor of the crossing with row + 1/2.
            let half_row = R::from_pixel(dx);
            let past = at_row_0 + rise * R::TWO + if rises { R::HALF } else { -R::HALF };
            let (is_steep, level) = (dy > dx, dy == 0);
            let begin = if is_steep { nearest } else { past - half_row } * inverse;
            let end = if is_steep { nearest + rise * R::TWO } else { past + half_row } * inverse;
            // A level line covers its one row from end to end: a slope that leaves the picture within a row either way.
            slopes[lane] = if level { R::from_pixel(1 << 17) } else { run * R::TWO * inverse };
            let level_from = R::from_pixel(-(1 << 17)) * R::from_pixel(top) - R::from_pixel(1 << 16);
            froms[lane] = if level { level_from } else { begin };
            tos[lane] = if level { level_from + R::from_pixel(1 << 17) } else { end };
        }
    }
}

/// Coordinates in 1/256 pixel rounded to whole pixels, halves up.
#[inline(always)]
fn to_pixels([a, b, c, d]: &[[i32; LANES]; 4]) -> [[i32; LANES]; 4] {
    // Corner by corner by name: a loop over corners would be vectorised across them instead of across the lanes.
    let mut pixels = [[0; LANES]; 4];
    for lane in 0..LANES {
        pixels[0][lane] = (a[lane] + 128) >> 8;
        pixels[1][lane] = (b[lane] + 128) >> 8;
        pixels[2][lane] = (c[lane] + 128) >> 8;
        pixels[3][lane] = (d[lane] + 128) >> 8;
    }
    pixels
}

/// Moves the origin of `coordinates` to the pixel `origin`; a pixel has 2 to the power of `bits` units.
#[inline(always)]
fn shift([a, b, c, d]: &mut [[i32; LANES]; 4], origin: &[i32; LANES], bits: u32) {
    for lane in 0..LANES {
        let origin = origin[lane] << bits;
        a[lane] -= origin;
        b[lane] -= origin;
        c[lane] -= origin;
        d[lane] -= origin;
    }
}

/// 1 / value, of integers up to 2^24, in single precision and one step of Newton's: the error squared, 2^-47.
#[inline(always)]
fn near_inverses(values: &[i32; LANES]) -> [f64; LANES] {
    let mut rough = [0.0_f32; LANES];
    for lane in 0..LANES {
        rough[lane] = 1.0 / values[lane] as f32;
    }
    let mut inverses = [0.0; LANES];
    for lane in 0..LANES {
        let rough = f64::from(rough[lane]);
        inverses[lane] = rough * (2.0 - f64::from(values[lane]) * rough);
    }
    inverses
}

/// 1 / value, correctly rounded.
#[inline(always)]
fn inverses(values: &[i32; LANES]) -> [f64; LANES] {
    let mut inverses = [0.0; LANES];
    for lane in 0..LANES {
        inverses[lane] = 1.0 / f64::from(values[lane]);
    }
    inverses
}

/// How far sixteen parts reach along one axis of the picture, pixels.
struct Extent {
    least: [i32; LANES],
    most: [i32; LANES],
    /// The longest edge's extent.
    longest_side: [i32; LANES],
}

impl Extent {
    #[inline(always)]
    fn of([a, b, c, d]: &[[i32; LANES]; 4]) -> Self {
        let mut extent = Self { least: [0; LANES], most: [0; LANES], longest_side: [0; LANES] };
        for lane in 0..LANES {
            let (a, b, c, d) = (a[lane], b[lane], c[lane], d[lane]);
            extent.least[lane] = a.min(b).min(c.min(d));
            extent.most[lane] = a.max(b).max(c.max(d));
            extent.longest_side[lane] = (b - a).abs().max((c - b).abs()).max((d - c).abs().max((a - d).abs()));
        }
        extent
    }
}

/// A precision to compute border lines in.
trait Real:
    Copy
    + std::ops::Add<Output = Self>
    + std::ops::Sub<Output = Self>
    + std::ops::Mul<Output = Self>
    + std::ops::Div<Output = Self>
    + std::ops::Neg<Output = Self>
{
    const HALF: Self;
    const TWO: Self;

    /// A pixel coordinate, exact for those that occur.
    fn from_pixel(value: i32) -> Self;

    /// Where slopes, begins and ends of an edge's lines are kept.
    fn coefficients(
        outline: &mut OutlineChunk,
        edge: usize,
    ) -> (&mut [Self; LANES], &mut [Self; LANES], &mut [Self; LANES]);
}

impl Real for f32 {
    const HALF: Self = 0.5;
    const TWO: Self = 2.0;

    #[inline(always)]
    fn from_pixel(value: i32) -> Self {
        value as Self
    }

    #[inline(always)]
    fn coefficients(
        outline: &mut OutlineChunk,
        edge: usize,
    ) -> (&mut [Self; LANES], &mut [Self; LANES], &mut [Self; LANES]) {
        (&mut outline.short_slope[edge], &mut outline.short_from[edge], &mut outline.short_to[edge])
    }
}

impl Real for f64 {
    const HALF: Self = 0.5;
    const TWO: Self = 2.0;

    #[inline(always)]
    fn from_pixel(value: i32) -> Self {
        Self::from(value)
    }

    #[inline(always)]
    fn coefficients(
        outline: &mut OutlineChunk,
        edge: usize,
    ) -> (&mut [Self; LANES], &mut [Self; LANES], &mut [Self; LANES]) {
        (&mut outline.line_slope[edge], &mut outline.line_from[edge], &mut outline.line_to[edge])
    }
}
