//! The distance between a trajectory and its truth (METHOD A10): |p(estimate) - p(truth)| for every point in every frame,
//! its mean over frames and then over points, and the standard deviation of all of them.

use std::io::Write;

use anyhow::{Result, bail, ensure};
use glam::DVec3;

use super::pairing::PointPairs;
use super::points::PointTrajectory;

/// Rates this close (relative) are the same: times in files have few digits. 59.94 and 60 are not.
const SAME_RATE: f64 = 5e-4;

/// How frames of the truth were found for ours.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Matching {
    /// By frame index: both have the same rate, or one does not say its own.
    FrameIndex,
    /// By time, the truth interpolated linearly between its two nearest frames.
    Time,
}

/// The error of one point.
#[derive(Clone, Debug, PartialEq)]
pub struct PointError {
    /// Its name in the truth.
    pub name: String,
    /// Its name in our trajectory.
    pub ours: String,
    /// Frames in which both have it.
    pub frames: usize,
    /// Mean distance, mm.
    pub mean: f64,
    /// Standard deviation of the distance, mm.
    pub std: f64,
    /// Largest distance, mm.
    pub max: f64,
    /// Mean of ours minus the truth, mm: what `remove_offset` takes away.
    pub offset: DVec3,
}

/// The errors of one frame.
#[derive(Clone, Debug, PartialEq)]
pub struct FrameError {
    /// Index of our frame, from 0.
    pub frame: usize,
    /// Mean over the points that both have; `None` where there is none.
    pub mean: Option<f64>,
    /// One entry a point, in the order of [`TrajectoryError::points`].
    pub points: Vec<Option<f64>>,
}

/// The errors of a trajectory.
#[derive(Clone, Debug, PartialEq)]
pub struct TrajectoryError {
    /// How frames were matched.
    pub matching: Matching,
    /// Seconds by which the truth's clock was taken to be ahead: our moment t is compared with the truth's moment t + shift.
    pub shift: f64,
    /// Points that are compared at least once.
    pub points: Vec<PointError>,
    /// Frames of ours that the truth covers.
    pub frames: Vec<FrameError>,
    /// Mean over frames, then over points, mm.
    pub mean: f64,
    /// Standard deviation of all marker-frame errors about their own mean, mm.
    pub std: f64,
    /// Frames of ours that the truth does not cover.
    pub frames_without_truth: usize,
    /// Pairs of point and frame within `frames` in which one side misses the point.
    pub missing: usize,
    /// Names of pairs that no frame compares.
    pub never_seen: Vec<String>,
}

impl TrajectoryError {
    /// Compares `ours` with `truth` over `pairs`. With `remove_offset` each point's constant mean offset is taken away
    /// first: joint definitions differ between systems.
    ///
    /// # Errors
    /// When no frame, or no point in any frame, is in both.
    pub fn between(
        ours: &PointTrajectory,
        truth: &PointTrajectory,
        pairs: &PointPairs,
        remove_offset: bool,
    ) -> Result<Self> {
        Self::shifted(ours, truth, pairs, remove_offset, 0.0)
    }

    /// The same with our moment t compared with the truth's moment t + `shift` seconds, which is interpolated where it lies between
    /// frames.
    ///
    /// # Errors
    /// As [`Self::between`]; and when neither side tells its rate and there is a shift.
    pub fn shifted(
        ours: &PointTrajectory,
        truth: &PointTrajectory,
        pairs: &PointPairs,
        remove_offset: bool,
        shift: f64,
    ) -> Result<Self> {
        let matching = matching(ours, truth);
        let rate = if truth.rate > 0.0 { truth.rate } else { ours.rate };
        ensure!(
            shift == 0.0 || rate > 0.0,
            "a shift of {shift} s is asked for and neither file tells its frame rate, expected one that does"
        );
        let ahead = if shift == 0.0 { 0.0 } else { shift * rate };
        let mut rows = Vec::new();
        for row in 0..ours.frames.len() {
            if let Some(there) = counterpart(ours, truth, matching, row, ahead) {
                let difference =
                    |&(theirs, mine): &(usize, usize)| Some(ours.frames[row][mine]? - there.point(truth, theirs)?);
                rows.push((
                    ours.first_frame + row,
                    pairs.columns().iter().map(difference).collect::<Vec<Option<DVec3>>>(),
                ));
            }
        }
        if rows.is_empty() {
            bail!(
                "the track and the truth share no frame: the track has {}, the truth has {}",
                extent(ours, matching),
                extent(truth, matching)
            );
        }

        let mut points = Vec::new();
        let mut never_seen = Vec::new();
        let mut columns = Vec::new();
        for (column, &(theirs, mine)) in pairs.columns().iter().enumerate() {
            let differences: Vec<DVec3> = rows.iter().filter_map(|(_, row)| row[column]).collect();
            if differences.is_empty() {
                never_seen.push(truth.names[theirs].clone());
                continue;
            }
            let offset = differences.iter().sum::<DVec3>() / differences.len() as f64;
            let removed = if remove_offset { offset } else { DVec3::ZERO };
            let distances: Vec<f64> = differences.iter().map(|d| (*d - removed).length()).collect();
            let (mean, std) = mean_and_std(&distances);
            let max = distances.iter().copied().fold(0.0, f64::max);
            columns.push((column, removed));
            points.push(PointError {
                name: truth.names[theirs].clone(),
                ours: ours.names[mine].clone(),
                frames: distances.len(),
                mean,
                std,
                max,
                offset,
            });
        }
        ensure!(!points.is_empty(), "no point is seen in both the track and the truth in any frame");

        let frames: Vec<FrameError> = rows
            .iter()
            .map(|(frame, row)| {
                let points: Vec<Option<f64>> =
                    columns.iter().map(|&(column, removed)| row[column].map(|d| (d - removed).length())).collect();
                let seen: Vec<f64> = points.iter().flatten().copied().collect();
                let mean = (!seen.is_empty()).then(|| mean_and_std(&seen).0);
                FrameError { frame: *frame, mean, points }
            })
            .collect();
        let all: Vec<f64> = frames.iter().flat_map(|frame| frame.points.iter().flatten().copied()).collect();
        let mean = points.iter().map(|point| point.mean).sum::<f64>() / points.len() as f64;
        Ok(Self {
            matching,
            shift,
            mean,
            std: mean_and_std(&all).1,
            frames_without_truth: ours.frames.len() - frames.len(),
            missing: frames.len() * points.len() - all.len(),
            never_seen,
            points,
            frames,
        })
    }
}

/// The farthest shift that [`best_shift`] looks at, seconds.
pub const FARTHEST_SHIFT: f64 = 1.0;
/// Shifts that leave fewer than this part of the most frames that any of them compares are not looked at.
const FRAMES_LEFT: f64 = 0.5;
/// How finely a shift is found, seconds.
const FINEST_SHIFT: f64 = 1e-4;
/// Shifts that are tried at first on each side at most.
const MOST_SHIFTS: f64 = 120.0;

/// The shift within [`FARTHEST_SHIFT`] with the smallest mean error, for [`TrajectoryError::shifted`]; of equals the smallest.
///
/// # Errors
/// As [`TrajectoryError::shifted`], where no shift can be compared; when neither side tells its rate.
pub fn best_shift(
    ours: &PointTrajectory,
    truth: &PointTrajectory,
    pairs: &PointPairs,
    remove_offset: bool,
) -> Result<f64> {
    let rate = ours.rate.max(truth.rate);
    ensure!(rate > 0.0, "a shift is to be found and neither file tells its frame rate, expected one that does");
    let error = |shift: f64| TrajectoryError::shifted(ours, truth, pairs, remove_offset, shift);
    let mut step = f64::max(1.0 / rate, FARTHEST_SHIFT / MOST_SHIFTS);
    let each_way = (FARTHEST_SHIFT / step).floor() as i32;
    let tried: Vec<(f64, f64, usize)> = (-each_way..=each_way)
        .filter_map(|at| {
            let shift = f64::from(at) * step;
            let error = error(shift).ok()?;
            Some((shift, error.mean, error.frames.len()))
        })
        .collect();
    let most = tried.iter().map(|(.., frames)| *frames).max().unwrap_or(0) as f64;
    let kept = tried.into_iter().filter(|(.., frames)| *frames as f64 >= FRAMES_LEFT * most);
    let Some((mut best, mut least, _)) = kept.min_by(|a, b| a.1.total_cmp(&b.1).then(a.0.abs().total_cmp(&b.0.abs())))
    else {
        return error(0.0).map(|error| error.shift);
    };
    while step > FINEST_SHIFT {
        step /= 2.0;
        for shift in [best - step, best + step] {
            if shift.abs() <= FARTHEST_SHIFT
                && let Ok(error) = error(shift)
                && error.mean < least
                && error.frames.len() as f64 >= FRAMES_LEFT * most
            {
                (best, least) = (shift, error.mean);
            }
        }
    }
    Ok(best)
}

/// Writes the errors frame by frame as CSV: `frame,mean,<point>,…`, mm, empty where one side misses the point.
///
/// # Errors
/// When writing fails.
pub fn write_frame_errors(out: &mut dyn Write, error: &TrajectoryError) -> Result<()> {
    let cell = |value: &Option<f64>| value.map_or_else(String::new, |value| format!("{value:.4}"));
    let mut writer = csv::Writer::from_writer(out);
    writer.write_record(["frame", "mean"].into_iter().chain(error.points.iter().map(|point| point.name.as_str())))?;
    for frame in &error.frames {
        let mut cells = vec![frame.frame.to_string(), cell(&frame.mean)];
        cells.extend(frame.points.iter().map(cell));
        writer.write_record(&cells)?;
    }
    writer.flush()?;
    Ok(())
}

/// Mean and standard deviation of a population.
fn mean_and_std(values: &[f64]) -> (f64, f64) {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let variance = values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / count;
    (mean, variance.sqrt())
}

fn matching(ours: &PointTrajectory, truth: &PointTrajectory) -> Matching {
    let unknown = ours.rate <= 0.0 || truth.rate <= 0.0;
    let equal = (ours.rate - truth.rate).abs() <= SAME_RATE * truth.rate;
    if unknown || equal { Matching::FrameIndex } else { Matching::Time }
}

/// A place on the truth's time line: so far (0..1) from one row towards the next.
struct Counterpart {
    row: usize,
    towards_next: f64,
}

impl Counterpart {
    fn point(&self, truth: &PointTrajectory, column: usize) -> Option<DVec3> {
        let at = truth.frames[self.row][column];
        if self.towards_next == 0.0 {
            return at;
        }
        Some(at?.lerp(truth.frames[self.row + 1][column]?, self.towards_next))
    }
}

/// The place on the truth's time line that is `ahead` rows of it later than a row of ours.
fn counterpart(
    ours: &PointTrajectory,
    truth: &PointTrajectory,
    matching: Matching,
    row: usize,
    ahead: f64,
) -> Option<Counterpart> {
    // The position in rows of the truth; frame indices are far below 2^53, so this is exact.
    let frame = (ours.first_frame + row) as f64;
    let position = match matching {
        Matching::FrameIndex => frame,
        Matching::Time => frame / ours.rate * truth.rate,
    } + ahead
        - truth.first_frame as f64;
    // Times that are meant to coincide do so up to rounding.
    let position = if (position - position.round()).abs() < 1e-6 { position.round() } else { position };
    let last = truth.frames.len().checked_sub(1)?;
    (0.0..=last as f64)
        .contains(&position)
        .then(|| Counterpart { row: position as usize, towards_next: position.fract() })
}

/// Frames or seconds from first to last, for a message.
fn extent(points: &PointTrajectory, matching: Matching) -> String {
    let last = points.frames.len().saturating_sub(1);
    match (matching, points.time(0), points.time(last)) {
        (Matching::Time, Some(from), Some(to)) => format!("{from:.3} s to {to:.3} s"),
        _ => format!("frames {} to {}", points.first_frame, points.first_frame + last),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::test_points::trajectory;
    use proptest::prelude::*;

    fn compare(ours: &PointTrajectory, truth: &PointTrajectory, remove_offset: bool) -> TrajectoryError {
        let pairs = PointPairs::find(ours, truth, &[]).unwrap();
        TrajectoryError::between(ours, truth, &pairs, remove_offset).unwrap()
    }

    #[test]
    fn means_over_frames_then_points() {
        let truth = trajectory(100.0, 0, 4);
        let mut ours = truth.clone();
        // a is off by 3-4-0 in every frame; b by 0, 10 and 20 in z, and missing once.
        for row in &mut ours.frames {
            row[0] = row[0].map(|p| p + DVec3::new(3.0, 4.0, 0.0));
        }
        for (row, error) in [10.0, 20.0].into_iter().enumerate() {
            ours.frames[row + 1][1] = ours.frames[row + 1][1].map(|p| p + DVec3::new(0.0, 0.0, error));
        }
        ours.frames[3][1] = None;
        let error = compare(&ours, &truth, false);
        assert_eq!((error.points[0].mean, error.points[0].std, error.points[0].max), (5.0, 0.0, 5.0));
        assert_eq!((error.points[1].mean, error.points[1].frames, error.points[1].max), (10.0, 3, 20.0));
        assert!((error.points[1].std - (200.0f64 / 3.0).sqrt()).abs() < 1e-12);
        assert_eq!(error.mean, 7.5, "each point counts the same, however often it is seen");
        // All errors: 5 5 5 5 0 10 20, about their own mean 50 / 7.
        let expected = (600.0 / 7.0 - (50.0f64 / 7.0).powi(2)).sqrt();
        assert!((error.std - expected).abs() < 1e-12);
        assert_eq!((error.missing, error.frames_without_truth, error.matching), (1, 0, Matching::FrameIndex));
        assert_eq!(error.frames[2].points, [Some(5.0), Some(20.0)]);
        assert_eq!((error.frames[2].mean, error.frames[3].mean), (Some(12.5), Some(5.0)));

        let mut table = Vec::new();
        write_frame_errors(&mut table, &error).unwrap();
        let expected = "frame,mean,a,b\n0,2.5000,5.0000,0.0000\n1,7.5000,5.0000,10.0000\n2,12.5000,5.0000,20.0000\n3,5.0000,5.0000,\n";
        assert_eq!(String::from_utf8(table).unwrap(), expected);

        let without = compare(&ours, &truth, true);
        assert_eq!(without.points[0].mean, 0.0);
        assert_eq!(without.points[0].offset, DVec3::new(3.0, 4.0, 0.0));
        assert!((without.points[1].mean - 20.0 / 3.0).abs() < 1e-9);
    }

    #[test]
    fn frames_are_matched_by_index_or_time() {
        let (slow, fast) = (trajectory(25.0, 2, 10), trajectory(60.0, 0, 20));
        let by_time = compare(&slow, &fast, false);
        assert_eq!(by_time.matching, Matching::Time);
        // 19/60 s lie within the truth: frames 2 to 7 of 25 a second.
        assert_eq!((by_time.frames.len(), by_time.frames[0].frame, by_time.frames_without_truth), (6, 2, 4));
        assert!(by_time.mean < 1e-9, "points move evenly, so interpolation is exact: {}", by_time.mean);
        let shifted = compare(&trajectory(60.0, 5, 20), &fast, false);
        assert_eq!((shifted.frames.len(), shifted.matching, shifted.mean), (15, Matching::FrameIndex, 0.0));
        let mut unknown = fast.clone();
        unknown.rate = 0.0;
        assert_eq!(compare(&unknown, &fast, false).matching, Matching::FrameIndex);
    }

    #[test]
    fn a_shift_in_time_is_found_and_taken_away() {
        let swing = |rate: f64, late: f64, frames: usize| {
            let mut points = trajectory(rate, 0, frames);
            for (row, points) in points.frames.iter_mut().enumerate() {
                let phase = 5.0 * (row as f64 / rate - late);
                points.fill(Some(DVec3::new(300.0 * phase.sin(), 200.0 * (0.7 * phase).cos(), 900.0)));
            }
            points
        };
        let ours = swing(50.0, 0.0, 200);
        for (rate, late) in [(50.0, 0.36), (50.0, -0.53), (120.0, 0.217), (50.0, 0.0)] {
            let truth = swing(rate, late, 400);
            let pairs = PointPairs::find(&ours, &truth, &[]).unwrap();
            for remove in [false, true] {
                let shift = best_shift(&ours, &truth, &pairs, remove).unwrap();
                assert!((shift - late).abs() < 0.004, "{shift} of {late}");
                let error = TrajectoryError::shifted(&ours, &truth, &pairs, remove, shift).unwrap();
                assert!(error.mean < 2.0 && error.shift == shift, "{}", error.mean);
            }
        }
        let mut unknown = ours.clone();
        unknown.rate = 0.0;
        let pairs = PointPairs::find(&ours, &ours, &[]).unwrap();
        let refused = TrajectoryError::shifted(&unknown, &unknown, &pairs, false, 0.1).unwrap_err().to_string();
        assert!(refused.contains("neither file tells its frame rate"), "{refused}");
    }

    #[test]
    fn a_missing_neighbour_is_not_interpolated_over() {
        let mut fast = trajectory(50.0, 0, 5);
        fast.frames[3][0] = None;
        let error = compare(&trajectory(40.0, 0, 4), &fast, false);
        // Our frames 2 and 3 lie at rows 2.5 and 3.75 of the truth, both beside row 3.
        assert_eq!(error.frames[2].points[0], None);
        assert_eq!(error.frames[3].points[0], None);
        assert_eq!(error.missing, 2);
    }

    #[test]
    fn nothing_in_common_is_a_sentence() {
        let (ours, truth) = (trajectory(60.0, 50, 10), trajectory(60.0, 0, 10));
        let pairs = PointPairs::find(&ours, &truth, &[]).unwrap();
        let message = TrajectoryError::between(&ours, &truth, &pairs, false).unwrap_err().to_string();
        assert!(message.contains("the track has frames 50 to 59, the truth has frames 0 to 9"), "{message}");
        let late = trajectory(25.0, 50, 10);
        let message = TrajectoryError::between(&late, &truth, &pairs, false).unwrap_err().to_string();
        assert!(message.contains("2.000 s to 2.360 s"), "{message}");
        let mut blind = truth.clone();
        blind.frames.iter_mut().flatten().for_each(|p| *p = None);
        let message = TrajectoryError::between(&blind, &truth, &pairs, false).unwrap_err().to_string();
        assert!(message.contains("no point is seen in both"), "{message}");
        blind.frames[0][0] = Some(DVec3::ZERO);
        assert_eq!(TrajectoryError::between(&blind, &truth, &pairs, false).unwrap().never_seen, ["b"]);
    }

    proptest! {
        #[test]
        fn a_constant_offset_is_the_error_and_removing_it_leaves_none(
            offset in [-500.0..500.0f64, -500.0..500.0, -500.0..500.0],
        ) {
            let truth = trajectory(50.0, 0, 7);
            let offset = DVec3::from(offset);
            let mut ours = truth.clone();
            ours.frames.iter_mut().flatten().flatten().for_each(|p| *p += offset);
            let error = compare(&ours, &truth, false);
            prop_assert!((error.mean - offset.length()).abs() < 1e-9);
            prop_assert!(error.std < 1e-6);
            prop_assert!(compare(&ours, &truth, true).mean < 1e-9);
        }
    }
}
