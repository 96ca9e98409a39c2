//! What one run yielded, and how it is kept.

use serde::{Deserialize, Serialize};

use super::run::Run;
use crate::files::Limit;

/// What is read of a run or trial that is done.
pub(super) const RESULT: Limit = Limit { what: "the results of a run", most: 64 << 20 };

/// A run and what it yielded: `row.json` of its folder, a row of runs.csv.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Row {
    /// The run.
    pub run: Run,
    /// What it yielded.
    pub outcome: Outcome,
}

/// What a run yielded.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Outcome {
    /// Frames tracked.
    pub frames: usize,
    /// Points that were compared with the truth.
    pub points: usize,
    /// Mean error over frames, then over points, mm (METHOD A10).
    pub error: Option<f64>,
    /// Standard deviation of all point-frame errors, mm.
    pub error_std: Option<f64>,
    /// The error after each point's constant mean offset is taken away, mm.
    pub error_without_offset: Option<f64>,
    /// Frames a second.
    pub frames_per_second: f64,
    /// Mean fitness.
    pub fitness: f64,
    /// Mean confidence.
    pub confidence: f64,
    /// The share of the frames that a run in real time passed over.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub skipped: Option<f64>,
    /// Where the time went.
    pub stages: Vec<StageShare>,
    /// The evaluator's name and variant, as `auto` resolved it.
    pub evaluator: String,
}

/// The time of one stage of a run.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct StageShare {
    /// Its name.
    pub name: String,
    /// Of one frame, ms.
    pub ms: f64,
}

impl Outcome {
    /// The time of a stage in one frame, ms.
    pub fn stage(&self, name: &str) -> Option<f64> {
        self.stages.iter().find(|stage| stage.name == name).map(|stage| stage.ms)
    }
}
