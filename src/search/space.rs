//! The space of poses a search moves in.

use anyhow::{Result, ensure};

use crate::body::Body;

/// The interval the steps of a body are for, s (FORMATS).
const STEP_INTERVAL: f64 = 1.0 / 25.0;

/// Limits and speeds of every degree of freedom in single precision, in state-vector order (mm, radians).
#[derive(Clone, Debug, PartialEq)]
pub struct SearchSpace {
    lower: Vec<f32>,
    upper: Vec<f32>,
    step: Vec<f32>,
    groups: Vec<usize>,
}

impl SearchSpace {
    /// A space from its limits and its steps (standard deviation of the change in 1/25 s).
    ///
    /// # Errors
    /// When there is no dimension, lengths differ, something is not finite, limits are reversed or a step is negative.
    pub fn new(lower: Vec<f32>, upper: Vec<f32>, step: Vec<f32>) -> Result<Self> {
        let count = lower.len();
        ensure!(count > 0, "there is no degree of freedom to search over");
        ensure!(
            upper.len() == count && step.len() == count,
            "{count} lower limits come with {} upper ones and {} steps, expected as many",
            upper.len(),
            step.len()
        );
        for (index, ((low, high), step)) in lower.iter().zip(&upper).zip(&step).enumerate() {
            ensure!(
                low.is_finite() && high.is_finite() && low <= high,
                "the limits of dimension {index} are {low} and {high}, expected finite numbers, the smaller first"
            );
            ensure!(
                step.is_finite() && *step >= 0.0,
                "the step of dimension {index} is {step}, expected a finite number of 0 or more"
            );
        }
        Ok(Self { groups: vec![0; count], lower, upper, step })
    }

    /// The space of a body's poses. Limits are rounded inwards, so that what keeps them here keeps them in the body.
    ///
    /// # Errors
    /// When the body has no degree of freedom.
    pub fn of(body: &Body) -> Result<Self> {
        let limits = body.dofs().map(|(_, dof)| {
            let [low, high] = [dof.limits[0] as f32, dof.limits[1] as f32];
            let low = if f64::from(low) < dof.limits[0] { low.next_up() } else { low };
            let high = if f64::from(high) > dof.limits[1] { high.next_down() } else { high };
            // A joint locked at a value that single precision lacks would have its limits cross.
            if low <= high { (low, high) } else { (high, high) }
        });
        let (lower, upper) = limits.unzip();
        let space = Self::new(lower, upper, body.dofs().map(|(_, dof)| dof.step as f32).collect())?;
        space.grouped(groups(body))
    }

    /// The same space with a group for every dimension, as [`Self::groups`] has them for a body.
    ///
    /// # Errors
    /// When there are not as many as dimensions.
    pub fn grouped(self, groups: Vec<usize>) -> Result<Self> {
        let (found, count) = (groups.len(), self.dof_count());
        ensure!(found == count, "{found} groups come for {count} dimensions, expected as many");
        Ok(Self { groups, ..self })
    }

    /// The number of dimensions.
    pub fn dof_count(&self) -> usize {
        self.lower.len()
    }

    /// Smallest values.
    pub fn lower(&self) -> &[f32] {
        &self.lower
    }

    /// Largest values.
    pub fn upper(&self) -> &[f32] {
        &self.upper
    }

    /// The group of every dimension: 0 for the torso, from 1 on for its limbs, each from where it leaves the torso to its
    /// end. A bone is the torso's if it is the root, if two or more branches of weight hang on it, or if such a bone
    /// hangs on it; a branch has weight with at least a sixteenth of the body's dimensions, so that fingers do not make
    /// an arm a part of the torso. A space without a body is one group unless [`Self::grouped`] says otherwise.
    pub fn groups(&self) -> &[usize] {
        &self.groups
    }

    /// The standard deviation to search with after `interval` seconds. A step stands for a joint's speed, so it grows in
    /// proportion to the time (skipped frames included), not with its square root.
    ///
    /// # Errors
    /// When the interval is not a positive, finite number.
    pub fn spread(&self, interval: f64) -> Result<Vec<f32>> {
        ensure!(
            interval > 0.0 && interval.is_finite(),
            "the time between frames is {interval} s, expected a positive number"
        );
        let factor = (interval / STEP_INTERVAL) as f32;
        Ok(self.step.iter().map(|step| step * factor).collect())
    }

    /// Moves a pose to the nearest one within the limits.
    pub fn clamp(&self, pose: &mut [f32]) {
        for ((value, low), high) in pose.iter_mut().zip(&self.lower).zip(&self.upper) {
            *value = value.max(*low).min(*high);
        }
    }

    /// The pose `offsets` away from `centre`, in units of `spread`; not held within the limits.
    pub(super) fn place(&self, centre: &[f32], spread: &[f32], offsets: &[f64], pose: &mut [f32]) {
        for (((value, centre), spread), offset) in pose.iter_mut().zip(centre).zip(spread).zip(offsets) {
            *value = (f64::from(*centre) + f64::from(*spread) * offset) as f32;
        }
    }

    /// Whether a pose keeps the limits.
    pub fn contains(&self, pose: &[f32]) -> bool {
        pose.len() == self.dof_count()
            && pose.iter().zip(&self.lower).zip(&self.upper).all(|((value, low), high)| (low..=high).contains(&value))
    }
}

/// The share of a body's dimensions that make a branch of weight, as its inverse.
const BRANCH: usize = 16;

/// [`SearchSpace::groups`] of a body.
fn groups(body: &Body) -> Vec<usize> {
    let count = body.bones.len();
    let mut weight: Vec<usize> = body.bones.iter().map(|bone| bone.dofs.len()).collect();
    let mut branches = vec![0; count];
    let mut is_torso = vec![false; count];
    // Children before their parents.
    for &bone in body.update_order.iter().rev() {
        let Some(parent) = body.bones[bone].parent else {
            is_torso[bone] = true;
            continue;
        };
        is_torso[bone] |= branches[bone] >= 2;
        weight[parent] += weight[bone];
        branches[parent] += usize::from(weight[bone] * BRANCH >= body.dof_count());
        is_torso[parent] |= is_torso[bone];
    }
    let (mut group, mut last) = (vec![0; count], 0);
    for &bone in &body.update_order {
        if is_torso[bone] {
            continue;
        }
        group[bone] = match body.bones[bone].parent {
            Some(parent) if !is_torso[parent] => group[parent],
            // A limb without any dimension needs no number.
            _ if weight[bone] == 0 => 0,
            _ => {
                last += 1;
                last
            }
        };
    }
    body.dofs().map(|(bone, _)| group[bone]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_adult_has_a_torso_and_five_limbs() {
        let body = Body::adult(1750.0).unwrap();
        let space = SearchSpace::of(&body).unwrap();
        let of = |name: &str| {
            let index = body.dof_names().iter().position(|dof| dof.starts_with(name)).unwrap();
            space.groups()[index]
        };
        assert_eq!(of("pelvis."), 0);
        let limbs = ["left_hip.", "right_hip.", "left_shoulder.", "right_shoulder.", "head."].map(of);
        assert!(limbs.iter().all(|limb| *limb > 0), "{limbs:?}");
        assert_eq!(limbs.iter().collect::<std::collections::HashSet<_>>().len(), 5);
        assert_eq!(of("left_knee."), of("left_hip."));
        assert_eq!(of("right_elbow."), of("right_shoulder."));
        assert_eq!(space.groups().iter().max(), Some(&5));
    }
}
