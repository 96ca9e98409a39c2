//! Soft evidence summed over what is drawn (METHOD A6): how far the colours of the pixels speak for the part that shows there.

use std::sync::Arc;

use anyhow::{Error, Result, anyhow, ensure};

use crate::features::{Evidence, Observation, PartClasses};

/// The evidence of one candidate in one view.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct EvidenceSum {
    /// Sum over the drawn pixels of code - 7, the code being that of the class of the part that shows there.
    pub sum: i32,
    /// What no drawing can exceed in this view ([`Evidence::best`]).
    pub best: u32,
}

/// The classes of a frame's evidence, the same in all views; none where no view has any.
pub(crate) fn evidence_of(observations: &[Observation]) -> Result<Option<Arc<PartClasses>>> {
    let classes = |view: &Observation| view.evidence.as_ref().map(|found| Arc::clone(found.classes()));
    let Some(first) = observations.first() else { return Ok(None) };
    let expected = classes(first);
    let mut pixels = 0;
    for (view, observation) in observations.iter().enumerate() {
        let size = (observation.width, observation.height);
        if let Some(found) = observation.evidence.as_ref().map(Evidence::dimensions) {
            ensure!(
                found == size,
                "the evidence of view {view} is {}x{}, its observation is {}x{}",
                found.0,
                found.1,
                size.0,
                size.1
            );
        }
        ensure!(
            classes(observation) == expected,
            "the observations of view 0 and view {view} have different evidence, expected the same classes of parts in every \
             view, or none"
        );
        pixels += u64::from(size.0) * u64::from(size.1);
    }
    // Sums over all views are 32-bit numbers on every device.
    let most = u64::from(i32::MAX as u32 / Evidence::NEUTRAL);
    ensure!(
        expected.is_none() || pixels <= most,
        "the views have {pixels} pixels together, and evidence is summed over at most {most}"
    );
    Ok(expected)
}

/// The best sums of observations, one a view; none without evidence.
pub(super) fn best_sums(observations: &[Observation]) -> Option<Arc<[u32]>> {
    observations.iter().map(|view| view.evidence.as_ref().map(Evidence::best)).collect()
}

/// What is said where evidence is asked for and there is none.
pub(super) fn no_evidence() -> Error {
    anyhow!("the observations carry no evidence: there is nothing to sum over what is drawn")
}
