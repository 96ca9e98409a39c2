//! The error against a sequence's truth while it is tracked, and in the end (METHOD A10).

use std::path::{Path, PathBuf};

use anyhow::{Context, Result};

use super::held::Held;
use crate::body::{Body, PoseTable};
use crate::motion::{PointPairs, PointTrajectory, TrajectoryError, read_points};

/// What of the body the truth is compared with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Compared {
    /// Its virtual markers.
    Markers,
    /// Its joints.
    Joints,
}

impl Compared {
    /// For messages.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Markers => "markers",
            Self::Joints => "joints",
        }
    }

    fn of(self, body: &Body, poses: &PoseTable, rate: f64) -> Result<PointTrajectory> {
        match self {
            Self::Markers => body.marker_trajectory(poses, rate),
            Self::Joints => body.joint_trajectory(poses, rate),
        }
    }
}

/// The truth and how it is compared.
pub(super) struct Truth {
    path: PathBuf,
    pub(super) compared: Compared,
    points: PointTrajectory,
    pairs: PointPairs,
    /// Sum and number of the frames' mean errors so far.
    running: (f64, usize),
}

impl Truth {
    /// What a user should know of the truth's file.
    pub(super) fn remark(&self) -> Option<String> {
        self.points.same_labels().map(|note| format!("{}: {note}", self.path.display()))
    }

    /// Reads the truth and pairs its points with the body's markers or, failing that, joints of equal name.
    ///
    /// # Errors
    /// When the file cannot be read. A truth without a name in common is not an error but `Ok(Err(why))`: tracking
    /// needs no truth, and `pantin score --map` can pair it.
    pub(super) fn read(path: &Path, body: &Body, fps: f64) -> Result<Result<Self, String>> {
        let points = read_points(path)?;
        let poses = PoseTable { frames: vec![0], poses: vec![body.standing_pose()] };
        let mut refusals = Vec::new();
        for compared in [Compared::Markers, Compared::Joints] {
            let ours = compared.of(body, &poses, fps)?;
            if ours.names.is_empty() {
                continue;
            }
            match PointPairs::find(&ours, &points, &[]) {
                Ok(pairs) => {
                    return Ok(Ok(Self { path: path.to_path_buf(), compared, points, pairs, running: (0.0, 0) }));
                }
                Err(refusal) => refusals.push(format!("{}: {refusal}", compared.name())),
            }
        }
        Ok(Err(format!("{} is not compared with: {}", path.display(), refusals.join("; "))))
    }

    /// The points of the truth.
    pub(super) fn points(&self) -> &PointTrajectory {
        &self.points
    }

    /// The error of all frames of a track; its gaps have none.
    pub(super) fn error(&self, body: &Body, held: &Held, fps: f64) -> Result<TrajectoryError> {
        self.error_of(&held.with_gaps(self.compared.of(body, &held.table, fps)?))
    }

    fn error_of(&self, ours: &PointTrajectory) -> Result<TrajectoryError> {
        TrajectoryError::between(ours, &self.points, &self.pairs, false)
            .with_context(|| format!("cannot compare the track with {}", self.path.display()))
    }

    /// Takes in a frame and gives the mean over frames so far of their mean errors, mm.
    pub(super) fn running_error(&mut self, body: &Body, frame: usize, pose: &[f32], fps: f64) -> Option<f64> {
        let poses = PoseTable { frames: vec![frame], poses: vec![pose.iter().map(|v| f64::from(*v)).collect()] };
        // A frame that the truth leaves out has no error.
        let ours = self.compared.of(body, &poses, fps).ok()?;
        let error = self.error_of(&ours).ok().and_then(|error| error.frames.first()?.mean);
        if let Some(error) = error {
            self.running = (self.running.0 + error, self.running.1 + 1);
        }
        self.mean_error()
    }

    /// The mean over the frames taken in, mm.
    pub(super) fn mean_error(&self) -> Option<f64> {
        (self.running.1 > 0).then(|| self.running.0 / self.running.1 as f64)
    }
}
