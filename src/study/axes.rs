//! What runs differ in, and what of them is compared.

use super::outcome::Outcome;
use super::run::Run;
use crate::files::choices;

choices! {
    /// A setting that runs differ in. Their order is that of the columns of runs.csv.
    "axis" pub enum Axis {
        /// The sequence.
        "sequence" Sequence,
        /// Who scores the poses.
        "backend" Backend,
        /// What the body is drawn as.
        "model" Model,
        /// The objective function.
        "objective" Objective,
        /// How poses are searched.
        "search" Search,
        /// Poses scored at once.
        "particles" Particles,
        /// Times that many poses are scored a frame.
        "iterations" Iterations,
        /// Poses scored a frame: particles times iterations.
        "evaluations" Evaluations,
        /// How it keeps time.
        "pace" Pace,
    }
}

impl Axis {
    /// Where a run stands on this axis.
    pub fn of(self, run: &Run) -> String {
        match self {
            Self::Sequence => run.sequence.clone(),
            Self::Backend => run.backend.to_string(),
            Self::Model => run.model.to_string(),
            Self::Objective => run.objective_name().to_string(),
            Self::Search => run.search.to_string(),
            Self::Particles => run.particles.to_string(),
            Self::Iterations => run.iterations.to_string(),
            Self::Evaluations => (run.particles * run.iterations).to_string(),
            Self::Pace => run.pace.to_string(),
        }
    }

    /// Whether runs stand on it as numbers: the horizontal axis of a plot, and a heading that says of what.
    pub(super) fn is_number(self) -> bool {
        match self {
            Self::Particles | Self::Iterations | Self::Evaluations => true,
            Self::Sequence | Self::Backend | Self::Model | Self::Objective | Self::Search | Self::Pace => false,
        }
    }

    /// Where a run stands as a number.
    pub(super) fn number(self, run: &Run) -> Option<f64> {
        match self {
            Self::Particles => Some(run.particles as f64),
            Self::Iterations => Some(run.iterations as f64),
            Self::Evaluations => Some((run.particles * run.iterations) as f64),
            Self::Sequence | Self::Backend | Self::Model | Self::Objective | Self::Search | Self::Pace => None,
        }
    }
}

choices! {
    /// What of a run is compared.
    "value" pub enum Value {
        /// Mean error against the truth, mm.
        "error" Error,
        /// Mean error after each point's constant offset is taken away, mm.
        "error_without_offset" ErrorWithoutOffset,
        /// Frames a second.
        "frames_per_second" FramesPerSecond,
        /// One frame's search, evaluation included, ms.
        "search_time" SearchTime,
        /// Drawing and comparing in one frame, ms.
        "evaluation_time" EvaluationTime,
        /// Mean fitness.
        "fitness" Fitness,
        /// Mean confidence.
        "confidence" Confidence,
        /// The share of the frames that a run in real time passed over, %.
        "skipped" Skipped,
    }
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
            Self::Skipped => "frames passed over, %",
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
            Self::Skipped => outcome.skipped.map(|share| 100.0 * share),
        }
    }
}
