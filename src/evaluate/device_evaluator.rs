//! Evaluation that a search on the device records into its own submission.

use anyhow::Result;

use super::objective::Objective;
use crate::gpu::{Buffer, Device, Dispatch, Recorder, Recording};

/// An evaluator whose poses and fitness stay on the device, so that all iterations of a frame need no host between them.
pub trait DeviceEvaluator: Send {
    /// The device it works on.
    fn device(&self) -> &Device;

    /// The poses it scores, `[candidate][dof]` single precision, mm and radians; filled by whoever records before.
    fn poses(&self) -> &Buffer;

    /// The fitness it gives, `[candidate]` single precision, in [0, 1].
    fn fitness(&self) -> &Buffer;

    /// The number of views.
    fn views(&self) -> usize;

    /// What stands behind the fitness, `[candidate][view]`: four words of drawn area, overlap, edge pixels and proximity (METHOD
    /// A6, without the observed area).
    fn sums(&self) -> &Buffer;

    /// Whether what was recorded, right as it stays, is better recorded anew for the newest observations.
    fn has_outgrown_its_recording(&self) -> bool {
        false
    }

    /// Whether the newest observations are handed over on the device ([`super::Evaluator::observe_held`]). What is recorded holds for
    /// observations that come in the same way.
    fn is_handed_observations(&self) -> bool {
        false
    }

    /// What hands the newest observations over: to be run once, ahead of what was recorded. None where nothing is, or where they come
    /// from the host.
    fn handover(&mut self) -> Option<&mut Recording> {
        None
    }

    /// Makes room for so many candidates; the buffers may be others afterwards, and what was recorded before goes on working
    /// with the old ones.
    ///
    /// # Errors
    /// When the device has no room.
    fn reserve(&mut self, candidates: u32) -> Result<()>;

    /// Records the copies that bring the body, the cameras and, where they come from the host, the newest observations to the device.
    /// Recorded once, they bring whatever is newest at every submission.
    ///
    /// # Errors
    /// When the device fails.
    fn record_upload(&self, recorder: &mut Recorder) -> Result<()>;

    /// Records everything from `poses` to what [`Self::scoring`] makes the fitness of, for the first `candidates` candidates.
    ///
    /// # Errors
    /// When there is no room for so many, or the device fails.
    fn record_sums(&self, recorder: &mut Recorder, objective: &Objective, candidates: u32) -> Result<()>;

    /// What makes the fitness of that.
    ///
    /// # Errors
    /// When the objective needs what the observations do not have.
    fn scoring(&self, objective: &Objective, candidates: u32) -> Result<Scoring<'_>>;

    /// Records everything from `poses` to `fitness` for the first `candidates` candidates.
    ///
    /// # Errors
    /// As [`Self::record_sums`] and [`Self::scoring`].
    fn record(&self, recorder: &mut Recorder, objective: &Objective, candidates: u32) -> Result<()> {
        self.record_sums(recorder, objective, candidates)?;
        recorder.run(self.scoring(objective, candidates)?.dispatch)
    }
}

/// What makes the fitness of candidates from their sums: a stage, which another one can do the work of where it knows how.
#[derive(Clone, Debug)]
pub struct Scoring<'a> {
    /// How it does it.
    pub by: ScoredBy,
    /// A run of the stage.
    pub dispatch: Dispatch<'a>,
}

/// Which fitness a stage makes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ScoredBy {
    /// That of whole silhouettes, as `objective.comp` with its bindings and its Scoring.
    Silhouettes,
    /// That of silhouettes in segments, as `objective_segments.comp`.
    Segments,
    /// That of soft evidence, as `objective_evidence.comp`.
    Evidence,
    /// One that no other stage makes.
    Otherwise,
}
