//! Which of many views are used: a calibration takes its knowledge from boards that lie differently in the pictures, and its
//! time from their number.

use glam::DVec2;

use super::homography::homography;
use super::target::{Board, BoardMoment, SeenCorner};

/// The four outer corners of a board in one camera's picture, over the picture's diagonal: place, distance and tilt at once.
pub(super) type Outline = [DVec2; 4];

/// The outline of what a camera sees of the board; None where it is no plane's image.
pub(super) fn outline(board: &Board, seen: &[SeenCorner], size: [u32; 2]) -> Option<Outline> {
    let mapping = homography(board, seen)?;
    let [columns, rows] = board.corners.map(|count| f64::from(count - 1) * board.square);
    let diagonal = f64::from(size[0]).hypot(f64::from(size[1]));
    let image = |x: f64, y: f64| {
        let at = mapping * glam::DVec3::new(x, y, 1.0);
        at.truncate() / at.z / diagonal
    };
    Some([image(0.0, 0.0), image(columns, 0.0), image(0.0, rows), image(columns, rows)])
}

/// One camera's outlines, a list of one a moment, and the moments at which there is one.
pub(super) fn of_camera(outlines: &[Vec<Option<Outline>>], camera: usize) -> (Vec<Vec<Option<Outline>>>, Vec<usize>) {
    let own: Vec<Vec<_>> = outlines.iter().map(|views| vec![views[camera]]).collect();
    let seen = (0..own.len()).filter(|&moment| own[moment][0].is_some()).collect();
    (own, seen)
}

/// Up to `most` of the candidates, each as far as possible from those chosen before it; the first is the one with the most
/// corners. Candidates are places in `moments`; outlines hold one a moment and camera.
pub(super) fn spread(
    candidates: &[usize],
    moments: &[BoardMoment],
    outlines: &[Vec<Option<Outline>>],
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
fn distance(one: &[Option<Outline>], other: &[Option<Outline>]) -> f64 {
    let both = one.iter().zip(other).filter_map(|(one, other)| Some((one.as_ref()?, other.as_ref()?)));
    let apart = |(one, other): (&Outline, &Outline)| {
        one.iter().zip(other).map(|(a, b)| a.distance_squared(*b)).sum::<f64>().sqrt()
    };
    // No camera in common: as different as can be.
    both.map(apart).reduce(f64::max).unwrap_or(f64::INFINITY)
}
