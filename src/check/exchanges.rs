//! Would the views agree with two cameras exchanged, or with all pictures mirrored?

use super::agreement::{CAP, FEWER_RAYS, Ray, disagreement, rays, rays_of};
use super::finding::Finding;
use super::partners::{shows, worst};
use super::silhouettes::Silhouettes;
use crate::geometry::{Camera, Lens};

/// Exchanges and turned pictures are only tried where the views disagree by more than this many pixels.
pub(super) const DISAGREE: f64 = 0.6;
/// By which factor an exchange or another orientation must improve on what there is.
pub(super) const BETTER: f64 = 0.6;

/// Handedness and order of the cameras.
pub(super) fn exchanges(cameras: &[Camera], silhouettes: &Silhouettes, found: &[Ray]) -> [Finding; 2] {
    let moments = silhouettes.moments();
    let now = disagreement(found, CAP);
    let with = |cameras: &[Camera]| disagreement(&rays(cameras, &moments, FEWER_RAYS), CAP);
    let tried = now > DISAGREE;
    // Where the views agree there is nothing to exchange.
    let mirrored = if tried { with(&cameras.iter().map(mirrored).collect::<Vec<_>>()) / now } else { 1.0 };
    let mut best = (1.0, String::new());
    let suspects = suspects(cameras.len(), found);
    for (a, b) in suspects.iter().flat_map(|&a| suspects.iter().map(move |&b| (b, a))).filter(|(b, a)| b < a) {
        if !tried || cameras[a].size != cameras[b].size {
            continue;
        }
        let mut exchanged = cameras.to_vec();
        exchanged.swap(a, b);
        // Only where it shows: with many cameras most rays meet neither of the two.
        let touched = |view: usize| shows(a, view, cameras.len()) || shows(b, view, cameras.len());
        let before = disagreement(found.iter().filter(|ray| touched(ray.view)), CAP);
        let after = disagreement(&rays_of(&exchanged, &moments, FEWER_RAYS, touched), CAP);
        let ratio = after / before;
        if ratio < best.0 {
            best = (ratio, format!("{} and {}", cameras[a].name, cameras[b].name));
        }
    }
    let how = if tried {
        format!("the views disagree by {now:.2} px a border ray")
    } else {
        format!("not needed: the views disagree by only {now:.2} px a border ray")
    };
    [
        Finding::number("handedness", "of the disagreement left with mirrored pictures", mirrored, [BETTER, f64::INFINITY])
            .found(how.clone())
            .or("the pictures are mirrored, or the calibration's world is left-handed: turn the pictures over, or calibrate in a \
                 right-handed world"),
        Finding::number("order of the cameras", "of the disagreement left with two exchanged", best.0, [BETTER, f64::INFINITY])
            .found(if best.1.is_empty() { how } else { format!("{how}; best with {} exchanged", best.1) })
            .or(format!("the calibrations of {} are exchanged, or their videos: correct the names", best.1)),
    ]
}

/// The cameras that two exchanged ones are looked for among: those that the others agree with least.
pub(super) fn suspects(cameras: usize, found: &[Ray]) -> Vec<usize> {
    let agreement = |view: usize| -disagreement(found.iter().filter(|ray| ray.view == view), CAP);
    worst(&(0..cameras).map(agreement).collect::<Vec<f64>>())
}

/// The camera of pictures turned over, left for right.
fn mirrored(camera: &Camera) -> Camera {
    let width = f64::from(camera.size[0]) - 1.0;
    let mut mirrored = camera.clone();
    match &mut mirrored.lens {
        Lens::Tsai(lens) => (lens.sx, lens.centre.x) = (-lens.sx, width - lens.centre.x),
        Lens::BrownConrady(lens) => (lens.focal.x, lens.centre.x) = (-lens.focal.x, width - lens.centre.x),
    }
    mirrored
}
