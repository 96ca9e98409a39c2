//! The second pass of a run that has time: every frame again, with what came before and after it known (METHOD A14). Tracks backwards
//! and forwards make several poses a frame, the path through them that is worth most is taken, and then every frame is searched again
//! close to where its neighbours expect it.

mod ambiguity;
mod bolder;
mod delayed;
mod hypotheses;
mod limb_search;
mod mending;
mod path;
mod refining;
mod scorer;
mod section;
mod shape;
mod team;
mod tracks;
#[cfg(test)]
mod tracks_tests;
mod watch;
mod window;

use anyhow::{Context, Result};
use image::RgbImage;

pub(super) use self::delayed::Delayed;
pub(super) use self::limb_search::{LimbSearch, SearchedFrame, TimeLeft};
use self::mending::Mending;
use self::refining::Settled;
use self::scorer::Scorer;
use self::section::{SECTION, pieces};
use self::shape::Shape;
use self::team::{Team, side_by_side};
use self::watch::{Stopped, Watch};
use self::window::{Seen, Windows};
use super::appearance::RunAppearance;
use super::confidence::{JointProbe, terms_alone};
use super::feed::Frames;
use super::journal::FrameResult;
use super::plan::Plan;
use super::progress::Progress;
use crate::evaluate::{Evaluator, Objective};
use crate::features::{Observation, SeenView};
use crate::geometry::Camera;

/// Parts of a frame's work: tracks go both ways.
const WORK: usize = 2 * tracks::SHARE + refining::ROUNDS * refining::SHARE;

/// What the second pass works on.
pub(super) struct Hindsight<'a> {
    pub(super) plan: &'a mut Plan,
    /// What asks a frame about its joints.
    pub(super) probe: &'a JointProbe,
    /// At working size.
    pub(super) cameras: &'a [Camera],
    pub(super) fps: f64,
    /// Every how many frames the pictures are handed on with the result; 0 for never.
    pub(super) pictures_every: usize,
}

/// Takes a frame's result and its pictures, where they were asked for.
pub(super) type Taker<'a> = dyn FnMut(FrameResult, Option<&[RgbImage]>) -> Result<()> + 'a;

impl Hindsight<'_> {
    /// Hands on the results of all frames of a run again, in order, from what is known of it: the person's colours, and the results of its first
    /// pass; views that those leave out stay out. `feed` begins with the first frame. Ends early where `progress` says so.
    ///
    /// # Errors
    /// When a frame cannot be read, the evaluator fails, or `take` does.
    pub(super) fn look_back(
        self,
        feed: &mut dyn Frames,
        (appearance, forward): (Option<&RunAppearance>, &[FrameResult]),
        progress: &mut dyn Progress,
        take: &mut Taker<'_>,
    ) -> Result<()> {
        let watch = Watch::of(progress);
        let worked = |share: usize| watch.work(share);
        let settings = *self.plan.search_settings();
        let Plan { body, mesh, objective, backend, space, .. } = self.plan;
        let shape = Shape::new(body);
        std::thread::scope(|scope| {
            let mut windows = Windows::begin(scope, feed, (appearance, forward), self.cameras, self.pictures_every)?;
            windows.fill()?;
            let run = backend.evaluator.as_mut();
            let pieces = pieces(windows.seen().len(), SECTION);
            let all = rayon::current_num_threads();
            let mut others = side_by_side(run, body, mesh.as_ref(), self.cameras, [pieces, all])?;
            let scorer = |evaluator| Scorer::new(evaluator, objective, space, &shape, &settings).watched_by(&worked);
            let team = if others.is_empty() {
                Team::of([scorer(run)].into_iter(), all)?
            } else {
                Team::of(others.iter_mut().map(|cpu| scorer(cpu)), all)?
            };
            let mut mending = Mending::new(team, space, body, self.cameras, self.fps)?;
            // Poses of the window before that are not settled yet, and the last that are.
            let mut carried: Vec<Vec<f32>> = Vec::new();
            let mut before: Vec<Settled> = Vec::new();
            let mut done = 0;
            loop {
                windows.fill()?;
                let seen: Vec<&Seen> = windows.seen().iter().collect();
                let Some(first) = seen.first() else { return Ok(()) };
                let mut track = std::mem::take(&mut carried);
                let given = forward.iter().skip(done + track.len()).map(|result| result.pose.clone());
                track.extend(given.take(seen.len().saturating_sub(track.len())));
                let count = windows.settled();
                watch.begin(WORK * seen.len(), count);
                let (settled, ambiguities) = match mending.mend(&seen, &track, &before) {
                    Err(error) if error.is::<Stopped>() => return Ok(()),
                    settled => settled.with_context(|| format!("the frames from {} on", first.index))?,
                };
                let frames = seen.iter().zip(&settled).zip(ambiguities).zip(&forward[done..]).take(count);
                let results = mending.team.share(frames, |scorer, (((seen, frame), ambiguities), first)| {
                    let mut result = result(scorer.evaluator, objective, self.probe, &seen.observations, frame, first)?;
                    let joints = result.joints.iter_mut().zip(ambiguities);
                    joints.for_each(|(hints, ambiguity)| hints.ambiguity = Some(ambiguity));
                    Ok(result)
                })?;
                for (seen, result) in seen.iter().zip(results) {
                    take(result, seen.pictures.as_deref())?;
                    if !watch.frame() {
                        return Ok(());
                    }
                }
                carried = settled[count..].iter().map(|frame| frame.pose.clone()).collect();
                before.extend(settled.into_iter().take(count));
                before.drain(..before.len().saturating_sub(mending.reach));
                windows.forget(count);
                done += count;
            }
        })
    }
}

/// The result of a frame that was searched again, from that of its first search.
fn result(
    evaluator: &mut dyn Evaluator,
    objective: &Objective,
    probe: &JointProbe,
    observations: &[Observation],
    settled: &Settled,
    first: &FrameResult,
) -> Result<FrameResult> {
    evaluator.observe(observations)?;
    let mut fitness = [0.0];
    evaluator.fitness(&settled.pose, objective, &mut fitness)?;
    let mut views = terms_alone(objective, &evaluator.view_counts(&settled.pose, objective)?);
    first.left_out().for_each(|view| views[view] = FrameResult::LEFT_OUT);
    Ok(FrameResult {
        frame: settled.frame,
        fitness: fitness[0],
        views,
        joints: probe.ask(evaluator, objective, &SeenView::all(observations), &settled.pose)?,
        pose: settled.pose.clone(),
        // Searches from neighbours on are narrow whatever the pictures say: how sure they are the first one tells.
        spread: first.spread.clone(),
    })
}

#[cfg(test)]
mod tests;
