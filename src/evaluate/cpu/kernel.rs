//! Drawing and comparing one candidate in one view without a picture: silhouette and edges as bit columns of sixteen
//! rows, parts from the nearest to the farthest, then counts against the observation's bit planes.

#![allow(clippy::needless_range_loop, reason = "loops over lanes say so, and several rows share the index")]

use std::ops::Range;

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
                left = left.min(outline.left[lane]);
                right = right.max(outline.right[lane]);
                top = top.min(outline.top[lane]);
                bottom = bottom.max(outline.bottom[lane]);
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
        for place in 0..self.order.len() {
            let part = part_of(self.order[place]);
            let outline = &self.outlines[part / LANES];
            let (lane, columns) = (part % LANES, planes.columns);
            if outline.is_near {
                draw_part::<S, true>(simd, outline, lane, columns, &mut self.cells);
            } else {
                draw_part::<S, false>(simd, outline, lane, columns, &mut self.cells);
            }
        }
        self.trim(simd, planes, &words, &blocks);
        self.count(simd, planes, words, blocks, &mut sums);
        sums
    }

    /// Brings the parts into order, nearest first; of two at equal depth the later one in the body is nearer.
    #[inline(always)]
    fn sort(&mut self, quads: &[QuadChunk]) {
        if let [quad] = quads {
            // Up to sixteen parts: each one's place is the number of parts nearer than it, counted for all at once. The
            // bits compare as the depths do, and give every part a place of its own even where a depth is no number.
            let depths = quad.depth_squared.map(|depth| depth.to_bits() as i32);
            let mut place = [0_u32; LANES];
            for (other, &depth) in depths.iter().enumerate().take(self.order.len()) {
                for lane in 0..LANES {
                    place[lane] += u32::from((depth < depths[lane]) | ((depth == depths[lane]) & (other > lane)));
                }
            }
            for part in 0..self.order.len() {
                self.order[place[part] as usize] = key(quad.depth_squared[part], part);
            }
            return;
        }
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

    /// Removes what was drawn in the given cells right of the picture and below it.
    #[inline(always)]
    fn trim<S: Simd>(&mut self, simd: S, planes: &Planes, words: &Range<usize>, blocks: &Range<usize>) {
        let (spare_columns, spare_rows) = (planes.width % CELL_COLUMNS, planes.height % CELL_ROWS);
        if words.end == planes.columns && spare_columns != 0 {
            let inside = simd.splat((1 << spare_columns) - 1);
            for block in blocks.clone() {
                self.cells[(block + 1) * planes.columns - 1].keep(simd, inside);
            }
        }
        if (blocks.end as u32) * CELL_ROWS > planes.height {
            let mut inside = Lanes::default();
            inside.0[..spare_rows as usize].fill(u32::MAX);
            let inside = simd.load(&inside);
            for cell in &mut self.cells[(blocks.end - 1) * planes.columns..][words.clone()] {
                cell.keep(simd, inside);
            }
        }
    }

    /// Counts what was drawn in the given cells.
    #[inline(always)]
    fn count<S: Simd>(
        &self,
        simd: S,
        planes: &Planes,
        words: Range<usize>,
        blocks: Range<usize>,
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

/// Draws one part behind what is there: its border where no fill is yet, then its fill. Pixels outside of the picture in its
/// last cells are left for [`Canvas::trim`].
#[inline(always)]
fn draw_part<S: Simd, const NEAR: bool>(
    simd: S,
    outline: &OutlineChunk,
    part: usize,
    columns: usize,
    cells: &mut [Cell],
) {
    if outline.left[part] >= outline.right[part] {
        return;
    }
    for edge in 0..4 {
        draw_line::<S, NEAR>(simd, outline, edge, part, columns, cells);
    }
    draw_fill(simd, outline, part, columns, cells);
}

/// Draws one border line where no fill is yet.
#[inline(always)]
fn draw_line<S: Simd, const NEAR: bool>(
    simd: S,
    outline: &OutlineChunk,
    edge: usize,
    part: usize,
    columns: usize,
    cells: &mut [Cell],
) {
    let (first, count) = (outline.line_first[edge][part], outline.line_rows[edge][part]);
    let (left, right) = (outline.line_left[edge][part], outline.line_right[edge][part]);
    let (first_word, end_word) = ((left >> 5).max(0), ((right + 31) >> 5).min(columns as i32));
    if count <= 0 || first_word >= end_word {
        return;
    }
    let columns_of = |rows: (S::Rows, S::ShortRows), double: f64, short: f32| {
        if NEAR {
            simd.short_line(rows.1, outline.short_slope[edge][part], short)
        } else {
            simd.line(rows.0, outline.line_slope[edge][part], double)
        }
    };
    let is_steep = outline.line_is_steep[edge][part] != 0;
    for block in first / 16..=(first + count - 1) / 16 {
        let base = block as u32 * CELL_ROWS;
        let rows = (simd.rows(base), simd.short_rows(base));
        let cells = &mut cells[block as usize * columns..][first_word as usize..end_word as usize];
        let from = columns_of(rows, outline.line_from[edge][part], outline.short_from[edge][part]);
        let mut origin = first_word as u32 * CELL_COLUMNS;
        if is_steep {
            let row = simd.sub(simd.row_words(base), simd.splat(first as u32));
            let active = simd.below(row, simd.splat(count as u32));
            for cell in cells {
                let dot = simd.bit(active, simd.sub(from, simd.splat(origin)));
                cell.add_edge(simd, dot);
                origin += CELL_COLUMNS;
            }
        } else {
            // In rows the line does not meet, clamping to its ends leaves nothing.
            let to = columns_of(rows, outline.line_to[edge][part], outline.short_to[edge][part]);
            let from = simd.max(from, simd.splat(left as u32));
            let to = simd.min(to, simd.splat(right as u32));
            for cell in cells {
                let dash = span(simd, from, to, origin);
                cell.add_edge(simd, dash);
                origin += CELL_COLUMNS;
            }
        }
    }
}

/// Fills one part.
#[inline(always)]
fn draw_fill<S: Simd>(simd: S, outline: &OutlineChunk, part: usize, columns: usize, cells: &mut [Cell]) {
    let first_word = outline.left[part] as u32 / CELL_COLUMNS;
    let end_word = (outline.right[part] as u32).div_ceil(CELL_COLUMNS);
    let (top, bottom) = (outline.top[part] as u32, outline.bottom[part] as u32);
    for block in top / CELL_ROWS..bottom.div_ceil(CELL_ROWS) {
        let base = block * CELL_ROWS;
        let row_words = simd.row_words(base);
        let rows = simd.rows(base);
        let mut from = simd.splat(FAR_RIGHT);
        let mut to = simd.splat(0);
        for edge in 0..4 {
            let (first, count) = (outline.fill_first[edge][part], outline.fill_rows[edge][part]);
            // The sides of a part are met in most of its blocks, its ends in few.
            let is_end = edge % 2 == 1;
            if is_end && (first >= (base + CELL_ROWS) as i32 || first + count <= base as i32) {
                continue;
            }
            let active = simd.below(simd.sub(row_words, simd.splat(first as u32)), simd.splat(count as u32));
            let column = simd.line(rows, outline.fill_slope[edge][part], outline.fill_offset[edge][part]);
            from = simd.min_where(active, from, column);
            to = simd.max_where(active, to, column);
        }
        let mut origin = first_word * CELL_COLUMNS;
        for cell in &mut cells[block as usize * columns..][first_word as usize..end_word as usize] {
            let fill = span(simd, from, to, origin);
            simd.store(simd.or(simd.load(&cell.fill), fill), &mut cell.fill);
            origin += CELL_COLUMNS;
        }
    }
}

/// A column right of every picture.
const FAR_RIGHT: u32 = 1 << 20;

impl Cell {
    /// Removes the pixels outside of `inside`.
    #[inline(always)]
    fn keep<S: Simd>(&mut self, simd: S, inside: S::Words) {
        simd.store(simd.and(simd.load(&self.fill), inside), &mut self.fill);
        simd.store(simd.and(simd.load(&self.edge), inside), &mut self.edge);
    }

    /// Adds border pixels where no fill is yet.
    #[inline(always)]
    fn add_edge<S: Simd>(&mut self, simd: S, line: S::Words) {
        let visible = simd.and_not(line, simd.load(&self.fill));
        simd.store(simd.or(simd.load(&self.edge), visible), &mut self.edge);
    }
}

/// The bits of columns `from..to` in the word that begins at column `origin`; none where `to <= from`.
#[inline(always)]
fn span<S: Simd>(simd: S, from: S::Words, to: S::Words, origin: u32) -> S::Words {
    let (ones, zero, origin) = (simd.splat(u32::MAX), simd.splat(0), simd.splat(origin));
    let at_or_right = simd.shift_left(ones, simd.max(simd.sub(from, origin), zero));
    let past = simd.shift_left(ones, simd.max(simd.sub(to, origin), zero));
    simd.and_not(at_or_right, past)
}
