//! Every frame searched again near where the frames around it lead to expect it: on a parabola through them, the frame itself left out, so
//! that what moves and turns evenly is not flattened (METHOD A14).

use anyhow::Result;
use glam::DVec3;

use super::scorer::{Candidate, Effort, Pull, Scorer, most_under};
use super::section::Section;
use super::team::Team;
use super::window::Seen;
use crate::features::Observation;

/// Times that every frame is searched again, and generations of that.
pub(super) const ROUNDS: usize = 2;
const REFINED: usize = 14;
/// What one of these times is of the second pass's work on a frame, in parts of it.
pub(super) const SHARE: usize = 1;
/// Width of these searches, as a share of that of a track's.
const NARROW: f32 = 0.15;

/// How long before and after a frame others tell of it, s.
const REACH: f64 = 0.05;
/// Frames before and after it, at least and at most.
const FRAMES: [usize; 2] = [2, 6];
/// How far off a joint may be that stands still, mm, and what its speed adds, as a share of its way in a frame.
const STILL: f64 = 20.0;
const MOVING: f64 = 0.4;

/// A frame's pose and its joints.
#[derive(Clone, Debug)]
pub(super) struct Settled {
    /// Its number.
    pub(super) frame: usize,
    pub(super) pose: Vec<f32>,
    pub(super) points: Vec<DVec3>,
}

/// How many frames on either side tell of a frame.
pub(super) fn reach(fps: f64) -> usize {
    ((REACH * fps).round() as usize).clamp(FRAMES[0], FRAMES[1])
}

/// Weights of the frames at `places` (frames from the one that is expected, which is none of them) of the parabola by least squares through
/// them; of a line, or their mean, where they are too few.
fn weights(places: &[f64]) -> Vec<f64> {
    let degree = match places.len() {
        0 | 1 => 0,
        2 | 3 => 1,
        _ => 2,
    };
    // Normal equations of the polynomial, whose value at 0 is its first coefficient.
    let power = |k: usize| places.iter().map(|x| x.powi(k as i32)).sum::<f64>();
    let size = degree + 1;
    let mut rows = [[0.0; 4]; 3];
    for (i, row) in rows.iter_mut().enumerate().take(size) {
        (0..size).for_each(|j| row[j] = power(i + j));
        row[3] = if i == 0 { 1.0 } else { 0.0 };
    }
    for i in 0..size {
        let pivot = rows[i][i];
        if pivot.abs() < 1e-12 {
            let even = 1.0 / places.len().max(1) as f64;
            return vec![even; places.len()];
        }
        for other in 0..size {
            if other != i {
                let factor = rows[other][i] / pivot;
                (0..4).for_each(|j| rows[other][j] -= factor * rows[i][j]);
            }
        }
    }
    let solved: Vec<f64> = (0..size).map(|i| rows[i][3] / rows[i][i]).collect();
    places.iter().map(|x| solved.iter().enumerate().map(|(k, c)| c * x.powi(k as i32)).sum()).collect()
}

/// Searches the frames `searched` of those seen again, `rounds` times; the others of `poses`, and those before the frames seen, stay. Sections
/// are searched side by side: of frames in others, one knows what the round before found.
///
/// # Errors
/// When the evaluator fails.
pub(super) fn refine(
    team: &mut Team<'_>,
    seen: &[&Seen],
    searched: &[usize],
    sections: &[Section],
    poses: &mut [Settled],
    [reach, rounds]: [usize; 2],
) -> Result<()> {
    let first = poses.len() - seen.len();
    for round in 0..rounds {
        let within = |section: &Section| {
            let mut order: Vec<usize> = searched.iter().copied().filter(|t| section.frames.contains(t)).collect();
            if round % 2 == 1 {
                order.reverse();
            }
            order
        };
        let jobs = sections.iter().map(|section| (section, within(section))).filter(|(_, order)| !order.is_empty());
        let found = team.share(jobs, |scorer, (section, order)| {
            let narrow: Vec<f32> = section.spread.iter().map(|spread| NARROW * spread).collect();
            let from = (first + section.frames.start).saturating_sub(reach);
            let to = (first + section.frames.end + reach).min(poses.len());
            let mut poses = poses[from..to].to_vec();
            for t in &order {
                scorer.observe(&seen[*t].observations)?;
                let at = first + t - from;
                poses[at] = beside(scorer, &narrow, &poses, at, reach, round)?;
                scorer.has_worked(SHARE)?;
            }
            Ok(order.into_iter().map(|t| (first + t, poses[first + t - from].clone())).collect::<Vec<_>>())
        })?;
        for (at, settled) in found.into_iter().flatten() {
            poses[at] = settled;
        }
    }
    Ok(())
}

/// Searches a frame that waited for those after it again; `at` is its place among the frames known around it.
///
/// # Errors
/// When the evaluator fails.
pub(super) fn refine_one(
    scorer: &mut Scorer<'_>,
    observations: &[Observation],
    spread: &[f32],
    poses: &[Settled],
    at: usize,
    reach: usize,
) -> Result<Settled> {
    scorer.observe(observations)?;
    let narrow: Vec<f32> = spread.iter().map(|spread| NARROW * spread).collect();
    beside(scorer, &narrow, poses, at, reach, 0)
}

/// What a search of frame `at`, which is observed, finds close to where the frames around it expect it.
fn beside(
    scorer: &mut Scorer<'_>,
    narrow: &[f32],
    poses: &[Settled],
    at: usize,
    reach: usize,
    round: usize,
) -> Result<Settled> {
    let Expected { mut pose, pull } = expected(poses, at, reach);
    scorer.space.clamp(&mut pose);
    let half = pose.iter().zip(&poses[at].pose).map(|(a, b)| 0.5 * (a + b)).collect();
    let starts = [poses[at].pose.clone(), half, pose];
    let start = most_under(&scorer.candidates(&starts)?, Some(&pull));
    let generations = scorer.generations(REFINED);
    let effort = Effort { spread: narrow, generations, turn: 200 + round as u64 };
    let frame = poses[at].frame;
    let Candidate { pose, points, .. } = scorer.search_all(frame, &starts[start], effort, Some(&pull))?;
    Ok(Settled { frame, pose, points })
}

/// What the frames around a frame expect of it.
struct Expected {
    /// The degrees of freedom; not held within the limits.
    pose: Vec<f32>,
    pull: Pull,
}

/// What is expected of the frame at `at`, from those up to `reach` places away.
fn expected(poses: &[Settled], at: usize, reach: usize) -> Expected {
    let range = at.saturating_sub(reach)..(at + reach + 1).min(poses.len());
    let around: Vec<usize> = range.filter(|&t| t != at).collect();
    let places: Vec<f64> = around.iter().map(|&t| poses[t].frame as f64 - poses[at].frame as f64).collect();
    let weights = weights(&places);
    let mut pose = vec![0.0; poses[at].pose.len()];
    let mut targets = vec![DVec3::ZERO; poses[at].points.len()];
    for (&t, &weight) in around.iter().zip(&weights) {
        pose.iter_mut().zip(&poses[t].pose).for_each(|(sum, value)| *sum += weight as f32 * value);
        targets.iter_mut().zip(&poses[t].points).for_each(|(sum, point)| *sum += weight * *point);
    }
    let scales = (0..targets.len()).map(|joint| STILL + MOVING * speed(poses, joint, &around)).collect();
    Expected { pose, pull: Pull { targets, scales } }
}

/// How far a joint goes in a frame, mm, on the straight way through the frames.
fn speed(poses: &[Settled], joint: usize, around: &[usize]) -> f64 {
    let [Some(&first), Some(&last)] = [around.first(), around.last()] else { return 0.0 };
    if last == first {
        return 0.0;
    }
    // The longer of the two halves: at a turning point the whole way is short.
    let middle = (first + last) / 2;
    let way = |a: usize, b: usize| {
        let frames = poses[b].frame - poses[a].frame;
        if frames == 0 { 0.0 } else { poses[a].points[joint].distance(poses[b].points[joint]) / frames as f64 }
    };
    way(first, middle).max(way(middle, last))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_turns_evenly_is_expected_where_it_is() {
        let parabola = |x: f64| 3.0 - 2.0 * x + 0.7 * x * x;
        for places in [&[-2.0, -1.0, 1.0, 2.0][..], &[-3.0, -1.0, 1.0, 2.0, 4.0], &[1.0, 2.0, 3.0, 4.0]] {
            let weights = weights(places);
            let value: f64 = weights.iter().zip(places).map(|(weight, &x)| weight * parabola(x)).sum();
            assert!((value - 3.0).abs() < 1e-9, "{places:?}: {value}");
        }
        // Too few for a parabola: a line, then a mean.
        assert_eq!(weights(&[-1.0, 1.0]), [0.5, 0.5]);
        assert_eq!(weights(&[1.0]), [1.0]);
        assert!(weights(&[]).is_empty());
    }

    #[test]
    fn more_frames_a_second_tell_more() {
        assert_eq!([10.0, 25.0, 60.0, 1000.0].map(reach), [2, 2, 3, 6]);
    }
}
