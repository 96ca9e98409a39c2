//! Silhouettes and edges compared segment by segment (METHOD A6, A7): a body in parts that look alike.

use std::sync::Arc;

use anyhow::{Error, Result, anyhow, ensure};

use crate::features::{Observation, Segmentation, Segments};

/// Sums over the pixels of one candidate in one view and one segment. A drawn pixel belongs to the segment of the part that is
/// visible there; one of a part in no segment belongs to none.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct SegmentSums {
    /// Pixels observed as this segment.
    pub area_obs: u32,
    /// Pixels drawn as this segment.
    pub area_model: u32,
    /// Pixels observed and drawn as this segment.
    pub overlap: u32,
    /// Visible edge pixels drawn as this segment.
    pub edges: u32,
    /// Sum over these of the packed 7-bit proximity.
    pub proximity: u32,
}

/// The segments of a frame's observations, one a view: those of all of them, or none.
pub(crate) fn segments_of(observations: &[Observation]) -> Result<Option<Arc<Segments>>> {
    let segments = |view: &Observation| view.segmentation.as_ref().map(|found| Arc::clone(found.segments()));
    let Some(first) = observations.first() else { return Ok(None) };
    let expected = segments(first);
    for (view, observation) in observations.iter().enumerate() {
        let size = (observation.width, observation.height);
        if let Some(found) = observation.segmentation.as_ref().map(Segmentation::dimensions) {
            ensure!(
                found == size,
                "the segmentation of view {view} is {}x{}, its observation is {}x{}",
                found.0,
                found.1,
                size.0,
                size.1
            );
        }
        ensure!(
            segments(observation) == expected,
            "the observations of view 0 and view {view} have different segments, expected the same ones in every view, or none"
        );
    }
    Ok(expected)
}

/// What is said where sums of segments are asked for and there are none.
pub(super) fn no_segments() -> Error {
    anyhow!("the observations do not tell body parts apart: there are no sums of segments")
}
