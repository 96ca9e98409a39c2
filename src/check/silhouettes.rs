//! The silhouettes that are looked at: those of some frames spread over the sequence and of their neighbours in time.

use std::ops::{Range, RangeInclusive};

use anyhow::{Context, Result, ensure};

use super::agreement::Moment;
use super::signed_distance::SignedDistance;
use crate::features::{Extractor, FeatureSettings, ViewSource};
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
    pub(super) fn read(sequence: &Sequence, frames: Range<usize>, count: usize) -> Result<Self> {
        let learns = sequence.views.iter().find(|view| view.mask.is_none() && view.background.is_none());
        if let Some(view) = learns {
            ensure!(
                frames.start > 0,
                "{}: camera {:?} has neither a background picture nor masks, and no frame comes before frame 0 to learn \
                 the empty scene from: give it one of them, or start later with --frames",
                sequence.path.display(),
                view.camera
            );
        }
        let name = sequence.path.display().to_string();
        let table = sequence.features.as_ref().map(|table| FeatureSettings::from_table(table, &name));
        let sources = sequence.backgrounds()?.into_iter().zip(&sequence.sizes);
        let sources = sources.map(|(plate, &[width, height])| ViewSource { width, height, plate }).collect();
        let settings = table.transpose()?.unwrap_or_default().without_segments();
        let mut extractor = Extractor::new(settings, sources).context(name)?;
        let samples = spread(&frames, count);
        let mut reader = sequence.read_frames(if learns.is_some() { 0 } else { frames.start }..frames.end)?;
        let mut features = Vec::new();
        let mut fields = Vec::new();
        while let Some(frame) = reader.next_frame()? {
            if frame.index < frames.start {
                extractor.prime(&frame.pictures)?;
                continue;
            }
            let near = |sample: &usize| SHIFTS.contains(&(frame.index as isize - *sample as isize));
            let is_wanted = samples.iter().any(near);
            if is_wanted || learns.is_some() {
                extractor.extract_into(&frame.pictures, &frame.masks, &mut features)?;
            }
            let field = |view: &crate::features::ViewFeatures| {
                SignedDistance::of(&view.silhouette, view.silhouette.height().div_ceil(ROWS))
            };
            fields.push(if is_wanted { features.iter().map(field).collect() } else { Vec::new() });
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
