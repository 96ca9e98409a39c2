//! Is a camera early or late? Each view's silhouettes in turn are taken from some frames earlier or later, and the views
//! agree best where they belong together.

use rayon::prelude::*;

use super::agreement::{CAP, FEWER_RAYS, Moment, disagreement, rays};
use super::finding::{Finding, Status};
use super::partners::{fewer, partners, shows};
use super::silhouettes::{SHIFTS, Silhouettes};
use crate::geometry::Camera;

/// More than this many frames is late.
const LATE: f64 = 0.6;
/// Where a shift changes the disagreement by less than this part, nobody moves enough to tell.
const TELLING: f64 = 0.05;

/// The disagreement for shifts of one view.
type Curve = Vec<(isize, f64)>;

/// The delay of every camera, frames. One late camera makes others look early that share much of its view: the one whose
/// shift helps most is put right before the others are measured again.
pub(super) fn timing(cameras: &[Camera], silhouettes: &Silhouettes) -> Vec<Finding> {
    let mut delays = vec![0; cameras.len()];
    let mut settled: Vec<Option<Finding>> = vec![None; cameras.len()];
    let mut curves: Vec<Curve> = vec![Vec::new(); cameras.len()];
    let mut changed: Option<usize> = None;
    loop {
        curves = curves
            .into_par_iter()
            .enumerate()
            .map(|(view, before)| match changed {
                Some(changed) if !shows(changed, view, cameras.len()) => before,
                _ => curve(cameras, silhouettes, &delays, view),
            })
            .collect();
        let found: Vec<Finding> = curves.iter().zip(cameras).map(|(curve, camera)| finding(curve, camera)).collect();
        let open = (0..cameras.len()).filter(|&view| settled[view].is_none() && found[view].status == Status::Failed);
        let gain = |view: &usize| lowest(&curves[*view]).map_or(f64::INFINITY, |(_, _, least)| least);
        let Some(worst) = open.min_by(|a, b| gain(a).total_cmp(&gain(b))) else {
            return settled.into_iter().zip(found).map(|(settled, found)| settled.unwrap_or(found)).collect();
        };
        delays[worst] = lowest(&curves[worst]).map_or(0, |(_, shift, _)| shift);
        settled[worst] = Some(found[worst].clone());
        changed = Some(worst);
    }
}

/// The disagreement for every shift of one view, the others as late as `delays` says.
fn curve(cameras: &[Camera], silhouettes: &Silhouettes, delays: &[isize], view: usize) -> Curve {
    // The same samples for every shift: those that have all their neighbours.
    let shifted = |sample: usize, shift: isize| {
        silhouettes.moment(sample, |other| if other == view { shift } else { delays[other] })
    };
    let has_all = |sample: &usize| SHIFTS.into_iter().all(|shift| shifted(*sample, shift).is_some());
    let samples: Vec<usize> = silhouettes.samples.iter().copied().filter(has_all).collect();
    if samples.is_empty() {
        return Vec::new();
    }
    // The view and those that it is compared with, by themselves.
    let mut group = partners(view, cameras.len());
    group.push(view);
    group.sort_unstable();
    let own_cameras: Vec<Camera> = group.iter().map(|&view| cameras[view].clone()).collect();
    let count = fewer(FEWER_RAYS, cameras.len());
    SHIFTS
        .map(|shift| {
            let own = |&sample: &usize| {
                let moment = shifted(sample, shift)?;
                Some(group.iter().map(|&view| moment[view]).collect())
            };
            let moments: Vec<Moment> = samples.iter().filter_map(own).collect();
            (shift, disagreement(&rays(&own_cameras, &moments, count), CAP))
        })
        .collect()
}

/// The place in the curve, the shift and the value where a curve is lowest.
fn lowest(curve: &[(isize, f64)]) -> Option<(usize, isize, f64)> {
    let best = curve.iter().enumerate().min_by(|a, b| a.1.1.total_cmp(&b.1.1));
    best.map(|(at, &(shift, value))| (at, shift, value))
}

fn finding(curve: &[(isize, f64)], camera: &Camera) -> Finding {
    let Some((at, shift, least)) = lowest(curve) else {
        return Finding::not_measured("timing", "the frames looked at have no three neighbours to either side")
            .of(&camera.name);
    };
    let most = curve.iter().map(|(_, value)| *value).fold(0.0, f64::max);
    if most - least < TELLING * most.max(0.1) {
        return Finding::not_measured("timing", "nobody moves enough in the frames looked at to tell").of(&camera.name);
    }
    // The lowest point of the parabola through the best shift and its neighbours.
    let part = match (at.checked_sub(1).and_then(|at| curve.get(at)), curve.get(at + 1)) {
        (Some((_, before)), Some((_, after))) => {
            let bend = before - 2.0 * least + after;
            if bend > 0.0 { 0.5 * (before - after) / bend } else { 0.0 }
        }
        _ => 0.0,
    };
    // Frames taken from later on agree with the others: this camera's pictures come that much too late.
    let late = shift as f64 + part;
    let now = curve.iter().find(|(shift, _)| *shift == 0).map_or(least, |(_, value)| *value);
    Finding::number("timing", "frames late", late, [-LATE, LATE])
        .of(&camera.name)
        .found(format!(
            "the views disagree by {now:.3} px as they are, by {least:.3} px with this camera moved by {shift}"
        ))
        .or(format!(
            "write `delay = {shift}` into the [[view]] of this camera (added to one that is there): frames by which its pictures come too \
             late"
        ))
}
