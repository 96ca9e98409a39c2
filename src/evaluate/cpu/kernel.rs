//! Drawing and comparing one candidate in one view without a picture: silhouette and edges as bit columns of sixteen
//! rows, parts from the nearest to the farthest, then counts against the observation's bit planes.

use crate::evaluate::Components;

use super::front::{LANES, QuadChunk};
use super::outline::OutlineChunk;
use super::planes::{CELL_COLUMNS, CELL_ROWS, Planes};
use super::simd::{Lanes, Simd};

/// Fills and visible borders of the part of the picture that one cell covers.
#[derive(Clone, Copy, Debug, Default)]
struct Cell {
    fill: Lanes,
    edge: Lanes,
}

/// Working memory for one picture size; nothing in it outlives an image.
#[derive(Clone, Debug)]
pub(super) struct Canvas {
    cells: Vec<Cell>,
    outlines: Vec<OutlineChunk>,
    /// Parts in the order of the last image, as keys that sort from near to far. The next image's order is much the same.
    order: Vec<u64>,
}

impl Canvas {
    /// For `parts` parts in `chunks` chunks, and pictures of at most `cells` cells.
    pub(super) fn new(parts: usize, chunks: usize, cells: usize) -> Self {
        Self {
            cells: vec![Cell::default(); cells],
            outlines: vec![OutlineChunk::default(); chunks],
            order: (0..parts).map(|part| key(0.0, part)).collect(),
        }
    }

    /// Draws `quads` and compares them with an observation.
    #[inline(always)]
    pub(super) fn compare<S: Simd>(&mut self, simd: S, quads: &[QuadChunk], planes: &Planes) -> Components {
        let (width, height) = (planes.width as i32, planes.height as i32);
        let (mut left, mut right, mut top, mut bottom) = (width, 0, height, 0);
        for (outline, quad) in self.outlines.iter_mut().zip(quads) {
            outline.build(quad, width, height);
            for lane in 0..LANES {
                let shown = outline.left[lane] < outline.right[lane] && outline.top[lane] < outline.bottom[lane];
                left = left.min(if shown { outline.left[lane] } else { width });
                right = right.max(if shown { outline.right[lane] } else { 0 });
                top = top.min(if shown { outline.top[lane] } else { height });
                bottom = bottom.max(if shown { outline.bottom[lane] } else { 0 });
            }
        }
        let mut sums = Components { area_obs: planes.area, ..Components::default() };
        if left >= right || top >= bottom {
            return sums;
        }
        let words = (left as u32 / CELL_COLUMNS) as usize..(right as u32).div_ceil(CELL_COLUMNS) as usize;
        let blocks = (top as u32 / CELL_ROWS) as usize..(bottom as u32).div_ceil(CELL_ROWS) as usize;
        for block in blocks.clone() {
            self.cells[block * planes.columns..][words.clone()].fill(Cell::default());
        }
        self.sort(quads);
        for key in 0..self.order.len() {
            let part = part_of(self.order[key]);
            draw_part(simd, &self.outlines[part / LANES], part % LANES, width, planes.columns, &mut self.cells);
        }
        self.count(simd, planes, words, blocks, &mut sums);
        sums
    }

    /// Brings the parts into order, nearest first; of two at equal depth the later one in the body is nearer.
    #[inline(always)]
    fn sort(&mut self, quads: &[QuadChunk]) {
        for place in 0..self.order.len() {
            let part = part_of(self.order[place]);
            let key = key(quads[part / LANES].depth_squared[part % LANES], part);
            let mut hole = place;
            while hole > 0 && self.order[hole - 1] > key {
                self.order[hole] = self.order[hole - 1];
                hole -= 1;
            }
            self.order[hole] = key;
        }
    }

    /// Counts what was drawn in the given cells.
    #[inline(always)]
    fn count<S: Simd>(
        &self,
        simd: S,
        planes: &Planes,
        words: std::ops::Range<usize>,
        blocks: std::ops::Range<usize>,
        sums: &mut Components,
    ) {
        let mut area = simd.no_bits();
        let mut overlap = simd.no_bits();
        let mut edges = simd.no_bits();
        let mut proximity = [simd.no_bits(); 7];
        for block in blocks {
            let row = block * planes.columns;
            let cells = &self.cells[row..][words.clone()];
            let observed = &planes.cells[row..][words.clone()];
            for (cell, seen) in cells.iter().zip(observed) {
                let edge = simd.load(&cell.edge);
                let silhouette = simd.or(simd.load(&cell.fill), edge);
                area = simd.count(area, silhouette);
                overlap = simd.count(overlap, simd.and(silhouette, simd.load(&seen[7])));
                if !simd.is_zero(edge) {
                    edges = simd.count(edges, edge);
                    for (bit, sum) in proximity.iter_mut().enumerate() {
                        *sum = simd.count(*sum, simd.and(edge, simd.load(&seen[bit])));
                    }
                }
            }
        }
        sums.area_model = simd.total(area);
        sums.overlap = simd.total(overlap);
        sums.edges = simd.total(edges);
        for (bit, sum) in proximity.into_iter().enumerate() {
            sums.proximity += simd.total(sum) << bit;
        }
    }
}

/// Sorts nearest first, and at equal depth the part listed later first. Squared distances are not negative, so their bits
/// sort as they do.
fn key(depth_squared: f32, part: usize) -> u64 {
    u64::from(depth_squared.to_bits()) << 32 | u64::from(u32::MAX - part as u32)
}

fn part_of(key: u64) -> usize {
    (u32::MAX - key as u32) as usize
}

/// Draws one part behind what is there: its border where no fill is yet, then its fill.
#[inline(always)]
fn draw_part<S: Simd>(simd: S, outline: &OutlineChunk, part: usize, width: i32, columns: usize, cells: &mut [Cell]) {
    let (left, right) = (outline.left[part], outline.right[part]);
    let (top, bottom) = (outline.top[part], outline.bottom[part]);
    if left >= right || top >= bottom {
        return;
    }
    let first_word = left as u32 / CELL_COLUMNS;
    let end_word = (right as u32).div_ceil(CELL_COLUMNS);
    let zero = simd.splat(0);
    let ones = simd.splat(u32::MAX);
    let one = simd.splat(1);
    let limit = simd.splat(width as u32);
    // Shifted by this a bit is outside of every word.
    let nowhere = simd.splat(0x4000_0000);
    for block in top as u32 / CELL_ROWS..(bottom as u32).div_ceil(CELL_ROWS) {
        let base = block * CELL_ROWS;
        let row_words = simd.row_words(base);
        let rows = simd.rows(base);
        let meets = |first: i32, count: i32| first < (base + CELL_ROWS) as i32 && first + count > base as i32;

        let mut fill_from = limit;
        let mut fill_to = zero;
        for edge in 0..4 {
            let (first, count) = (outline.fill_first[edge][part], outline.fill_rows[edge][part]);
            if count > 0 && meets(first, count) {
                let active = simd.below(simd.sub(row_words, simd.splat(first as u32)), simd.splat(count as u32));
                let column = simd.line(rows, outline.fill_slope[edge][part], outline.fill_offset[edge][part]);
                fill_from = simd.select(active, simd.min(fill_from, column), fill_from);
                fill_to = simd.select(active, simd.max(fill_to, column), fill_to);
            }
        }
        let fill_from = simd.max(fill_from, zero);
        let fill_to = simd.min(fill_to, limit);

        let mut dots = [nowhere; 4];
        let mut dot_count = 0;
        let mut spans = [(zero, zero); 4];
        let mut span_count = 0;
        for edge in 0..4 {
            let (first, count) = (outline.line_first[edge][part], outline.line_rows[edge][part]);
            if count > 0 && meets(first, count) {
                let active = simd.below(simd.sub(row_words, simd.splat(first as u32)), simd.splat(count as u32));
                let slope = outline.line_slope[edge][part];
                let from = simd.line(rows, slope, outline.line_from[edge][part]);
                if outline.line_is_steep[edge][part] != 0 {
                    // Past the picture's width a dot could still lie in the last word.
                    let inside = simd.select(simd.below(from, limit), from, nowhere);
                    dots[dot_count] = simd.select(active, inside, nowhere);
                    dot_count += 1;
                } else {
                    let to = simd.line(rows, slope, outline.line_to[edge][part]);
                    let from = simd.max(from, simd.splat(outline.line_left[edge][part].max(0) as u32));
                    let to = simd.min(to, simd.splat(outline.line_right[edge][part].min(width) as u32));
                    spans[span_count] = (from, simd.select(active, to, zero));
                    span_count += 1;
                }
            }
        }

        for word in first_word..end_word {
            let origin = simd.splat(word * CELL_COLUMNS);
            let mut line = zero;
            for &dot in &dots[..dot_count] {
                line = simd.or(line, simd.shift_left(one, simd.sub(dot, origin)));
            }
            for &(from, to) in &spans[..span_count] {
                line = simd.or(line, span(simd, ones, from, to, origin, zero));
            }
            let fill = span(simd, ones, fill_from, fill_to, origin, zero);
            let cell = &mut cells[block as usize * columns + word as usize];
            let covered = simd.load(&cell.fill);
            simd.store(simd.or(simd.load(&cell.edge), simd.and_not(line, covered)), &mut cell.edge);
            simd.store(simd.or(covered, fill), &mut cell.fill);
        }
    }
}

/// The bits of columns `from..to` in the word that begins at column `origin`; none where `to <= from`.
#[inline(always)]
fn span<S: Simd>(simd: S, ones: S::Words, from: S::Words, to: S::Words, origin: S::Words, zero: S::Words) -> S::Words {
    let at_or_right = simd.shift_left(ones, simd.max(simd.sub(from, origin), zero));
    let past = simd.shift_left(ones, simd.max(simd.sub(to, origin), zero));
    simd.and_not(at_or_right, past)
}
