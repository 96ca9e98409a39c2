//! Limbs looked for where no second pass would find them: in the only one of a run, forwards or in real time (METHOD A14), and in the first poses of
//! a fit (METHOD A3).

use std::collections::VecDeque;
use std::time::{Duration, Instant};

use anyhow::Result;

use super::hypotheses::Limbs;
use super::scorer::{Candidate, Effort, Scorer};
use super::shape::Shape;
use super::team::on_the_pool;
use crate::body::Body;
use crate::evaluate::{Evaluator, Objective};
use crate::features::SeenView;
use crate::geometry::Camera;
use crate::search::{SearchSettings, SearchSpace};
use crate::track::searcher::Searched;

/// Poses of a limb that are looked at.
const LOOKED_AT: usize = 192;
/// Generations of all degrees of freedom from a limb that was found.
const SETTLED: usize = 12;
/// By how much a limb found must be worth more than the one that was tracked.
const CONVINCING: f64 = 8.0;
/// Poses that are scored for a limb about, where a run scores as many as it usually does; with fewer to go before its time is up a frame does
/// without.
const SCORED: usize = 1600;
/// What tells the random numbers of these searches from others of a frame.
const TURN: u64 = 1000;

/// What looks for limbs.
pub(crate) struct LimbSearch {
    limbs: Limbs,
    shape: Shape,
    /// The body's, a frame: mm, radians.
    steps: Vec<f32>,
}

/// A frame that was searched, and what searched it.
pub(crate) struct SearchedFrame<'a> {
    pub(crate) evaluator: &'a mut dyn Evaluator,
    pub(crate) objective: &'a Objective,
    pub(crate) settings: &'a SearchSettings,
    pub(crate) space: &'a SearchSpace,
    /// What was seen, one a view.
    pub(crate) views: &'a [SeenView<'a>],
    pub(crate) index: usize,
    /// What time there is, where there is a deadline.
    pub(crate) time: Option<TimeLeft>,
}

/// When a frame must be done.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TimeLeft {
    pub(crate) until: Instant,
    /// How long its search took.
    pub(crate) took: Duration,
}

impl LimbSearch {
    /// For a body seen by cameras at working size.
    ///
    /// # Errors
    /// When the rate makes no sense.
    pub(crate) fn new(body: &Body, cameras: &[Camera], space: &SearchSpace, fps: f64) -> Result<Self> {
        let steps = space.spread(1.0 / fps)?;
        Ok(Self { limbs: Limbs::new(body, cameras, space), shape: Shape::new(body), steps })
    }

    /// Looks at the limbs, in every frame beginning with another one. Where the pictures say more of one elsewhere than where `found` has it, it is
    /// looked for, and all else moves along; what is clearly worth more is found instead. A frame whose time is up leaves the others.
    ///
    /// # Errors
    /// When the evaluator fails.
    pub(crate) fn improve(&self, frame: SearchedFrame<'_>, found: &mut Searched) -> Result<()> {
        on_the_pool(|| self.improve_here(frame, found))
    }

    fn improve_here(&self, frame: SearchedFrame<'_>, found: &mut Searched) -> Result<()> {
        let SearchedFrame { evaluator, objective, settings, space, views, index, time } = frame;
        let mut scorer = Scorer::new(evaluator, objective, space, &self.shape, settings);
        let share = scorer.generations(SCORED) as f64 / found.estimate.evaluations.max(1) as f64;
        let count = self.limbs.count();
        let limbs: Vec<usize> = (0..count).map(|nth| (index + nth) % count).collect();
        // Of this limb and those behind it, as the body is held now.
        let mut are_suspicious = VecDeque::new();
        for (nth, &limb) in limbs.iter().enumerate() {
            if time.is_some_and(|time| Instant::now() + time.took.mul_f64(share) > time.until) {
                break;
            }
            let pose = &found.estimate.pose;
            if are_suspicious.is_empty() {
                are_suspicious = self.limbs.are_suspicious(&mut scorer, views, &limbs[nth..], pose, LOOKED_AT)?.into();
            }
            if are_suspicious.pop_front() != Some(true) {
                continue;
            }
            let before = scorer.candidate(pose.clone())?;
            let after = self.elsewhere(&mut scorer, views, index, limb, &before.pose)?;
            if after.worth > before.worth + CONVINCING {
                let mut fitness = [0.0];
                scorer.evaluator.fitness(&after.pose, objective, &mut fitness)?;
                found.views = scorer.evaluator.view_counts(&after.pose, objective)?;
                (found.estimate.pose, found.estimate.fitness) = (after.pose, fitness[0]);
                are_suspicious.clear();
            }
        }
        found.estimate.evaluations += scorer.scored;
        Ok(())
    }

    /// The pose with every limb looked for, whatever the pictures say of it; what is worth more is found instead, however little.
    ///
    /// # Errors
    /// When the evaluator fails.
    pub(crate) fn look_everywhere(&self, frame: SearchedFrame<'_>, pose: Vec<f32>) -> Result<Vec<f32>> {
        let SearchedFrame { evaluator, objective, settings, space, views, index, .. } = frame;
        let mut scorer = Scorer::new(evaluator, objective, space, &self.shape, settings);
        let mut found = scorer.candidate(pose)?;
        for limb in 0..self.limbs.count() {
            let after = self.elsewhere(&mut scorer, views, index, limb, &found.pose)?;
            if after.worth > found.worth {
                found = after;
            }
        }
        Ok(found.pose)
    }

    /// A pose with a limb looked for everywhere, and then all of it searched round.
    fn elsewhere(
        &self,
        scorer: &mut Scorer<'_>,
        views: &[SeenView<'_>],
        index: usize,
        limb: usize,
        pose: &[f32],
    ) -> Result<Candidate> {
        let turn = TURN + 10 * limb as u64;
        let elsewhere = self.limbs.ends_inward(scorer, views, index, limb, pose, turn)?;
        let effort = Effort { spread: &self.steps, generations: scorer.generations(SETTLED), turn: turn + 1 };
        scorer.search_all(index, &elsewhere.pose, effort, None)
    }
}
