//! Is a camera early or late? Its silhouettes are taken from some frames earlier or later, and the views agree best where they belong
//! together.

use super::agreement::{CAP, FEWER_RAYS, Moment, Ray, disagreements, rays};
use super::betterment::Betterment;
use super::partners::{fewer, partners};
use super::silhouettes::{SHIFTS, Silhouettes};
use crate::geometry::Camera;

/// Where a shift changes the disagreement by less than this part, nobody moves enough to tell.
const TELLING: f64 = 0.05;

/// How late a camera is.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Delay {
    /// The frames looked at have no neighbours.
    NoNeighbours,
    /// Every shift agrees as well as any other.
    NobodyMoves,
    /// Frames: whole ones, with the part that the neighbours' agreement tells, its scatter over the moments, and what moving the camera by
    /// the whole ones betters.
    Late { shift: isize, late: f64, scatter: f64, betterment: Betterment },
}

/// The delay of one camera against the others, which are as late as `delays` says.
pub(super) fn delay(cameras: &[Camera], silhouettes: &Silhouettes, delays: &[isize], view: usize) -> Delay {
    let shifted = |sample: usize, shift: isize| {
        silhouettes.moment(sample, |other| if other == view { shift } else { delays[other] })
    };
    // The same samples for every shift: those that have all their neighbours.
    let has_all = |sample: &usize| SHIFTS.into_iter().all(|shift| shifted(*sample, shift).is_some());
    let samples: Vec<usize> = silhouettes.samples.iter().copied().filter(has_all).collect();
    if samples.is_empty() {
        return Delay::NoNeighbours;
    }
    // The view and those that it is compared with, by themselves.
    let mut group = partners(view, cameras.len());
    group.push(view);
    group.sort_unstable();
    let own_cameras: Vec<Camera> = group.iter().map(|&view| cameras[view].clone()).collect();
    let count = fewer(FEWER_RAYS, cameras.len());
    let seen = |shift: isize| -> Vec<Ray> {
        let own = |&sample: &usize| {
            let moment = shifted(sample, shift)?;
            Some(group.iter().map(|&view| moment[view]).collect())
        };
        let moments: Vec<Moment> = samples.iter().filter_map(own).collect();
        rays(&own_cameras, &moments, count)
    };
    let curve: Vec<(isize, Vec<Ray>)> = SHIFTS.map(|shift| (shift, seen(shift))).collect();
    let values: Vec<Vec<Option<f64>>> = curve.iter().map(|(_, rays)| disagreements(rays, samples.len(), CAP)).collect();
    let without = |left_out: Option<usize>| -> Vec<f64> {
        let mean = |values: &Vec<Option<f64>>| {
            let kept = values.iter().enumerate().filter(|(moment, _)| Some(*moment) != left_out);
            let (sum, count) =
                kept.filter_map(|(_, value)| *value).fold((0.0, 0.0), |(sum, count), value| (sum + value, count + 1.0));
            sum / f64::max(count, 1.0)
        };
        values.iter().map(mean).collect()
    };
    let whole = without(None);
    let most = whole.iter().copied().fold(0.0, f64::max);
    let Some((at, part)) = lowest(&whole) else { return Delay::NoNeighbours };
    if most - whole[at] < TELLING * most.max(0.1) {
        return Delay::NobodyMoves;
    }
    let (shift, ref after) = curve[at];
    let unmoved = curve.iter().find(|(shift, _)| *shift == 0).map_or(after, |(_, rays)| rays);
    let betterment = Betterment::of(unmoved, after, samples.len());
    // The scatter of the estimates that leave out one moment each (the jackknife).
    let place = |(at, part): (usize, f64)| at as f64 + part;
    let estimates: Vec<f64> =
        (0..samples.len()).filter_map(|moment| lowest(&without(Some(moment))).map(place)).collect();
    let count = estimates.len() as f64;
    let mean = estimates.iter().sum::<f64>() / count;
    let scatter =
        ((count - 1.0) / count * estimates.iter().map(|estimate| (estimate - mean).powi(2)).sum::<f64>()).sqrt();
    // Frames taken from later on agree with the others: this camera's pictures come that much too late.
    Delay::Late { shift, late: shift as f64 + part, scatter, betterment }
}

/// Where in a curve it is lowest: the place, and the part of a place by which the parabola through its neighbours is lower beside it.
fn lowest(curve: &[f64]) -> Option<(usize, f64)> {
    let (at, least) = curve.iter().copied().enumerate().min_by(|a, b| a.1.total_cmp(&b.1))?;
    let beside = |at: Option<usize>| curve.get(at?).copied();
    let part = match (beside(at.checked_sub(1)), beside(Some(at + 1))) {
        (Some(before), Some(after)) => {
            let bend = before - 2.0 * least + after;
            if bend > 0.0 { 0.5 * (before - after) / bend } else { 0.0 }
        }
        _ => 0.0,
    };
    Some((at, part))
}
