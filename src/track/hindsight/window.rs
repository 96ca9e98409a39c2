//! Frames seen again, some in a row at a time.

use std::collections::VecDeque;

use anyhow::Result;
use image::RgbImage;

use crate::features::Observation;
use crate::track::appearance::RunAppearance;
use crate::track::feed::Frames;

/// Bytes that the observations of a window may take, and frames that it has at least and at most.
const BYTES: usize = 512 << 20;
const FRAMES: [usize; 2] = [8, 64];
/// Share of a window, as its inverse, that the next window sees again.
const OVERLAP: usize = 4;

/// What was seen in a frame.
pub(super) struct Seen {
    pub(super) index: usize,
    pub(super) observations: Vec<Observation>,
    /// Its pictures, where they are asked for.
    pub(super) pictures: Option<Vec<RgbImage>>,
}

/// The frames of a run again, in windows that overlap.
pub(super) struct Windows<'a> {
    feed: &'a mut dyn Frames,
    appearance: Option<&'a RunAppearance>,
    pictures_every: usize,
    seen: VecDeque<Seen>,
    size: usize,
    is_over: bool,
}

impl<'a> Windows<'a> {
    /// From the first frame of a run on; the evidence is what `appearance` knows. Every `pictures_every` frames keep their pictures.
    pub(super) fn new(feed: &'a mut dyn Frames, appearance: Option<&'a RunAppearance>, pictures_every: usize) -> Self {
        Self { feed, appearance, pictures_every, seen: VecDeque::new(), size: FRAMES[0], is_over: false }
    }

    /// Reads on until the window is full or there are no more frames.
    ///
    /// # Errors
    /// When a frame cannot be read.
    pub(super) fn fill(&mut self) -> Result<()> {
        while !self.is_over && self.seen.len() < self.size {
            let Some(mut prepared) = self.feed.next()? else {
                self.is_over = true;
                break;
            };
            if let Some(appearance) = self.appearance {
                appearance.observe(&mut prepared)?;
            }
            let bytes: usize = prepared.observations.iter().map(bytes_of).sum();
            self.size = (BYTES / bytes.max(1)).clamp(FRAMES[0], FRAMES[1]);
            let index = prepared.index;
            let is_shown = self.pictures_every > 0 && index.is_multiple_of(self.pictures_every);
            let pictures = is_shown.then_some(prepared.pictures);
            self.seen.push_back(Seen { index, observations: prepared.observations, pictures });
        }
        Ok(())
    }

    /// The frames in it.
    pub(super) fn seen(&self) -> &VecDeque<Seen> {
        &self.seen
    }

    /// How many of its frames are settled with it: the others are seen again in the next.
    pub(super) fn settled(&self) -> usize {
        if self.is_over { self.seen.len() } else { self.seen.len() - self.seen.len() / OVERLAP }
    }

    /// Forgets the first frames.
    pub(super) fn forget(&mut self, count: usize) {
        self.seen.drain(..count);
    }
}

/// What an observation takes in memory.
fn bytes_of(observation: &Observation) -> usize {
    let segments = observation.segmentation.as_ref().map_or(0, |segmentation| segmentation.numbers().len());
    let evidence = observation.evidence.as_ref().map_or(0, |evidence| 4 * evidence.words().len());
    observation.bytes.len() + segments + evidence
}
