//! How a run begins: its inputs read and checked, then its folder, its journal, and the frames that an earlier run did.

use anyhow::{Result, bail};

use super::journal::{Extent, FrameResult, Journal};
use super::pace::{Offline, Pace};
use super::plan::Plan;
use super::realtime::{OpenOutlets, Realtime};
use super::run::{Run, why_not_again};
use super::run_record::RunRecord;
use super::timings::Timings;
use super::truth::Truth;
use super::{Backend, Drawing, TrackSettings, folder, run_record};
use crate::files::OutputFolder;
use crate::sequence::Sequence;

/// A run whose inputs are read and checked; nothing is written yet.
pub(super) struct Planned<'a> {
    sequence: &'a Sequence,
    settings: &'a TrackSettings,
    output: &'a OutputFolder,
    pub(super) plan: Plan,
    truth: Option<Truth>,
    record: RunRecord,
    outlets: OpenOutlets,
    warnings: Vec<String>,
}

/// A run that begins: the frames that an earlier one did are not taken over yet.
pub(super) struct Begun<'a> {
    pub(super) run: Run<'a>,
    pub(super) record: RunRecord,
    pub(super) done: Vec<FrameResult>,
    pub(super) warnings: Vec<String>,
}

impl<'a> Planned<'a> {
    /// Reads everything that a run of one person needs.
    ///
    /// # Errors
    /// Anything wrong with an input, named.
    pub(super) fn new(
        sequence: &'a Sequence,
        settings: &'a TrackSettings,
        output: &'a OutputFolder,
        mut warnings: Vec<String>,
    ) -> Result<Self> {
        // What auto once chose is kept to: another machine, or a moment of noise, must not change a run midway.
        let recorded = match settings.drawing.backend {
            Backend::Auto if settings.resume => run_record::recorded_backend(output)?,
            _ => None,
        };
        let drawing = recorded.map_or(settings.drawing, Drawing::from);
        let mut plan = Plan::new(sequence, settings, drawing)?;
        if let Some(backend) = recorded {
            plan.backend.reason = format!("{}, which this run began with", backend.name());
        }
        if let (Some(true), Some(why)) = (settings.measure_again, why_not_again(sequence, &plan)) {
            bail!("{why}: leave out --measure-again");
        }
        let truth = match &sequence.truth {
            Some(path) => Truth::read(path, &plan.body, sequence.fps)?.map_err(|why| warnings.push(why)).ok(),
            None => None,
        };
        warnings.extend(truth.as_ref().and_then(Truth::remark));
        let record = RunRecord::new(sequence, settings, &plan)?;
        let outlets = OpenOutlets::of(sequence, settings, &plan.body)?;
        Ok(Self { sequence, settings, output, plan, truth, record, outlets, warnings })
    }

    /// Begins the run in its folder.
    ///
    /// # Errors
    /// When a run cannot be gone on with, or the folder cannot be written.
    pub(super) fn begin(self) -> Result<Begun<'a>> {
        let Self { sequence, settings, output, mut plan, truth, record, outlets, mut warnings } = self;
        let occupied = output.occupy()?;
        let journal_path = output.path().join(Journal::NAME);
        let (journal, done) = if settings.resume {
            record.check_same(output)?;
            let extent = Extent::of(&plan.body, &sequence.cameras);
            let (journal, done) = Journal::resume(&journal_path, settings.numbering(plan.range.start), extent)?;
            if settings.search.kind.carries_on() && !done.is_empty() && done.len() < plan.range.len() {
                warnings.push(
                    "the particle filter carries its particles on, so the run begins at its first frame again".into(),
                );
                (Journal::create(&journal_path)?, Vec::new())
            } else {
                (journal, done)
            }
        } else {
            folder::clear(output)?;
            record.write(output)?;
            (Journal::create(&journal_path)?, Vec::new())
        };
        warnings.extend(plan.search.note(plan.backend.evaluator.as_mut()));
        let timings = Timings::new(&output.file("trace.json")?)?;
        let pace: Box<dyn Pace> = match &settings.realtime {
            Some(realtime) => {
                let Plan { body, mesh, range, .. } = &mut plan;
                Box::new(Realtime::new(
                    sequence,
                    settings,
                    realtime,
                    output,
                    body,
                    mesh.as_ref(),
                    range,
                    &done,
                    outlets,
                )?)
            }
            None => Box::new(Offline::new(settings)),
        };
        plan.backend.evaluator.measure_passes(settings.trace)?;
        let run = Run::new(sequence, settings, output, occupied, plan, truth, journal, timings, pace)?;
        Ok(Begun { run, record, done, warnings })
    }
}
