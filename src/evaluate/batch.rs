//! The layout of a batch and what every backend checks of it.

use anyhow::{Result, ensure};

use crate::features::Observation;

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
    }
    Ok(())
}
