//! Every particle takes note of its best and moves.

use anyhow::Result;

use super::Extent;
use super::generated::move_comp;
use crate::gpu::{ComputeStage, Device, Recorder, Stage};

/// What draws the particles in a move.
#[derive(Clone, Copy, Debug)]
pub(in crate::search) struct Pull {
    /// The iteration moved into, 1 and up.
    pub(in crate::search) iteration: u32,
    /// Share of the velocity that is kept.
    pub(in crate::search) inertia: f32,
    /// Towards the particle's own best.
    pub(in crate::search) cognitive: f32,
    /// Towards the swarm's best.
    pub(in crate::search) social: f32,
}

/// The stage.
#[derive(Debug)]
pub(in crate::search) struct MoveStage {
    stage: ComputeStage,
}

impl MoveStage {
    /// Its name in timings.
    pub(in crate::search) const NAME: &'static str = "move";

    /// Compiles it.
    pub(in crate::search) fn new(device: &Device) -> Result<Self> {
        let stage = ComputeStage::new(device, Self::NAME, Stage { shader: &move_comp::SHADER, constants: &[] })?;
        Ok(Self { stage })
    }

    /// Records it; without a pull, particles only take note.
    pub(in crate::search) fn record(
        &self,
        recorder: &mut Recorder,
        bindings: &move_comp::Bindings<'_>,
        extent: Extent,
        pull: Option<Pull>,
    ) -> Result<()> {
        let Pull { iteration, inertia, cognitive, social } =
            pull.unwrap_or(Pull { iteration: 0, inertia: 0.0, cognitive: 0.0, social: 0.0 });
        let Extent { candidates: particles, dofs } = extent;
        let push = move_comp::Push { particles, dofs, iteration, inertia, cognitive, social };
        let groups = extent.block_groups(recorder.device());
        self.stage.record(recorder, &bindings.bound(), &push, groups)
    }
}
