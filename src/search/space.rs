//! The space of poses a search moves in.

use anyhow::{Result, ensure};

use crate::body::Body;

/// The interval the steps of a body are for, s (INTERFACES).
const STEP_INTERVAL: f64 = 1.0 / 25.0;

/// Limits and speeds of every degree of freedom in single precision, in state-vector order (mm, radians).
#[derive(Clone, Debug, PartialEq)]
pub struct SearchSpace {
    lower: Vec<f32>,
    upper: Vec<f32>,
    step: Vec<f32>,
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
        Ok(Self { lower, upper, step })
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
        Self::new(lower, upper, body.dofs().map(|(_, dof)| dof.step as f32).collect())
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

    /// Whether a pose keeps the limits.
    pub fn contains(&self, pose: &[f32]) -> bool {
        pose.len() == self.dof_count()
            && pose.iter().zip(&self.lower).zip(&self.upper).all(|((value, low), high)| (low..=high).contains(&value))
    }
}
