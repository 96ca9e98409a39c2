//! Do the silhouettes of one moment agree? A ray through a silhouette's border touches the person, so somewhere along it
//! every other camera must see the person too. By how many pixels the best point of the ray misses their silhouettes is
//! what the cameras disagree about: nothing where the calibration is right, and no model of the person is needed.

use glam::{DMat3, DVec2, DVec3};
use rayon::prelude::*;

use super::partners::partners;
use super::signed_distance::SignedDistance;
use super::surely_far::{SurelyFar, is_far};
use crate::geometry::Camera;

/// Half the stretch of a ray that is searched, mm: a person's reach and some error.
const REACH: f64 = 1600.0;
/// First and last step along a ray, mm.
const COARSE: f64 = 40.0;
const FINE: f64 = 2.5;
/// To either side of a ray's best point: where the slopes there are measured, and as far as a small change is taken to move it, mm.
const BESIDE: f64 = 10.0;
const NEAR: f64 = 20.0;

/// Rays a silhouette for a search that needs many of them.
pub(super) const FEWER_RAYS: usize = 60;
/// A border ray that misses the other silhouettes by more than this many pixels is not explained by them.
pub(super) const EXPLAINED: f64 = 1.5;
/// What share of the border rays the other views explain where silhouettes are whole, and where calibration and pictures belong together
/// at all, %: what lies between is silhouettes that lose parts.
pub(super) const WELL_EXPLAINED: f64 = 80.0;
pub(super) const HARDLY_EXPLAINED: f64 = 40.0;
/// A ray's excess counts up to this many pixels.
pub(super) const CAP: f64 = 4.0;

/// One moment: a silhouette a view, None where the person was not seen.
pub(super) type Moment<'a> = Vec<Option<&'a SignedDistance>>;

/// A ray through the border of a silhouette, and what the other views say of it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Ray {
    /// The moment and the view it belongs to.
    pub(super) moment: usize,
    pub(super) view: usize,
    pub(super) pixel: DVec2,
    /// Pixels by which the best point misses another silhouette; negative inside all of them.
    pub(super) miss: f64,
    /// Distance of that point along the ray, mm.
    pub(super) along: f64,
    /// That point, world, mm.
    pub(super) point: DVec3,
}

impl Ray {
    /// What is left to be explained, pixels: the pixel just inside the border may be half a pixel inside the others.
    pub(super) fn excess(&self) -> f64 {
        excess(self.miss)
    }
}

fn excess(miss: f64) -> f64 {
    (miss + 0.5).max(0.0)
}

/// Every ray of every moment, at most `rays` a silhouette.
pub(super) fn rays(cameras: &[Camera], moments: &[Moment], rays: usize) -> Vec<Ray> {
    rays_of(cameras, moments, rays, |_| true)
}

/// [`rays`] of some views alone.
pub(super) fn rays_of(
    cameras: &[Camera],
    moments: &[Moment],
    rays: usize,
    is_wanted: impl Fn(usize) -> bool,
) -> Vec<Ray> {
    let far = |(camera, silhouette): (&Camera, &Option<&SignedDistance>)| SurelyFar::of(camera, (*silhouette)?);
    let looked: Vec<Looked> = moments
        .iter()
        .enumerate()
        .filter_map(|(index, moment)| {
            let middle = crossing(cameras, moment)?;
            Some(Looked { index, moment, middle, far: cameras.iter().zip(moment).map(far).collect() })
        })
        .collect();
    let silhouettes: Vec<(&Looked, usize)> = looked
        .iter()
        .flat_map(|looked| (0..looked.moment.len()).map(move |view| (looked, view)))
        .filter(|&(looked, view)| looked.moment[view].is_some() && is_wanted(view))
        .collect();
    silhouettes
        .into_par_iter()
        .flat_map_iter(|(looked, view)| {
            let border = looked.moment[view].map(SignedDistance::border).unwrap_or_default();
            let every = border.len().div_ceil(rays.max(1)).max(1);
            border.iter().step_by(every).filter_map(move |&pixel| {
                let (origin, direction) = cameras[view].ray(pixel)?;
                let (along, miss) = looked.best(cameras, view, origin, direction)?;
                Some(Ray { moment: looked.index, view, pixel, miss, along, point: origin + direction * along })
            })
        })
        .collect()
}

/// A ray about its best point, for changes of a camera so small that this moves little: what the other views say is taken to change evenly
/// along it. A search of the ray for each change would take twenty times as long.
pub(super) struct Near<'a> {
    cameras: &'a [Camera],
    ray: &'a Ray,
    /// Those of the views it is compared with that say something there.
    others: Vec<Other<'a>>,
}

/// What a view says at the best point of another's ray.
struct Other<'a> {
    view: usize,
    silhouette: &'a SignedDistance,
    /// Pixels.
    miss: f64,
    /// Pixels more a mm along the ray.
    slope: f64,
}

impl<'a> Near<'a> {
    pub(super) fn of(cameras: &'a [Camera], moment: &Moment<'a>, ray: &'a Ray) -> Self {
        let away = (ray.point - cameras[ray.view].centre_in_world()).normalize_or_zero() * BESIDE;
        let other = |view: usize| {
            let silhouette = moment[view]?;
            let said = |point: DVec3| said(&cameras[view], silhouette, point);
            let slope = match (said(ray.point + away), said(ray.point - away)) {
                (Some(beyond), Some(before)) => (beyond - before) / (2.0 * BESIDE),
                _ => 0.0,
            };
            Some(Other { view, silhouette, miss: said(ray.point)?, slope })
        };
        let others = partners(ray.view, cameras.len()).into_iter().filter_map(other).collect();
        Self { cameras, ray, others }
    }

    /// The ray's [`Ray::excess`] with one of the cameras changed; None where no other view says anything. Views whose pictures end beside
    /// the point say what they said: whether it lies within one changes with the smallest turn, and a search would go round that.
    pub(super) fn excess_with(&self, view: usize, changed: &Camera) -> Option<f64> {
        let is_own = view == self.ray.view;
        let point = if is_own {
            let (origin, direction) = changed.ray(self.ray.pixel)?;
            origin + direction * self.ray.along
        } else {
            self.ray.point
        };
        let line = |other: &Other| {
            let camera = if is_own { &self.cameras[other.view] } else { changed };
            let is_moved = is_own || other.view == view;
            let now = if is_moved { said(camera, other.silhouette, point) } else { None };
            (now.unwrap_or(other.miss), other.slope)
        };
        let lines: Vec<(f64, f64)> = self.others.iter().map(line).collect();
        least_of_the_largest(&lines).map(excess)
    }
}

/// By how many pixels a point misses what a camera sees; None where its picture ends before the point.
fn said(camera: &Camera, silhouette: &SignedDistance, point: DVec3) -> Option<f64> {
    silhouette.at(camera.project(point)?)
}

/// Where lines (value at 0, slope) have the least largest value within [`NEAR`] of 0: that value. None without lines.
fn least_of_the_largest(lines: &[(f64, f64)]) -> Option<f64> {
    let largest = |at: f64| lines.iter().map(|(value, slope)| value + slope * at).reduce(f64::max);
    let crossings = lines.iter().enumerate().flat_map(|(index, a)| lines[..index].iter().map(move |b| (a, b)));
    let crossings = crossings.filter(|(a, b)| a.1 * b.1 < 0.0).map(|(a, b)| (b.0 - a.0) / (a.1 - b.1));
    crossings.filter(|at| at.abs() < NEAR).chain([-NEAR, NEAR]).filter_map(largest).reduce(f64::min)
}

/// A view that a ray is compared with, and the ray in its axes: a third of the work of leading each point there.
struct Asked<'a> {
    camera: &'a Camera,
    silhouette: &'a SignedDistance,
    origin: DVec3,
    direction: DVec3,
}

/// The largest miss of a point of a ray, or any that is no less than `bound`. Who says that is asked first at the next point: it mostly says
/// so there too.
fn largest_miss(others: &mut [Asked], along: f64, bound: f64) -> Option<f64> {
    let mut largest: Option<f64> = None;
    for at in 0..others.len() {
        let Asked { camera, silhouette, origin, direction } = others[at];
        // A view whose picture ends before the point says nothing about it.
        let said = camera.image_of(origin + direction * along).and_then(|pixel| silhouette.at(pixel));
        largest = said.map_or(largest, |said| Some(largest.map_or(said, |largest| largest.max(said))));
        if largest.is_some_and(|largest| largest >= bound) {
            others.swap(0, at);
            break;
        }
    }
    largest
}

/// A moment whose rays are looked at.
struct Looked<'a> {
    /// Of the moments.
    index: usize,
    moment: &'a Moment<'a>,
    /// Where the person is about, world, mm.
    middle: DVec3,
    /// Where each view is surely far, and is asked nothing.
    far: Vec<Option<SurelyFar>>,
}

impl Looked<'_> {
    /// The best point of a ray of a view, [`REACH`] to either side of where it passes the middle, and its miss: first in steps, then ever
    /// finer about the best one.
    fn best(&self, cameras: &[Camera], view: usize, origin: DVec3, direction: DVec3) -> Option<(f64, f64)> {
        let around = (self.middle - origin).dot(direction);
        let mut nothing_near = Vec::new();
        let mut farthest = f64::INFINITY;
        let asked = |other: usize| {
            let (camera, silhouette) = (&cameras[other], self.moment[other]?);
            let map = &camera.camera_from_world;
            let (origin, direction) = (map.transform_point3(origin), map.transform_vector3(direction));
            if let Some(far) = self.far[other] {
                nothing_near.push(far.along(origin, direction));
                farthest = farthest.min(silhouette.farthest());
            }
            Some(Asked { camera, silhouette, origin, direction })
        };
        let mut others: Vec<Asked> = partners(view, cameras.len()).into_iter().filter_map(asked).collect();
        let may_be_near = |along: f64| !nothing_near.iter().any(|&sure| is_far(sure, along));
        let everywhere = |_: f64| true;
        let mut coarse = best_of(&mut others, around, REACH, COARSE, None, may_be_near);
        // Places that are no less than the farthest were left out: which of them comes first, nobody asked.
        if coarse.is_none_or(|(_, miss)| miss >= farthest) {
            coarse = best_of(&mut others, around, REACH, COARSE, None, everywhere);
        }
        let (mut found, mut step) = (coarse?, COARSE);
        while step > FINE {
            let reach = step;
            step /= 4.0;
            found = best_of(&mut others, found.0, reach, step, Some(found), everywhere)?;
        }
        Some(found)
    }
}

/// The first best of the points in steps to either side of `around` that are `wanted`, where it is better than `found`; else that.
fn best_of(
    others: &mut [Asked],
    around: f64,
    reach: f64,
    step: f64,
    mut found: Option<(f64, f64)>,
    wanted: impl Fn(f64) -> bool,
) -> Option<(f64, f64)> {
    let steps = (reach / step).ceil() as i32;
    for at in -steps..=steps {
        let along = around + f64::from(at) * step;
        let least = found.map_or(f64::INFINITY, |(_, least)| least);
        if along > 0.0
            && wanted(along)
            && let Some(miss) = largest_miss(others, along, least)
            && miss < least
        {
            found = Some((along, miss));
        }
    }
    found
}

/// The point nearest to the rays through the middles of a moment's borders; None for fewer than two.
fn crossing(cameras: &[Camera], moment: &Moment) -> Option<DVec3> {
    let (mut matrix, mut vector, mut count) = (DMat3::ZERO, DVec3::ZERO, 0);
    for (camera, silhouette) in cameras.iter().zip(moment) {
        let border = silhouette.map(SignedDistance::border).unwrap_or_default();
        if border.is_empty() {
            continue;
        }
        let middle = border.iter().sum::<DVec2>() / border.len() as f64;
        let Some((origin, d)) = camera.ray(middle) else { continue };
        let across = DMat3::IDENTITY - DMat3::from_cols(d * d.x, d * d.y, d * d.z);
        (matrix, vector, count) = (matrix + across, vector + across * origin, count + 1);
    }
    let point = matrix.inverse() * vector;
    (count >= 2 && point.is_finite()).then_some(point)
}

/// In which share of the moments a view shows the person, %, of those in which whoever the other views show is in its picture. Moments without anybody
/// tell of a view only where there are no others.
pub(super) fn percent_seen(cameras: &[Camera], moments: &[Moment], view: usize) -> f64 {
    let anybody = moments.iter().any(|moment| moment.iter().any(Option::is_some));
    let is_in_picture = |moment: &Moment| match crossing(cameras, moment) {
        Some(middle) => cameras[view].sees(middle),
        None => !anybody || moment.iter().any(Option::is_some),
    };
    let is_due = |moment: &&Moment| moment[view].is_some() || is_in_picture(moment);
    let due: Vec<&Moment> = moments.iter().filter(is_due).collect();
    let seen = due.iter().filter(|moment| moment[view].is_some()).count();
    100.0 * seen as f64 / due.len().max(1) as f64
}

/// The share of rays that the other views explain, %.
pub(super) fn percent_explained<'a>(rays: impl IntoIterator<Item = &'a Ray>) -> f64 {
    let (good, count) =
        rays.into_iter().fold((0, 0), |(good, count), ray| (good + u32::from(ray.excess() <= EXPLAINED), count + 1));
    100.0 * f64::from(good) / f64::from(count.max(1))
}

/// How much the views disagree at each of `moments` moments, in pixels; None where a moment has no ray.
pub(super) fn disagreements(rays: &[Ray], moments: usize, cap: f64) -> Vec<Option<f64>> {
    let mut sums = vec![(0.0, 0_u32); moments];
    for ray in rays {
        let sum = &mut sums[ray.moment];
        *sum = (sum.0 + ray.excess().min(cap), sum.1 + 1);
    }
    sums.into_iter().map(|(sum, count)| (count > 0).then(|| sum / f64::from(count))).collect()
}

/// How much the views disagree, in pixels: the mean excess, each ray's cut at `cap` so that a missing hand weighs no more
/// than that.
pub(super) fn disagreement<'a>(rays: impl IntoIterator<Item = &'a Ray>, cap: f64) -> f64 {
    let (sum, count) = rays.into_iter().fold((0.0, 0), |(sum, count), ray| (sum + ray.excess().min(cap), count + 1));
    sum / f64::from(count.max(1))
}

#[cfg(test)]
#[path = "agreement_tests.rs"]
mod tests;
