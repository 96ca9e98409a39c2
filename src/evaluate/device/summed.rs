//! What a run sums of its candidates besides the components.

use anyhow::Result;

use super::evidence::DeviceEvidence;
use super::segments::DeviceSegments;
use super::workspace::Workspace;
use crate::gpu::Recorder;

/// What a run sums besides the components, with the memory for it.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Summed<'a> {
    Nothing,
    /// Areas and overlaps of the segments, and, where it is true, their edges and proximity.
    Segments(&'a DeviceSegments, bool),
    Evidence(&'a DeviceEvidence),
}

/// Records that all of them are 0, for stages that add to them.
pub(super) fn clear_sums(recorder: &mut Recorder, workspace: &Workspace, summed: Summed<'_>) -> Result<()> {
    recorder.fill("clear sums", &workspace.sums, 0)?;
    match summed {
        Summed::Nothing => Ok(()),
        Summed::Segments(segments, _) => recorder.fill("clear segments", &segments.sums, 0),
        Summed::Evidence(evidence) => recorder.fill("clear evidence", &evidence.sums, 0),
    }
}
