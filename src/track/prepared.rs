//! A frame ready to be searched: its pictures, and what was seen in them, wherever that is.

use std::time::Instant;

use image::RgbImage;

use super::timings::Span;
use crate::features::{HeldFrame, Likelihood, Observation, SeenFrame, ViewFeatures};

/// A frame ready to be searched.
pub(super) struct Prepared {
    /// Its index in the sequence.
    pub(super) index: usize,
    /// The pictures at working size, one a view.
    pub(super) pictures: Vec<RgbImage>,
    /// What was seen, one a view; none where a device holds it.
    pub(super) observations: Vec<Observation>,
    /// What was seen, where the device that made it holds it.
    pub(super) held: Option<HeldFrame>,
    /// How likely each pixel is as background, one a view; none where poses are not compared by evidence.
    pub(super) likelihoods: Vec<Likelihood>,
    /// All features of every view but the likelihoods, where several people are told apart by them; else none.
    pub(super) features_kept: Vec<ViewFeatures>,
    /// Views that delivered nothing.
    pub(super) silent: Vec<usize>,
    /// Waiting for the pictures.
    pub(super) read: Span,
    /// Making the features.
    pub(super) features: Span,
    /// When it was captured, where it was just now.
    pub(super) captured: Option<Instant>,
}

impl Prepared {
    /// What was seen, wherever it is.
    pub(super) fn seen(&self) -> SeenFrame<'_> {
        self.held.as_ref().map_or(SeenFrame::Whole(&self.observations), SeenFrame::Held)
    }
}
