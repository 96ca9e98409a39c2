//! The body measured again between the passes: in the poses of the first, for the second.

use std::time::Instant;

use anyhow::{Context, Result};

use super::Run;
use crate::body::Body;
use crate::features::SeenView;
use crate::sequence::Sequence;
use crate::track::confidence::JointProbe;
use crate::track::fit::{Following, LeaveOut, TrackedPoses, measure_again};
use crate::track::plan::Plan;
use crate::track::progress::Progress;

/// The body of the results, where it is not the one that was given.
pub(in crate::track) const REFINED_BODY: &str = "refined_body.toml";
/// Frames that are looked at, half of them to judge.
const FRAMES: usize = 20;
/// Fewer tell nothing.
const FEWEST: usize = 12;
/// They are among so many first frames: those between are read too.
const AMONG: usize = 1000;

/// Why the person of a run cannot be measured again, where that is so: whole silhouettes before known backgrounds are measured by.
pub(in crate::track) fn why_not_again(sequence: &Sequence, plan: &Plan) -> Option<String> {
    if !plan.features.segment.is_empty() {
        let name = sequence.path.display();
        return Some(format!("{name} has [[features.segment]], and a person is measured again by whole silhouettes"));
    }
    let unknown = sequence.unknown_background()?;
    Some(format!("{unknown}, and a person is measured again with one of them"))
}

impl Run<'_> {
    /// Measures the person again in the poses of the first pass, and goes on with that body where frames that it was not measured in say that
    /// it fits better. `others` says what shows somebody else, by the number of the frame in the run, where that is known. A sentence of what
    /// came of it, where that was asked for.
    ///
    /// # Errors
    /// When frames cannot be read, or the body cannot be written.
    pub(in crate::track) fn measure_again(
        &mut self,
        others: Option<&mut LeaveOut<'_>>,
        progress: &mut dyn Progress,
    ) -> Result<Option<String>> {
        if !self.settings.measures_again(self.sequence) || !self.looks_back() {
            return Ok(None);
        }
        let (plan, sequence) = (&self.plan, self.sequence);
        if let Some(why) = why_not_again(sequence, plan) {
            return Ok(Some(format!("the person was not measured again: {why}")));
        }
        let frames = self.telling();
        if frames.len() < FEWEST {
            return Ok(Some(format!(
                "the person was not measured again: the first pass tells of the body in {} of its frames, expected {FEWEST} or more",
                frames.len()
            )));
        }
        let start = Instant::now();
        let mut others = others.map(|others| |at: usize, views: &[SeenView<'_>]| others(frames[at], views));
        let tracked = TrackedPoses {
            sequence,
            body: &plan.body,
            objective: plan.objective,
            poses: frames.iter().map(|at| self.frames[*at].pose.clone()).collect(),
            frames: frames.iter().map(|at| self.frames[*at].frame).collect(),
            seed: self.settings.search.seed,
            others: others.as_mut().map(|others| others as &mut LeaveOut<'_>),
        };
        let found = measure_again(tracked, &mut |what, done, total| progress.preparing(what, done, total))
            .context("measuring the person again")?;
        self.count_over_frames("measure", start);
        let Some(found) = found else {
            return Ok(Some("the person was not measured again: the body lacks joints of the default one".to_string()));
        };
        if !found.is_believed() {
            return Ok(Some(format!(
                "the person was measured again, and the body stays as it was given: with what was found other frames fit better by \
                 {:.4} +- {:.4}, too little to go by",
                found.gain[0], found.gain[1]
            )));
        }
        self.go_on_with(found.body)?;
        Ok(Some(format!(
            "the person was measured again in {} frames of the first pass, and {} others fit better by {:.3} with that body: the results are \
             of {REFINED_BODY} beside them",
            frames.len().div_ceil(2),
            frames.len() / 2,
            found.gain[0]
        )))
    }

    /// Frames that tell of the body: evenly spread over those that are not lost, without the quarter that fits worst; where enough are left,
    /// without those in which a view is left out.
    fn telling(&self) -> Vec<usize> {
        let first = &self.frames[..self.frames.len().min(AMONG)];
        let mut fitness: Vec<f32> = first.iter().map(|result| result.fitness).collect();
        fitness.sort_by(f32::total_cmp);
        let Some(least) = fitness.get(fitness.len() / 4).copied() else { return Vec::new() };
        let mut good: Vec<usize> = (0..first.len())
            .filter(|&at| first[at].fitness >= least && !self.lost.contains(&first[at].frame))
            .collect();
        let agreed: Vec<usize> = good.iter().copied().filter(|&at| first[at].left_out().next().is_none()).collect();
        if agreed.len() >= FEWEST {
            good = agreed;
        }
        let count = good.len().min(FRAMES);
        (0..count).map(|i| good[i * (good.len() - 1) / (count - 1).max(1)]).collect()
    }

    /// Exchanges the body; what was found is drawn where it was.
    fn go_on_with(&mut self, body: Body) -> Result<()> {
        let steps = self.plan.space.spread(1.0 / 25.0)?;
        for result in &mut self.frames {
            result.pose = Following::new(&self.plan.body, &result.pose, &steps)?.with(&body)?;
        }
        self.plan.backend.evaluator.set_body(&body)?;
        self.probe = JointProbe::new(&body, &self.sequence.cameras);
        let text = format!(
            "# {} as measured again by `pantin track`: the body of the results beside it.\n\n{}",
            body.name,
            body.to_toml()
        );
        self.output.write(REFINED_BODY, |writer| Ok(writer.write_all(text.as_bytes())?))?;
        self.plan.body = body;
        Ok(())
    }
}
