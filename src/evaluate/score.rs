//! One call for whoever has poses and wants numbers.

use anyhow::{Result, ensure};

use super::components::Components;
use super::cpu::Cpu;
use super::evaluator::Evaluator;
use crate::body::Body;
use crate::features::Observation;
use crate::geometry::Camera;

/// Scores poses against what the cameras saw, on the processor: the components (METHOD A6) of every pose in every view,
/// `components[pose * cameras.len() + view]`.
///
/// `poses` holds rows of [`Body::dof_count`] values (mm, radians), in the order of [`Body::dof_names`]. For many batches
/// against the same body and cameras, keep an [`Evaluator`] instead: making it is not free.
///
/// ```
/// use pantin::{bench::Scene, evaluate::{Objective, score}};
///
/// // A person among four cameras and what they see of her; yours come from `sequence::Sequence` and `track::ScoredFrame`.
/// let Scene { body, cameras, observations, pose } = Scene::new([480, 270], 150.0)?;
/// let mut poses = [pose.clone(), pose].concat();
/// poses[body.dof_count()] += 100.0; // the second one stands 100 mm beside her
/// let components = score(&body, &cameras, &observations, &poses)?;
/// let [right, wrong] = [&components[..4], &components[4..]].map(|pose| Objective::default().fitness(pose));
/// assert!(right > wrong + 0.1);
/// # anyhow::Ok(())
/// ```
///
/// # Errors
/// When there is no camera, an observation is missing or of another size than its camera's pictures, or `poses` is no
/// whole number of rows.
pub fn score(body: &Body, cameras: &[Camera], observations: &[Observation], poses: &[f32]) -> Result<Vec<Components>> {
    let mut evaluator = Cpu::new(body, cameras)?;
    let dofs = body.dof_count();
    ensure!(
        dofs > 0 && poses.len().is_multiple_of(dofs),
        "there are {} values, expected a whole number of poses of {dofs}",
        poses.len()
    );
    evaluator.observe(observations)?;
    let mut components = vec![Components::default(); poses.len() / dofs * cameras.len()];
    evaluator.components(poses, &mut components)?;
    Ok(components)
}
