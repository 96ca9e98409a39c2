//! What runs differ in, and what of them is compared.

use serde::{Deserialize, Serialize};

use super::outcome::Outcome;
use super::plan::Run;

/// A setting that runs differ in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Deserialize, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Axis {
    /// The sequence.
    Sequence,
    /// Who scores the poses.
    Backend,
    /// What the body is drawn as.
    Model,
    /// The objective function.
    Objective,
    /// How poses are searched.
    Search,
    /// Poses scored at once.
    Particles,
    /// Times that many poses are scored a frame.
    Iterations,
}

impl Axis {
    /// All of them, in the order of the columns of runs.csv.
    pub const ALL: [Self; 7] =
        [Self::Sequence, Self::Backend, Self::Model, Self::Objective, Self::Search, Self::Particles, Self::Iterations];

    /// The name, as in the study file and the header of runs.csv.
    pub fn name(self) -> &'static str {
        match self {
            Self::Sequence => "sequence",
            Self::Backend => "backend",
            Self::Model => "model",
            Self::Objective => "objective",
            Self::Search => "search",
            Self::Particles => "particles",
            Self::Iterations => "iterations",
        }
    }

    /// Where a run stands on this axis.
    pub fn of(self, run: &Run) -> String {
        match self {
            Self::Sequence => run.sequence.clone(),
            Self::Backend => run.backend.clone(),
            Self::Model => run.model.to_string(),
            Self::Objective => run.objective.clone(),
            Self::Search => run.search.clone(),
            Self::Particles => run.particles.to_string(),
            Self::Iterations => run.iterations.to_string(),
        }
    }

    /// Where a run stands as a number, for the horizontal axis of a plot.
    pub(super) fn number(self, run: &Run) -> Option<f64> {
        match self {
            Self::Particles => Some(run.particles as f64),
            Self::Iterations => Some(run.iterations as f64),
            _ => None,
        }
    }
}

/// What of a run is compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Deserialize, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Value {
    /// Mean error against the truth, mm.
    Error,
    /// Mean error after each point's constant offset is taken away, mm.
    ErrorWithoutOffset,
    /// Frames a second.
    FramesPerSecond,
    /// One frame's search, evaluation included, ms.
    SearchTime,
    /// Drawing and comparing in one frame, ms.
    EvaluationTime,
    /// Mean fitness.
    Fitness,
    /// Mean confidence.
    Confidence,
}

impl Value {
    /// For headings, with the unit.
    pub fn heading(self) -> &'static str {
        match self {
            Self::Error => "error, mm",
            Self::ErrorWithoutOffset => "error without offsets, mm",
            Self::FramesPerSecond => "frames/s",
            Self::SearchTime => "search a frame, ms",
            Self::EvaluationTime => "evaluation a frame, ms",
            Self::Fitness => "fitness",
            Self::Confidence => "confidence",
        }
    }

    /// The value of a run; none where it has none (no truth, say).
    pub fn of(self, outcome: &Outcome) -> Option<f64> {
        match self {
            Self::Error => outcome.error,
            Self::ErrorWithoutOffset => outcome.error_without_offset,
            Self::FramesPerSecond => Some(outcome.frames_per_second),
            Self::SearchTime => Some(outcome.stage("search")? + outcome.stage("evaluate").unwrap_or(0.0)),
            Self::EvaluationTime => outcome.stage("evaluate"),
            Self::Fitness => Some(outcome.fitness),
            Self::Confidence => Some(outcome.confidence),
        }
    }
}
