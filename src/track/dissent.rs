//! Views that do not fit what the others show: of a camera that stopped or was moved, that lost frames, or before which something stands
//! (METHOD A14).

use std::sync::Arc;

use anyhow::Result;

use super::confidence::FrameConfidence;
use super::held::runs_of;
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
        let is_same = next.first <= before.last + 1;
        before.last = if is_same { before.last.max(next.last) } else { before.last };
        is_same
    });
    found
}

/// Which views of which frames of a run are wrong.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Dissent {
    /// A row a frame, empty where none is.
    rows: Vec<Vec<bool>>,
}

impl Dissent {
    /// Of so many views and frames.
    pub(super) fn new(views: usize, frames: usize, wrong: impl Iterator<Item = (usize, Stretch)>) -> Self {
        let mut rows = vec![Vec::new(); frames];
        for (view, Stretch { first, last }) in wrong {
            for row in &mut rows[first..=last] {
                row.resize(views, false);
                row[view] = true;
            }
        }
        Self { rows }
    }

    /// Those that a second pass left out.
    pub(super) fn left_out(results: &[FrameResult]) -> Self {
        let row = |result: &FrameResult| {
            let mut row = vec![false; result.views.len()];
            result.left_out().for_each(|view| row[view] = true);
            if row.contains(&true) { row } else { Vec::new() }
        };
        Self { rows: results.iter().map(row).collect() }
    }

    /// The views that dissent in the frame at this place in the run.
    pub(super) fn views_at(&self, at: usize) -> impl Iterator<Item = usize> + '_ {
        let row = self.rows.get(at).map_or(&[][..], Vec::as_slice);
        row.iter().enumerate().filter(|(_, dissents)| **dissents).map(|(view, _)| view)
    }

    /// Runs of frames, by their places in the run, in which a view dissents: the first and the last of each.
    pub(super) fn runs(&self, view: usize) -> Vec<[usize; 2]> {
        runs_of((0..self.rows.len()).filter(|at| self.rows[*at].get(view) == Some(&true)))
    }
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

/// The stretches in which a view of these shares does not agree with the others.
fn of_view(shares: &[Option<f32>]) -> Vec<Stretch> {
    let mut known: Vec<f32> = shares.iter().flatten().copied().collect();
    known.sort_by(f32::total_cmp);
    let better = known.get(((1.0 - BETTER) * known.len() as f32) as usize).copied().unwrap_or(1.0);
    // A view is more than the others where one of those is wrong.
    let least = SHARE.max(SUDDEN * better.min(1.0));
    let believed = &known[known.partition_point(|share| *share < least)..];
    let usual = believed.get(believed.len() / 2).copied().unwrap_or(1.0);
    let is_unbelieved = |at: &usize| shares[*at].is_none_or(|share| share < NEAR * usual);
    let mut found: Vec<Stretch> = Vec::new();
    for (at, window) in shares.windows(FRAMES).enumerate() {
        let sum: Option<f32> = window.iter().copied().sum();
        if sum.is_none_or(|sum| sum >= least * FRAMES as f32) {
            continue;
        }
        let mut within = (at..at + FRAMES).filter(is_unbelieved);
        let Some(begin) = within.next() else { continue };
        let end = within.next_back().unwrap_or(begin);
        let first = (0..begin).rev().take_while(is_unbelieved).last().unwrap_or(begin);
        let last = (end + 1..shares.len()).take_while(is_unbelieved).last().unwrap_or(end);
        match found.last_mut() {
            Some(before) if before.last + 1 >= first => before.last = before.last.max(last),
            _ => found.push(Stretch { first, last }),
        }
    }
    found
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

    #[test]
    fn a_wrong_view_is_known_in_its_frames() {
        let dissent = Dissent::new(
            4,
            50,
            [(2, Stretch { first: 10, last: 20 }), (0, Stretch { first: 15, last: 16 })].into_iter(),
        );
        assert_eq!((dissent.runs(2), dissent.runs(0), dissent.runs(1)), (vec![[10, 20]], vec![[15, 16]], vec![]));
        assert_eq!(
            [9, 10, 15, 21, 50].map(|at| dissent.views_at(at).collect::<Vec<_>>()),
            [vec![], vec![2], vec![0, 2], vec![], vec![]]
        );
    }

    #[test]
    fn what_was_left_out_is_known_again() {
        let mut results = run(12, |_| vec![0.8; 4]);
        results[3..9].iter_mut().for_each(|result| result.views[2] = FrameResult::LEFT_OUT);
        let left_out = Dissent::left_out(&results);
        assert_eq!((0..4).map(|view| left_out.runs(view)).collect::<Vec<_>>(), [vec![], vec![], vec![[3, 8]], vec![]]);
        assert_eq!(left_out.views_at(5).collect::<Vec<_>>(), [2]);
        // It counts for nothing: neither against the frame nor for what is usual in the view.
        let frames = Confidence::of_all(&Body::adult(1750.0).unwrap(), LossRule::default(), &results);
        assert!(frames.iter().all(|frame| frame.agreement == 1.0 && frame.confidence == 1.0 && !frame.is_lost));
    }
}
