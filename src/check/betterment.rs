//! By how much a change of one camera betters the agreement of the views, and whether the scatter of the silhouettes from one moment to
//! the next could have made it.

use super::agreement::{CAP, Ray, disagreements};

/// A change counts when it takes this part of the disagreement away: faults of silhouettes, which are alike at all moments, do less.
pub(super) const COUNTS: f64 = 0.05;

/// And what it changes is as many times its scatter over the moments.
pub(super) const SURE: f64 = 3.0;

/// What a change does to the disagreement of the rays that can show it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Betterment {
    /// Mean disagreement before and after, pixels.
    pub(super) before: f64,
    pub(super) after: f64,
    /// How many standard errors over the moments the betterment is; infinite for one moment, which has no scatter.
    pub(super) sureness: f64,
    /// Moments at which the views agree better after the change, and all.
    pub(super) better: usize,
    pub(super) moments: usize,
}

impl Betterment {
    /// Of the same moments' rays before and after.
    pub(super) fn of(before: &[Ray], after: &[Ray], moments: usize) -> Self {
        let pairs: Vec<[f64; 2]> = disagreements(before, moments, CAP)
            .into_iter()
            .zip(disagreements(after, moments, CAP))
            .filter_map(|(before, after)| Some([before?, after?]))
            .collect();
        let count = pairs.len().max(1) as f64;
        let mean = |value: &dyn Fn(&[f64; 2]) -> f64| pairs.iter().map(value).sum::<f64>() / count;
        let (mean_before, mean_after) = (mean(&|pair| pair[0]), mean(&|pair| pair[1]));
        let gain = mean_before - mean_after;
        let variance =
            pairs.iter().map(|[before, after]| (before - after - gain).powi(2)).sum::<f64>() / (count - 1.0).max(1.0);
        let error = (variance / count).sqrt();
        let sureness = if pairs.len() > 1 && error > 0.0 { gain / error } else { gain.signum() * f64::INFINITY };
        Self {
            before: mean_before,
            after: mean_after,
            sureness,
            better: pairs.iter().filter(|[before, after]| after < before).count(),
            moments: pairs.len(),
        }
    }

    /// The disagreement that the change takes away, pixels.
    pub(super) fn gain(&self) -> f64 {
        self.before - self.after
    }

    /// The part of the disagreement that is taken away.
    pub(super) fn part(&self) -> f64 {
        if self.before > 0.0 { self.gain() / self.before } else { 0.0 }
    }

    /// Whether the change takes away more than the silhouettes' faults would.
    pub(super) fn counts(&self) -> bool {
        self.part() >= COUNTS
    }

    /// In words.
    pub(super) fn words(&self) -> String {
        let Self { before, after, better, moments, .. } = self;
        let sureness =
            if self.sureness.is_finite() { format!(" ({:.1} standard errors)", self.sureness) } else { String::new() };
        format!(
            "the views then disagree by {after:.3} px instead of {before:.3}, less at {better} of {moments} moments{sureness}"
        )
    }
}
