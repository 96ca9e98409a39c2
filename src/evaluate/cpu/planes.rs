//! An observation as bit planes: for every 16 rows x 32 columns a cell of eight sixteen-lane words, one lane a row and
//! one bit a column. So a comparison is a bit operation and a bit count, with no look-up a pixel.

use crate::evaluate::bit_planes::{bit_planes, word_planes};
use crate::features::{BitImage, Evidence, Observation, Segmentation, Segments};

use super::simd::Lanes;

/// Rows of a cell.
pub(super) const CELL_ROWS: u32 = 16;
/// Columns of a cell.
pub(super) const CELL_COLUMNS: u32 = 32;

/// Bit planes of one view's observation.
#[derive(Clone, Debug)]
pub(super) struct Planes {
    /// Picture size, pixels.
    pub(super) width: u32,
    pub(super) height: u32,
    /// Cells a row of cells.
    pub(super) columns: usize,
    /// `cells[block * columns + word]`: planes 0..=6 the proximity bits, plane 7 the silhouette.
    pub(super) cells: Vec<[Lanes; 8]>,
    /// Pixels of the observed silhouette.
    pub(super) area: u32,
    /// `segment_cells[block * columns + word]`: a plane a segment; nothing without segments.
    pub(super) segment_cells: Vec<[Lanes; Segments::MOST]>,
    /// Pixels of every observed segment.
    pub(super) segment_areas: Vec<u32>,
    /// `evidence[class * canvas_cells + block * (columns + 1) + word]`: the four bits of the codes, 0 right of the picture; nothing
    /// without evidence. Where a part is drawn they are beside its cells.
    pub(super) evidence: Vec<[Lanes; Evidence::BITS]>,
    /// `counted[block * columns + word]`: the pixels that are not ignored; nothing where all count.
    pub(super) counted: Vec<Lanes>,
}

impl Planes {
    pub(super) fn new(width: u32, height: u32) -> Self {
        let columns = width.div_ceil(CELL_COLUMNS) as usize;
        let blocks = height.div_ceil(CELL_ROWS) as usize;
        Self {
            width,
            height,
            columns,
            cells: vec![[Lanes::default(); 8]; columns * blocks],
            area: 0,
            segment_cells: Vec::new(),
            segment_areas: Vec::new(),
            evidence: Vec::new(),
            counted: Vec::new(),
        }
    }

    /// Cells of a canvas for pictures of this size: a row has one more than here.
    pub(super) fn canvas_cells(&self) -> usize {
        self.cells.len() / self.columns * (self.columns + 1)
    }

    /// Takes an observation of the planes' own size.
    pub(super) fn fill(&mut self, observation: &Observation) {
        self.area = observation.area();
        self.fill_segments(observation.segmentation.as_ref());
        self.fill_counted(observation.ignored.as_deref());
        self.fill_evidence(observation.evidence.as_ref());
        let width = self.width as usize;
        for (y, row) in observation.bytes.chunks_exact(width).enumerate() {
            let (block, lane) = (y / CELL_ROWS as usize, y % CELL_ROWS as usize);
            for (word, pixels) in row.chunks(CELL_COLUMNS as usize).enumerate() {
                let cell = &mut self.cells[block * self.columns + word];
                for (plane, bits) in cell.iter_mut().zip(bit_planes(pixels)) {
                    plane.0[lane] = bits;
                }
            }
        }
    }

    fn fill_counted(&mut self, ignored: Option<&BitImage>) {
        self.counted.clear();
        let Some(ignored) = ignored else { return };
        self.counted.resize(self.cells.len(), Lanes::default());
        for y in 0..self.height as usize {
            let (block, lane) = (y / CELL_ROWS as usize, y % CELL_ROWS as usize);
            let cells = self.counted[block * self.columns..][..self.columns].iter_mut();
            cells.zip(ignored.row_words(y)).for_each(|(cell, bits)| cell.0[lane] = !bits);
        }
    }

    fn fill_segments(&mut self, segmentation: Option<&Segmentation>) {
        self.segment_cells.clear();
        self.segment_areas.clear();
        let Some(segmentation) = segmentation else { return };
        self.segment_areas = segmentation.areas();
        self.segment_cells.resize(self.cells.len(), [Lanes::default(); Segments::MOST]);
        for (y, row) in segmentation.numbers().chunks_exact(self.width as usize).enumerate() {
            let (block, lane) = (y / CELL_ROWS as usize, y % CELL_ROWS as usize);
            for (x, &number) in row.iter().enumerate().filter(|(_, number)| **number > 0) {
                let (word, bit) = (x / CELL_COLUMNS as usize, x % CELL_COLUMNS as usize);
                self.segment_cells[block * self.columns + word][usize::from(number) - 1].0[lane] |= 1 << bit;
            }
        }
    }

    fn fill_evidence(&mut self, evidence: Option<&Evidence>) {
        let (cells, classes) = (self.canvas_cells(), evidence.map_or(0, |evidence| evidence.classes().count()));
        self.evidence.resize(classes * cells, [Lanes::default(); Evidence::BITS]);
        let Some(evidence) = evidence else { return };
        for (y, row) in evidence.words().chunks_exact(self.width as usize).enumerate() {
            let (block, lane) = (y / CELL_ROWS as usize, y % CELL_ROWS as usize);
            for (word, pixels) in row.chunks(CELL_COLUMNS as usize).enumerate() {
                let planes = word_planes(pixels);
                let place = block * (self.columns + 1) + word;
                // What is ignored is not drawn, and the codes that parts show there are none.
                let counted = self.counted.get(block * self.columns + word).map_or(u32::MAX, |cell| cell.0[lane]);
                for (class, bits) in planes.chunks_exact(Evidence::BITS).take(classes).enumerate() {
                    for (plane, &bits) in self.evidence[class * cells + place].iter_mut().zip(bits) {
                        plane.0[lane] = bits & counted;
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_bit_is_where_it_belongs() {
        let (width, height) = (75, 21);
        let mut observation = Observation::empty(width, height);
        for (index, byte) in observation.bytes.iter_mut().enumerate() {
            *byte = (index as u32).wrapping_mul(2_654_435_761).to_be_bytes()[0];
        }
        let mut planes = Planes::new(width, height);
        planes.fill(&observation);
        for y in 0..height {
            for x in 0..width {
                let cell = &planes.cells[(y / 16) as usize * planes.columns + (x / 32) as usize];
                let byte =
                    (0..8).fold(0, |byte, bit| byte | ((cell[bit].0[(y % 16) as usize] >> (x % 32) & 1) as u8) << bit);
                assert_eq!(byte, observation.bytes[(y * width + x) as usize], "pixel {x}, {y}");
            }
        }
        assert_eq!(planes.area, observation.area());
    }
}
