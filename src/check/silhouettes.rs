//! The silhouettes that are looked at: those of some frames spread over the sequence and of their neighbours in time, more of them where a
//! camera may be far from the others in time.

use std::ops::{Range, RangeInclusive};

use anyhow::Result;

use super::agreement::Moment;
use super::signed_distance::SignedDistance;
use crate::features::ViewFeatures;
use crate::observe::{Advance, Observer, check_background, silhouette_settings};
use crate::sequence::{FrameSet, Sequence, View};

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
    /// Frames by which a view can be moved; [`SHIFTS`] unless widened.
    pub(super) reach: usize,
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
        Self::read_and_show(sequence, frames, count, &mut |_| {}, progress)
    }

    /// [`Self::read`], and shows `see` every frame of the range.
    pub(super) fn read_and_show(
        sequence: &Sequence,
        frames: Range<usize>,
        count: usize,
        see: &mut dyn FnMut(&FrameSet),
        progress: &mut Advance<'_>,
    ) -> Result<Self> {
        check_background(sequence, &frames)?;
        let samples = spread(&frames, count);
        let reach = SHIFTS.end().unsigned_abs();
        let is_kept = |frame: usize, _: usize| is_near(&samples, frame, reach);
        let fields = fields(sequence, frames.clone(), is_kept, see, progress)?;
        Ok(Self { frames, samples, reach, fields })
    }

    /// The same samples with more neighbours of the views `wide`, by which these can be moved by `reach` frames, beyond the range too.
    ///
    /// # Errors
    /// As [`Self::read`].
    pub(super) fn widened(
        &self,
        sequence: &Sequence,
        wide: &[usize],
        reach: usize,
        progress: &mut Advance<'_>,
    ) -> Result<Self> {
        let near = SHIFTS.end().unsigned_abs();
        // A background that is learnt as the frames go by would be learnt from others.
        let before = if sequence.views.iter().any(View::learns_background) { 0 } else { reach + near };
        let (start, end) = (self.frames.start.saturating_sub(before), self.frames.end + reach + near);
        let frames = start..end.min(sequence.frame_count);
        let is_kept = |frame: usize, view: usize| {
            is_near(&self.samples, frame, if wide.contains(&view) { reach + near } else { near })
        };
        let fields = fields(sequence, frames.clone(), is_kept, &mut |_| {}, progress)?;
        Ok(Self { frames, samples: self.samples.clone(), reach, fields })
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

/// Whether a frame is at most `reach` from a sample.
fn is_near(samples: &[usize], frame: usize, reach: usize) -> bool {
    samples.iter().any(|&sample| sample.abs_diff(frame) <= reach)
}

/// The silhouettes of the frames and views that are kept; all frames are shown to `see`.
fn fields(
    sequence: &Sequence,
    frames: Range<usize>,
    is_kept: impl Fn(usize, usize) -> bool,
    see: &mut dyn FnMut(&FrameSet),
    progress: &mut Advance<'_>,
) -> Result<Vec<Vec<Option<SignedDistance>>>> {
    let views = 0..sequence.views.len();
    let mut observer = Observer::new(sequence, silhouette_settings(sequence)?, frames.clone(), frames.start)?;
    let mut fields = vec![Vec::new(); frames.len()];
    while let Some(frame) = observer.read()? {
        progress("reading", frame.index.saturating_sub(frames.start), frames.len());
        if frames.contains(&frame.index) {
            see(&frame);
        }
        let is_wanted = views.clone().any(|view| is_kept(frame.index, view));
        if let Some(features) = observer.features(&frame, is_wanted)? {
            let field = |(at, view): (usize, &ViewFeatures)| {
                let step = view.silhouette.height().div_ceil(ROWS);
                let kept = is_kept(frame.index, at).then_some(&view.silhouette)?;
                SignedDistance::of(kept, step, view.observation.ignored.clone())
            };
            fields[frame.index - frames.start] = features.iter().enumerate().map(field).collect();
        }
    }
    Ok(fields)
}

/// `count` frames evenly spread, away from the ends where there is room for their neighbours.
fn spread(frames: &Range<usize>, count: usize) -> Vec<usize> {
    let edge = 3.min(frames.len().saturating_sub(1) / 2);
    let (first, last) = (frames.start + edge, frames.end - 1 - edge);
    let count = count.clamp(1, last - first + 1);
    let step = if count > 1 { (last - first) as f64 / (count - 1) as f64 } else { 0.0 };
    (0..count).map(|at| first + (at as f64 * step).round() as usize).collect()
}
