//! Do all cameras look at the same place? A calibration in mixed units, or with one camera's extrinsics inverted, is
//! otherwise noticed only as a track that fails.

use std::path::Path;

use anyhow::{Result, bail};
use glam::{DMat3, DVec3};

use crate::geometry::Camera;

/// Radius of the neighbourhood that a camera has to see some of, mm: about a person's reach.
const NEIGHBOURHOOD: f64 = 1000.0;

/// Points on each of the spheres that stand for the neighbourhood.
const POINTS_A_SPHERE: usize = 200;

/// Fails when one camera sees nothing of the neighbourhood of the point nearest to all optical axes, and every other
/// camera does. With fewer than three cameras there is no telling which one is wrong, and nothing is checked.
///
/// # Errors
/// One sentence naming the manifest, the camera and the place.
pub(super) fn check_coverage(path: &Path, cameras: &[Camera]) -> Result<()> {
    if cameras.len() < 3 {
        return Ok(());
    }
    let Some(middle) = nearest_to_axes(cameras) else { return Ok(()) };
    let blind: Vec<&Camera> = cameras.iter().filter(|camera| !sees_near(camera, middle)).collect();
    if let [camera] = blind[..] {
        let place = middle / 1000.0;
        bail!(
            "{}: camera {:?} sees nothing of the place all cameras point at, around ({:.1}, {:.1}, {:.1}) m, and the other \
             {} see it: check its rotation, its translation and the units of the calibration",
            path.display(),
            camera.name,
            place.x,
            place.y,
            place.z,
            cameras.len() - 1
        );
    }
    Ok(())
}

/// The point that cameras look at, world, mm: the one with the least sum of squared distances to the optical axes; `None` where the axes are parallel.
pub fn nearest_to_axes(cameras: &[Camera]) -> Option<DVec3> {
    let (mut matrix, mut right) = (DMat3::ZERO, DVec3::ZERO);
    for camera in cameras {
        let axis = axis_in_world(camera);
        // Projects onto the plane across the axis.
        let across = DMat3::IDENTITY - DMat3::from_cols(axis * axis.x, axis * axis.y, axis * axis.z);
        matrix += across;
        right += across * camera.centre_in_world();
    }
    let point = matrix.inverse() * right;
    (matrix.determinant() > 1e-6 && point.is_finite()).then_some(point)
}

fn axis_in_world(camera: &Camera) -> DVec3 {
    camera.camera_from_world.matrix3.transpose() * DVec3::Z
}

fn sees_near(camera: &Camera, middle: DVec3) -> bool {
    let axis = axis_in_world(camera);
    let along = (middle - camera.centre_in_world()).dot(axis);
    // The point of the axis nearest to the middle: a long lens may see that and no sampled point.
    let on_axis = camera.centre_in_world() + axis * along;
    if along > 0.0 && on_axis.distance(middle) <= NEIGHBOURHOOD {
        return true;
    }
    let mut points = std::iter::once(middle)
        .chain([0.25, 0.5, 0.75, 1.0].into_iter().flat_map(|part| sphere(middle, part * NEIGHBOURHOOD)));
    points.any(|point| {
        camera.project(point).is_some_and(|pixel| {
            let [width, height] = camera.size.map(f64::from);
            (-0.5..width - 0.5).contains(&pixel.x) && (-0.5..height - 0.5).contains(&pixel.y)
        })
    })
}

/// Points spread evenly over a sphere, along a spiral that turns by the golden angle.
fn sphere(centre: DVec3, radius: f64) -> impl Iterator<Item = DVec3> {
    let golden_angle = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
    (0..POINTS_A_SPHERE).map(move |index| {
        let z = 1.0 - 2.0 * (index as f64 + 0.5) / POINTS_A_SPHERE as f64;
        let (sine, cosine) = (golden_angle * index as f64).sin_cos();
        let across = (1.0 - z * z).sqrt();
        centre + radius * DVec3::new(across * cosine, across * sine, z)
    })
}
