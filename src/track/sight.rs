//! What the pictures say of a part of the body being at a place in space.

use anyhow::Result;
use glam::DVec3;

use crate::evaluate::{Evaluator, Objective};
use crate::features::{Evidence, SeenView, evidence};
use crate::geometry::Camera;

/// Where a view shows a place on the axis of a part.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    pub(super) view: usize,
    /// Column and row.
    pub(super) at: [usize; 2],
    /// In the picture's rows.
    pub(super) pixel: usize,
    /// The part's.
    pub(super) label: u8,
}

/// The pixel that a point is seen in, by column and row, and its place in the picture's rows; none outside the picture and where nothing counts.
pub(super) fn pixel(camera: &Camera, view: SeenView<'_>, point: DVec3) -> Option<([usize; 2], usize)> {
    let at = camera.project(point)?;
    let [width, height] = view.size();
    // A pixel reaches half of one around its centre; what is half way belongs to the next.
    let is_inside = at.min_element() > -0.5 && at.x < f64::from(width) - 0.5 && at.y < f64::from(height) - 0.5;
    let [column, row] = is_inside.then_some([at.x, at.y].map(|at| (at + 0.5) as usize))?;
    let pixel = row * width as usize + column;
    (!view.ignores(pixel)).then_some(([column, row], pixel))
}

/// Where the views show a part, of which `axis` is the axis in space: so many places along it, each in all views that show it.
pub(super) fn along<'a>(
    cameras: &'a [Camera],
    views: &'a [SeenView<'a>],
    axis: [DVec3; 2],
    label: u8,
    places: usize,
) -> impl Iterator<Item = Place> + 'a {
    (0..places).flat_map(move |nth| {
        let at = axis[0].lerp(axis[1], (nth as f64 + 0.5) / places as f64);
        let of_views = cameras.iter().zip(views).enumerate();
        of_views.filter_map(move |(view, (camera, seen))| {
            pixel(camera, *seen, at).map(|(at, pixel)| Place { view, at, pixel, label })
        })
    })
}

/// Whether the host knows what was seen; else the evaluator's device does.
pub(super) fn is_known(objective: &Objective, views: &[SeenView<'_>]) -> bool {
    !objective.weighs_evidence() || views.iter().all(|view| view.evidence().is_some())
}

/// What each place says of its part being there, from -1 (surely background) to 1 (surely this part). Evidence that the evaluator's device
/// made is asked of it, all at once.
///
/// # Errors
/// When the device fails.
pub(super) fn said_of(
    evaluator: &mut dyn Evaluator,
    objective: &Objective,
    views: &[SeenView<'_>],
    places: &[Place],
) -> Result<Vec<f32>> {
    if is_known(objective, views) {
        return Ok(places.iter().map(|place| said(views, place)).collect());
    }
    let pixels: Vec<[usize; 2]> = places.iter().map(|place| [place.view, place.pixel]).collect();
    let words = evaluator.evidence_at(&pixels)?;
    let classes = evaluator.evidence_classes();
    let class = |label: u8| classes.map_or(0, |classes| usize::from(classes.of_label(label)));
    Ok(words.into_iter().zip(places).map(|(word, place)| of_code(evidence::code(word, class(place.label)))).collect())
}

/// The same of a place in views that the host knows.
pub(super) fn said(views: &[SeenView<'_>], Place { view, pixel, label, .. }: &Place) -> f32 {
    let view = views[*view];
    match view.evidence() {
        Some(seen) => of_code(evidence::code(seen.words()[*pixel], usize::from(seen.classes().of_label(*label)))),
        None if view.is_person(*pixel) => 1.0,
        None => -1.0,
    }
}

/// The same by the code of the part's class.
fn of_code(code: u32) -> f32 {
    (code as f32 - Evidence::NEUTRAL as f32) / Evidence::NEUTRAL as f32
}
