//! Components and segments' sums to fitness (SPEC A7).

use anyhow::Result;

use super::objective::scoring;
use super::scene::DeviceScene;
use super::workspace::Workspace;
use crate::evaluate::Objective;
use crate::evaluate::shaders::{OBJECTIVE_GROUP, objective_segments_comp};
use crate::gpu::{Buffer, ComputeStage, Device, Groups, Recorder, Stage};

/// The stage.
#[derive(Debug)]
pub(crate) struct ObjectiveSegmentsStage {
    stage: ComputeStage,
}

impl ObjectiveSegmentsStage {
    /// Its name in timings.
    pub(crate) const NAME: &'static str = "objective segments";

    /// Compiles it.
    pub(crate) fn new(device: &Device) -> Result<Self> {
        let shader = &objective_segments_comp::SHADER;
        Ok(Self { stage: ComputeStage::new(device, Self::NAME, Stage { shader, constants: &[] })? })
    }

    /// Records it for the first `candidates` of the run: `workspace.sums` and `segment_sums` to `fitness`.
    pub(crate) fn record(
        &self,
        recorder: &mut Recorder,
        (model, workspace): (&DeviceScene, &Workspace),
        (table, segment_sums): (&Buffer, &Buffer),
        (objective, candidates): (&Objective, u32),
        fitness: &Buffer,
    ) -> Result<()> {
        let bindings = objective_segments_comp::Bindings {
            cameras: &model.cameras,
            all_sums: &workspace.sums,
            fitness,
            table,
            all_segment_sums: segment_sums,
        };
        let groups = Groups::Count([candidates.div_ceil(OBJECTIVE_GROUP), 1, 1]);
        self.stage.record(recorder, &bindings.bound(), &scoring(model, objective, candidates), groups)
    }
}
