//! A frame's observations that stay on the device which made them, and what the host knows of them.

use std::sync::mpsc::Sender;

use super::{BitImage, Evidence, Observation, Region};
use crate::gpu::{Buffer, DevicePass};

/// One camera's packed observation in the two forms that evaluators on a device compare with.
#[derive(Clone, Debug)]
pub struct HeldView {
    /// The packed bytes, four pixels a word, rows padded to whole words.
    pub pixels: Buffer,
    /// Bit planes, eight words for 32 pixels of a row: planes 0..=6 the proximity bits, plane 7 the silhouette.
    pub planes: Buffer,
}

/// What a device saw in a frame. Its memory is one of two that take turns, and serves another frame when this is dropped.
#[derive(Debug)]
pub struct HeldFrame {
    pub(super) views: Vec<HeldView>,
    pub(super) silhouettes: Vec<BitImage>,
    pub(super) passes: Vec<DevicePass>,
    pub(super) lease: Lease,
}

impl HeldFrame {
    /// The observations, one a view, in the order of the cameras.
    pub fn views(&self) -> &[HeldView] {
        &self.views
    }

    /// The silhouettes, which the host has too, one a view: a bit of the eight of a pixel.
    pub fn silhouettes(&self) -> &[BitImage] {
        &self.silhouettes
    }

    /// The passes that made it, where they were timed.
    pub fn passes(&self) -> &[DevicePass] {
        &self.passes
    }

    /// Which of the two memories it has.
    pub fn place(&self) -> usize {
        self.lease.place
    }
}

/// The right to one of two memories: given back when dropped.
#[derive(Debug)]
pub(super) struct Lease {
    pub(super) place: usize,
    pub(super) given_back: Sender<usize>,
}

impl Drop for Lease {
    fn drop(&mut self) {
        // Without a chain there is nothing to give it back to.
        let _ = self.given_back.send(self.place);
    }
}

/// What the host knows of a view: everything, or the silhouette of what a device holds.
#[derive(Clone, Copy, Debug)]
pub enum SeenView<'a> {
    /// The observation itself.
    Whole(&'a Observation),
    /// The silhouette of one that a device holds, in which every pixel counts.
    Silhouette(&'a BitImage),
}

impl<'a> SeenView<'a> {
    /// Of observations, one a view.
    pub fn all(observations: &'a [Observation]) -> Vec<Self> {
        observations.iter().map(Self::Whole).collect()
    }

    /// Width and height, pixels.
    pub fn size(self) -> [u32; 2] {
        match self {
            Self::Whole(observation) => [observation.width, observation.height],
            Self::Silhouette(silhouette) => [silhouette.width(), silhouette.height()],
        }
    }

    /// Whether a pixel, by its place in the picture's rows, is in the silhouette.
    pub fn is_person(self, at: usize) -> bool {
        match self {
            Self::Whole(observation) => observation.bytes[at] & Observation::SILHOUETTE != 0,
            Self::Silhouette(silhouette) => {
                let width = silhouette.width() as usize;
                silhouette.get((at % width) as u32, (at / width) as u32)
            }
        }
    }

    /// Whether a pixel counts neither for nor against a candidate.
    pub fn ignores(self, at: usize) -> bool {
        match self {
            Self::Whole(observation) => observation.ignores(at),
            Self::Silhouette(_) => false,
        }
    }

    /// How likely each pixel is of each class of parts, where that is known.
    pub fn evidence(self) -> Option<&'a Evidence> {
        match self {
            Self::Whole(observation) => observation.evidence.as_ref(),
            Self::Silhouette(_) => None,
        }
    }

    /// The smallest region that holds the silhouette; none where there is none.
    pub fn bounds(self) -> Option<Region> {
        match self {
            Self::Whole(observation) => observation.silhouette().bounds(),
            Self::Silhouette(silhouette) => silhouette.bounds(),
        }
    }

    /// The number of silhouette pixels.
    pub fn area(self) -> u32 {
        match self {
            Self::Whole(observation) => observation.area(),
            Self::Silhouette(silhouette) => silhouette.count(),
        }
    }
}

/// What was seen in a frame, wherever it is.
#[derive(Clone, Copy, Debug)]
pub enum SeenFrame<'a> {
    /// Observations of the host.
    Whole(&'a [Observation]),
    /// What a device made and holds.
    Held(&'a HeldFrame),
}

impl<'a> SeenFrame<'a> {
    /// What the host knows of the views.
    pub fn views(self) -> Vec<SeenView<'a>> {
        match self {
            Self::Whole(observations) => SeenView::all(observations),
            Self::Held(frame) => frame.silhouettes.iter().map(SeenView::Silhouette).collect(),
        }
    }
}
