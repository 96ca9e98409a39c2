//! Frames of a window in a row, which are worked on side by side with those of other sections (METHOD A14).

use std::ops::Range;

/// Frames of a section: tracks go through sections side by side, and on into the next ones where they lead to something else there.
pub(super) const SECTION: usize = 32;

/// Some frames of a window in a row.
#[derive(Clone, Debug)]
pub(super) struct Section {
    pub(super) frames: Range<usize>,
    /// How widely to search them.
    pub(super) spread: Vec<f32>,
}

/// The places of so many frames in the order of a track.
pub(super) fn order(count: usize, is_back: bool) -> Vec<usize> {
    if is_back { (0..count).rev().collect() } else { (0..count).collect() }
}
