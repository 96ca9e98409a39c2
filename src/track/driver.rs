//! The offline driver: every frame of a range in order, however long it takes.

use std::time::{Duration, Instant};

use anyhow::{Context, Result, anyhow};
use serde_json::json;

use super::confidence::Confidence;
use super::feed::{Feed, Prepared};
use super::journal::{FrameResult, Journal};
use super::overlay::Overlay;
use super::page::write_report;
use super::plan::Plan;
use super::run_record::RunRecord;
use super::searcher::{Searched, Start};
use super::stages::{Span, Stages, Thread};
use super::truth::Truth;
use super::{Backend, StageSummary, TrackSettings, results, run_record};
use crate::files::OutputFolder;
use crate::gpu::DeviceLost;
use crate::motion::TrajectoryError;
use crate::search::SearchKind;
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
    /// Frames in all.
    pub frames: usize,
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
    /// Frames done, those of an earlier run included.
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
    /// Every frame that was tracked, in order.
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
}

/// Tracks a sequence and fills `output` with what INTERFACES calls a track's folder.
///
/// While it runs, the folder holds `run.toml` and a journal with every finished frame; the results appear when the last
/// frame is done. With [`TrackSettings::resume`] it goes on from the journal and ends with the same bytes as a run that was
/// never stopped. Without, what an earlier run left in `output` is removed.
///
/// The result files depend on the sequence, the settings and the seed alone, never on the number of threads.
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
        let (journal, done) = Journal::resume(&journal_path, plan.range.start, dofs, views)?;
        if settings.search.kind == SearchKind::ParticleFilter && !done.is_empty() && done.len() < plan.range.len() {
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
    let stages = Stages::new(&output.file("trace.json")?)?;
    progress.start(&RunStart {
        first_frame: plan.range.start,
        frames: plan.range.len(),
        done: done.len(),
        backend: plan.backend.reason.clone(),
        warnings: warnings.clone(),
    });
    plan.backend.evaluator.measure_passes(settings.trace)?;
    let confidence = Confidence::new(&plan.body);
    let mut run = Run { sequence, settings, output, plan, truth, journal, frames: Vec::new(), stages, confidence };
    run.take_over(done)?;
    run.search_all(progress)?;
    run.finish(&record, warnings)
}

/// A run in work.
struct Run<'a> {
    sequence: &'a Sequence,
    settings: &'a TrackSettings,
    output: &'a OutputFolder,
    plan: Plan,
    truth: Option<Truth>,
    journal: Journal,
    frames: Vec<FrameResult>,
    stages: Stages,
    confidence: Confidence,
}

impl Run<'_> {
    /// Frames that an earlier run did.
    fn take_over(&mut self, done: Vec<FrameResult>) -> Result<()> {
        let name = self.journal_name();
        for result in done {
            let values: Vec<f64> = result.pose.iter().map(|value| f64::from(*value)).collect();
            self.plan.body.check_limits(&values).with_context(|| format!("{name}, frame {}", result.frame))?;
            self.confidence.next(&result);
            if let Some(truth) = &mut self.truth {
                truth.running_error(&self.plan.body, result.frame, &result.pose, self.sequence.fps);
            }
            self.frames.push(result);
        }
        Ok(())
    }

    fn journal_name(&self) -> String {
        self.output.path().join(Journal::NAME).display().to_string()
    }

    fn next_frame(&self) -> usize {
        self.plan.range.start + self.frames.len()
    }

    /// Searches the frames that are left, until the last or until asked to stop.
    fn search_all(&mut self, progress: &mut dyn Progress) -> Result<()> {
        if self.next_frame() >= self.plan.range.end {
            return Ok(());
        }
        let mut feed =
            Feed::start(self.sequence, self.plan.features.clone(), self.plan.range.clone(), self.next_frame())?;
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
            self.stages.record("output", Thread::Search, frame, Span::since(start))?;
            let confidence = self.confidence.next(&result).confidence;
            let fps = self.sequence.fps;
            let mean_error =
                self.truth.as_mut().and_then(|truth| truth.running_error(&self.plan.body, frame, &result.pose, fps));
            let fitness = result.fitness;
            self.frames.push(result);
            progress.frame(&FrameDone { frame, done: self.frames.len(), fitness, confidence, mean_error });
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
            self.frames.len(),
            self.output.path().display()
        )
    }

    /// One frame: its search round the frame before, and the terms of the result in every view.
    fn search(&mut self, prepared: &Prepared) -> Result<FrameResult> {
        let frame = prepared.index;
        let begin = Instant::now();
        let spread = self.plan.spread(self.frames.is_empty())?;
        let Plan { start, objective, backend, search, .. } = &mut self.plan;
        let previous = self.frames.last().map_or(&*start, |result| &result.pose);
        let evaluator = backend.evaluator.as_mut();
        let counter =
            u32::try_from(frame).map_err(|_| anyhow!("frame {frame} is beyond the counters of the search"))?;
        let start = Start { frame: counter, centre: previous, spread: &spread };
        let Searched { estimate, components, evaluations, passes } = search
            .search(evaluator, objective, &prepared.observations, start)
            .with_context(|| format!("frame {frame}"))?;
        let views = components.iter().map(|view| objective.view_terms(view)).collect();

        let whole = Span::since(begin);
        self.stages.trace("frame", Thread::Search, frame, whole)?;
        for evaluation in &evaluations {
            self.stages.trace("evaluate", Thread::Search, frame, *evaluation)?;
        }
        let evaluating: Duration = evaluations.iter().map(|evaluation| evaluation.time).sum();
        self.stages.count("evaluate", evaluating);
        self.stages.record_passes(frame, &passes)?;
        self.stages.count("search", whole.time.saturating_sub(evaluating));
        Ok(FrameResult { frame, pose: estimate.pose, fitness: estimate.fitness, spread: estimate.spread, views })
    }

    /// Writes the results, unless the run was stopped.
    fn finish(self, record: &RunRecord, warnings: Vec<String>) -> Result<TrackSummary> {
        let (sequence, output, body) = (self.sequence, self.output, &self.plan.body);
        let next = self.next_frame();
        let stopped_before = (next < self.plan.range.end).then_some(next);
        let mut summary = TrackSummary {
            first_frame: self.plan.range.start,
            new_frames: 0,
            frames_per_second: 0.0,
            mean_fitness: mean(self.frames.iter().map(|result| f64::from(result.fitness))),
            mean_confidence: {
                let mut confidence = Confidence::new(body);
                mean(self.frames.iter().map(|result| confidence.next(result).confidence))
            },
            error: None,
            stages: Vec::new(),
            backend: [self.plan.backend.evaluator.name(), self.plan.backend.evaluator.variant()],
            warnings,
            stopped_before,
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
        results::write(output, body, &sequence.cameras, &summary.frames, sequence.fps)?;
        if let Some(truth) = &self.truth {
            let table = results::pose_table(&summary.frames);
            match truth.error(body, &table, sequence.fps) {
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
        write_report(output, sequence, body, &summary, self.truth.as_ref(), record.rows())?;
        Ok(summary)
    }
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0_usize), |(sum, count), value| (sum + value, count + 1));
    if count > 0 { sum / count as f64 } else { 0.0 }
}
