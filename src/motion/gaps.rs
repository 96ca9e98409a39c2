//! Gaps of a trajectory, for programs that want every point in every frame.

use std::ops::Range;

use super::PointTrajectory;

impl PointTrajectory {
    /// Without the frames at both ends that hold no point; no frames at all where none holds any.
    #[must_use]
    pub fn trimmed(mut self) -> Self {
        let is_empty = |points: &Vec<Option<glam::DVec3>>| points.iter().all(Option::is_none);
        let begin = self.frames.iter().take_while(|points| is_empty(points)).count();
        let end = self.frames.iter().rev().take_while(|points| is_empty(points)).count();
        self.frames.truncate((self.frames.len() - end).max(begin));
        self.frames.drain(..begin);
        self.first_frame += begin;
        self
    }

    /// With straight lines over every point's gaps of at most `longest` frames that have an end on both sides.
    #[must_use]
    pub fn interpolated(mut self, longest: usize) -> Self {
        for point in 0..self.names.len() {
            for gap in self.gaps(point) {
                let ends = [gap.start.checked_sub(1), Some(gap.end)];
                let [Some(before), Some(after)] = ends.map(|row| self.frames.get(row?)?[point]) else { continue };
                if gap.len() > longest {
                    continue;
                }
                let steps = (gap.len() + 1) as f64;
                for row in gap.clone() {
                    let share = (row + 1 - gap.start) as f64 / steps;
                    self.frames[row][point] = Some(before.lerp(after, share));
                }
            }
        }
        self
    }

    /// With the last place before in every gap, and the first after where there is none before.
    #[must_use]
    pub fn held(mut self) -> Self {
        for point in 0..self.names.len() {
            for gap in self.gaps(point) {
                let before = gap.start.checked_sub(1).and_then(|row| self.frames[row][point]);
                let place = before.or_else(|| self.frames.get(gap.end)?[point]);
                for row in gap {
                    self.frames[row][point] = place;
                }
            }
        }
        self
    }

    /// The rows of each gap of a point.
    fn gaps(&self, point: usize) -> Vec<Range<usize>> {
        let mut gaps: Vec<Range<usize>> = Vec::new();
        for row in (0..self.frames.len()).filter(|&row| self.frames[row][point].is_none()) {
            match gaps.last_mut() {
                Some(gap) if gap.end == row => gap.end = row + 1,
                _ => gaps.push(row..row + 1),
            }
        }
        gaps
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    /// One point on the x axis, a gap where the number is negative.
    fn along(places: &[f64]) -> PointTrajectory {
        let frames = places.iter().map(|&x| vec![(x >= 0.0).then(|| DVec3::new(x, 0.0, 0.0))]).collect();
        PointTrajectory { names: vec!["a".into()], rate: 50.0, first_frame: 10, frames, smoothed: None }
    }

    fn places(points: &PointTrajectory) -> Vec<f64> {
        points.frames.iter().map(|points| points[0].map_or(-1.0, |point| point.x)).collect()
    }

    #[test]
    fn ends_go_and_inner_gaps_stay() {
        let trimmed = along(&[-1.0, -1.0, 3.0, -1.0, 4.0, -1.0]).trimmed();
        assert_eq!((trimmed.first_frame, places(&trimmed)), (12, vec![3.0, -1.0, 4.0]));
        let empty = along(&[-1.0, -1.0]).trimmed();
        assert!(empty.frames.is_empty());
        let whole = along(&[1.0, 2.0]);
        assert_eq!(whole.clone().trimmed(), whole);
    }

    #[test]
    fn short_gaps_are_lines_and_long_ones_hold() {
        let gappy = along(&[-1.0, 0.0, -1.0, -1.0, 3.0, -1.0, -1.0, -1.0, 9.0, -1.0]);
        let lines = gappy.interpolated(2);
        assert_eq!(places(&lines), [-1.0, 0.0, 1.0, 2.0, 3.0, -1.0, -1.0, -1.0, 9.0, -1.0]);
        assert_eq!(places(&lines.held()), [0.0, 0.0, 1.0, 2.0, 3.0, 3.0, 3.0, 3.0, 9.0, 9.0]);
        assert_eq!(places(&along(&[-1.0]).held()), [-1.0]);
    }
}
