//! Drawing and comparing one candidate in one view without a picture: silhouette and edges as bit columns of sixteen
//! rows, parts from the nearest to the farthest, then counts against the observation's bit planes.

#![allow(clippy::needless_range_loop, reason = "loops over lanes say so, and several rows share the index")]

use std::ops::Range;

use crate::evaluate::{Components, SegmentSums};
use crate::features::Evidence;

use super::cell::{Cell, Pixels, SegmentedCell};
use super::front::{LANES, QuadChunk};
use super::outline::OutlineChunk;
use super::planes::{CELL_COLUMNS, CELL_ROWS, Planes};
use super::simd::{Lanes, Simd};

/// What is summed of the pixels that parts show, part by part.
trait Tally<S: Simd> {
    /// Takes the pixels that a part of this number shows in `N` cells of a row from `place` on, no two in the same column.
    fn add<const N: usize>(&mut self, simd: S, place: usize, shown: [S::Words; N], number: u8);
}

/// Nothing.
impl<S: Simd> Tally<S> for () {
    #[inline(always)]
    fn add<const N: usize>(&mut self, _: S, _: usize, _: [S::Words; N], _: u8) {}
}

/// The codes of the evidence, of the class that is the part's number. Parts come from the nearest on, so what one shows is final.
struct Codes<'a, S: Simd> {
    planes: &'a [[Lanes; Evidence::BITS]],
    /// Cells of a class.
    cells: usize,
    sums: [S::Sum; Evidence::BITS],
}

impl<S: Simd> Tally<S> for Codes<'_, S> {
    #[inline(always)]
    fn add<const N: usize>(&mut self, simd: S, place: usize, shown: [S::Words; N], number: u8) {
        let cells = &self.planes[usize::from(number) * self.cells + place..][..N];
        let mut bits = [simd.splat(0); Evidence::BITS];
        for bit in 0..Evidence::BITS {
            for cell in 0..N {
                bits[bit] = simd.or(bits[bit], simd.and(shown[cell], simd.load(&cells[cell][bit])));
            }
        }
        self.sums = simd.count_codes(self.sums, bits);
    }
}

/// Working memory for one picture size; nothing in it outlives an image.
#[derive(Clone, Debug)]
pub(super) struct Canvas<P> {
    /// All zero between images. A row of cells has one more than the planes, for what a narrow part's second cell spills.
    cells: Vec<P>,
    outlines: Vec<OutlineChunk>,
    /// Lanes of all chunks in the order of the last image, from near to far. The next image's order is much the same.
    order: Vec<usize>,
    /// Numbers of the segments, or of the classes of evidence, of the lanes of all chunks; those behind the last are 0.
    numbers: Vec<u8>,
}

impl<P: Pixels> Canvas<P> {
    /// For parts in `chunks` chunks, of these numbers, and pictures of at most `cells` cells.
    pub(super) fn new(chunks: usize, cells: usize, numbers: Vec<u8>) -> Self {
        Self {
            cells: vec![P::default(); cells],
            outlines: vec![OutlineChunk::default(); chunks],
            order: (0..chunks * LANES).collect(),
            numbers,
        }
    }

    /// Draws `quads` and compares them with an observation.
    #[inline(always)]
    pub(super) fn compare<S: Simd>(&mut self, simd: S, quads: &[QuadChunk], planes: &Planes) -> Components {
        let mut sums = Components { area_obs: planes.area, ..Components::default() };
        if let Some((words, blocks)) = self.draw(simd, quads, planes, &mut ()) {
            self.count(simd, planes, words, blocks, &mut sums);
        }
        sums
    }

    /// Draws `quads` and tallies what they show: the columns and the rows of cells that they lie in.
    #[inline(always)]
    fn draw<S: Simd>(
        &mut self,
        simd: S,
        quads: &[QuadChunk],
        planes: &Planes,
        tally: &mut impl Tally<S>,
    ) -> Option<(Range<usize>, Range<usize>)> {
        self.sort(simd, quads);
        let (width, height) = (planes.width as i32, planes.height as i32);
        let (mut left, mut right, mut top, mut bottom) = (width, 0, height, 0);
        for (outline, quad) in self.outlines.iter_mut().zip(quads) {
            outline.build(quad, width, height);
            left = left.min(simd.least(&outline.left));
            right = right.max(simd.most(&outline.right));
            top = top.min(simd.least(&outline.top));
            bottom = bottom.max(simd.most(&outline.bottom));
        }
        if left >= right || top >= bottom {
            return None;
        }
        let words = (left as u32 / CELL_COLUMNS) as usize..(right as u32).div_ceil(CELL_COLUMNS) as usize;
        let blocks = (top as u32 / CELL_ROWS) as usize..(bottom as u32).div_ceil(CELL_ROWS) as usize;
        let columns = planes.columns + 1;
        for &lane in &self.order {
            let (outline, part) = (&self.outlines[lane / LANES], lane % LANES);
            let number = self.numbers.get(lane).copied().unwrap_or(0);
            if outline.is_near {
                draw_part::<S, P, true>(simd, (outline, part, number), columns, &mut self.cells, tally);
            } else {
                draw_part::<S, P, false>(simd, (outline, part, number), columns, &mut self.cells, tally);
            }
        }
        self.trim(simd, planes, &words, &blocks);
        if !planes.counted.is_empty() {
            self.pass_over(simd, planes, &words, &blocks);
        }
        Some((words, blocks))
    }

    /// Brings the parts into order, nearest first; of two at equal depth the later one in the body is nearer.
    #[inline(always)]
    fn sort<S: Simd>(&mut self, simd: S, quads: &[QuadChunk]) {
        if let ([quad], Ok(order)) = (quads, <&mut [usize; LANES]>::try_from(&mut self.order[..])) {
            // Each part's place is the number of parts nearer than it, counted for all at once. The bits compare as the
            // depths do, and give every part a place of its own even where a depth is no number.
            let depths = quad.depth_squared.map(|depth| (depth.to_bits() as i32).min(i32::MAX - 1));
            let place = simd.places(&depths);
            for lane in 0..LANES {
                order[place[lane] as usize % LANES] = lane;
            }
            return;
        }
        for place in 0..self.order.len() {
            let lane = self.order[place];
            let key = key(quads, lane);
            let mut hole = place;
            while hole > 0 && self::key(quads, self.order[hole - 1]) > key {
                self.order[hole] = self.order[hole - 1];
                hole -= 1;
            }
            self.order[hole] = lane;
        }
    }

    /// Removes what was drawn in the given cells right of the picture.
    #[inline(always)]
    fn trim<S: Simd>(&mut self, simd: S, planes: &Planes, words: &Range<usize>, blocks: &Range<usize>) {
        if words.end < planes.columns {
            return;
        }
        let spare_columns = planes.width % CELL_COLUMNS;
        let inside = simd.splat(if spare_columns == 0 { u32::MAX } else { (1 << spare_columns) - 1 });
        for block in blocks.clone() {
            let end = block * (planes.columns + 1) + planes.columns;
            self.cells[end - 1].keep(simd, inside);
            self.cells[end].keep(simd, simd.splat(0));
        }
    }

    /// Removes what was drawn in the given cells where the observation ignores it.
    #[inline(always)]
    fn pass_over<S: Simd>(&mut self, simd: S, planes: &Planes, words: &Range<usize>, blocks: &Range<usize>) {
        for block in blocks.clone() {
            let cells = &mut self.cells[block * (planes.columns + 1)..][words.clone()];
            let counted = &planes.counted[block * planes.columns..][words.clone()];
            cells.iter_mut().zip(counted).for_each(|(cell, counted)| cell.keep(simd, simd.load(counted)));
        }
    }

    /// Counts what was drawn in the given cells and clears them for the next image.
    #[inline(always)]
    fn count<S: Simd>(
        &mut self,
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
            let cells = &mut self.cells[block * (planes.columns + 1)..][words.clone()];
            let observed = &planes.cells[block * planes.columns..][words.clone()];
            for (cell, seen) in cells.iter_mut().zip(observed) {
                let cell = cell.cell();
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
                simd.store(simd.splat(0), &mut cell.fill);
                simd.store(simd.splat(0), &mut cell.edge);
            }
        }
        ([sums.area_model, sums.overlap, sums.edges], sums.proximity) = simd.totals([area, overlap, edges], proximity);
    }
}

/// Sorts nearest first, and at equal depth the part listed later first. Squared distances are not negative, so their bits
/// sort as they do.
fn key(quads: &[QuadChunk], lane: usize) -> (u32, std::cmp::Reverse<usize>) {
    (quads[lane / LANES].depth_squared[lane % LANES].to_bits(), std::cmp::Reverse(lane))
}

/// Draws one part behind what is there: its border where no fill is yet, then its fill. Pixels outside of the picture in its
/// last cells are left for [`Canvas::trim`].
#[inline(always)]
fn draw_part<S: Simd, P: Pixels, const NEAR: bool>(
    simd: S,
    (outline, part, number): (&OutlineChunk, usize, u8),
    columns: usize,
    cells: &mut [P],
    tally: &mut impl Tally<S>,
) {
    if outline.left[part] >= outline.right[part] {
        return;
    }
    let (first_block, end_block) =
        (outline.top[part] as u32 / CELL_ROWS, (outline.bottom[part] as u32).div_ceil(CELL_ROWS));
    let (first_word, shift) = (outline.origin[part] as u32 / CELL_COLUMNS, outline.origin[part] as u32 % CELL_COLUMNS);
    let end_word = (outline.right[part] as u32).div_ceil(CELL_COLUMNS);
    let is_narrow = NEAR && outline.is_narrow[part] != 0;
    let mut rows = simd.first_rows();
    let (mut fill_rows, mut line_rows) = ([0; 4], [0; 4]);
    for block in 0..end_block - first_block {
        if block % 4 == 0 {
            for edge in 0..4 {
                fill_rows[edge] = outline.fill_rows[edge].bits_from(part, block * CELL_ROWS);
                line_rows[edge] = outline.line_rows[edge].bits_from(part, block * CELL_ROWS);
            }
        }
        let place = (first_block + block) as usize * columns + first_word as usize;
        let cells = &mut cells[place..];
        let (from, to) = fill_span(simd, outline, part, rows.0, &fill_rows);
        let mut lines = [(from, to); 4];
        for edge in 0..4 {
            if skips(simd, line_rows[edge]) {
                continue;
            }
            lines[edge] = line_span::<S, NEAR>(simd, outline, edge, part, rows);
        }
        if is_narrow {
            let fill = simd.and_not(simd.ones_from(from), simd.ones_from(to));
            let mut border = simd.splat(0);
            for edge in 0..4 {
                if skips(simd, line_rows[edge]) {
                    continue;
                }
                let (from, to) = lines[edge];
                border = simd.add_where(simd.mask(line_rows[edge]), border, simd.ones_from(from), simd.ones_from(to));
            }
            let cells = &mut cells[..2];
            let left = cells[0].add(simd, simd.shift_left(border, shift), simd.shift_left(fill, shift), number);
            let back = CELL_COLUMNS - shift;
            let right = cells[1].add(simd, simd.shift_right(border, back), simd.shift_right(fill, back), number);
            tally.add(simd, place, [left, right], number);
        } else {
            let zero = simd.splat(0);
            let from = simd.max(from, zero);
            for (_, to) in &mut lines {
                *to = simd.max(*to, zero);
            }
            let mut column = 0;
            for (cell, place) in cells[..(end_word - first_word) as usize].iter_mut().zip(place..) {
                let origin = simd.splat(column);
                let fill = simd.and_not(ones_right_of(simd, from, origin), ones_right_of(simd, to, origin));
                let mut border = zero;
                for edge in 0..4 {
                    if skips(simd, line_rows[edge]) {
                        continue;
                    }
                    let (from, to) = lines[edge];
                    let (from, to) = (ones_right_of(simd, from, origin), ones_right_of(simd, to, origin));
                    border = simd.add_where(simd.mask(line_rows[edge]), border, from, to);
                }
                let shown = cell.add(simd, border, fill, number);
                tally.add(simd, place, [shown], number);
                column += CELL_COLUMNS;
            }
        }
        rows = simd.next_rows(rows);
        for edge in 0..4 {
            fill_rows[edge] >>= CELL_ROWS;
            line_rows[edge] >>= CELL_ROWS;
        }
    }
}

/// Whether to leave out an edge, because it has none of the sixteen rows of a block.
#[inline(always)]
fn skips<S: Simd>(_: S, rows: u64) -> bool {
    S::SKIPS_EDGES && rows as u16 == 0
}

/// The columns that a part's fill covers in each of sixteen rows.
#[inline(always)]
fn fill_span<S: Simd>(
    simd: S,
    outline: &OutlineChunk,
    part: usize,
    rows: S::Rows,
    active: &[u64; 4],
) -> (S::Words, S::Words) {
    let mut from = simd.splat(NOWHERE);
    let mut to = simd.splat(0);
    for edge in 0..4 {
        if skips(simd, active[edge]) {
            continue;
        }
        let active = simd.mask(active[edge]);
        let column = simd.line(rows, outline.fill_slope[edge][part], outline.fill_offset[edge][part]);
        from = simd.min_where(active, from, column);
        to = simd.max_where(active, to, column);
    }
    (from, to)
}

/// The columns that a border line covers in each of sixteen rows, where the line has them.
#[inline(always)]
fn line_span<S: Simd, const NEAR: bool>(
    simd: S,
    outline: &OutlineChunk,
    edge: usize,
    part: usize,
    rows: (S::Rows, S::ShortRows),
) -> (S::Words, S::Words) {
    let (from, to) = if NEAR {
        let slope = outline.short_slope[edge][part];
        (
            simd.short_line(rows.1, slope, outline.short_from[edge][part]),
            simd.short_line(rows.1, slope, outline.short_to[edge][part]),
        )
    } else {
        let slope = outline.line_slope[edge][part];
        (simd.line(rows.0, slope, outline.line_from[edge][part]), simd.line(rows.0, slope, outline.line_to[edge][part]))
    };
    (
        simd.max(from, simd.splat(outline.line_left[edge][part] as u32)),
        simd.min(to, simd.splat(outline.line_right[edge][part] as u32)),
    )
}

/// The bits at and right of `column` in the word that begins at column `origin`.
#[inline(always)]
fn ones_right_of<S: Simd>(simd: S, column: S::Words, origin: S::Words) -> S::Words {
    simd.ones_from(simd.sub_to_zero(column, origin))
}

/// A column right of every part's last, that [`Simd::sub_to_zero`] still takes.
const NOWHERE: u32 = 0xffff;

impl Canvas<Cell> {
    /// Takes the class of evidence of the lanes of all chunks.
    pub(super) fn set_classes(&mut self, classes: Vec<u8>) {
        self.numbers = classes;
    }

    /// [`Self::compare`], and the evidence of what is drawn.
    #[inline(always)]
    pub(super) fn compare_evidence<S: Simd>(
        &mut self,
        simd: S,
        quads: &[QuadChunk],
        planes: &Planes,
    ) -> (Components, i32) {
        let mut sums = Components { area_obs: planes.area, ..Components::default() };
        let mut codes =
            Codes { planes: &planes.evidence, cells: planes.canvas_cells(), sums: [simd.no_bits(); Evidence::BITS] };
        if let Some((words, blocks)) = self.draw(simd, quads, planes, &mut codes) {
            self.count(simd, planes, words, blocks, &mut sums);
        }
        // Right of the picture a part may show pixels, but codes are 0 there.
        let codes = i64::from(simd.total_codes(codes.sums));
        (sums, (codes - i64::from(Evidence::NEUTRAL) * i64::from(sums.area_model)) as i32)
    }
}

impl Canvas<SegmentedCell> {
    /// [`Self::compare`], and the sums of every segment, its edges where `edges` says so.
    #[inline(always)]
    pub(super) fn compare_segments<S: Simd>(
        &mut self,
        simd: S,
        quads: &[QuadChunk],
        planes: &Planes,
        (segment_sums, edges): (&mut [SegmentSums], bool),
    ) -> Components {
        for (sums, &area_obs) in segment_sums.iter_mut().zip(&planes.segment_areas) {
            *sums = SegmentSums { area_obs, ..SegmentSums::default() };
        }
        let mut sums = Components { area_obs: planes.area, ..Components::default() };
        if let Some((words, blocks)) = self.draw(simd, quads, planes, &mut ()) {
            if edges {
                for (segment, sums) in segment_sums.iter_mut().enumerate() {
                    self.count_segment_edges(simd, planes, &words, &blocks, (segment, sums));
                }
            }
            self.count_segments(simd, planes, &words, &blocks, segment_sums);
            self.count(simd, planes, words, blocks, &mut sums);
        }
        sums
    }

    /// Counts the segments of what was drawn in the given cells and clears them for the next image.
    #[inline(always)]
    fn count_segments<S: Simd>(
        &mut self,
        simd: S,
        planes: &Planes,
        words: &Range<usize>,
        blocks: &Range<usize>,
        segment_sums: &mut [SegmentSums],
    ) {
        for (segment, sums) in segment_sums.iter_mut().enumerate() {
            let (mut area, mut overlap) = (simd.no_bits(), simd.no_bits());
            for block in blocks.clone() {
                let cells = &mut self.cells[block * (planes.columns + 1)..][words.clone()];
                let observed = &planes.segment_cells[block * planes.columns..][words.clone()];
                for (cell, seen) in cells.iter_mut().zip(observed) {
                    let drawn = simd.load(&cell.segments[segment]);
                    area = simd.count(area, drawn);
                    overlap = simd.count(overlap, simd.and(drawn, simd.load(&seen[segment])));
                    simd.store(simd.splat(0), &mut cell.segments[segment]);
                }
            }
            sums.area_model = simd.total(area);
            sums.overlap = simd.total(overlap);
        }
    }

    /// Counts the edges of a segment in the given cells, apart from its areas: whoever does not ask for them is to wait for nothing.
    #[inline(always)]
    fn count_segment_edges<S: Simd>(
        &self,
        simd: S,
        planes: &Planes,
        words: &Range<usize>,
        blocks: &Range<usize>,
        (segment, sums): (usize, &mut SegmentSums),
    ) {
        let mut edges = simd.no_bits();
        let mut proximity = [simd.no_bits(); 7];
        for block in blocks.clone() {
            let cells = &self.cells[block * (planes.columns + 1)..][words.clone()];
            let observed = &planes.cells[block * planes.columns..][words.clone()];
            for (cell, seen) in cells.iter().zip(observed) {
                let edge = simd.and(simd.load(&cell.segments[segment]), simd.load(&cell.cell.edge));
                if !simd.is_zero(edge) {
                    edges = simd.count(edges, edge);
                    for (bit, sum) in proximity.iter_mut().enumerate() {
                        *sum = simd.count(*sum, simd.and(edge, simd.load(&seen[bit])));
                    }
                }
            }
        }
        sums.edges = simd.total(edges);
        for (bit, sum) in proximity.into_iter().enumerate() {
            sums.proximity += simd.total(sum) << bit;
        }
    }
}
