//! Frames of a run in real time that wait for those after them: each is searched again close to where the frames around it lead to expect
//! it (METHOD A14), as the second pass of a run that has time does, with as much of what comes after as the delay holds.

use std::collections::VecDeque;

use anyhow::Result;

use super::mending::widths;
use super::refining::{self, Settled};
use super::scorer::Scorer;
use super::shape::Shape;
use super::team::on_the_pool;
use crate::body::Body;
use crate::track::confidence::JointProbe;
use crate::track::feed::Prepared;
use crate::track::journal::FrameResult;
use crate::track::plan::Plan;

/// The frames that wait, and what is known of those before them.
pub(crate) struct Delayed {
    /// Frames that a frame waits for.
    delay: usize,
    /// Frames on either side that tell of a frame.
    reach: usize,
    shape: Shape,
    /// The last frames given out, oldest first.
    before: Vec<Settled>,
    waiting: VecDeque<Waiting>,
}

struct Waiting {
    prepared: Prepared,
    result: FrameResult,
    /// Where its search put it; nowhere where the person is lost.
    found: Option<Settled>,
}

impl Delayed {
    /// For a run whose frames wait for `delay` more.
    pub(crate) fn new(body: &Body, fps: f64, delay: usize) -> Self {
        let shape = Shape::new(body);
        Self { delay, reach: refining::reach(fps), shape, before: Vec::new(), waiting: VecDeque::new() }
    }

    /// Lets a frame wait.
    pub(crate) fn push(&mut self, prepared: Prepared, result: FrameResult, is_lost: bool) {
        let found = (!is_lost).then(|| Settled {
            frame: result.frame,
            pose: result.pose.clone(),
            points: self.shape.points(&result.pose),
        });
        self.waiting.push_back(Waiting { prepared, result, found });
    }

    /// The next frame that has waited long enough when frame `last` is searched, searched again. It stays first in line where that fails.
    ///
    /// # Errors
    /// When the evaluator fails.
    pub(crate) fn next(
        &mut self,
        last: usize,
        plan: &mut Plan,
        probe: &JointProbe,
    ) -> Result<Option<(Prepared, FrameResult)>> {
        let Some(Waiting { prepared, result, found }) = self.waiting.front() else { return Ok(None) };
        if last.saturating_sub(result.frame) < self.delay {
            return Ok(None);
        }
        let mut poses = self.before.clone();
        poses.extend(self.waiting.iter().filter_map(|waiting| waiting.found.clone()));
        let mut settled = None;
        if found.is_some() && poses.len() > 1 {
            let steps = plan.spread(false)?;
            let rows: Vec<Vec<f32>> = poses.iter().map(|settled| settled.pose.clone()).collect();
            let settings = *plan.search_settings();
            let Plan { objective, backend, space, .. } = plan;
            let evaluator = backend.evaluator.as_mut();
            let spread = widths(&steps, &rows);
            let observations = &prepared.observations;
            let again = on_the_pool(|| {
                let mut scorer = Scorer::new(&mut *evaluator, objective, space, &self.shape, &settings);
                refining::refine_one(&mut scorer, observations, &spread, &poses, self.before.len(), self.reach)
            })?;
            let result = super::result(evaluator, objective, probe, observations, &again, result)?;
            settled = Some((again, result));
        }
        Ok(self.take().map(|(prepared, first, found)| match settled {
            Some((settled, result)) => {
                self.keep(settled);
                (prepared, result)
            }
            None => {
                found.into_iter().for_each(|found| self.keep(found));
                (prepared, first)
            }
        }))
    }

    /// The next frame as its search left it.
    pub(crate) fn give_up(&mut self) -> Option<(Prepared, FrameResult)> {
        self.take().map(|(prepared, result, _)| (prepared, result))
    }

    /// Forgets the frames given out: what comes does not go on from them.
    pub(crate) fn begin_anew(&mut self) {
        self.before.clear();
    }

    fn take(&mut self) -> Option<(Prepared, FrameResult, Option<Settled>)> {
        self.waiting.pop_front().map(|Waiting { prepared, result, found }| (prepared, result, found))
    }

    fn keep(&mut self, settled: Settled) {
        self.before.push(settled);
        self.before.drain(..self.before.len().saturating_sub(self.reach));
    }
}
