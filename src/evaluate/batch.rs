//! The layout of a batch and what every backend checks of it.

use anyhow::{Result, ensure};

use crate::body::Body;
use crate::features::Observation;
use crate::geometry::{Camera, LARGEST_SIDE};

/// Holds `poses` (rows of `dof_count`) to `results` values, `per_pose` for each pose.
pub(crate) fn check_batch(poses: &[f32], dof_count: usize, results: usize, per_pose: usize) -> Result<()> {
    ensure!(dof_count > 0, "the body has no degree of freedom, expected at least one to search over");
    ensure!(per_pose > 0, "there are no views, expected at least one camera");
    ensure!(
        poses.len().is_multiple_of(dof_count),
        "a batch of {} values is no whole number of poses of {dof_count} degrees of freedom",
        poses.len()
    );
    let count = poses.len() / dof_count;
    ensure!(results == count * per_pose, "{count} poses need room for {} results, found {results}", count * per_pose);
    Ok(())
}

/// Holds a body and its cameras to what every fast backend can draw and compare.
pub(crate) fn check_scene(body: &Body, cameras: &[Camera]) -> Result<()> {
    ensure!(!cameras.is_empty(), "there are no cameras, expected at least one to compare poses with");
    ensure!(body.dof_count() > 0, "the body has no degree of freedom, expected at least one to search over");
    check_pictures(cameras)
}

/// Holds the pictures of cameras to the sizes that corners are told apart in.
pub(crate) fn check_pictures(cameras: &[Camera]) -> Result<()> {
    for camera in cameras {
        let [width, height] = camera.size;
        ensure!(
            (1..=LARGEST_SIDE).contains(&width) && (1..=LARGEST_SIDE).contains(&height),
            "camera {} has pictures of {width}x{height}, expected 1 to {LARGEST_SIDE} pixels a side",
            camera.name
        );
    }
    Ok(())
}

/// Holds observations to the pictures sizes `[width, height]` of the views.
pub(crate) fn check_observations(
    observations: &[Observation],
    sizes: impl ExactSizeIterator<Item = [u32; 2]>,
) -> Result<()> {
    ensure!(
        observations.len() == sizes.len(),
        "there are {} observations for {} views, expected one a view",
        observations.len(),
        sizes.len()
    );
    for (view, (observation, [width, height])) in observations.iter().zip(sizes).enumerate() {
        ensure!(
            [observation.width, observation.height] == [width, height]
                && observation.bytes.len() == width as usize * height as usize,
            "the observation of view {view} is {}x{} with {} bytes, its camera's pictures are {width}x{height}",
            observation.width,
            observation.height,
            observation.bytes.len()
        );
        if let Some([across, down]) = observation.ignored.as_ref().map(|ignored| [ignored.width(), ignored.height()]) {
            ensure!(
                [across, down] == [width, height],
                "the ignored pixels of view {view} are {across}x{down}, its observation is {width}x{height}"
            );
        }
    }
    Ok(())
}
