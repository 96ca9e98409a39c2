//! Frames of a window in a row, which are worked on side by side with those of other sections (METHOD A14).

use std::ops::Range;

/// Frames that a section has at least, in a window of as many: tracks go through sections side by side, and on into the next ones where they lead
/// to something else there. A track that begins in the middle of a quick turn does not find what one does that comes from before it.
pub(super) const SECTION: usize = 64;

/// Some frames of a window in a row.
#[derive(Clone, Debug)]
pub(super) struct Section {
    pub(super) frames: Range<usize>,
    /// How widely to search them.
    pub(super) spread: Vec<f32>,
}

/// How many sections of at least so many frames a window has.
pub(super) fn pieces(frames: usize, least: usize) -> usize {
    (frames / least).max(1)
}

/// The places of so many frames in the order of a track.
pub(super) fn order(count: usize, is_back: bool) -> Vec<usize> {
    if is_back { (0..count).rev().collect() } else { (0..count).collect() }
}
