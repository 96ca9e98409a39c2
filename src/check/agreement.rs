//! Do the silhouettes of one moment agree? A ray through a silhouette's border touches the person, so somewhere along it
//! every other camera must see the person too. By how many pixels the best point of the ray misses their silhouettes is
//! what the cameras disagree about: nothing where the calibration is right, and no model of the person is needed.

use glam::{DMat3, DVec2, DVec3};
use rayon::prelude::*;

use super::partners::partners;
use super::signed_distance::SignedDistance;
use crate::geometry::Camera;

/// Half the stretch of a ray that is searched, mm: a person's reach and some error.
const REACH: f64 = 1600.0;
/// First and last step along a ray, mm.
const COARSE: f64 = 40.0;
const FINE: f64 = 2.5;

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
        (self.miss + 0.5).max(0.0)
    }
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
    let is_wanted = &is_wanted;
    let silhouettes: Vec<(usize, usize, DVec3)> = moments
        .iter()
        .enumerate()
        .filter_map(|(at, moment)| Some((at, moment, crossing(cameras, moment)?)))
        .flat_map(|(at, moment, middle)| {
            (0..moment.len())
                .filter(|&view| moment[view].is_some() && is_wanted(view))
                .map(move |view| (at, view, middle))
        })
        .collect();
    silhouettes
        .into_par_iter()
        .flat_map_iter(|(at, view, middle)| {
            let moment = &moments[at];
            let border = moment[view].map(SignedDistance::border).unwrap_or_default();
            let every = border.len().div_ceil(rays.max(1)).max(1);
            let chosen: Vec<DVec2> = border.iter().copied().step_by(every).collect();
            chosen.into_iter().filter_map(move |pixel| {
                let (origin, direction) = cameras[view].ray(pixel)?;
                let around = (middle - origin).dot(direction);
                let (along, miss) = best(cameras, moment, view, origin, direction, [around, REACH, COARSE])?;
                Some(Ray { moment: at, view, pixel, miss, along, point: origin + direction * along })
            })
        })
        .collect()
}

/// The same ray after a change of the cameras so small that its best point hardly moved.
pub(super) fn again(cameras: &[Camera], moment: &Moment, ray: &Ray) -> Option<f64> {
    let (origin, direction) = cameras[ray.view].ray(ray.pixel)?;
    best(cameras, moment, ray.view, origin, direction, [ray.along, 2.0 * COARSE, COARSE / 2.0]).map(|(_, miss)| miss)
}

/// The best point of a ray, `reach` to either side of `around`: first in steps, then ever finer about the best one.
fn best(
    cameras: &[Camera],
    moment: &Moment,
    view: usize,
    origin: DVec3,
    direction: DVec3,
    [mut around, mut reach, mut step]: [f64; 3],
) -> Option<(f64, f64)> {
    let mut others = partners(view, cameras.len());
    // The largest miss, or any that is no less than `bound`. Who says that is asked first at the next point: it mostly says so there too.
    let mut miss = |along: f64, bound: f64| {
        let point = origin + direction * along;
        let mut largest: Option<f64> = None;
        for at in 0..others.len() {
            let other = others[at];
            // A view whose picture ends before the point says nothing about it.
            let said = moment[other].and_then(|silhouette| silhouette.at(cameras[other].project(point)?));
            largest = said.map_or(largest, |said| Some(largest.map_or(said, |largest| largest.max(said))));
            if largest.is_some_and(|largest| largest >= bound) {
                others.swap(0, at);
                break;
            }
        }
        largest
    };
    let mut found: Option<(f64, f64)> = None;
    loop {
        let steps = (reach / step).ceil() as i32;
        for at in -steps..=steps {
            let along = around + f64::from(at) * step;
            let least = found.map_or(f64::INFINITY, |(_, least)| least);
            if along > 0.0
                && let Some(miss) = miss(along, least)
                && miss < least
            {
                found = Some((along, miss));
            }
        }
        let (along, _) = found?;
        if step <= FINE {
            return found;
        }
        (around, reach, step) = (along, step, step / 4.0);
    }
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
