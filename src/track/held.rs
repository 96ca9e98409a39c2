//! The poses of a track with its gaps.

use super::confidence::FrameConfidence;
use super::journal::FrameResult;
use crate::body::PoseTable;
use crate::motion::PointTrajectory;

/// The poses of a track as its files hold them: where the person is lost, and such frames are to be gaps, the last sure pose
/// before stands in (the first after, where there is none), so that every frame has its row.
pub(super) struct Held {
    pub(super) table: PoseTable,
    /// Rows that are gaps.
    gaps: Vec<usize>,
    /// Cut-off, Hz, where the poses were smoothed.
    pub(super) smoothed: Option<f64>,
}

impl Held {
    /// Of results and their confidence; without gaps when `has_gaps` says so.
    pub(super) fn new(results: &[FrameResult], confidences: &[FrameConfidence], has_gaps: bool) -> Self {
        let lost = |row: usize| has_gaps && confidences.get(row).is_some_and(|confidence| confidence.is_lost);
        let first_sure = (0..results.len()).find(|&row| !lost(row)).unwrap_or(0);
        let mut held = first_sure;
        let poses = (0..results.len()).map(|row| {
            held = if lost(row) { held } else { row };
            results[held].pose.iter().map(|value| f64::from(*value)).collect()
        });
        let table = PoseTable { poses: poses.collect(), frames: results.iter().map(|result| result.frame).collect() };
        Self { table, gaps: (0..results.len()).filter(|&row| lost(row)).collect(), smoothed: None }
    }

    /// Takes the points of the gaps out of a trajectory of the table, and has it say how the poses were smoothed.
    pub(super) fn with_gaps(&self, mut points: PointTrajectory) -> PointTrajectory {
        for &row in &self.gaps {
            points.frames[row].fill(None);
        }
        points.smoothed = self.smoothed;
        points
    }

    /// How many rows are gaps.
    pub(super) fn gap_count(&self) -> usize {
        self.gaps.len()
    }

    /// Rows that are no gaps.
    pub(super) fn sure(&self) -> Vec<usize> {
        (0..self.table.frames.len()).filter(|row| self.gaps.binary_search(row).is_err()).collect()
    }

    /// Runs of rows that are gaps.
    pub(super) fn runs(&self) -> Vec<[usize; 2]> {
        runs_of(self.gaps.iter().copied())
    }

    /// The frames of the first and the last row of each run.
    pub(super) fn frames_of(&self, runs: &[[usize; 2]]) -> Vec<[usize; 2]> {
        runs.iter().map(|run| run.map(|row| self.table.frames[row])).collect()
    }
}

/// Runs of rising rows: the first and the last of each. A run in real time passes frames over, so rows follow each other where frames do not.
pub(super) fn runs_of(rows: impl Iterator<Item = usize>) -> Vec<[usize; 2]> {
    let mut runs: Vec<[usize; 2]> = Vec::new();
    for row in rows {
        match runs.last_mut() {
            Some([_, last]) if *last + 1 == row => *last = row,
            _ => runs.push([row, row]),
        }
    }
    runs
}
