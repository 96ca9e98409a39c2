//! Everything that an objective is told of one candidate in one view.

use super::components::Components;
use super::evidence::EvidenceSum;

/// The components, and the evidence where the objective weighs it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct ViewCounts {
    /// Counts of pixels.
    pub components: Components,
    /// Evidence under what is drawn; none where silhouettes are compared.
    pub evidence: Option<EvidenceSum>,
}

impl ViewCounts {
    /// Those of all views, with the sums of evidence and the best there is where it is weighed.
    pub(super) fn all(components: Vec<Components>, evidence: Option<(Vec<i32>, &[u32])>) -> Vec<Self> {
        let mut all: Vec<Self> = components.into_iter().map(|components| Self { components, evidence: None }).collect();
        if let Some((sums, best)) = evidence {
            for ((counts, sum), &best) in all.iter_mut().zip(sums).zip(best) {
                counts.evidence = Some(EvidenceSum { sum, best });
            }
        }
        all
    }
}
