//! The silhouettes that are looked at: those of some frames spread over the sequence and of their neighbours in time.

use std::ops::{Range, RangeInclusive};

use anyhow::Result;

use super::agreement::Moment;
use super::signed_distance::SignedDistance;
use crate::features::ViewFeatures;
use crate::observe::{Advance, Observer, check_background, silhouette_settings};
use crate::sequence::Sequence;

/// Frames by which a camera may be early or late.
pub(super) const SHIFTS: RangeInclusive<isize> = -3..=3;
/// Silhouettes are sampled so that their pictures have about this many rows: enough for a tenth of a degree.
const ROWS: u32 = 540;

/// The silhouettes of a stretch of frames, every view's.
pub(super) struct Silhouettes {
    /// Frames of the sequence that lie here.
    pub(super) frames: Range<usize>,
    /// The frames looked at.
    pub(super) samples: Vec<usize>,
    /// A row a frame, a silhouette a view; empty rows where a frame is neither sample nor neighbour.
    fields: Vec<Vec<Option<SignedDistance>>>,
}

impl Silhouettes {
    /// Reads the silhouettes of `count` frames spread over `frames`, and of their neighbours within it.
    ///
    /// # Errors
    /// When the range is not the sequence's, the features' settings make no sense, a picture cannot be read, or a
    /// background would have to be learnt and no frame comes before the range.
    pub(super) fn read(
        sequence: &Sequence,
        frames: Range<usize>,
        count: usize,
        progress: &mut Advance<'_>,
    ) -> Result<Self> {
        check_background(sequence, &frames)?;
        let samples = spread(&frames, count);
        let is_wanted =
            |frame: usize| samples.iter().any(|&sample| SHIFTS.contains(&(frame as isize - sample as isize)));
        let mut observer = Observer::new(sequence, silhouette_settings(sequence)?, frames.clone(), frames.start)?;
        let mut fields = vec![Vec::new(); frames.len()];
        while let Some(frame) = observer.read()? {
            progress("reading", frame.index.saturating_sub(frames.start), frames.len());
            if let Some(features) = observer.features(&frame, is_wanted(frame.index))? {
                let field = |view: &ViewFeatures| {
                    let step = view.silhouette.height().div_ceil(ROWS);
                    SignedDistance::of(&view.silhouette, step, view.observation.ignored.clone())
                };
                fields[frame.index - frames.start] = features.iter().map(field).collect();
            }
        }
        Ok(Self { frames, samples, fields })
    }

    /// A sample as the views saw it, with each view's frame moved by `shift(view)`; None where a neighbour is not in
    /// the range.
    pub(super) fn moment(&self, sample: usize, shift: impl Fn(usize) -> isize) -> Option<Moment<'_>> {
        let views = self.fields[sample - self.frames.start].len();
        let seen = |view: usize| {
            let frame = sample.checked_add_signed(shift(view))?.checked_sub(self.frames.start)?;
            self.fields.get(frame)?.get(view).map(Option::as_ref)
        };
        (0..views).map(seen).collect()
    }

    /// Every sample as it is.
    pub(super) fn moments(&self) -> Vec<Moment<'_>> {
        self.samples.iter().filter_map(|&sample| self.moment(sample, |_| 0)).collect()
    }
}

/// `count` frames evenly spread, away from the ends where there is room for their neighbours.
fn spread(frames: &Range<usize>, count: usize) -> Vec<usize> {
    let edge = 3.min(frames.len().saturating_sub(1) / 2);
    let (first, last) = (frames.start + edge, frames.end - 1 - edge);
    let count = count.clamp(1, last - first + 1);
    let step = if count > 1 { (last - first) as f64 / (count - 1) as f64 } else { 0.0 };
    (0..count).map(|at| first + (at as f64 * step).round() as usize).collect()
}
