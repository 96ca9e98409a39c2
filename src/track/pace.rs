//! How a run keeps pace with its frames: offline every frame waits for the whole search of the one before, in real time none does
//! ([`super::realtime`]).

use std::path::Path;
use std::time::{Duration, Instant};

use anyhow::Result;

use super::TrackSettings;
use super::confidence::FrameConfidence;
use super::feed::{Feed, Frames, Keeps, Prepared};
use super::held::Held;
use super::journal::{Extent, FrameResult};
use super::page::write_report;
use super::plan::Plan;
use super::run_record::RunRecord;
use super::summary::{ErrorSummary, TrackSummary};
use super::timings::Span;
use super::truth::Truth;
use crate::body::Body;
use crate::files::OutputFolder;
use crate::sequence::Sequence;

/// How a frame is to be searched.
#[derive(Clone, Copy, Debug)]
pub(super) struct Turn {
    /// Whether it has nothing to do with the frame before: there is none, or a loop has begun again.
    pub(super) starts_anew: bool,
    /// Factor on the width of the start: frame times since the frame before.
    pub(super) widen: f32,
    /// Particles and iterations.
    pub(super) size: [usize; 2],
    /// When to be done.
    pub(super) until: Option<Instant>,
}

/// A run whose frames are done, for what is made of it in the end.
pub(super) struct Finished<'a> {
    pub(super) sequence: &'a Sequence,
    pub(super) settings: &'a TrackSettings,
    pub(super) output: &'a OutputFolder,
    pub(super) body: &'a Body,
    pub(super) confidences: &'a [FrameConfidence],
    pub(super) held: &'a Held,
    pub(super) truth: Option<&'a Truth>,
    pub(super) record: &'a RunRecord,
    /// Frames done.
    pub(super) done: usize,
}

/// What differs between a run offline and one in real time.
pub(super) trait Pace {
    /// Where the frames from `next` on come from, with what is kept of them.
    ///
    /// # Errors
    /// When the features cannot be made ready, or threads or decoders not be started.
    fn feed(&self, sequence: &Sequence, plan: &Plan, next: usize, keeps: &Keeps<'_>) -> Result<Box<dyn Frames>>;

    /// How to search a frame after the frame `before`.
    fn turn(&self, prepared: &Prepared, before: Option<usize>, fps: f64) -> Turn;

    /// Whether a frame goes on from the frame `before`.
    fn follows(&self, _before: usize, _frame: usize) -> bool {
        true
    }

    /// Takes note of a search.
    fn searched(&mut self, _frame: usize, _evaluations: usize, _whole: Span) {}

    /// Gives a pose out at once to those who wait for it.
    ///
    /// # Errors
    /// When it cannot be written.
    fn deliver(&mut self, _body: &Body, _result: &FrameResult, _prepared: &Prepared) -> Result<()> {
        Ok(())
    }

    /// Where poses can be had as they are found, sentences for the user.
    fn outlets(&self) -> Vec<String> {
        Vec::new()
    }

    /// What happened to the sources since this was asked before, sentences for the user.
    fn take_news(&mut self) -> Vec<String> {
        Vec::new()
    }

    /// Takes note of how good a pose is.
    fn judge(&mut self, _fitness: f32, _confidence: f64) {}

    /// A frame of the run as the truth counts it.
    fn in_sequence(&self, frame: usize) -> usize {
        frame
    }

    /// Whether a run that is stopped, or whose source fails, is finished with what it has.
    fn ends_anywhere(&self) -> bool;

    /// Keeps a frame that is done in memory, for the frames after it.
    fn keep(&self, frames: &mut Vec<FrameResult>, result: FrameResult);

    /// Every frame of the run, from those kept or its journal.
    ///
    /// # Errors
    /// When the journal cannot be read.
    fn all_frames(
        &self,
        kept: Vec<FrameResult>,
        journal: &Path,
        extent: Extent,
        done: usize,
    ) -> Result<Vec<FrameResult>>;

    /// Adds to the summary what it alone knows, and writes its own files.
    ///
    /// # Errors
    /// When they cannot be written.
    fn close(&mut self, run: &Finished<'_>, summary: &mut TrackSummary) -> Result<()>;
}

/// Every frame, however long it takes; a report in the end.
pub(super) struct Offline {
    size: [usize; 2],
    stall_timeout: Duration,
}

impl Offline {
    pub(super) fn new(settings: &TrackSettings) -> Self {
        Self { size: [settings.search.particles, settings.search.iterations], stall_timeout: settings.stall_timeout }
    }
}

impl Pace for Offline {
    fn feed(&self, sequence: &Sequence, plan: &Plan, next: usize, keeps: &Keeps<'_>) -> Result<Box<dyn Frames>> {
        let Plan { features, range, .. } = plan;
        Ok(Box::new(Feed::start(sequence, features.clone(), range.clone(), next, self.stall_timeout, keeps)?))
    }

    fn turn(&self, _: &Prepared, before: Option<usize>, _: f64) -> Turn {
        Turn { starts_anew: before.is_none(), widen: 1.0, size: self.size, until: None }
    }

    fn ends_anywhere(&self) -> bool {
        false
    }

    fn keep(&self, frames: &mut Vec<FrameResult>, result: FrameResult) {
        frames.push(result);
    }

    fn all_frames(&self, kept: Vec<FrameResult>, _: &Path, _: Extent, _: usize) -> Result<Vec<FrameResult>> {
        Ok(kept)
    }

    fn close(&mut self, run: &Finished<'_>, summary: &mut TrackSummary) -> Result<()> {
        let &Finished { sequence, settings, output, body, confidences, held, truth, record, .. } = run;
        if let Some(truth) = truth {
            match truth.error(body, held, sequence.fps) {
                Ok(error) => summary.error = Some(ErrorSummary { compared: truth.compared.name(), error }),
                Err(why) => summary.warnings.push(format!("{why:#}")),
            }
        }
        write_report(output, sequence, body, summary, confidences, held, truth, record.rows(), settings.recording)
    }
}
