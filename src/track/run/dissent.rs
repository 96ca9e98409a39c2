//! Which camera is wrong where the views of the first pass do not agree: the one without which the others do (METHOD A14).

use std::time::Instant;

use anyhow::{Context, Result};

use super::{Run, found_in};
use crate::features::{SeenFrame, SeenView};
use crate::track::confidence::{Confidence, LossRule};
use crate::track::dissent::{leave_out, stretches};
use crate::track::feed::{Frames, Keeps, Prepared};
use crate::track::journal::FrameResult;
use crate::track::plan::Plan;
use crate::track::progress::Progress;
use crate::track::searcher::{Searcher, Start};

/// Frames of a stretch that are searched to tell.
const ASKED: usize = 5;
/// What the fitness without a view must have more than that with all, and than that without any other.
const MORE_THAN_ALL: f32 = 0.02;
const MORE_THAN_OTHERS: f32 = 0.01;

/// Follows the person through a stretch, without one of the views or with all.
struct Follower {
    without: Option<usize>,
    search: Searcher,
    results: Vec<FrameResult>,
}

impl Run<'_> {
    /// Finds out which view is wrong where those of the first pass do not agree, and searches those frames again without it:
    /// their results say which one is left out.
    ///
    /// # Errors
    /// When frames cannot be read, or the evaluator fails.
    pub(in crate::track) fn find_dissent(&mut self, progress: &mut dyn Progress) -> Result<()> {
        let feed = |run: &Self, from: usize| run.pace.feed(run.sequence, &run.plan, from, &Keeps::Observations);
        self.find_dissent_in(feed, progress)
    }

    /// [`Self::find_dissent`], where `feed` opens the frames that are left to her, from the one of this number on.
    pub(in crate::track) fn find_dissent_in<'f>(
        &mut self,
        feed: impl FnOnce(&Self, usize) -> Result<Box<dyn Frames + 'f>>,
        progress: &mut dyn Progress,
    ) -> Result<()> {
        if !self.looks_back() {
            return Ok(());
        }
        let confidences = Confidence::of_all(&self.plan.body, LossRule::default(), &self.frames);
        let stretches = stretches(&self.frames, &confidences);
        let ([first, .., last] | [first @ last]) = stretches.as_slice() else { return Ok(()) };
        let start = Instant::now();
        let mut feed = feed(self, self.plan.range.start + first.first)?;
        let mut followers = Vec::new();
        for at in first.first..=last.last {
            progress.preparing("asking which camera is wrong", at - first.first, last.last - first.first + 1);
            if progress.should_stop() {
                // Nor will the second pass begin.
                break;
            }
            let Some(mut prepared) = feed.next()? else { break };
            let Some(stretch) = stretches.iter().find(|stretch| stretch.contains(at)) else { continue };
            if at == stretch.first {
                followers = self.followers()?;
            }
            if followers.is_empty() {
                continue;
            }
            self.observe(&mut prepared)?;
            let before = self.frames[stretch.first.saturating_sub(1)].pose.clone();
            for follower in &mut followers {
                self.follow(follower, &before, &prepared).with_context(|| format!("frame {}", prepared.index))?;
            }
            if at == stretch.last.min(stretch.first + ASKED - 1) {
                let told = wrong_view(&followers.iter().map(Follower::fitness).collect::<Vec<f32>>());
                followers.retain(|follower| told.is_some() && follower.without == told);
            }
            if at == stretch.last
                && let Some(Follower { results, .. }) = followers.pop()
            {
                self.frames.splice(stretch.first..=stretch.last, results);
            }
        }
        self.count_over_frames("dissent", start);
        Ok(())
    }

    /// One without each view and, last, one with all.
    fn followers(&self) -> Result<Vec<Follower>> {
        let views = (0..self.sequence.cameras.len()).map(Some);
        let follower = |without| {
            let search = Searcher::on_host(self.plan.search_settings(), &self.plan.space)?;
            Ok(Follower { without, search, results: Vec::new() })
        };
        views.chain([None]).map(follower).collect()
    }

    /// Searches the next frame of a stretch, before which she was there.
    fn follow(&mut self, follower: &mut Follower, before: &[f32], prepared: &Prepared) -> Result<()> {
        let spread = self.plan.spread(false)?;
        let number = u32::try_from(prepared.index).context("it is beyond the counters of the search")?;
        let mut observations = prepared.observations.clone();
        if let Some(view) = follower.without {
            leave_out(&mut observations[view])?;
        }
        let centre = follower.results.last().map_or(before, |result| &result.pose);
        let start = Start { frame: number, centre, spread: &spread, until: None };
        let Plan { objective, backend, .. } = &mut self.plan;
        let evaluator = backend.evaluator.as_mut();
        let searched = follower.search.search(evaluator, objective, SeenFrame::Whole(&observations), start)?;
        let views = SeenView::all(&observations);
        let mut result = found_in(prepared.index, &searched, &views, (evaluator, objective, &self.probe))?;
        if let Some(view) = follower.without {
            result.views[view] = FrameResult::LEFT_OUT;
        }
        follower.results.push(result);
        Ok(())
    }
}

impl Follower {
    /// The mean over its frames.
    fn fitness(&self) -> f32 {
        self.results.iter().map(|result| result.fitness).sum::<f32>() / self.results.len() as f32
    }
}

/// The view that is wrong, where one is, by the fitness without each view and, last, with all.
fn wrong_view(fitness: &[f32]) -> Option<usize> {
    let (with_all, without) = fitness.split_last()?;
    let (view, best) = without.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1))?;
    let others = without.iter().enumerate().filter(|(other, _)| *other != view);
    let next = others.map(|(_, fitness)| *fitness).fold(0.0, f32::max);
    (best - with_all >= MORE_THAN_ALL && best - next >= MORE_THAN_OTHERS).then_some(view)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_view_without_which_the_others_agree_is_wrong() {
        assert_eq!(wrong_view(&[0.7, 0.9, 0.75, 0.7]), Some(1));
        assert_eq!(wrong_view(&[0.895, 0.9, 0.75, 0.7]), None, "nearly as well without another");
        assert_eq!(wrong_view(&[0.7, 0.715, 0.7, 0.7]), None, "nearly as well with all");
    }
}
