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
