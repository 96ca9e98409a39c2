//! Is a camera early or late? Its silhouettes are taken from some frames earlier or later, and the views agree best where they belong
//! together. Far off, where the silhouettes of a walk share nothing any more, that place is first looked for with few rays.

use std::borrow::Cow;

use super::agreement::{CAP, FEWER_RAYS, Moment, Ray, disagreement, disagreements, rays};
use super::betterment::Betterment;
use super::partners::{fewer, partners};
use super::silhouettes::{SHIFTS, Silhouettes};
use crate::geometry::Camera;

/// Where a shift changes the disagreement by less than this part, nobody moves enough to tell.
const TELLING: f64 = 0.05;

/// Rays a silhouette of the search far off, the samples that it needs at least, and the part of the disagreement that a place must take
/// away: over so many places chance does more than over seven.
pub(super) const FAR_RAYS: usize = 20;
const FAR_SAMPLES: usize = 3;
pub(super) const FAR_COUNTS: f64 = 0.3;
/// Places that take away nearly as much as the best one, by this part of that: the nearest of them is meant, as a gait repeats itself.
const NEARLY: f64 = 0.1;
/// Frames a second that are looked through one by one; at higher rates steps are as long in time.
const EACH: f64 = 30.0;

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

/// The delay of one camera against the others, which are as late as `delays` says; looked for about `about` frames.
pub(super) fn delay(
    cameras: &[Camera],
    silhouettes: &Silhouettes,
    delays: &[isize],
    view: usize,
    about: isize,
) -> Delay {
    let shifted = |sample: usize, shift: isize| {
        silhouettes.moment(sample, |other| if other == view { shift } else { delays[other] })
    };
    let shifts = || SHIFTS.map(move |shift| about + shift);
    // The same samples for every shift: those that have all their neighbours.
    let has_all = |sample: &usize| shifts().chain([0]).all(|shift| shifted(*sample, shift).is_some());
    let samples: Vec<usize> = silhouettes.samples.iter().copied().filter(has_all).collect();
    if samples.is_empty() {
        return Delay::NoNeighbours;
    }
    let (group, own_cameras) = group(cameras, view);
    let count = fewer(FEWER_RAYS, cameras.len());
    let seen = |shift: isize| -> Vec<Ray> {
        let own = |&sample: &usize| {
            let moment = shifted(sample, shift)?;
            Some(group.iter().map(|&view| moment[view]).collect())
        };
        let moments: Vec<Moment> = samples.iter().filter_map(own).collect();
        rays(&own_cameras, &moments, count)
    };
    let curve: Vec<(isize, Vec<Ray>)> = shifts().map(|shift| (shift, seen(shift))).collect();
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
    let unmoved = curve
        .iter()
        .find(|(shift, _)| *shift == 0)
        .map_or_else(|| Cow::Owned(seen(0)), |(_, rays)| Cow::Borrowed(rays));
    let most = whole.iter().copied().chain([disagreement(unmoved.iter(), CAP)]).fold(0.0, f64::max);
    let Some((at, part)) = lowest(&whole) else { return Delay::NoNeighbours };
    if most - whole[at] < TELLING * most.max(0.1) {
        return Delay::NobodyMoves;
    }
    let (shift, ref after) = curve[at];
    let betterment = Betterment::of(&unmoved, after, samples.len());
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

/// A view and those that it is compared with, by themselves.
fn group(cameras: &[Camera], view: usize) -> (Vec<usize>, Vec<Camera>) {
    let mut group = partners(view, cameras.len());
    group.push(view);
    group.sort_unstable();
    let own = group.iter().map(|&view| cameras[view].clone()).collect();
    (group, own)
}

/// About how many frames, farther than [`SHIFTS`] reaches, one camera is late, where it agrees much better with the others there. `fps` are
/// the sequence's.
pub(super) fn far(
    cameras: &[Camera],
    silhouettes: &Silhouettes,
    delays: &[isize],
    view: usize,
    fps: f64,
) -> Option<isize> {
    let (group, own_cameras) = group(cameras, view);
    let count = fewer(FAR_RAYS, cameras.len());
    let step = (fps / EACH).round().max(1.0) as usize;
    let reach = silhouettes.reach as isize;
    // At each sample that there is: the disagreement.
    let seen = |shift: isize| -> Vec<Option<f64>> {
        let (mut places, mut moments): (Vec<usize>, Vec<Moment>) = (Vec::new(), Vec::new());
        for (place, &sample) in silhouettes.samples.iter().enumerate() {
            let moment = silhouettes.moment(sample, |other| if other == view { shift } else { delays[other] });
            if let Some(moment) = moment.filter(|moment| moment[view].is_some()) {
                places.push(place);
                moments.push(group.iter().map(|&view| moment[view]).collect());
            }
        }
        let found = disagreements(&rays(&own_cameras, &moments, count), moments.len(), CAP);
        let mut all = vec![None; silhouettes.samples.len()];
        places.into_iter().zip(found).for_each(|(place, found)| all[place] = found);
        all
    };
    let unmoved = seen(0);
    let left = |shift: isize| -> Option<(isize, f64)> {
        let pairs: Vec<(f64, f64)> =
            unmoved.iter().zip(seen(shift)).filter_map(|(before, after)| Some(((*before)?, after?))).collect();
        let (before, after) = pairs.iter().fold((0.0, 0.0), |sum, pair| (sum.0 + pair.0, sum.1 + pair.1));
        (pairs.len() >= FAR_SAMPLES && before > 0.0).then_some((shift, after / before))
    };
    let places: Vec<(isize, f64)> = (-reach..=reach).step_by(step).filter_map(left).collect();
    let least = places.iter().map(|(_, left)| *left).fold(1.0, f64::min);
    let enough = least + NEARLY * (1.0 - least);
    let (about, left) =
        places.into_iter().filter(|(_, left)| *left <= enough).min_by_key(|(shift, _)| shift.unsigned_abs())?;
    (1.0 - left >= FAR_COUNTS && !SHIFTS.contains(&about)).then_some(about)
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
