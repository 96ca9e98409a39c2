//! Where along a ray another view surely sees nothing near: there its silhouette need not be asked, which takes most of a search's time.
//!
//! In a camera's normalised coordinates without distortion the sides of a box are planes through its centre, so a ray enters and leaves
//! one at places that are known exactly. What bends a picture's lines is in the boxes alone, and they are that much larger or smaller.

use glam::{DVec2, DVec3};

use super::signed_distance::SignedDistance;
use crate::geometry::Camera;

/// Points on each side of a box of pixels that tell how the lens bends it.
const POINTS: u32 = 4;
/// How much of a box's size is added to it or taken off for what is bent between those points.
const SLACK: f64 = 0.05;

/// A box in normalised coordinates without distortion (x / z, y / z): its lower and upper corner.
type Bounds = [DVec2; 2];

/// What a view is sure of without a look at its silhouette.
#[derive(Clone, Copy, Debug)]
pub(super) struct SurelyFar {
    /// Within the picture.
    seen: Bounds,
    /// All that is near to the silhouette.
    near: Bounds,
}

impl SurelyFar {
    /// None where a view is sure of nothing: of parts of its picture nothing is known, or its lens has no such place for a pixel.
    pub(super) fn of(camera: &Camera, silhouette: &SignedDistance) -> Option<Self> {
        if silhouette.has_ignored() {
            return None;
        }
        let [seen, near] = [silhouette.picture(), silhouette.told_apart()].map(|bounds| sides(camera, bounds));
        Some(Self { seen: grown(inner(&seen?), -SLACK), near: grown(outer(&near?), SLACK) })
    }

    /// Where along a ray (in the camera's axes) the view is sure: from and to of `seen`, and of `near` within it, which is not.
    pub(super) fn along(&self, origin: DVec3, direction: DVec3) -> [[f64; 2]; 2] {
        [stretch(self.seen, origin, direction), stretch(self.near, origin, direction)]
    }
}

/// Whether a place along a ray is within what [`SurelyFar::along`] says is far.
pub(super) fn is_far([seen, near]: [[f64; 2]; 2], along: f64) -> bool {
    let is_in = |[from, to]: [f64; 2]| along >= from && along <= to;
    is_in(seen) && !is_in(near)
}

/// A box's sides of pixels as normalised points: left, right, top, bottom.
fn sides(camera: &Camera, [low, high]: [DVec2; 2]) -> Option<[Vec<DVec2>; 4]> {
    let side = |from: DVec2, to: DVec2| -> Option<Vec<DVec2>> {
        let point = |at: u32| from.lerp(to, f64::from(at) / f64::from(POINTS));
        (0..=POINTS).map(|at| camera.lens.undistort(camera.lens.from_pixel(point(at)))).collect()
    };
    let [upper_right, lower_left] = [DVec2::new(high.x, low.y), DVec2::new(low.x, high.y)];
    Some([side(low, lower_left)?, side(upper_right, high)?, side(low, upper_right)?, side(lower_left, high)?])
}

/// The box that all sides lie around.
fn inner([left, right, top, bottom]: &[Vec<DVec2>; 4]) -> Bounds {
    let least = |side: &[DVec2]| side.iter().copied().fold(DVec2::INFINITY, DVec2::min);
    let largest = |side: &[DVec2]| side.iter().copied().fold(DVec2::NEG_INFINITY, DVec2::max);
    [DVec2::new(largest(left).x, largest(top).y), DVec2::new(least(right).x, least(bottom).y)]
}

/// The box around all sides.
fn outer(sides: &[Vec<DVec2>; 4]) -> Bounds {
    let none = [DVec2::INFINITY, DVec2::NEG_INFINITY];
    sides.iter().flatten().fold(none, |[low, high], at| [low.min(*at), high.max(*at)])
}

/// A box with a share of its size more on every side.
fn grown([low, high]: Bounds, share: f64) -> Bounds {
    let more = (high - low) * share;
    [low - more, high + more]
}

/// From where to where a ray lies within a box and before the camera; from beyond to where it does not.
fn stretch([low, high]: Bounds, origin: DVec3, direction: DVec3) -> [f64; 2] {
    // What must not be negative along the ray: its value at the origin and its slope.
    let sides = [
        (origin.x - low.x * origin.z, direction.x - low.x * direction.z),
        (high.x * origin.z - origin.x, high.x * direction.z - direction.x),
        (origin.y - low.y * origin.z, direction.y - low.y * direction.z),
        (high.y * origin.z - origin.y, high.y * direction.z - direction.y),
        (origin.z, direction.z),
    ];
    let mut along = [f64::NEG_INFINITY, f64::INFINITY];
    for (value, slope) in sides {
        if slope > 0.0 {
            along[0] = along[0].max(-value / slope);
        } else if slope < 0.0 {
            along[1] = along[1].min(-value / slope);
        } else if value < 0.0 {
            return [f64::INFINITY, f64::NEG_INFINITY];
        }
    }
    along
}
