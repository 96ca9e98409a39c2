//! What one camera saw, and how it is compared with a drawn image.

use crate::evaluate::components::Components;
use crate::evaluate::segments::SegmentSums;
use crate::features::evidence::code;
use crate::features::{Evidence, Observation, Segmentation};

use super::super::front::LANES;
use super::raster::{Canvas, NOTHING};

/// An observation beside which images are counted.
#[derive(Clone, Debug)]
pub(super) struct View {
    pub(super) width: u32,
    pub(super) height: u32,
    bytes: Vec<u8>,
    /// Pixels of the observed silhouette.
    area: u32,
    /// All bits where a pixel is ignored; empty where all count.
    ignored: Vec<u32>,
    segmentation: Option<Segmentation>,
    /// Pixels of every observed segment.
    pub(super) segment_areas: Vec<u32>,
    evidence: Option<Evidence>,
}

/// Counts of sixteen pixels at a time.
#[derive(Clone, Copy, Default)]
struct Counts {
    drawn: [u32; LANES],
    overlap: [u32; LANES],
    edges: [u32; LANES],
    proximity: [u32; LANES],
}

impl View {
    pub(super) fn new([width, height]: [u32; 2]) -> Self {
        Self {
            width,
            height,
            bytes: vec![0; width as usize * height as usize],
            area: 0,
            ignored: Vec::new(),
            segmentation: None,
            segment_areas: Vec::new(),
            evidence: None,
        }
    }

    /// Takes an observation of the view's own size.
    pub(super) fn fill(&mut self, observation: &Observation) {
        self.bytes.copy_from_slice(&observation.bytes);
        self.area = observation.area();
        self.segmentation.clone_from(&observation.segmentation);
        self.segment_areas = observation.segmentation.as_ref().map(Segmentation::areas).unwrap_or_default();
        self.evidence.clone_from(&observation.evidence);
        self.ignored.clear();
        if let Some(ignored) = &observation.ignored {
            self.ignored.resize(self.bytes.len(), 0);
            ignored.pixels().for_each(|at| self.ignored[at] = u32::MAX);
        }
    }

    /// Takes out of a drawn image what is not counted.
    #[inline(always)]
    pub(super) fn pass_over(&self, canvas: &mut Canvas) {
        if self.ignored.is_empty() {
            return;
        }
        for (keys, ignored) in self.rows(&self.ignored, canvas) {
            for (key, ignored) in keys.iter_mut().zip(ignored) {
                *key |= ignored;
            }
        }
    }

    /// Every row of a drawn image and what stands in `pixels` beside it. For loops: a closure is not always compiled for the instruction set.
    #[inline(always)]
    fn rows<'a, T>(&self, pixels: &'a [T], canvas: &'a mut Canvas) -> impl Iterator<Item = (&'a mut [u32], &'a [T])> {
        let ([left, top], rows) = canvas.region();
        let beside = pixels[(top * self.width as usize).min(pixels.len())..].chunks_exact(self.width as usize);
        rows.zip(beside).map(move |(keys, beside)| {
            let width = keys.len();
            (keys, &beside[left..left + width])
        })
    }

    /// Whole silhouettes and edges.
    #[inline(always)]
    pub(super) fn compare(&self, canvas: &mut Canvas) -> Components {
        let mut counts = Counts::default();
        for (keys, bytes) in self.rows(&self.bytes, canvas) {
            let (keys, keys_left) = keys.as_chunks::<LANES>();
            let (bytes, bytes_left) = bytes.as_chunks::<LANES>();
            for (keys, bytes) in keys.iter().zip(bytes) {
                counts.add(keys, bytes);
            }
            if !keys_left.is_empty() {
                let (mut keys, mut bytes) = ([NOTHING; LANES], [0; LANES]);
                keys[..keys_left.len()].copy_from_slice(keys_left);
                bytes[..bytes_left.len()].copy_from_slice(bytes_left);
                counts.add(&keys, &bytes);
            }
        }
        let sum = |lanes: [u32; LANES]| lanes.into_iter().sum();
        Components {
            area_obs: self.area,
            area_model: sum(counts.drawn),
            overlap: sum(counts.overlap),
            edges: sum(counts.edges),
            proximity: sum(counts.proximity),
        }
    }

    /// Areas segment by segment; `numbers` has that of every label.
    #[inline(always)]
    pub(super) fn compare_segments(&self, canvas: &mut Canvas, numbers: &[u8; 128], sums: &mut [SegmentSums]) {
        for (sums, &area) in sums.iter_mut().zip(&self.segment_areas) {
            *sums = SegmentSums { area_obs: area, ..SegmentSums::default() };
        }
        let Some(segmentation) = &self.segmentation else { return };
        for (keys, observed) in self.rows(segmentation.numbers(), canvas) {
            for (&key, &observed) in keys.iter().zip(observed) {
                if let Some(label) = label(key)
                    && let Some(sums) = sums.get_mut(usize::from(numbers[label]).wrapping_sub(1))
                {
                    sums.area_model += 1;
                    sums.overlap += u32::from(numbers[label] == observed);
                }
            }
        }
    }

    /// Adds the edges of each segment and their proximity, which are 0 before.
    #[inline(always)]
    pub(super) fn count_segment_edges(&self, canvas: &mut Canvas, numbers: &[u8; 128], sums: &mut [SegmentSums]) {
        for (keys, bytes) in self.rows(&self.bytes, canvas) {
            for (&key, &seen) in keys.iter().zip(bytes) {
                if is_edge(key)
                    && let Some(label) = label(key)
                    && let Some(sums) = sums.get_mut(usize::from(numbers[label]).wrapping_sub(1))
                {
                    sums.edges += 1;
                    sums.proximity += u32::from(seen & Observation::PROXIMITY);
                }
            }
        }
    }

    /// The evidence of what is drawn; `classes` has that of every label.
    #[inline(always)]
    pub(super) fn sum_evidence(&self, canvas: &mut Canvas, classes: &[u8; 128]) -> i32 {
        let mut sum = 0;
        let Some(evidence) = &self.evidence else { return sum };
        for (keys, words) in self.rows(evidence.words(), canvas) {
            for (&key, &word) in keys.iter().zip(words) {
                if let Some(label) = label(key) {
                    sum += code(word, usize::from(classes[label])) as i32 - Evidence::NEUTRAL as i32;
                }
            }
        }
        sum
    }
}

/// The label that a key shows, where anything is drawn.
#[inline(always)]
fn label(key: u32) -> Option<usize> {
    (key != NOTHING).then_some((!key & 0x7f) as usize)
}

/// Whether a key is of an edge; nothing is none.
#[inline(always)]
fn is_edge(key: u32) -> bool {
    (!key >> 7) & 1 == 1
}

impl Counts {
    #[inline(always)]
    fn add(&mut self, keys: &[u32; LANES], bytes: &[u8; LANES]) {
        let mut all = NOTHING;
        for key in keys {
            all &= key;
        }
        if all == NOTHING {
            return;
        }
        for lane in 0..LANES {
            let (key, seen) = (keys[lane], u32::from(bytes[lane]));
            let is_drawn = u32::from(key != NOTHING);
            let is_edge = u32::from(is_edge(key));
            self.drawn[lane] += is_drawn;
            self.overlap[lane] += is_drawn & (seen >> 7);
            self.edges[lane] += is_edge;
            self.proximity[lane] += (seen & u32::from(Observation::PROXIMITY)) & is_edge.wrapping_neg();
        }
    }
}
