//! What a run yielded.

use std::cmp::Reverse;

use super::TimingSummary;
use super::confidence::FrameConfidence;
use super::held::{Held, runs_of};
use super::journal::FrameResult;
use super::realtime::RealtimeSummary;
use crate::geometry::Camera;
use crate::motion::TrajectoryError;

/// An expected error from which on a joint is one to look at, mm.
const DOUBTFUL: f64 = 100.0;
/// Of these, how many are named.
const NAMED: usize = 4;

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
pub(super) fn lost_sentence(held: &Held) -> Option<String> {
    let (lost, frames) = (held.gap_count(), held.table.frames.len());
    (lost > 0).then(|| {
        let shown = shown(held, &held.runs(), 5);
        format!("the person is lost in {lost} of {frames} frames, which are gaps in the results: {shown}")
    })
}

/// What the user should look at before using it: joints that are expected to be off by more than [`DOUBTFUL`], in frames that are no gaps. Those
/// of most frames go first.
pub(super) fn doubtful_sentence(names: &[String], held: &Held, confidences: &[FrameConfidence]) -> Option<String> {
    let sure = held.sure();
    let doubtful = |joint: usize| -> Vec<usize> {
        let is_doubtful = |row: &usize| confidences[*row].joints.get(joint).is_some_and(|it| it.sigma > DOUBTFUL);
        sure.iter().copied().filter(is_doubtful).collect()
    };
    let mut joints: Vec<(&String, Vec<usize>)> =
        names.iter().enumerate().map(|(joint, name)| (name, doubtful(joint))).collect();
    joints.retain(|(_, rows)| !rows.is_empty());
    joints.sort_by_key(|(_, rows)| Reverse(rows.len()));
    let told: Vec<String> = (joints.iter().take(NAMED))
        .map(|(name, rows)| format!("{name} in {}", shown(held, &runs_of(rows.iter().copied()), 3)))
        .collect();
    let more = match joints.len() - told.len() {
        0 => String::new(),
        1 => ", and 1 more joint".to_string(),
        more => format!(", and {more} more joints"),
    };
    (!told.is_empty()).then(|| {
        format!(
            "look at these frames before you use them, joints are expected to be off by more than {DOUBTFUL} mm there (sigma in confidence.csv): \
             {}{more}",
            told.join("; ")
        )
    })
}

/// What the user should know about each camera that was left out: in real time since nothing came of it, else since it does not fit what the
/// others show.
pub(super) fn left_out_sentences(
    cameras: &[Camera],
    held: &Held,
    frames: &[FrameResult],
    in_real_time: bool,
) -> Vec<String> {
    let of_view = |(view, camera): (usize, &Camera)| {
        let is_without = |row: &usize| frames[*row].left_out().any(|left_out| left_out == view);
        let runs = runs_of((0..frames.len()).filter(is_without));
        (!runs.is_empty()).then(|| {
            let shown = shown(held, &runs, 5);
            if in_real_time {
                return format!(
                    "camera {:?} delivered nothing in frames {shown}, which are tracked without it",
                    camera.name
                );
            }
            format!(
                "camera {:?} does not fit what the others show in frames {shown}, which are tracked without it: see whether it stopped, was moved, lost frames, has \
                 something before it, or sees the person before her own colours",
                camera.name
            )
        })
    };
    cameras.iter().enumerate().filter_map(of_view).collect()
}

/// The frames of the first so many of runs of rows.
fn shown(held: &Held, runs: &[[usize; 2]], most: usize) -> String {
    let run = |[first, last]: [usize; 2]| if first == last { format!("{first}") } else { format!("{first} to {last}") };
    let shown: Vec<String> = held.frames_of(&runs[..most.min(runs.len())]).into_iter().map(run).collect();
    let more = if runs.len() > most { ", …" } else { "" };
    format!("{}{more}", shown.join(", "))
}

/// The mean; 0 of nothing.
pub(super) fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0_usize), |(sum, count), value| (sum + value, count + 1));
    if count > 0 { sum / count as f64 } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::track::confidence::JointConfidence;
    use crate::track::fit_tests::cameras_around;

    /// A camera that was left out is named with its frames, wherever they lie and whatever others were.
    #[test]
    fn cameras_that_were_left_out_are_named_with_their_frames() {
        let cameras = cameras_around();
        let left_out = |view: usize, frame: usize| match view {
            0 => (15..17).contains(&frame),
            1 => (110..=120).contains(&frame) || frame == 130,
            _ => false,
        };
        let result = |frame: usize| FrameResult {
            frame,
            pose: Vec::new(),
            fitness: 1.0,
            spread: Vec::new(),
            views: (0..cameras.len())
                .map(|view| if left_out(view, frame) { FrameResult::LEFT_OUT } else { [0.8; 2] })
                .collect(),
            joints: Vec::new(),
        };
        let frames: Vec<FrameResult> = (10..150).map(result).collect();
        let told = |frames: &[FrameResult], in_real_time: bool| {
            left_out_sentences(&cameras, &Held::new(frames, &[], false), frames, in_real_time)
        };
        let in_real_time: Vec<FrameResult> = frames.iter().filter(|result| result.frame % 5 == 0).cloned().collect();
        let (passed_over, told) = (told(&in_real_time, true), told(&frames, false));
        let begins = [(0, "15 to 16"), (1, "110 to 120, 130")].map(|(view, frames): (usize, &str)| {
            format!("camera {:?} does not fit what the others show in frames {frames}, ", cameras[view].name)
        });
        assert_eq!(told.len(), 2, "{told:?}");
        assert!(told.iter().zip(&begins).all(|(told, begin)| told.starts_with(begin)), "{told:?}");
        // Frames that were passed over do not part a run.
        let silent = format!("camera {:?} delivered nothing in frames 110 to 120, 130, which", cameras[1].name);
        assert!(passed_over.len() == 2 && passed_over[1].starts_with(&silent), "{passed_over:?}");
    }

    /// The joints of most frames are named first, with the stretches in which they are doubtful; gaps are told of elsewhere.
    #[test]
    fn doubtful_joints_are_named_with_their_frames() {
        let names: Vec<String> = ["hip", "knee", "ankle", "elbow", "wrist", "head"].map(str::to_string).to_vec();
        let frame = |sigmas: [f64; 6], is_lost: bool| FrameConfidence {
            position_spread: 0.0,
            angle_spread: 0.0,
            confidence: 1.0,
            agreement: 1.0,
            wrong: 0.0,
            is_lost,
            joints: sigmas.map(|sigma| JointConfidence { spread: 0.0, seen: 1.0, confidence: 1.0, sigma }).to_vec(),
        };
        let said = |frames: &[([f64; 6], bool)]| {
            let confidences: Vec<FrameConfidence> = frames.iter().map(|(sigmas, lost)| frame(*sigmas, *lost)).collect();
            let gaps = |held: &[FrameConfidence]| -> Vec<FrameResult> {
                (10..10 + held.len())
                    .map(|frame| FrameResult {
                        frame,
                        pose: Vec::new(),
                        fitness: 1.0,
                        spread: Vec::new(),
                        views: Vec::new(),
                        joints: Vec::new(),
                    })
                    .collect()
            };
            let held = Held::new(&gaps(&confidences), &confidences, true);
            doubtful_sentence(&names, &held, &confidences)
        };
        let sure = ([99.0; 6], false);
        assert_eq!(said(&[sure; 3]), None);
        let with = |joint: usize| {
            let mut sigmas = [20.0; 6];
            sigmas[joint] = 101.0;
            (sigmas, false)
        };
        let told = said(&[with(3), sure, with(4), with(4), sure, with(4), ([500.0; 6], true)]).unwrap();
        assert!(told.ends_with("wrist in 12 to 13, 15; elbow in 10"), "{told}");
        let all = said(&[([200.0; 6], false), sure, with(5), sure, with(5), sure, with(5)]).unwrap();
        assert!(
            all.contains(": head in 10, 12, 14, …; hip in 10; knee in 10; ankle in 10, and 2 more joints"),
            "{all}"
        );
    }
}
