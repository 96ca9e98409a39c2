//! What is kept of the pixels of a candidate while its parts are drawn, from the nearest to the farthest.

use crate::features::Segments;

use super::simd::{Lanes, Simd};

/// Fills and visible borders of the part of the picture that one cell covers.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Cell {
    pub(super) fill: Lanes,
    pub(super) edge: Lanes,
}

/// A [`Cell`] with, for every segment, the pixels at which a part of it is the nearest.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct SegmentedCell {
    pub(super) cell: Cell,
    pub(super) segments: [Lanes; Segments::MOST],
}

/// What is kept of the pixels that one cell covers.
pub(super) trait Pixels: Clone + Default {
    fn cell(&mut self) -> &mut Cell;

    /// Adds a part's border where no fill is yet, then its fill; the part is of the segment of this number, 0 none. Where the part
    /// shows: nothing that is nearer has been drawn there.
    fn add<S: Simd>(&mut self, simd: S, border: S::Words, fill: S::Words, number: u8) -> S::Words;

    /// Removes the pixels outside of `inside`.
    fn keep<S: Simd>(&mut self, simd: S, inside: S::Words);
}

impl Pixels for Cell {
    #[inline(always)]
    fn cell(&mut self) -> &mut Cell {
        self
    }

    #[inline(always)]
    fn add<S: Simd>(&mut self, simd: S, border: S::Words, fill: S::Words, _number: u8) -> S::Words {
        let (hidden, edge) = (simd.load(&self.fill), simd.load(&self.edge));
        simd.store(simd.or(edge, simd.and_not(border, hidden)), &mut self.edge);
        simd.store(simd.or(hidden, fill), &mut self.fill);
        simd.and_not(simd.or(border, fill), simd.or(hidden, edge))
    }

    #[inline(always)]
    fn keep<S: Simd>(&mut self, simd: S, inside: S::Words) {
        simd.store(simd.and(simd.load(&self.fill), inside), &mut self.fill);
        simd.store(simd.and(simd.load(&self.edge), inside), &mut self.edge);
    }
}

impl Pixels for SegmentedCell {
    #[inline(always)]
    fn cell(&mut self) -> &mut Cell {
        &mut self.cell
    }

    #[inline(always)]
    fn add<S: Simd>(&mut self, simd: S, border: S::Words, fill: S::Words, number: u8) -> S::Words {
        // The nearest part whose fill or border lies on a pixel is the one that is drawn there.
        let shown = self.cell.add(simd, border, fill, number);
        if let Some(segment) = usize::from(number).checked_sub(1).and_then(|at| self.segments.get_mut(at)) {
            simd.store(simd.or(simd.load(segment), shown), segment);
        }
        shown
    }

    #[inline(always)]
    fn keep<S: Simd>(&mut self, simd: S, inside: S::Words) {
        self.cell.keep(simd, inside);
        for segment in &mut self.segments {
            simd.store(simd.and(simd.load(segment), inside), segment);
        }
    }
}
