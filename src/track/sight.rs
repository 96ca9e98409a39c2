//! What the pictures say of a part of the body being at a place in space.

use glam::DVec3;

use crate::features::{Evidence, SeenView, evidence};
use crate::geometry::Camera;

/// The pixel that a point is seen in; none outside the picture and where nothing counts.
pub(super) fn pixel(camera: &Camera, view: SeenView<'_>, point: DVec3) -> Option<usize> {
    let at = camera.project(point)?.round();
    let [width, height] = view.size();
    let inside = at.x >= 0.0 && at.y >= 0.0 && at.x < f64::from(width) && at.y < f64::from(height);
    let at = inside.then(|| at.y as usize * width as usize + at.x as usize)?;
    (!view.ignores(at)).then_some(at)
}

/// What a pixel says of a part being there, by the part's label, from -1 (surely background) to 1 (surely this part).
pub(super) fn said(view: SeenView<'_>, pixel: usize, label: u8) -> f32 {
    match view.evidence() {
        Some(seen) => {
            let code = evidence::code(seen.words()[pixel], usize::from(seen.classes().of_label(label)));
            (code as f32 - Evidence::NEUTRAL as f32) / Evidence::NEUTRAL as f32
        }
        None if view.is_person(pixel) => 1.0,
        None => -1.0,
    }
}
