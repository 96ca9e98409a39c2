//! What a run sums of its candidates besides the components.

use super::evidence::DeviceEvidence;
use super::segments::DeviceSegments;

/// What a run sums besides the components, with the memory for it.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Summed<'a> {
    Nothing,
    Segments(&'a DeviceSegments),
    Evidence(&'a DeviceEvidence),
}
