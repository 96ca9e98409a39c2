//! What is summed of drawn candidates besides their components.

use super::edge_term::EdgeTerm;
use super::objective::Objective;

/// One of the sums that cost time of their own; the objective says which it needs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Besides {
    /// The components alone.
    Nothing,
    /// Areas and overlaps of the segments, where there are any.
    Segments,
    /// Those, and the edges of each with their proximity.
    SegmentEdges,
    /// Evidence.
    Evidence,
}

impl Besides {
    /// What an objective needs; silhouettes are compared by segments where there are any.
    pub(crate) fn of(objective: &Objective) -> Self {
        match objective.edges {
            _ if objective.weighs_evidence() => Self::Evidence,
            EdgeTerm::Whole => Self::Segments,
            EdgeTerm::Segments => Self::SegmentEdges,
        }
    }
}
