//! A run in work: its frames searched one after the other, what is learnt from each, and the results at its end.

mod again;
mod delayed;
mod dissent;
mod finish;
mod look_back;

pub(super) use self::again::{REFINED_BODY, why_not_again};

use std::time::{Duration, Instant};

use anyhow::{Context, Result, anyhow};

use super::appearance::RunAppearance;
use super::confidence::{Confidence, FrameConfidence, JointProbe, LossRule, terms_alone};
use super::feed::{Frames, Prepared};
use super::hindsight::{Delayed, LimbSearch, SearchedFrame, TimeLeft};
use super::journal::{FrameResult, Journal};
use super::motion::LearntMotion;
use super::overlay::Overlay;
use super::pace::{Pace, Turn};
use super::plan::Plan;
use super::progress::{FrameDone, Progress, RunStart};
use super::recovery::{LostFrame, Recovery};
use super::searcher::{Searched, Start};
use super::timings::{Span, Thread, Timings};
use super::truth::Truth;
use super::{Passes, Prediction, TrackSettings, Width};
use crate::evaluate::{Evaluator, Objective};
use crate::features::SeenView;
use crate::files::{Occupied, OutputFolder};
use crate::gpu::DeviceLost;
use crate::search::Estimate;
use crate::sequence::Sequence;

/// A run in work.
pub(super) struct Run<'a> {
    sequence: &'a Sequence,
    settings: &'a TrackSettings,
    output: &'a OutputFolder,
    /// Keeps other runs out of the folder.
    _occupied: Occupied,
    pub(super) plan: Plan,
    truth: Option<Truth>,
    journal: Journal,
    /// The frames done that the pace keeps in memory.
    pub(super) frames: Vec<FrameResult>,
    /// How many are done.
    done: usize,
    timings: Timings,
    confidence: Confidence,
    /// What asks a frame about its joints.
    probe: JointProbe,
    /// The search for a lost person, where one is asked for.
    recovery: Option<Recovery>,
    /// What looks for limbs that were lost, where the search is one that does.
    limbs: Option<LimbSearch>,
    pace: Box<dyn Pace>,
    /// The person's colours, where poses are compared by evidence.
    appearance: Option<RunAppearance>,
    /// The frames that are lost.
    lost: Vec<usize>,
    /// Whether it was asked to stop before its work was done.
    is_cut: bool,
    /// How the person moves, where a search starts by that.
    motion: LearntMotion,
    /// The frames that wait for those after them, where there is a delay.
    delayed: Option<Delayed>,
}

impl<'a> Run<'a> {
    /// Before its first frame.
    ///
    /// # Errors
    /// When the body has no search space.
    pub(super) fn new(
        sequence: &'a Sequence,
        settings: &'a TrackSettings,
        output: &'a OutputFolder,
        occupied: Occupied,
        plan: Plan,
        truth: Option<Truth>,
        journal: Journal,
        timings: Timings,
        pace: Box<dyn Pace>,
    ) -> Result<Self> {
        let (body, cameras) = (&plan.body, &sequence.cameras);
        let recovery = settings.may_recover().then(|| Recovery::new(body, cameras, &settings.search, &plan.space));
        let looks = settings.may_look_for_limbs();
        let limbs = looks.then(|| LimbSearch::new(body, cameras, &plan.space, sequence.fps)).transpose()?;
        let appearance = plan.features.likelihoods.then(|| RunAppearance::new(body, cameras));
        let motion =
            LearntMotion::new(plan.space.spread(1.0 / sequence.fps)?, settings.prediction() == Prediction::Learnt);
        let delay = settings.realtime.as_ref().map_or(0, |realtime| realtime.delay);
        let delayed = (delay > 0).then(|| Delayed::new(body, sequence.fps, delay));
        Ok(Self {
            confidence: Confidence::new(body, LossRule::default()),
            probe: JointProbe::new(body, cameras),
            recovery,
            limbs,
            appearance,
            motion,
            delayed,
            sequence,
            settings,
            output,
            _occupied: occupied,
            plan,
            truth,
            journal,
            frames: Vec::new(),
            done: 0,
            timings,
            pace,
            lost: Vec::new(),
            is_cut: false,
        })
    }

    /// How many frames are done.
    pub(super) fn done(&self) -> usize {
        self.done
    }

    /// Whether a run that ends before its last frame is a whole one.
    pub(super) fn ends_anywhere(&self) -> bool {
        self.pace.ends_anywhere()
    }

    /// How it begins, after so many frames that an earlier run did.
    pub(super) fn start(&self, done: usize, warnings: &[String]) -> RunStart {
        RunStart {
            first_frame: self.plan.range.start,
            frames: (!self.sequence.is_live()).then_some(self.plan.range.len()),
            done,
            backend: self.plan.backend.reason.clone(),
            outlets: self.pace.outlets(),
            warnings: warnings.to_vec(),
        }
    }

    /// Frames that an earlier run did.
    pub(super) fn take_over(&mut self, done: Vec<FrameResult>) -> Result<()> {
        let name = self.journal_name();
        for result in done {
            let values: Vec<f64> = result.pose.iter().map(|value| f64::from(*value)).collect();
            self.plan.body.check_limits(&values).with_context(|| format!("{name}, frame {}", result.frame))?;
            let confidence = self.judge(&result);
            self.running_error(&result, &confidence);
            self.keep(result);
        }
        Ok(())
    }

    /// Takes note of a frame that is searched: how sure it is.
    fn judge(&mut self, result: &FrameResult) -> FrameConfidence {
        let confidence = self.confidence.next(result);
        if confidence.is_lost {
            self.lost.push(result.frame);
        }
        let follows = self.motion.last_frame().is_some_and(|before| self.pace.follows(before, result.frame));
        self.motion.note(result, follows && !confidence.is_lost);
        if let Some(recovery) = &mut self.recovery {
            recovery.note(&result.pose, confidence.is_lost);
        }
        confidence
    }

    fn journal_name(&self) -> String {
        self.output.path().join(Journal::NAME).display().to_string()
    }

    pub(super) fn next_frame(&self) -> usize {
        self.frames.last().map_or(self.plan.range.start, |last| last.frame + 1)
    }

    fn keep(&mut self, result: FrameResult) {
        self.pace.keep(&mut self.frames, result);
        self.done += 1;
    }

    /// [`Self::error_up_to`] a frame; none where it is lost and so left out of the results.
    fn running_error(&mut self, result: &FrameResult, confidence: &FrameConfidence) -> Option<f64> {
        let is_gap = confidence.is_lost && self.recovery.is_some();
        if is_gap { None } else { self.error_up_to(result) }
    }

    /// Mean error against the truth up to and with this frame, mm.
    fn error_up_to(&mut self, result: &FrameResult) -> Option<f64> {
        let frame = self.pace.in_sequence(result.frame);
        self.truth.as_mut()?.running_error(&self.plan.body, frame, &result.pose, self.sequence.fps)
    }

    /// Searches the frames that are left, until the last or until asked to stop.
    pub(super) fn search_all(&mut self, progress: &mut dyn Progress) -> Result<()> {
        // The person's colours are learnt again from the frames that an earlier run did.
        let next = self.next_frame();
        let learns_again = self.appearance.is_some() && self.settings.realtime.is_none();
        let looks_back = self.settings.passes() == Passes::Both;
        if next >= self.plan.range.end && !(looks_back && learns_again) {
            return Ok(());
        }
        let from = if learns_again { self.plan.range.start } else { next };
        let mut feed = self.pace.feed(self.sequence, &self.plan, from, &self.plan.keeps())?;
        let searched = self.search_each(feed.as_mut(), next, progress);
        // What waits for frames that do not come goes out with what there is.
        let given = self.give_out_all();
        searched.and(given)
    }

    fn search_each(&mut self, feed: &mut dyn Frames, next: usize, progress: &mut dyn Progress) -> Result<()> {
        loop {
            let start = Instant::now();
            let prepared = feed.next().map_err(|error| self.how_to_go_on(self.next_frame(), error))?;
            let Some(mut prepared) = prepared else { return Ok(()) };
            let waited = Span::since(start);
            let frame = prepared.index;
            self.observe(&mut prepared)?;
            if frame < next {
                let result = self.frames.get(frame - self.plan.range.start).cloned();
                result.map_or(Ok(()), |result| self.learn_again(&prepared, &result))?;
                continue;
            }
            self.note_features(&prepared, waited)?;
            let result = self.search(&prepared)?;
            let done = if self.delayed.is_some() {
                self.delay(prepared, result)?
            } else {
                self.finish_frame(&prepared, result)?
            };
            self.pace.take_news().iter().for_each(|news| progress.tell(news));
            progress.frame(&done);
            if progress.should_stop() {
                self.is_cut = frame + 1 < self.plan.range.end;
                return Ok(());
            }
        }
    }

    /// Takes note of how long a frame's features took.
    pub(super) fn note_features(&mut self, prepared: &Prepared, waited: Span) -> Result<()> {
        let frame = prepared.index;
        self.timings.record("read", Thread::Features, frame, prepared.read)?;
        self.timings.record("features", Thread::Features, frame, prepared.features)?;
        if let Some(held) = &prepared.held {
            self.timings.record_passes(Thread::Features, frame, held.passes())?;
        }
        self.timings.record("wait", Thread::Search, frame, waited)
    }

    /// Gives a frame's observations the evidence of the person's colours, where poses are compared by evidence.
    pub(super) fn observe(&mut self, prepared: &mut Prepared) -> Result<()> {
        let Some(appearance) = &self.appearance else { return Ok(()) };
        let start = Instant::now();
        appearance.observe(prepared)?;
        if prepared.index < self.next_frame() {
            // Of a frame that an earlier run did.
            return Ok(());
        }
        self.timings.record("evidence", Thread::Search, prepared.index, Span::since(start))
    }

    /// Keeps a frame's result, gives it out and learns from it.
    pub(super) fn finish_frame(&mut self, prepared: &Prepared, result: FrameResult) -> Result<FrameDone> {
        let start = Instant::now();
        self.give_out(prepared, &result)?;
        self.timings.record("output", Thread::Search, prepared.index, Span::since(start))?;
        let confidence = self.judge(&result);
        let mean_error = self.running_error(&result, &confidence);
        self.learn(prepared, &result)?;
        Ok(self.done_with(result, &confidence, mean_error))
    }

    /// Writes what a frame came to, for those who wait for it.
    fn give_out(&mut self, prepared: &Prepared, result: &FrameResult) -> Result<()> {
        let frame = prepared.index;
        // The second pass draws its own.
        let is_last = self.settings.passes() == Passes::Forward;
        if is_last && self.settings.overlay_every > 0 && frame.is_multiple_of(self.settings.overlay_every) {
            let overlay = Overlay::new(&self.plan.body, self.plan.mesh.as_ref(), &self.sequence.cameras)?;
            overlay.write(self.output, frame, &prepared.pictures, &result.pose)?;
        }
        self.journal.append(result)?;
        self.pace.deliver(&self.plan.body, result, prepared)
    }

    /// Keeps a frame's result for the frames after it.
    fn done_with(&mut self, result: FrameResult, confidence: &FrameConfidence, mean_error: Option<f64>) -> FrameDone {
        let (frame, fitness, confidence) = (result.frame, result.fitness, confidence.confidence);
        self.keep(result);
        self.pace.judge(fitness, confidence);
        FrameDone { frame, done: frame + 1 - self.plan.range.start, fitness, confidence, mean_error }
    }

    /// Learns the person's colours from a frame, unless she is lost in it.
    pub(super) fn learn(&mut self, prepared: &Prepared, result: &FrameResult) -> Result<()> {
        match &mut self.appearance {
            Some(appearance) if !self.lost.contains(&result.frame) => {
                appearance.learn(result.frame.saturating_sub(self.plan.range.start), prepared, &result.pose)
            }
            _ => Ok(()),
        }
    }

    /// [`Self::learn`] from a frame that an earlier run searched: what a device holds becomes evidence when something is compared with it.
    fn learn_again(&mut self, prepared: &Prepared, result: &FrameResult) -> Result<()> {
        let since = result.frame.saturating_sub(self.plan.range.start);
        if prepared.held.is_some() && self.appearance.is_some() && RunAppearance::is_lesson(since) {
            let evaluator = self.plan.backend.evaluator.as_mut();
            evaluator.observe_seen(prepared.seen())?;
            evaluator.view_counts(&result.pose, &self.plan.objective)?;
        }
        self.learn(prepared, result)
    }

    /// What became of a frame whose device was lost, and what the user can do; other errors stay as they are.
    fn how_to_go_on(&self, frame: usize, error: anyhow::Error) -> anyhow::Error {
        let Some(lost) = error.downcast_ref::<DeviceLost>() else { return error };
        anyhow!(
            "frame {frame}: {lost}; the {} frames before it are safe in {}: run the same command with --resume to go on, or \
             begin another folder with --backend cpu, which needs no device",
            self.done,
            self.output.path().display()
        )
    }

    /// Where a frame's search starts.
    fn predicted(&self, turn: &Turn) -> Vec<f32> {
        let Plan { start, space, .. } = &self.plan;
        match &*self.frames {
            _ if turn.starts_anew => start.clone(),
            [] => start.clone(),
            [.., last] if self.settings.prediction() == Prediction::Learnt => {
                let mut pose = self.motion.start(&last.pose, turn.widen);
                space.clamp(&mut pose);
                pose
            }
            [only] => only.pose.clone(),
            [.., earlier, last] => self.settings.prediction().start(space, &last.pose, Some(&earlier.pose)),
        }
    }

    /// Where a frame shows her as far as is known before it is searched; none while she is lost.
    pub(super) fn expected(&self, prepared: &Prepared) -> Option<Vec<f32>> {
        let before = self.frames.last().map(|result| result.frame);
        let is_lost = self.lost.last().is_some_and(|lost| Some(*lost) == before);
        let turn = self.pace.turn(prepared, before, self.sequence.fps);
        (!is_lost).then(|| self.predicted(&turn))
    }

    /// Where a result shows her; nowhere where it is a loss.
    pub(super) fn shown(&self, result: &FrameResult) -> Option<Vec<f32>> {
        let is_done = result.frame < self.next_frame();
        let is_lost = if is_done { self.lost.contains(&result.frame) } else { self.confidence.is_loss_at(result) };
        (!is_lost).then(|| result.pose.clone())
    }

    /// Forgets all but the first `count` of the frames that an earlier run did.
    pub(super) fn go_back_to(&mut self, done: &mut Vec<FrameResult>, count: usize) -> Result<()> {
        if done.len() > count {
            done.truncate(count);
            self.journal = Journal::create(&self.output.path().join(Journal::NAME))?;
            done.iter().try_for_each(|result| self.journal.append(result))?;
        }
        Ok(())
    }

    /// One frame: its search round the frame before, and the terms of the result in every view.
    pub(super) fn search(&mut self, prepared: &Prepared) -> Result<FrameResult> {
        self.search_frame(prepared).map_err(|error| self.how_to_go_on(prepared.index, error))
    }

    fn search_frame(&mut self, prepared: &Prepared) -> Result<FrameResult> {
        let frame = prepared.index;
        let begin = Instant::now();
        let before = self.frames.last().map(|result| result.frame);
        let turn = self.pace.turn(prepared, before, self.sequence.fps);
        let mut spread = self.plan.spread(turn.starts_anew)?;
        spread.iter_mut().for_each(|deviation| *deviation *= turn.widen);
        // Whoever is lost is searched for by the body's steps.
        let steps = spread.clone();
        if self.settings.width() == Width::Learnt && !turn.starts_anew {
            spread.iter_mut().zip(self.motion.widths()).for_each(|(deviation, width)| *deviation *= width);
        }
        let [particles, iterations] = turn.size;
        self.plan.resize(particles, iterations)?;
        let predicted = self.predicted(&turn);
        let settings = *self.plan.search_settings();
        let Plan { objective, backend, search, space, .. } = &mut self.plan;
        let evaluator = backend.evaluator.as_mut();
        let counter =
            u32::try_from(frame).map_err(|_| anyhow!("frame {frame} is beyond the counters of the search"))?;
        let start = Start { frame: counter, centre: &predicted, spread: &spread, until: turn.until };
        let seen = prepared.seen();
        let views = seen.views();
        let in_frame = || format!("frame {frame}");
        let mut searched = search.search(evaluator, objective, seen, start).with_context(in_frame)?;
        if let Some(limbs) = &self.limbs {
            let begin_looking = Instant::now();
            let frame = SearchedFrame {
                evaluator: &mut *evaluator,
                objective,
                settings: &settings,
                space,
                views: &views,
                index: frame,
                time: turn.until.map(|until| TimeLeft { until, took: begin.elapsed() }),
            };
            limbs.improve(frame, &mut searched).with_context(in_frame)?;
            searched.passes.extend(evaluator.device_passes());
            searched.evaluations.push(Span::since(begin_looking));
        }
        let probe = &self.probe;
        let result = |evaluator: &mut dyn Evaluator, searched: &Searched| -> Result<FrameResult> {
            let mut found = found_in(frame, searched, &views, (evaluator, objective, probe))?;
            prepared.silent.iter().for_each(|&view| found.views[view] = FrameResult::LEFT_OUT);
            Ok(found)
        };
        let mut found = result(evaluator, &searched).with_context(in_frame)?;
        searched.passes.extend(evaluator.device_passes());
        if let Some(recovery) =
            self.recovery.as_ref().filter(|recovery| recovery.is_lost() || self.confidence.is_loss_at(&found))
        {
            let begin = Instant::now();
            let is_sure = |evaluator: &mut dyn Evaluator, searched: &Searched| -> Result<bool> {
                Ok(!self.confidence.is_loss_at(&result(evaluator, searched)?))
            };
            let is_there = |searched: &Searched| self.confidence.is_there(&terms_alone(objective, &searched.views));
            let lost =
                LostFrame { evaluator: &mut *evaluator, objective, views: &views, number: counter, spread: &steps };
            recovery.search(lost, &mut searched, &is_sure, &is_there).with_context(in_frame)?;
            searched.evaluations.push(Span::since(begin));
            found = result(evaluator, &searched).with_context(in_frame)?;
            searched.passes.extend(evaluator.device_passes());
        }
        let Searched { estimate, evaluations, passes, .. } = searched;

        let whole = Span::since(begin);
        self.pace.searched(frame, estimate.evaluations, whole);
        self.timings.trace("frame", Thread::Search, frame, whole)?;
        for evaluation in &evaluations {
            self.timings.trace("evaluate", Thread::Search, frame, *evaluation)?;
        }
        let evaluating: Duration = evaluations.iter().map(|evaluation| evaluation.time).sum();
        self.timings.count("evaluate", evaluating);
        self.timings.record_passes(Thread::Search, frame, &passes)?;
        self.timings.count("search", whole.time.saturating_sub(evaluating));
        Ok(found)
    }
}

/// What a search found in a frame, of which the views show this.
fn found_in(
    frame: usize,
    searched: &Searched,
    views: &[SeenView<'_>],
    (evaluator, objective, probe): (&mut dyn Evaluator, &Objective, &JointProbe),
) -> Result<FrameResult> {
    let Estimate { pose, fitness, spread, .. } = &searched.estimate;
    Ok(FrameResult {
        frame,
        fitness: *fitness,
        spread: spread.clone(),
        views: terms_alone(objective, &searched.views),
        joints: probe.ask(evaluator, objective, views, pose)?,
        pose: pose.clone(),
    })
}
