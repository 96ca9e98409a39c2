//! What a way to draw candidates gives the backend that is made of it.

use anyhow::Result;

use super::evidence::DeviceEvidence;
use super::host_buffers::HostCounts;
use super::resources::Resources;
use super::scene::{DeviceScene, Share};
use super::segments::DeviceSegments;
use super::summed::Summed;
use super::workspace::Workspace;
use crate::evaluate::evaluator::Footprint;
use crate::evaluate::raster::CandidateImage;
use crate::features::{Observation, SeenView};
use crate::gpu::Recorder;

/// A way to draw candidates on a device and to compare them with the observations.
pub(crate) trait Rasteriser: Send {
    /// The backend's name as `--backend` takes it.
    const NAME: &'static str;

    /// How it does it: the name of its rows in tables.
    fn variant(&self) -> &'static str;

    /// How a candidate's picture is kept in memory.
    fn footprint(&self) -> Footprint;

    /// Makes room for runs of so many candidates.
    fn reserve(&mut self, _scene: &DeviceScene, _candidates: u32) -> Result<()> {
        Ok(())
    }

    /// Takes another workspace, made after [`Self::reserve`] of what memory was left.
    fn set_workspace(&mut self, _scene: &DeviceScene, _workspace: &Workspace) -> Result<()> {
        Ok(())
    }

    /// Most candidates of a batch.
    fn batch(&self, workspace: &Workspace) -> u32 {
        workspace.batch
    }

    /// Compares by these segments from now on; by whole silhouettes without.
    fn set_segments(
        &mut self,
        scene: &DeviceScene,
        workspace: &Workspace,
        segments: Option<&DeviceSegments>,
    ) -> Result<()>;

    /// Sums evidence from now on, or no longer.
    fn set_evidence(
        &mut self,
        scene: &DeviceScene,
        workspace: &Workspace,
        evidence: Option<&DeviceEvidence>,
    ) -> Result<()>;

    /// Takes the observations of a frame; `is_recorded` says whether a search has recorded itself with what is there.
    fn observe(&mut self, _scene: &DeviceScene, _observations: &[Observation], _is_recorded: bool) -> Result<()> {
        Ok(())
    }

    /// Takes what is known of observations that are handed over on the device.
    fn observe_handed(&mut self, _views: &[SeenView<'_>], _is_recorded: bool) {}

    /// Records the copies that bring its own buffers to the device, but for observations where they are handed over.
    fn record_upload(&self, _recorder: &mut Recorder, _is_handed: bool) -> Result<()> {
        Ok(())
    }

    /// Records what it makes of evidence that was made on the device.
    fn record_evidence(
        &self,
        _recorder: &mut Recorder,
        _scene: &DeviceScene,
        _evidence: &DeviceEvidence,
    ) -> Result<()> {
        Ok(())
    }

    /// Records everything from `resources.workspace.poses` to the sums of a share.
    fn record_share(
        &self,
        recorder: &mut Recorder,
        resources: &Resources,
        summed: Summed<'_>,
        share: Share,
    ) -> Result<()>;

    /// Records the same for a run that the host waits for: with the comparison on the host, to what it compares, and the sums of the
    /// images that the device scores all the same.
    fn record_host_share(
        &self,
        recorder: &mut Recorder,
        resources: &Resources,
        summed: Summed<'_>,
        share: Share,
    ) -> Result<()> {
        self.record_share(recorder, resources, summed, share)
    }

    /// Whether the host compares, after every batch.
    fn compares_on_host(&self) -> bool {
        false
    }

    /// Compares what a batch has left for the host, and adds it to `counts`.
    fn count(
        &self,
        _resources: &Resources,
        _summed: Summed<'_>,
        _share: Share,
        _counts: &mut HostCounts,
    ) -> Result<()> {
        Ok(())
    }

    /// Learns from a finished run of so many candidates; whether it is to be run again.
    fn learn(&mut self, _scene: &DeviceScene, _candidates: u32) -> Result<bool> {
        Ok(false)
    }

    /// Makes sure that what a search records serves any candidates.
    fn prepare_search(&mut self, _scene: &DeviceScene) {}

    /// Whether what was observed or learnt asks for other memory than there is.
    fn is_outgrown(&self) -> bool {
        false
    }

    /// Takes the memory that was asked for, when no recording holds the old one.
    fn refit(&mut self, _resources: &Resources) -> Result<()> {
        Ok(())
    }

    /// One pose in one view as it draws it; none where it keeps no picture.
    fn draw(&self, _resources: &Resources, _pose: &[f32], _view: usize) -> Result<Option<CandidateImage>> {
        Ok(None)
    }

    /// Refuses another body where what is drawn belongs to the one it was made with.
    fn check_exchange(&self) -> Result<()> {
        Ok(())
    }
}
