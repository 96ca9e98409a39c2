//! What is summed of drawn candidates besides their components.

use super::objective::Objective;

/// One of the sums that cost time of their own; the objective says which it needs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Besides {
    /// The components alone.
    Nothing,
    /// Areas and overlaps of the segments, where there are any.
    Segments,
    /// Evidence.
    Evidence,
}

impl Besides {
    /// What an objective needs; silhouettes are compared by segments where there are any.
    pub(crate) fn of(objective: &Objective) -> Self {
        if objective.weighs_evidence() { Self::Evidence } else { Self::Segments }
    }
}
