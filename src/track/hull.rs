//! Where a person roughly is: the visual hull of the silhouettes, the part of space that every camera sees as person.

use anyhow::{Result, ensure};
use glam::{DMat3, DVec3};
use rayon::prelude::*;

use super::sight::pixel;
use crate::features::SeenView;
use crate::geometry::Camera;

/// Side of a voxel, mm.
const VOXEL: f64 = 25.0;
/// Voxels from the middle to each side of the searched cube: a person with raised arms fits in.
const HALF: i32 = 60;
/// Share of the hull cut off below and above: specks, and the spikes where few cameras look.
const OUTLIERS: f64 = 0.002;

/// The rough place and size of a person.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Hull {
    /// The middle of the hull's volume, world, mm.
    pub(super) centre: DVec3,
    /// Height of its lowest and highest point, world z, mm.
    pub(super) span: [f64; 2],
}

impl Hull {
    /// Carves it from the silhouettes of one frame, one a camera.
    ///
    /// # Errors
    /// When fewer than two cameras see a silhouette, or the silhouettes have no common volume.
    pub(super) fn carve(cameras: &[Camera], views: &[SeenView<'_>]) -> Result<Self> {
        Self::carve_by(VOXEL, HALF, cameras, views)
    }

    /// As [`Self::carve`], with voxels of twice the size: an eighth of the work, where only the place matters.
    ///
    /// # Errors
    /// As [`Self::carve`].
    pub(super) fn carve_coarsely(cameras: &[Camera], views: &[SeenView<'_>]) -> Result<Self> {
        Self::carve_by(2.0 * VOXEL, HALF / 2, cameras, views)
    }

    /// Of voxels of side `side`, `half` from the middle to each side.
    fn carve_by(side: f64, half: i32, cameras: &[Camera], views: &[SeenView<'_>]) -> Result<Self> {
        let around = crossing(cameras, views)?;
        let offsets = -half..=half;
        let mut voxels: Vec<DVec3> = offsets
            .clone()
            .into_par_iter()
            .flat_map_iter(|z| {
                let columns = offsets.clone().flat_map(|y| offsets.clone().map(move |x| (x, y)));
                columns.filter_map(move |(x, y)| {
                    let at = around + DVec3::new(f64::from(x), f64::from(y), f64::from(z)) * side;
                    is_person(cameras, views, at).then_some(at)
                })
            })
            .collect();
        ensure!(
            !voxels.is_empty(),
            "the silhouettes have no volume in common: are the cameras calibrated for these pictures, and do the \
             silhouettes show the same person?"
        );
        let centre = voxels.iter().sum::<DVec3>() / voxels.len() as f64;
        voxels.sort_by(|a, b| a.z.total_cmp(&b.z));
        let cut = (OUTLIERS * voxels.len() as f64) as usize;
        let span = [voxels[cut].z - 0.5 * side, voxels[voxels.len() - 1 - cut].z + 0.5 * side];
        Ok(Self { centre, span })
    }
}

/// Whether a point is in the silhouette of every camera whose picture it is in and does not ignore it there, and those are two or more.
pub(super) fn is_person(cameras: &[Camera], views: &[SeenView<'_>], at: DVec3) -> bool {
    let mut seen = 0;
    for (camera, view) in cameras.iter().zip(views) {
        let Some((_, place)) = pixel(camera, *view, at) else { continue };
        if !view.is_person(place) {
            return false;
        }
        seen += 1;
    }
    seen >= 2
}

/// The point nearest to the rays through the middles of the silhouettes.
fn crossing(cameras: &[Camera], views: &[SeenView<'_>]) -> Result<DVec3> {
    let (mut matrix, mut vector, mut rays) = (DMat3::ZERO, DVec3::ZERO, 0);
    for (camera, view) in cameras.iter().zip(views) {
        let Some(bounds) = view.bounds() else { continue };
        let middle = |low: u32, high: u32| 0.5 * f64::from(low + high - 1);
        let pixel = glam::DVec2::new(middle(bounds.x0, bounds.x1), middle(bounds.y0, bounds.y1));
        if let Some((origin, direction)) = camera.ray(pixel) {
            // The squared distance of a point p from the ray is (p - o)' (I - d d') (p - o).
            let across = DMat3::IDENTITY - outer(direction);
            matrix += across;
            vector += across * origin;
            rays += 1;
        }
    }
    ensure!(rays >= 2, "{rays} of {} cameras see a silhouette, expected at least 2", cameras.len());
    ensure!(matrix.determinant().abs() > 1e-6, "the cameras that see a silhouette all look along one line");
    Ok(matrix.inverse() * vector)
}

/// d d'
fn outer(d: DVec3) -> DMat3 {
    DMat3::from_cols(d * d.x, d * d.y, d * d.z)
}

#[cfg(test)]
mod tests {
    use super::super::fit_tests::{cameras_around, seen};
    use super::*;
    use crate::body::Body;
    use crate::features::Observation;

    #[test]
    fn a_drawn_person_is_found_at_his_place_and_height() {
        let cameras = cameras_around();
        let body = Body::adult(1700.0).unwrap();
        let mut pose = body.standing_pose();
        (pose[0], pose[1]) = (420.0, -310.0);
        let hull = Hull::carve(&cameras, &SeenView::all(&seen(&body, &cameras, &pose))).unwrap();
        // A hull of three views: (423, -311), from -36 to 1714 mm, which does not vary.
        assert!(hull.centre.truncate().distance(glam::DVec2::new(430.0, -310.0)) < 15.0, "{hull:?}");
        let [low, high] = hull.span;
        println!("centre {}, from {low:.1} to {high:.1} mm", hull.centre);
        assert!(low.abs() < 45.0 && (high - 1700.0).abs() < 25.0, "{hull:?}");
    }

    #[test]
    fn too_little_is_said() {
        let cameras = cameras_around();
        let nothing: Vec<Observation> = cameras.iter().map(|c| Observation::empty(c.size[0], c.size[1])).collect();
        let error = Hull::carve(&cameras, &SeenView::all(&nothing)).unwrap_err().to_string();
        assert!(error.contains("0 of 3 cameras see a silhouette"), "{error}");
        let body = Body::adult(1700.0).unwrap();
        let mut seen = seen(&body, &cameras, &body.standing_pose());
        // One camera sees somebody in a corner that the others do not look at.
        seen[0] = Observation::empty(seen[0].width, seen[0].height);
        for at in 0..400 {
            seen[0].bytes[at] = Observation::SILHOUETTE;
        }
        let error = Hull::carve(&cameras, &SeenView::all(&seen)).unwrap_err().to_string();
        assert!(error.contains("no volume in common"), "{error}");
    }
}
