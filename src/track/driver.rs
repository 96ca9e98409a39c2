//! The driver: offline every frame of a range in order, however long it takes; in real time those that can be done in time.

use std::time::{Duration, Instant};

use anyhow::{Context, Result, anyhow};
use serde_json::json;

use super::confidence::{Confidence, LossRule, seen_joints};
use super::feed::{Feed, Frames, Prepared};
use super::journal::{Extent, FrameResult, Journal, Numbering};
use super::overlay::Overlay;
use super::page::write_report;
use super::plan::Plan;
use super::realtime::{Realtime, RealtimeSummary};
use super::recovery::{LostFrame, Recovery};
use super::results::Held;
use super::run_record::RunRecord;
use super::searcher::{Searched, Start};
use super::stages::{Span, Stages, Thread};
use super::truth::Truth;
use super::{Backend, StageSummary, TrackSettings, results, run_record};
use crate::evaluate::Components;
use crate::files::OutputFolder;
use crate::gpu::DeviceLost;
use crate::motion::TrajectoryError;
use crate::sequence::Sequence;

/// What a run tells whoever waits for it.
pub trait Progress {
    /// The run begins.
    fn start(&mut self, _run: &RunStart) {}

    /// A frame is done and safe.
    fn frame(&mut self, _frame: &FrameDone) {}

    /// Whether to stop after the frame in work.
    fn should_stop(&self) -> bool {
        false
    }
}

/// Nobody waits.
#[derive(Clone, Copy, Debug, Default)]
pub struct Silent;

impl Progress for Silent {}

/// How a run begins.
#[derive(Clone, Debug)]
pub struct RunStart {
    /// The first frame.
    pub first_frame: usize,
    /// Frames in all; none where a live source has no end.
    pub frames: Option<usize>,
    /// Frames that an earlier run did already.
    pub done: usize,
    /// Which evaluator, and why.
    pub backend: String,
    /// Sentences the user should read.
    pub warnings: Vec<String>,
}

/// A frame that was tracked.
#[derive(Clone, Debug)]
pub struct FrameDone {
    /// Its index.
    pub frame: usize,
    /// Frames done, those of an earlier run and those that real time left out included.
    pub done: usize,
    /// The fitness of its pose.
    pub fitness: f32,
    /// Its confidence, in [0, 1].
    pub confidence: f64,
    /// Mean error against the truth so far, mm.
    pub mean_error: Option<f64>,
}

/// The error of a whole track.
#[derive(Clone, Debug, PartialEq)]
pub struct ErrorSummary {
    /// `markers` or `joints`.
    pub compared: &'static str,
    /// Mean over frames, then over points, mm; and everything by point and frame.
    pub error: TrajectoryError,
}

/// What a run yielded.
#[derive(Clone, Debug)]
pub struct TrackSummary {
    /// The first frame.
    pub first_frame: usize,
    /// Every frame that was tracked, in order; none after a run in real time that was too long to be kept.
    pub frames: Vec<FrameResult>,
    /// Frames of them that this run did itself, not an earlier one it went on from.
    pub new_frames: usize,
    /// Frames a second of this run.
    pub frames_per_second: f64,
    /// Mean fitness.
    pub mean_fitness: f64,
    /// Mean confidence.
    pub mean_confidence: f64,
    /// The error, where there is a truth to compare with.
    pub error: Option<ErrorSummary>,
    /// Where the time went.
    pub stages: Vec<StageSummary>,
    /// The evaluator's name and variant.
    pub backend: [&'static str; 2],
    /// Sentences the user should read.
    pub warnings: Vec<String>,
    /// The next frame, when the run was asked to stop before its end; the folder then holds the journal alone.
    pub stopped_before: Option<usize>,
    /// How a run in real time kept time.
    pub realtime: Option<RealtimeSummary>,
}

/// Tracks a sequence and fills `output` with what INTERFACES calls a track's folder.
///
/// While it runs, the folder holds `run.toml` and a journal with every finished frame; the results appear when the last
/// frame is done. With [`TrackSettings::resume`] it goes on from the journal and ends with the same bytes as a run that was
/// never stopped. Without, what an earlier run left in `output` is removed.
///
/// The result files depend on the sequence, the settings and the seed alone, never on the number of threads.
///
/// In real time ([`TrackSettings::realtime`]) frames are left out and searched as time allows, so no two runs are the same.
/// poses.csv and joints.csv grow with every pose, realtime.json and timeline.svg tell of the times, and there is no page. A
/// run that is asked to stop, or whose source fails, keeps what it has: all files are written.
///
/// # Errors
/// Anything wrong with an input, named, before a file is written; a run that cannot be resumed; a picture that cannot be
/// read; a folder that cannot be written (the frames before are safe).
pub fn track(
    sequence: &Sequence,
    settings: &TrackSettings,
    output: &OutputFolder,
    progress: &mut dyn Progress,
) -> Result<TrackSummary> {
    // What auto once chose is kept to: another machine, or a moment of noise, must not change a run midway.
    let recorded = match settings.backend {
        Backend::Auto if settings.resume => run_record::recorded_backend(output)?,
        _ => None,
    };
    let mut plan = Plan::new(sequence, settings, recorded.unwrap_or(settings.backend))?;
    if let Some(backend) = recorded {
        plan.backend.reason = format!("{}, which this run began with", backend.name());
    }
    let mut warnings = Vec::new();
    let truth = match &sequence.truth {
        Some(path) => Truth::read(path, &plan.body, sequence.fps)?.map_err(|why| warnings.push(why)).ok(),
        None => None,
    };
    let record = RunRecord::new(sequence, settings, &plan)?;
    let journal_path = output.path().join(Journal::NAME);
    let (journal, done) = if settings.resume {
        record.check_same(output)?;
        let (dofs, views) = (plan.body.dof_count(), sequence.cameras.len());
        let extent = Extent { dofs, views, joints: plan.body.joint_names().len() };
        let numbering =
            if settings.realtime.is_some() { Numbering::Rising } else { Numbering::EachFrom(plan.range.start) };
        let (journal, done) = Journal::resume(&journal_path, numbering, extent)?;
        if settings.search.kind.carries_on() && !done.is_empty() && done.len() < plan.range.len() {
            warnings.push(
                "the particle filter carries its particles on, so the run begins at its first frame again".into(),
            );
            (Journal::create(&journal_path)?, Vec::new())
        } else {
            (journal, done)
        }
    } else {
        results::clear(output)?;
        record.write(output)?;
        (Journal::create(&journal_path)?, Vec::new())
    };
    warnings.extend(plan.search.note(plan.backend.evaluator.as_mut()));
    let stages = Stages::new(&output.file("trace.json")?)?;
    let realtime = match &settings.realtime {
        Some(realtime) => {
            Some(Realtime::new(sequence, settings, realtime, output, &plan.body, &mut plan.range, &done)?)
        }
        None => None,
    };
    progress.start(&RunStart {
        first_frame: plan.range.start,
        frames: (!sequence.is_live()).then_some(plan.range.len()),
        done: done.len(),
        backend: plan.backend.reason.clone(),
        warnings: warnings.clone(),
    });
    plan.backend.evaluator.measure_passes(settings.trace)?;
    let confidence = Confidence::new(&plan.body, LossRule::default());
    let recovery = Recovery::new(&plan.body, &sequence.cameras, &settings.search, &plan.space);
    // A wider search takes the time that real time has not.
    let recovery = (settings.recover && realtime.is_none()).then_some(recovery);
    let mut run = Run {
        sequence,
        settings,
        output,
        plan,
        truth,
        journal,
        frames: Vec::new(),
        done: 0,
        stages,
        confidence,
        recovery,
        realtime,
    };
    run.take_over(done)?;
    let searched = run.search_all(progress);
    if run.realtime.is_none() || run.done == 0 {
        searched?;
        return run.finish(&record, warnings);
    }
    // What a source delivered before it failed is as good as ever.
    let done = run.done;
    let finished = run.finish(&record, warnings);
    searched.map_err(|error| anyhow!("{error:#}; the {done} poses before it are in {}", output.path().display()))?;
    finished
}

/// A run in work.
struct Run<'a> {
    sequence: &'a Sequence,
    settings: &'a TrackSettings,
    output: &'a OutputFolder,
    plan: Plan,
    truth: Option<Truth>,
    journal: Journal,
    /// The frames done; in real time the last of them, so that memory does not grow.
    frames: Vec<FrameResult>,
    /// How many are done.
    done: usize,
    stages: Stages,
    confidence: Confidence,
    /// The search for a lost person, where one is asked for.
    recovery: Option<Recovery>,
    realtime: Option<Realtime>,
}

impl Run<'_> {
    /// Frames that an earlier run did.
    fn take_over(&mut self, done: Vec<FrameResult>) -> Result<()> {
        let name = self.journal_name();
        for result in done {
            let values: Vec<f64> = result.pose.iter().map(|value| f64::from(*value)).collect();
            self.plan.body.check_limits(&values).with_context(|| format!("{name}, frame {}", result.frame))?;
            self.judge(&result);
            self.keep(result);
        }
        Ok(())
    }

    /// Takes note of a frame that is done: its confidence, and the mean error so far.
    fn judge(&mut self, result: &FrameResult) -> (f64, Option<f64>) {
        let confidence = self.confidence.next(result);
        let mut is_gap = false;
        if let Some(recovery) = &mut self.recovery {
            recovery.note(&result.pose, confidence.is_lost);
            is_gap = confidence.is_lost;
        }
        let error = if is_gap { None } else { self.running_error(result) };
        (confidence.confidence, error)
    }

    fn journal_name(&self) -> String {
        self.output.path().join(Journal::NAME).display().to_string()
    }

    fn next_frame(&self) -> usize {
        self.frames.last().map_or(self.plan.range.start, |last| last.frame + 1)
    }

    fn keep(&mut self, result: FrameResult) {
        if self.realtime.is_some() {
            self.frames.clear();
        }
        self.frames.push(result);
        self.done += 1;
    }

    /// Mean error against the truth up to and with this frame, mm.
    fn running_error(&mut self, result: &FrameResult) -> Option<f64> {
        let frame = self.realtime.as_ref().map_or(result.frame, |realtime| realtime.in_sequence(result.frame));
        self.truth.as_mut()?.running_error(&self.plan.body, frame, &result.pose, self.sequence.fps)
    }

    /// Where the frames that are left come from.
    fn feed(&self) -> Result<Box<dyn Frames>> {
        let (sequence, next) = (self.sequence, self.next_frame());
        Ok(match &self.realtime {
            Some(realtime) => Box::new(realtime.feed(sequence, &self.plan, next)?),
            None => {
                let Plan { features, range, .. } = &self.plan;
                Box::new(Feed::start(sequence, features.clone(), range.clone(), next, self.settings.stall_timeout)?)
            }
        })
    }

    /// Searches the frames that are left, until the last or until asked to stop.
    fn search_all(&mut self, progress: &mut dyn Progress) -> Result<()> {
        if self.next_frame() >= self.plan.range.end {
            return Ok(());
        }
        let mut feed = self.feed()?;
        loop {
            let start = Instant::now();
            let Some(prepared) = feed.next()? else { break };
            let waited = Span::since(start);
            let frame = prepared.index;
            self.stages.record("read", Thread::Features, frame, prepared.read)?;
            self.stages.record("features", Thread::Features, frame, prepared.features)?;
            self.stages.record("wait", Thread::Search, frame, waited)?;
            let result = self.search(&prepared).map_err(|error| self.how_to_go_on(frame, error))?;
            let start = Instant::now();
            if self.settings.overlay_every > 0 && frame.is_multiple_of(self.settings.overlay_every) {
                let overlay = Overlay::new(&self.plan.body, self.plan.mesh.as_ref(), &self.sequence.cameras)?;
                overlay.write(self.output, frame, &prepared.pictures, &result.pose)?;
            }
            self.journal.append(&result)?;
            if let Some(realtime) = &mut self.realtime {
                realtime.deliver(&self.plan.body, &result, prepared.captured)?;
            }
            self.stages.record("output", Thread::Search, frame, Span::since(start))?;
            let (confidence, mean_error) = self.judge(&result);
            let fitness = result.fitness;
            self.keep(result);
            if let Some(realtime) = &mut self.realtime {
                realtime.judge(fitness, confidence);
            }
            let done = frame + 1 - self.plan.range.start;
            progress.frame(&FrameDone { frame, done, fitness, confidence, mean_error });
            if progress.should_stop() {
                break;
            }
        }
        Ok(())
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

    /// One frame: its search round the frame before, and the terms of the result in every view.
    fn search(&mut self, prepared: &Prepared) -> Result<FrameResult> {
        let frame = prepared.index;
        let begin = Instant::now();
        let before = self.frames.last().map(|result| result.frame);
        let turn = self.realtime.as_ref().map(|realtime| realtime.turn(prepared, before, self.sequence.fps));
        let starts_anew = turn.map_or(before.is_none(), |turn| turn.starts_anew);
        let mut spread = self.plan.spread(starts_anew)?;
        if let Some(turn) = turn {
            spread.iter_mut().for_each(|deviation| *deviation *= turn.widen);
            let [particles, iterations] = turn.size;
            self.plan.resize(particles, iterations)?;
        }
        let Plan { start, objective, backend, search, space, body, .. } = &mut self.plan;
        let predicted = match &*self.frames {
            _ if starts_anew => start.clone(),
            [] => start.clone(),
            [only] => only.pose.clone(),
            [.., earlier, last] => self.settings.predict.start(space, &last.pose, Some(&earlier.pose)),
        };
        let evaluator = backend.evaluator.as_mut();
        let counter =
            u32::try_from(frame).map_err(|_| anyhow!("frame {frame} is beyond the counters of the search"))?;
        let start =
            Start { frame: counter, centre: &predicted, spread: &spread, until: turn.and_then(|turn| turn.until) };
        let observations = &prepared.observations;
        let in_frame = || format!("frame {frame}");
        let mut searched = search.search(evaluator, objective, observations, start).with_context(in_frame)?;
        let cameras = &self.sequence.cameras;
        let result = |searched: &Searched| FrameResult {
            frame,
            pose: searched.estimate.pose.clone(),
            fitness: searched.estimate.fitness,
            spread: searched.estimate.spread.clone(),
            views: searched.components.iter().map(|view| objective.view_terms(view)).collect(),
            joints: seen_joints(body, cameras, observations, &searched.estimate.pose),
        };
        let mut found = result(&searched);
        if let Some(recovery) =
            self.recovery.as_ref().filter(|recovery| recovery.is_lost() || self.confidence.is_loss_at(&found))
        {
            let begin = Instant::now();
            let is_sure = |components: &[Components]| {
                let views = components.iter().map(|view| objective.view_terms(view)).collect();
                !self.confidence.is_loss_at(&FrameResult { views, ..found.clone() })
            };
            let lost = LostFrame { evaluator, objective, observations, number: counter, spread: &spread };
            recovery.search(lost, &mut searched, &is_sure).with_context(in_frame)?;
            searched.evaluations.push(Span::since(begin));
            found = result(&searched);
        }
        let Searched { estimate, evaluations, passes, .. } = searched;

        let whole = Span::since(begin);
        if let Some(realtime) = &mut self.realtime {
            realtime.searched(estimate.evaluations, whole);
        }
        self.stages.trace("frame", Thread::Search, frame, whole)?;
        for evaluation in &evaluations {
            self.stages.trace("evaluate", Thread::Search, frame, *evaluation)?;
        }
        let evaluating: Duration = evaluations.iter().map(|evaluation| evaluation.time).sum();
        self.stages.count("evaluate", evaluating);
        self.stages.record_passes(frame, &passes)?;
        self.stages.count("search", whole.time.saturating_sub(evaluating));
        Ok(found)
    }

    /// Writes the results, unless the run was stopped.
    fn finish(mut self, record: &RunRecord, warnings: Vec<String>) -> Result<TrackSummary> {
        let (sequence, output, body) = (self.sequence, self.output, &self.plan.body);
        let next = self.next_frame();
        let stopped_before = (self.realtime.is_none() && next < self.plan.range.end).then_some(next);
        if let Some(realtime) = &self.realtime {
            let journal = output.path().join(Journal::NAME);
            self.frames = realtime.frames(&journal, body, sequence.cameras.len(), self.done)?;
        }
        let confidences = Confidence::of_all(body, LossRule::default(), &self.frames);
        let held = Held::new(&self.frames, &confidences, self.recovery.is_some());
        let mut summary = TrackSummary {
            first_frame: self.plan.range.start,
            new_frames: 0,
            frames_per_second: 0.0,
            mean_fitness: mean(self.frames.iter().map(|result| f64::from(result.fitness))),
            mean_confidence: mean(confidences.iter().map(|frame| frame.confidence)),
            error: None,
            stages: Vec::new(),
            backend: [self.plan.backend.evaluator.name(), self.plan.backend.evaluator.variant()],
            warnings,
            stopped_before,
            realtime: None,
            frames: self.frames,
        };
        let has_passes = self.stages.has_device_passes();
        summary.stages = self.stages.finish()?;
        if self.settings.trace && summary.stages.iter().any(|stage| stage.name == "search") && !has_passes {
            let [name, variant] = summary.backend;
            summary.warnings.push(format!("the trace holds no device passes: {name} ({variant}) told of none"));
        }
        // Per frame: waiting for the features, searching, writing; the rest runs beside it.
        let busy: f64 = ["wait", "evaluate", "search", "output"]
            .iter()
            .filter_map(|name| summary.stages.iter().find(|stage| stage.name == *name))
            .map(|stage| stage.total)
            .sum();
        let searched = summary.stages.iter().find(|stage| stage.name == "search").map_or(0, |stage| stage.count);
        summary.new_frames = searched as usize;
        summary.frames_per_second = if busy > 0.0 { searched as f64 / busy * 1e3 } else { 0.0 };
        if stopped_before.is_some() {
            return Ok(summary);
        }
        summary.warnings.extend(lost_sentence(&held.runs(), summary.frames.len()));
        if !summary.frames.is_empty() {
            results::write(output, body, &sequence.cameras, &summary.frames, &confidences, &held, sequence.fps)?;
        }
        if let (Some(truth), None) = (&self.truth, &self.realtime) {
            match truth.error(body, &held, sequence.fps) {
                Ok(error) => summary.error = Some(ErrorSummary { compared: truth.compared.name(), error }),
                Err(why) => summary.warnings.push(format!("{why:#}")),
            }
        }
        // A finished run that is gone on with has no times to tell; those of the run that did the work stay.
        if summary.new_frames > 0 || !output.path().join("stages.json").exists() {
            output.write("stages.json", |writer| {
                let object = json!({
                    "unit": "ms",
                    "frames": summary.new_frames,
                    "frames_per_second": summary.frames_per_second,
                    "stages": summary.stages,
                });
                Ok(serde_json::to_writer_pretty(writer, &object)?)
            })?;
        }
        if let Some(realtime) = &self.realtime {
            [summary.mean_fitness, summary.mean_confidence] = realtime.means();
            let (truth, warnings) = (self.truth.as_ref(), &mut summary.warnings);
            summary.realtime = Some(realtime.finish(output, sequence, truth, warnings, self.done)?);
            return Ok(summary);
        }
        let (truth, has_recording) = (self.truth.as_ref(), self.settings.recording);
        write_report(output, sequence, body, &summary, &confidences, &held, truth, record.rows(), has_recording)?;
        Ok(summary)
    }
}

/// What the user should know about the gaps of a track.
fn lost_sentence(runs: &[[usize; 2]], frames: usize) -> Option<String> {
    let lost: usize = runs.iter().map(|[first, last]| last + 1 - first).sum();
    let shown: Vec<String> = runs.iter().take(5).map(|[first, last]| format!("{first} to {last}")).collect();
    let more = if runs.len() > shown.len() { ", …" } else { "" };
    (lost > 0).then(|| {
        format!(
            "the person is lost in {lost} of {frames} frames, which are gaps in the results: {}{more}",
            shown.join(", ")
        )
    })
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0_usize), |(sum, count), value| (sum + value, count + 1));
    if count > 0 { sum / count as f64 } else { 0.0 }
}
