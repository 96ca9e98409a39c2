//! The points of a trial, as Pose2Sim's triangulation would leave them.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, ensure};
use glam::DVec3;

use crate::body::{Body, PoseTable};
use crate::motion::{PointTrajectory, read_points};
use crate::sequence::{LargeGaps, Pose2SimTrial, Sequence};
use crate::track::unaided::BODY;

/// Where Pose2Sim looks for points, in a trial's folder.
pub const POSE2SIM_POINTS: &str = "pose-3d";

/// The points of a trial.
#[derive(Clone, Debug, PartialEq)]
pub struct Pose2SimPoints {
    /// Mm, z up: from the first frame with a find to the last.
    pub points: PointTrajectory,
    /// Frames among them without a find, which were filled.
    pub filled: usize,
    /// The file's name as Pose2Sim would have it.
    pub file_name: String,
}

/// The 22 points of Halpe26 over the frames of a trial's track, with its gaps as the configuration wants them.
///
/// # Errors
/// When the folder of the track lacks poses.csv, joints.csv or the body, one of them cannot be read, the body is no person's, or the person is
/// lost in every frame.
pub fn pose2sim_points(trial: &Pose2SimTrial, sequence: &Sequence, folder: &Path) -> Result<Pose2SimPoints> {
    let found = halpe26_points(sequence, folder)?.trimmed();
    ensure!(!found.frames.is_empty(), "the person is lost in every frame, see {}", folder.display());
    let filled = found.frames.iter().filter(|points| is_empty(points)).count();
    let points = with_filled_gaps(found, trial.longest_line, trial.large_gaps);
    let (first, last) = (points.first_frame, points.first_frame + points.frames.len().saturating_sub(1));
    Ok(Pose2SimPoints { file_name: format!("{}_{first}-{last}.trc", trial.name), points, filled })
}

/// The points of earlier runs in a trial's folder, ours or Pose2Sim's: those of its name and any frames; and all other .trc files there.
///
/// # Errors
/// When the folder cannot be read.
pub fn pose2sim_written(trial: &Pose2SimTrial) -> Result<[Vec<PathBuf>; 2]> {
    let folder = trial.dir.join(POSE2SIM_POINTS);
    if !folder.is_dir() {
        return Ok([Vec::new(), Vec::new()]);
    }
    let cannot = || format!("cannot read the folder {}", folder.display());
    let mut names = Vec::new();
    for entry in fs::read_dir(&folder).with_context(cannot)? {
        names.push(entry.with_context(cannot)?.file_name().to_string_lossy().into_owned());
    }
    names.retain(|name| name.to_lowercase().ends_with(".trc"));
    names.sort();
    let (own, others): (Vec<String>, Vec<String>) = names.into_iter().partition(|name| is_of(name, &trial.name));
    Ok([own, others].map(|names| names.into_iter().map(|name| folder.join(name)).collect()))
}

/// Whether it is the name of a trial with two frames.
fn is_of(name: &str, trial: &str) -> bool {
    let range = name.strip_prefix(trial).and_then(|rest| rest.strip_prefix('_')?.strip_suffix(".trc")?.split_once('-'));
    let is_number = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    range.is_some_and(|(first, last)| is_number(first) && is_number(last))
}

/// None where the person is lost.
fn halpe26_points(sequence: &Sequence, folder: &Path) -> Result<PointTrajectory> {
    let body = if sequence.needs_body() { Body::load(&folder.join(BODY)) } else { Body::load(&sequence.body) }?;
    let table = PoseTable::read(&folder.join("poses.csv"), &body)?;
    let mut points = body.halpe26_trajectory(&table, sequence.fps)?;
    // Poses hold the last sure one where joints have a gap.
    let joints = read_points(&folder.join("joints.csv"))?;
    for (points, joints) in points.frames.iter_mut().zip(&joints.frames) {
        if is_empty(joints) {
            points.fill(None);
        }
    }
    Ok(points)
}

fn is_empty(points: &[Option<DVec3>]) -> bool {
    points.iter().all(Option::is_none)
}

fn with_filled_gaps(points: PointTrajectory, longest_line: usize, large: LargeGaps) -> PointTrajectory {
    let mut points = points.interpolated(longest_line);
    match large {
        LargeGaps::Nan => points,
        LargeGaps::LastValue => points.held(),
        LargeGaps::Zeros => {
            for point in points.frames.iter_mut().flatten() {
                point.get_or_insert(DVec3::ZERO);
            }
            points
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gaps_are_filled_as_the_configuration_wants() {
        let gappy = |places: &[f64]| PointTrajectory {
            names: vec!["Hip".into()],
            rate: 60.0,
            first_frame: 0,
            frames: places.iter().map(|&x| vec![(x >= 0.0).then(|| DVec3::new(x, 1.0, 0.0))]).collect(),
            smoothed: None,
        };
        let places = |large| -> Vec<f64> {
            let filled = with_filled_gaps(gappy(&[1.0, -1.0, 3.0, -1.0, -1.0, 9.0]), 1, large);
            filled.frames.iter().map(|points| points[0].map_or(-1.0, |point| point.x)).collect()
        };
        assert_eq!(places(LargeGaps::Nan), [1.0, 2.0, 3.0, -1.0, -1.0, 9.0]);
        assert_eq!(places(LargeGaps::LastValue), [1.0, 2.0, 3.0, 3.0, 3.0, 9.0]);
        assert_eq!(places(LargeGaps::Zeros), [1.0, 2.0, 3.0, 0.0, 0.0, 9.0]);
    }

    #[test]
    fn only_names_of_the_trial_with_two_frames_are_its_own() {
        assert!(is_of("walk_0-99.trc", "walk"));
        for other in
            ["walk_0-99_filt_butterworth.trc", "walk_P0_0-99.trc", "run_0-99.trc", "walk_0-99.c3d", "walk_-9.trc"]
        {
            assert!(!is_of(other, "walk"), "{other}");
        }
    }
}
