//! Tracking in real time (METHOD A11): acquisition, processing (a worker a view) and tracking in threads of their own. Between
//! two modules there is room for one set, and the newest wins: what is older is passed over and counted, so nothing queues up.
//! The driver is that of a run without a clock; this room gives it its frames, its budget and the account of its times.

mod budget;
mod feed;
mod outlets;
mod painter;
mod processing;
mod rounds;
mod rows;
mod settings;
mod tally;
mod timeline;

use std::ops::Range;
use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

use anyhow::{Result, ensure};

use budget::{Budget, Size};
use feed::{Input, RealtimeFeed};
pub(super) use outlets::OpenOutlets;
use outlets::Outlets;
use rounds::Rounds;
use rows::Rows;
pub use settings::{RealtimeSettings, Repeat};
use tally::{Counts, Tally};
pub use tally::{Drops, LatencySummary, RealtimeSummary};
use timeline::{Row, Timeline};

use super::TrackSettings;
use super::feed::{Frames, Keeps, Prepared};
use super::journal::{Extent, FrameResult, Journal, Numbering};
use super::pace::{Finished, Pace, Turn};
use super::plan::Plan;
use super::summary::TrackSummary;
use super::timings::Span;
use super::truth::Truth;
use crate::body::{Body, Mesh};
use crate::files::OutputFolder;
use crate::sequence::Sequence;

/// The account of a run, in a track's folder.
pub(super) const SUMMARY: &str = "realtime.json";
/// The picture of its last moments.
pub(super) const TIMELINE: &str = "timeline.svg";
/// The longest time that the start of a search is widened for, s: by then the person may be anywhere within a step.
const LONGEST_AGE: f64 = 0.5;
/// Frames of which all result files are made; a longer run keeps its rows and its journal, and memory stays flat.
const LONGEST_RUN: u64 = 50_000;

/// A run's real time.
pub(super) struct Realtime {
    settings: RealtimeSettings,
    stall_timeout: Duration,
    rounds: Rounds,
    budget: Budget,
    tally: Tally,
    counts: Arc<Counts>,
    timeline: Arc<Timeline>,
    rows: Rows,
    outlets: Option<Outlets>,
    /// The search of the frame in work and the time after it.
    searched: Option<Searched>,
}

/// The search of a frame.
#[derive(Clone, Copy)]
struct Searched {
    frame: usize,
    begin: Instant,
    end: Instant,
}

impl Realtime {
    /// For the frames of `range`, to the end of which a run of many rounds is moved; `done` are the frames of an earlier run.
    ///
    /// # Errors
    /// When there are more frames than can be counted, or the rows cannot be written.
    pub(super) fn new(
        sequence: &Sequence,
        settings: &TrackSettings,
        realtime: &RealtimeSettings,
        output: &OutputFolder,
        body: &Body,
        mesh: Option<&Mesh>,
        range: &mut Range<usize>,
        done: &[FrameResult],
        outlets: OpenOutlets,
    ) -> Result<Self> {
        let rounds = Rounds::of(range.clone());
        if !sequence.is_live() {
            let frames = realtime.repeat.frames(range.len(), sequence.fps * realtime.rate);
            let end = range.start.saturating_add(frames);
            ensure!(u32::try_from(end).is_ok(), "{end} frames are too many to count, expected a shorter --loop");
            range.end = end;
        }
        let asked = Size { particles: settings.search.particles, iterations: settings.search.iterations };
        Ok(Self {
            settings: realtime.clone(),
            stall_timeout: settings.stall_timeout,
            rounds,
            budget: Budget::new(asked, realtime.time_to_search(sequence)?),
            tally: Tally::default(),
            counts: Arc::default(),
            timeline: Arc::default(),
            rows: Rows::create(output, body, sequence.fps, done)?,
            outlets: outlets.start(sequence, body, mesh, done)?,
            searched: None,
        })
    }

    /// Writes realtime.json and the time-line, if this run did anything.
    fn write(&mut self, run: &Finished<'_>, warnings: &mut Vec<String>) -> Result<RealtimeSummary> {
        let &Finished { sequence, output, truth, done, .. } = run;
        let mut summary = self.tally.summary(&self.counts, &self.settings, truth.and_then(Truth::mean_error));
        if let Some(outlets) = self.outlets.take() {
            summary.sent = outlets.finish(warnings);
        }
        warnings.extend(summary.ended.clone());
        if done as u64 > LONGEST_RUN {
            warnings.push(format!(
                "the run has more than {LONGEST_RUN} poses, so poses.csv and joints.csv are all there is: `pantin convert` makes \
                 the other formats"
            ));
        }
        if summary.poses > 0 {
            output.write(SUMMARY, |writer| Ok(serde_json::to_writer_pretty(writer, &summary)?))?;
            let cameras: Vec<String> = sequence.cameras.iter().map(|camera| camera.name.clone()).collect();
            let fps = sequence.fps * if sequence.is_live() { 1.0 } else { self.settings.rate };
            let svg = self.timeline.draw(&cameras, fps, self.settings.deadline)?;
            output.write(TIMELINE, |writer| Ok(writer.write_all(svg.as_bytes())?))?;
        }
        Ok(summary)
    }
}

impl Pace for Realtime {
    fn feed(&self, sequence: &Sequence, plan: &Plan, from: usize, _: &Keeps<'_>) -> Result<Box<dyn Frames>> {
        let rate = if sequence.is_live() { 1.0 } else { self.settings.rate };
        let input = Input {
            range: self.rounds.range(),
            frames: plan.range.len(),
            from,
            fps: sequence.fps * rate,
            stall_timeout: self.stall_timeout,
        };
        Ok(Box::new(RealtimeFeed::start(sequence, &plan.features, &input, &self.counts, &self.timeline)?))
    }

    fn turn(&self, prepared: &Prepared, before: Option<usize>, fps: f64) -> Turn {
        let frame = prepared.index;
        let before = before.filter(|before| self.rounds.are_together(*before, frame));
        let age = before.map_or_else(|| self.rounds.since_start(frame), |before| frame - before);
        let longest = (LONGEST_AGE * fps).max(1.0);
        let now = Instant::now();
        let captured = prepared.captured.unwrap_or(now);
        let Size { particles, iterations } = self.budget.size(captured, now);
        Turn {
            starts_anew: before.is_none(),
            widen: (age as f64).min(longest) as f32,
            size: [particles, iterations],
            until: if self.tally.poses() > 0 { self.budget.until(captured) } else { None },
        }
    }

    fn follows(&self, before: usize, frame: usize) -> bool {
        self.rounds.are_together(before, frame)
    }

    fn searched(&mut self, frame: usize, evaluations: usize, whole: Span) {
        self.budget.searched(evaluations, whole.time);
        self.tally.searched(evaluations);
        self.searched = Some(Searched { frame, begin: whole.start, end: Instant::now() });
    }

    /// Sends the pose on and adds the rows of the tables; the age of the pose is taken then.
    fn deliver(&mut self, body: &Body, result: &FrameResult, prepared: &Prepared) -> Result<()> {
        let captured = prepared.captured;
        if let Some(outlets) = &self.outlets {
            outlets.send(result, captured);
        }
        self.rows.append(body, result)?;
        if let Some(captured) = captured {
            self.tally.deliver(captured, self.settings.deadline);
        }
        if let Some(outlets) = &self.outlets {
            outlets.show(prepared, result);
        }
        let Some(Searched { frame, begin, end }) = self.searched.take() else { return Ok(()) };
        self.budget.delivered(end.elapsed());
        if result.frame == frame {
            self.timeline.worked(Row::Tracking, frame, Span::since(begin));
        } else {
            // What waited is at work once more.
            self.timeline.worked(Row::Tracking, frame, Span { start: begin, time: end - begin });
            self.timeline.worked(Row::Tracking, result.frame, Span::since(end));
        }
        Ok(())
    }

    fn judge(&mut self, fitness: f32, confidence: f64) {
        self.tally.fitness += f64::from(fitness);
        self.tally.confidence += confidence;
    }

    fn in_sequence(&self, frame: usize) -> usize {
        self.rounds.in_sequence(frame)
    }

    fn ends_anywhere(&self) -> bool {
        true
    }

    /// The last alone, so that memory does not grow.
    fn keep(&self, frames: &mut Vec<FrameResult>, result: FrameResult) {
        frames.clear();
        frames.push(result);
    }

    /// None of a run that is too long to be kept in memory.
    fn all_frames(&self, _: Vec<FrameResult>, journal: &Path, extent: Extent, done: usize) -> Result<Vec<FrameResult>> {
        if done as u64 > LONGEST_RUN {
            return Ok(Vec::new());
        }
        Ok(Journal::resume(journal, Numbering::Rising, extent)?.1)
    }

    fn outlets(&self) -> Vec<String> {
        self.outlets.as_ref().map(|outlets| outlets.addresses().to_vec()).unwrap_or_default()
    }

    fn take_news(&mut self) -> Vec<String> {
        self.counts.take_news()
    }

    fn close(&mut self, run: &Finished<'_>, summary: &mut TrackSummary) -> Result<()> {
        let count = self.tally.poses().max(1) as f64;
        (summary.mean_fitness, summary.mean_confidence) = (self.tally.fitness / count, self.tally.confidence / count);
        summary.realtime = Some(self.write(run, &mut summary.warnings)?);
        Ok(())
    }
}
