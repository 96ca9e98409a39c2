//! Which of many views are used: a calibration takes its knowledge from boards that lie differently in the pictures, and its
//! time from their number.

use glam::DVec2;

use super::homography::homography;
use super::target::{Board, BoardMoment, SeenCorner};

/// The four outer corners of a board in one camera's picture, over the picture's diagonal: place, distance and tilt at once.
pub(super) fn outline(board: &Board, seen: &[SeenCorner], size: [u32; 2]) -> Option<[DVec2; 4]> {
    let mapping = homography(board, seen)?;
    let [columns, rows] = board.corners.map(|count| f64::from(count - 1) * board.square);
    let diagonal = f64::from(size[0]).hypot(f64::from(size[1]));
    let image = |x: f64, y: f64| {
        let at = mapping * glam::DVec3::new(x, y, 1.0);
        at.truncate() / at.z / diagonal
    };
    Some([image(0.0, 0.0), image(columns, 0.0), image(0.0, rows), image(columns, rows)])
}

/// Up to `most` of the candidates, each as far as possible from those chosen before it; the first is the one with the most
/// corners. Candidates are places in `moments`; outlines hold one a moment and camera.
pub(super) fn spread(
    candidates: &[usize],
    moments: &[BoardMoment],
    outlines: &[Vec<Option<[DVec2; 4]>>],
    most: usize,
) -> Vec<usize> {
    let corners = |moment: usize| moments[moment].views.iter().map(Vec::len).sum::<usize>();
    let Some(&first) = candidates.iter().max_by_key(|&&moment| (corners(moment), usize::MAX - moment)) else {
        return Vec::new();
    };
    let mut chosen = vec![first];
    let mut nearest: Vec<f64> = candidates.iter().map(|&at| distance(&outlines[at], &outlines[first])).collect();
    while chosen.len() < most.min(candidates.len()) {
        let farthest = nearest.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1).then(b.0.cmp(&a.0)));
        let Some((next, _)) = farthest.filter(|(_, away)| **away > 0.0) else { break };
        let next = candidates[next];
        chosen.push(next);
        for (away, &at) in nearest.iter_mut().zip(candidates) {
            *away = away.min(distance(&outlines[at], &outlines[next]));
        }
    }
    chosen
}

/// How differently the board lies at two moments, to the cameras that see it at both; those that see it at one say nothing.
fn distance(one: &[Option<[DVec2; 4]>], other: &[Option<[DVec2; 4]>]) -> f64 {
    let both = one.iter().zip(other).filter_map(|(one, other)| Some((one.as_ref()?, other.as_ref()?)));
    let apart = |(one, other): (&[DVec2; 4], &[DVec2; 4])| {
        one.iter().zip(other).map(|(a, b)| a.distance_squared(*b)).sum::<f64>().sqrt()
    };
    // No camera in common: as different as can be.
    both.map(apart).reduce(f64::max).unwrap_or(f64::INFINITY)
}
