//! The outlines of sixteen parts as linear functions of the image row, ready for the kernel (docs/RASTER.md).
//!
//! Every pixel bound of the raster rule is floor of a rational with a small denominator D, linear in the row. Adding half a
//! D-th to the numerator keeps the exact value at least 1/(2D) away from an integer. In double precision the slope and
//! the offset are rounded once each, and the result once: with corners within 16384 pixels of the origin the error stays
//! under 2^-14/dY, the margin is 2^-9/dY. So the floor is exact, with or without fused multiply-add.
//!
//! Borders have whole pixels for ends, so their margin is 1/(4 dY), and single precision does as long as everything is
//! near: pictures of at most 1024 pixels a side, ends at most 512 pixels outside of that, lines of at most 256 pixels.
//! Flat lines then err by at most 0.094/dY + 2^-11.9, steep ones by 2^-10.6. Where anything is farther, the whole image
//! takes double precision.

#![allow(clippy::needless_range_loop, reason = "loops over lanes say so, and several rows share the index")]

use super::front::{LANES, QuadChunk};

/// Linear bounds of sixteen parts: `field[edge][part]`.
#[derive(Clone, Debug)]
#[repr(align(64))]
pub(super) struct OutlineChunk {
    /// Fill: the first pixel at or right of the crossing is floor(slope * row + offset).
    pub(super) fill_slope: [[f64; LANES]; 4],
    pub(super) fill_offset: [[f64; LANES]; 4],
    /// Fill: rows whose pixel centres the edge crosses, clipped to the picture: first, and how many.
    pub(super) fill_first: [[i32; LANES]; 4],
    pub(super) fill_rows: [[i32; LANES]; 4],
    /// Border: in a row the line covers from floor(slope * row + from) to before floor(slope * row + to).
    pub(super) line_slope: [[f64; LANES]; 4],
    pub(super) line_from: [[f64; LANES]; 4],
    pub(super) line_to: [[f64; LANES]; 4],
    /// The same in single precision. Only one of the two forms is filled in, this one where `is_near`.
    pub(super) short_slope: [[f32; LANES]; 4],
    pub(super) short_from: [[f32; LANES]; 4],
    pub(super) short_to: [[f32; LANES]; 4],
    /// Whether single precision is exact for the borders of all drawn parts.
    pub(super) is_near: bool,
    /// Border: steeper than 45 degrees, one pixel a row, at `line_from` alone.
    pub(super) line_is_steep: [[u32; LANES]; 4],
    /// Border: rows, clipped to the picture: first, and how many.
    pub(super) line_first: [[i32; LANES]; 4],
    pub(super) line_rows: [[i32; LANES]; 4],
    /// Border: columns of its ends, first and past the last.
    pub(super) line_left: [[i32; LANES]; 4],
    pub(super) line_right: [[i32; LANES]; 4],
    /// Bounding box of each part in pixels, clipped to the picture: half open; inside out when there is nothing to draw.
    pub(super) left: [i32; LANES],
    pub(super) right: [i32; LANES],
    pub(super) top: [i32; LANES],
    pub(super) bottom: [i32; LANES],
}

impl Default for OutlineChunk {
    fn default() -> Self {
        Self {
            fill_slope: [[0.0; LANES]; 4],
            fill_offset: [[0.0; LANES]; 4],
            fill_first: [[0; LANES]; 4],
            fill_rows: [[0; LANES]; 4],
            line_slope: [[0.0; LANES]; 4],
            line_from: [[0.0; LANES]; 4],
            line_to: [[0.0; LANES]; 4],
            short_slope: [[0.0; LANES]; 4],
            short_from: [[0.0; LANES]; 4],
            short_to: [[0.0; LANES]; 4],
            is_near: false,
            line_is_steep: [[0; LANES]; 4],
            line_first: [[0; LANES]; 4],
            line_rows: [[0; LANES]; 4],
            line_left: [[0; LANES]; 4],
            line_right: [[0; LANES]; 4],
            left: [0; LANES],
            right: [0; LANES],
            top: [0; LANES],
            bottom: [0; LANES],
        }
    }
}

impl OutlineChunk {
    /// The outlines of a chunk of quads in a picture of `width` x `height`.
    #[inline(always)]
    pub(super) fn build(&mut self, quads: &QuadChunk, width: i32, height: i32) {
        let mut pixel_x = [[0; LANES]; 4];
        let mut pixel_y = [[0; LANES]; 4];
        for corner in 0..4 {
            for lane in 0..LANES {
                pixel_x[corner][lane] = (quads.x[corner][lane] + 128) >> 8;
                pixel_y[corner][lane] = (quads.y[corner][lane] + 128) >> 8;
            }
        }
        for lane in 0..LANES {
            let (x, y) = (|c: usize| pixel_x[c][lane], |c: usize| pixel_y[c][lane]);
            let left = x(0).min(x(1)).min(x(2).min(x(3))).max(0);
            let right = (x(0).max(x(1)).max(x(2).max(x(3))) + 1).min(width);
            let top = y(0).min(y(1)).min(y(2).min(y(3))).max(0);
            let bottom = (y(0).max(y(1)).max(y(2).max(y(3))) + 1).min(height);
            let shown = quads.drawn[lane] & (left < right) & (top < bottom);
            self.left[lane] = if shown { left } else { width };
            self.right[lane] = if shown { right } else { 0 };
            self.top[lane] = if shown { top } else { height };
            self.bottom[lane] = if shown { bottom } else { 0 };
        }
        let mut farthest = 0;
        for lane in 0..LANES {
            let mut reach = 0;
            for corner in 0..4 {
                let next = (corner + 1) % 4;
                let (x, y) = (pixel_x[corner][lane], pixel_y[corner][lane]);
                // Each is at most 256 where the part is near.
                reach = reach
                    .max((x - 512).abs() / 4)
                    .max((y - 512).abs() / 4)
                    .max((pixel_x[next][lane] - x).abs())
                    .max((pixel_y[next][lane] - y).abs());
            }
            farthest = farthest.max(reach);
        }
        self.is_near = farthest <= 255 && width <= 1024 && height <= 1024;
        for edge in 0..4 {
            let next = (edge + 1) % 4;
            self.build_fill(edge, [&quads.x[edge], &quads.y[edge], &quads.x[next], &quads.y[next]], height);
            let ends = [&pixel_x[edge], &pixel_y[edge], &pixel_x[next], &pixel_y[next]];
            if self.is_near {
                self.build_line::<f32>(edge, ends, height);
            } else {
                self.build_line::<f64>(edge, ends, height);
            }
        }
    }

    #[inline(always)]
    fn build_fill(&mut self, edge: usize, [x0, y0, x1, y1]: [&[i32; LANES]; 4], height: i32) {
        for lane in 0..LANES {
            let downwards = y0[lane] <= y1[lane];
            let (top_x, bottom_x) = if downwards { (x0[lane], x1[lane]) } else { (x1[lane], x0[lane]) };
            let (top_y, bottom_y) = if downwards { (y0[lane], y1[lane]) } else { (y1[lane], y0[lane]) };
            // Rows whose centre 256 row lies in [top_y, bottom_y).
            let first = ((top_y + 255) >> 8).max(0);
            let end = ((bottom_y + 255) >> 8).min(height);
            self.fill_first[edge][lane] = first;
            self.fill_rows[edge][lane] = (end - first).max(0);
            // ceil(X(row) / 256) with X the crossing, over the denominator 256 dy.
            let dx = f64::from(bottom_x - top_x);
            let dy = f64::from((bottom_y - top_y).max(1));
            let denominator = 256.0 * dy;
            let inverse = 1.0 / denominator;
            let numerator = f64::from(top_x) * dy - dx * f64::from(top_y) + (denominator - 1.0) + 0.5;
            self.fill_slope[edge][lane] = dx * 256.0 * inverse;
            self.fill_offset[edge][lane] = numerator * inverse;
        }
    }

    #[inline(always)]
    fn build_line<R: Real>(&mut self, edge: usize, [x0, y0, x1, y1]: [&[i32; LANES]; 4], height: i32) {
        for lane in 0..LANES {
            let (left, right) = (x0[lane].min(x1[lane]), x0[lane].max(x1[lane]));
            let (top, bottom) = (y0[lane].min(y1[lane]), y0[lane].max(y1[lane]));
            let first = top.max(0);
            self.line_first[edge][lane] = first;
            self.line_rows[edge][lane] = ((bottom + 1).min(height) - first).max(0);
            self.line_left[edge][lane] = left;
            self.line_right[edge][lane] = right + 1;
            self.line_is_steep[edge][lane] = u32::from(bottom - top > right - left);
        }
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
            let nearest = (at_row_0 + rise + R::HALF) * inverse;
            // Flat: the columns whose nearest row is this one. Falling to the right they begin at the ceiling of the
            // crossing with row - 1/2; rising, after the floor of the crossing with row + 1/2.
            let half_row = R::from_pixel(dx);
            let past = at_row_0 + rise * R::TWO + if rises { R::HALF } else { -R::HALF };
            let (begin, end) = ((past - half_row) * inverse, (past + half_row) * inverse);
            let (is_steep, level) = (dy > dx, dy == 0);
            // A level line covers its one row from end to end: a slope that leaves the picture within a row either way.
            slopes[lane] = if level { R::from_pixel(1 << 17) } else { run * R::TWO * inverse };
            let level_from = R::from_pixel(-(1 << 17)) * R::from_pixel(top) - R::from_pixel(1 << 16);
            let begin = if level { level_from } else { begin };
            let end = if level { level_from + R::from_pixel(1 << 17) } else { end };
            froms[lane] = if is_steep { nearest } else { begin };
            tos[lane] = end;
        }
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
