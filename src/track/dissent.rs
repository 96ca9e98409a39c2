//! Views that do not fit what the others show: of a camera that stopped or was moved, that lost frames, or before which something stands
//! (METHOD A14).

use std::sync::Arc;

use anyhow::Result;

use super::confidence::FrameConfidence;
use super::journal::FrameResult;
use crate::features::{BitImage, Observation};

/// Views do not agree where the f1 of one is below this share of the median of the others,
const SHARE: f32 = 0.45;
/// or its share below this one of that in its better frames.
const SUDDEN: f32 = 0.65;
/// The better frames of a view are so many of it.
const BETTER: f32 = 0.25;
/// On average over so many frames.
const FRAMES: usize = 5;
/// The others agree where the median of their f1 is at least this.
const AGREED: f32 = 0.5;
/// Round about, they do not where the share is below this one of what it is elsewhere.
const NEAR: f32 = 0.9;

/// A run of frames, by their places in the run of the track.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Stretch {
    pub(super) first: usize,
    pub(super) last: usize,
}

impl Stretch {
    /// Whether the frame at this place in the run is one of it.
    pub(super) fn contains(self, at: usize) -> bool {
        (self.first..=self.last).contains(&at)
    }
}

/// Where the views of a run do not agree; none of fewer than three views, of which nobody could tell which one is wrong. It need not be the one of
/// the lowest f1: a camera that stands still may hold the pose where the one across sees nobody.
pub(super) fn stretches(results: &[FrameResult], confidences: &[FrameConfidence]) -> Vec<Stretch> {
    let views = results.iter().map(|result| result.views.len()).min().unwrap_or(0);
    if views < 3 {
        return Vec::new();
    }
    let shares = |view: usize| -> Vec<Option<f32>> {
        let frames = results.iter().zip(confidences);
        frames.map(move |(result, confidence)| (!confidence.is_lost).then(|| share(&result.views, view))?).collect()
    };
    let mut found: Vec<Stretch> = (0..views).flat_map(|view| of_view(&shares(view))).collect();
    found.sort_by_key(|stretch| stretch.first);
    found.dedup_by(|next, before| {
        let goes_on = next.first <= before.last + 1;
        if goes_on {
            before.last = before.last.max(next.last);
        }
        goes_on
    });
    found
}

/// Has all pixels of a view count neither for nor against anybody.
pub(super) fn leave_out(observation: &mut Observation) -> Result<()> {
    let all = BitImage::from_fn(observation.width, observation.height, |_, _| true);
    observation.ignore(&Arc::new(all))
}

/// f1 of a view over the median of the others; none where the person is not drawn in it, or the others do not agree.
fn share(views: &[[f32; 2]], view: usize) -> Option<f32> {
    let others = views.iter().enumerate().filter(|(other, terms)| *other != view && is_drawn(terms));
    let mut others: Vec<f32> = others.map(|(_, terms)| terms[0]).collect();
    others.sort_by(f32::total_cmp);
    let middle = others.len() / 2;
    let median = match others.len() {
        0 | 1 => return None,
        count if count.is_multiple_of(2) => 0.5 * (others[middle - 1] + others[middle]),
        _ => others[middle],
    };
    (median >= AGREED && is_drawn(&views[view])).then(|| views[view][0] / median)
}

/// Whether somebody is drawn there, who then has edges.
fn is_drawn(terms: &[f32; 2]) -> bool {
    terms[1] > 0.0
}

/// The stretches in which a view of these shares does not agree with the others; many are the same, or overlap.
fn of_view(shares: &[Option<f32>]) -> Vec<Stretch> {
    let mut known: Vec<f32> = shares.iter().flatten().copied().collect();
    known.sort_by(f32::total_cmp);
    let better = known.get(((1.0 - BETTER) * known.len() as f32) as usize).copied().unwrap_or(1.0);
    // A view is more than the others where one of those is wrong.
    let least = SHARE.max(SUDDEN * better.min(1.0));
    let believed = &known[known.partition_point(|share| *share < least)..];
    let usual = believed.get(believed.len() / 2).copied().unwrap_or(1.0);
    let is_unbelieved = |at: &usize| shares[*at].is_none_or(|share| share < NEAR * usual);
    let stretch = |(at, window): (usize, &[Option<f32>])| {
        let sum: Option<f32> = window.iter().copied().sum();
        sum.filter(|sum| *sum < least * FRAMES as f32)?;
        let mut within = (at..at + FRAMES).filter(is_unbelieved);
        let begin = within.next()?;
        let end = within.next_back().unwrap_or(begin);
        let first = (0..begin).rev().take_while(is_unbelieved).last().unwrap_or(begin);
        let last = (end + 1..shares.len()).take_while(is_unbelieved).last().unwrap_or(end);
        Some(Stretch { first, last })
    };
    shares.windows(FRAMES).enumerate().filter_map(stretch).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::Body;
    use crate::track::JointHints;
    use crate::track::confidence::{Confidence, LossRule};

    /// Frames in which each view has this f1, and edges where it is drawn.
    fn run(frames: usize, f1: impl Fn(usize) -> Vec<f32>) -> Vec<FrameResult> {
        let sure = JointHints { seen: 1.0, looseness: 20.0, support: 1.0, ambiguity: None };
        let joints = vec![sure; Body::adult(1750.0).unwrap().joint_names().len()];
        let of_frame = |frame| FrameResult {
            frame: 100 + frame,
            pose: vec![0.0; 31],
            fitness: 0.8,
            spread: vec![0.0; 31],
            views: f1(frame).into_iter().map(|f1| [f1, if f1 < 0.0 { 0.0 } else { 0.9 }]).collect(),
            joints: joints.clone(),
        };
        (0..frames).map(of_frame).collect()
    }

    fn found(results: &[FrameResult]) -> Vec<[usize; 2]> {
        let confidences = Confidence::of_all(&Body::adult(1750.0).unwrap(), LossRule::default(), results);
        stretches(results, &confidences).into_iter().map(|stretch| [stretch.first, stretch.last]).collect()
    }

    /// A camera that stops shows less and less of her: they do not agree from where that begins until it goes on.
    #[test]
    fn a_view_that_shows_her_elsewhere_begins_a_stretch() {
        let stopped = |frame: usize| match frame {
            20..24 => 0.8 - 0.1 * (frame - 19) as f32,
            24..40 => 0.1,
            40..42 => 0.6,
            _ => 0.8,
        };
        assert_eq!(found(&run(60, |frame| vec![0.85, stopped(frame), 0.8, 0.75])), [[20, 41]]);
        // Two at a time are one stretch, two after another two.
        let between = |frame: usize, frames: std::ops::Range<usize>| if frames.contains(&frame) { 0.2 } else { 0.8 };
        let two = |a: std::ops::Range<usize>, b: std::ops::Range<usize>| {
            found(&run(60, |frame| vec![between(frame, a.clone()), 0.8, 0.7, between(frame, b.clone()), 0.8]))
        };
        assert_eq!(two(10..30, 20..40), [[10, 39]]);
        assert_eq!(two(10..20, 30..40), [[10, 19], [30, 39]]);
    }

    #[test]
    fn views_that_cannot_be_told_apart_or_agree_on_nobody_begin_none() {
        let bad = |frame: usize| if frame < 10 { 0.8 } else { 0.2 };
        assert!(found(&run(50, |frame| vec![bad(frame), 0.8])).is_empty());
        assert_eq!(found(&run(50, |frame| vec![bad(frame), 0.8, 0.6])), [[10, 49]]);
        assert!(found(&run(50, |frame| vec![0.25 * bad(frame), 0.5, 0.4])).is_empty());
        // Not in the picture; hidden for a moment; shown poorly all the time.
        assert!(found(&run(50, |frame| vec![if frame < 10 { 0.8 } else { -1.0 }, 0.8, 0.8, 0.8])).is_empty());
        assert!(
            found(&run(50, |frame| vec![if (20..22).contains(&frame) { 0.3 } else { 0.8 }, 0.8, 0.8, 0.8])).is_empty()
        );
        assert!(found(&run(50, |_| vec![0.45, 0.8, 0.8, 0.8])).is_empty());
    }

    /// A view that is worse than it was, though better than none at all: a camera that was knocked, or is late.
    #[test]
    fn a_view_that_turns_worse_begins_a_stretch() {
        let knocked =
            |from: usize, after: f32| move |frame: usize| vec![if frame < from { 0.8 } else { after }, 0.8, 0.8];
        assert_eq!(found(&run(60, knocked(20, 0.48))), [[20, 59]]);
        assert!(found(&run(60, knocked(20, 0.56))).is_empty(), "not so much worse");
        assert!(found(&run(60, knocked(5, 0.48))).is_empty(), "no better in a quarter of its frames");
    }

    /// Neither against a frame nor for what is usual in the view.
    #[test]
    fn what_was_left_out_counts_for_nothing() {
        let mut results = run(12, |_| vec![0.8; 4]);
        results[3..9].iter_mut().for_each(|result| result.views[2] = FrameResult::LEFT_OUT);
        assert_eq!(
            [2, 3, 8, 9].map(|at| results[at].left_out().collect::<Vec<_>>()),
            [vec![], vec![2], vec![2], vec![]]
        );
        assert_eq!([0, 5].map(|at| results[at].counted_views().count()), [4, 3]);
        assert!((results[5].mean_f1() - 0.8).abs() < 1e-6);
        let frames = Confidence::of_all(&Body::adult(1750.0).unwrap(), LossRule::default(), &results);
        assert!(frames.iter().all(|frame| frame.agreement == 1.0 && frame.confidence == 1.0 && !frame.is_lost));
    }
}
