//! Components to fitness (SPEC A7).

use anyhow::Result;

use super::scene::DeviceScene;
use super::workspace::Workspace;
use crate::evaluate::Objective;
use crate::evaluate::shaders::{OBJECTIVE_GROUP, layout, objective_comp};
use crate::gpu::{Buffer, ComputeStage, Device, Groups, Recorder, Stage};

/// The stage.
#[derive(Debug)]
pub(crate) struct ObjectiveStage {
    stage: ComputeStage,
}

impl ObjectiveStage {
    /// Its name in timings.
    pub(crate) const NAME: &'static str = "objective";

    /// Compiles it.
    pub(crate) fn new(device: &Device) -> Result<Self> {
        Ok(Self {
            stage: ComputeStage::new(device, Self::NAME, Stage { shader: &objective_comp::SHADER, constants: &[] })?,
        })
    }

    /// Records it for the first `candidates` of the run, in one go however many batches they took: `workspace.sums` to
    /// `fitness`, single precision, one a candidate.
    pub(crate) fn record(
        &self,
        recorder: &mut Recorder,
        model: &DeviceScene,
        workspace: &Workspace,
        objective: &Objective,
        candidates: u32,
        fitness: &Buffer,
    ) -> Result<()> {
        let push = scoring(model, objective, candidates);
        let bindings = objective_comp::Bindings { cameras: &model.cameras, all_sums: &workspace.sums, fitness };
        self.stage.record(
            recorder,
            &bindings.bound(),
            &push,
            Groups::Count([candidates.div_ceil(OBJECTIVE_GROUP), 1, 1]),
        )
    }
}

/// The push constants of both forms of the objective.
pub(super) fn scoring(model: &DeviceScene, objective: &Objective, candidates: u32) -> layout::Scoring {
    let (terms, over) = objective.kind.formula();
    layout::Scoring {
        candidates,
        views: model.counts.views,
        terms: terms as u32,
        over: over as u32,
        beta: objective.beta,
        w1: objective.w1,
        w2: objective.w2,
    }
}
