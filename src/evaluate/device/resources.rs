//! What an evaluation works with on a device, whichever way candidates are drawn.

use anyhow::{Result, ensure};

use super::evidence::DeviceEvidence;
use super::host_buffers::HostBuffers;
use super::passes;
use super::scene::{DeviceScene, Share};
use super::segments::DeviceSegments;
use super::summed::Summed;
use super::workspace::Workspace;
use crate::evaluate::besides::Besides;
use crate::evaluate::device_evaluator::Scoring;
use crate::evaluate::evidence::no_evidence;
use crate::evaluate::objective::Objective;
use crate::gpu::Recorder;

/// Body, cameras and observations, and the memory for a number of candidates.
#[derive(Debug)]
pub(crate) struct Resources {
    pub(super) scene: DeviceScene,
    pub(super) workspace: Workspace,
    pub(super) host: HostBuffers,
    /// Where the newest observations have them.
    pub(super) segments: Option<DeviceSegments>,
    /// Where the newest observations carry it.
    pub(super) evidence: Option<DeviceEvidence>,
}

impl Resources {
    /// For one candidate at first.
    pub(super) fn new(scene: DeviceScene) -> Result<Self> {
        Ok(Self {
            workspace: Workspace::new(&scene.device, scene.counts, 1)?,
            host: HostBuffers::new(&scene, 1)?,
            segments: None,
            evidence: None,
            scene,
        })
    }

    /// What is summed besides the components where that is asked for.
    pub(super) fn summed(&self, besides: Besides) -> Result<Summed<'_>> {
        Ok(match besides {
            Besides::Nothing => Summed::Nothing,
            Besides::Segments | Besides::SegmentEdges => self
                .segments
                .as_ref()
                .map_or(Summed::Nothing, |segments| Summed::Segments(segments, besides == Besides::SegmentEdges)),
            Besides::Evidence => Summed::Evidence(self.evidence.as_ref().ok_or_else(no_evidence)?),
        })
    }

    /// Records the copies that bring body, cameras and observations to the device.
    pub(super) fn record_upload(&self, recorder: &mut Recorder) -> Result<()> {
        self.scene.record_upload(recorder)?;
        self.segments.as_ref().map_or(Ok(()), |segments| segments.record_upload(recorder))?;
        // What is handed over comes with its evidence.
        let evidence = self.evidence.as_ref().filter(|_| !self.scene.is_handed());
        evidence.map_or(Ok(()), |evidence| evidence.record_upload(recorder))
    }

    /// What makes the fitness of a run from its sums.
    pub(super) fn scoring(&self, objective: &Objective, candidates: u32) -> Result<Scoring<'_>> {
        let Self { scene, workspace, host, .. } = self;
        let summed = self.summed(Besides::of(objective))?;
        Ok(passes::objective((scene, workspace), summed, (objective, candidates), &host.fitness))
    }

    /// The batches of at most `batch` candidates of a run.
    pub(super) fn shares(&self, candidates: u32, batch: u32) -> Result<Vec<Share>> {
        ensure!(
            candidates <= self.workspace.candidates,
            "there is room for {} candidates, and {candidates} were asked for",
            self.workspace.candidates
        );
        let firsts = (0..candidates).step_by(batch as usize);
        Ok(firsts.map(|first| Share { first, candidates: batch.min(candidates - first) }).collect())
    }
}
