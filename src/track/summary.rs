//! What a run yielded.

use super::TimingSummary;
use super::journal::FrameResult;
use super::realtime::RealtimeSummary;
use crate::motion::TrajectoryError;

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
    /// Frames of them in which the person is lost.
    pub lost: usize,
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
    pub timings: Vec<TimingSummary>,
    /// The evaluator's name and variant.
    pub backend: [&'static str; 2],
    /// Sentences the user should read.
    pub warnings: Vec<String>,
    /// Whether the run was asked to stop before its last frame. One in real time has results all the same, of fewer frames.
    pub is_cut: bool,
    /// The next frame of a run that was cut and can be gone on with; the folder then holds the journal alone.
    pub stopped_before: Option<usize>,
    /// How a run in real time kept time.
    pub realtime: Option<RealtimeSummary>,
}

/// What the user should know about the gaps of a track.
pub(super) fn lost_sentence(runs: &[[usize; 2]], frames: usize) -> Option<String> {
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

/// The mean; 0 of nothing.
pub(super) fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0_usize), |(sum, count), value| (sum + value, count + 1));
    if count > 0 { sum / count as f64 } else { 0.0 }
}
