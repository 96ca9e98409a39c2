//! Stages that do in one pass what a search does behind the drawing of its candidates.

use anyhow::Result;
use bytemuck::{Pod, Zeroable, bytes_of, pod_read_unaligned};

use super::frame::FrameRecording;
use crate::evaluate::ScoredBy;
use crate::gpu::{Binding, Device, Dispatch, Groups, Shader, ShaderStage};
use crate::search::shaders::{
    LEARN_DOFS, LEARN_SAMPLES, LOOK_GROUP, SUM_LANES, advance_comp, advance_evidence_comp, advance_objective_comp,
    advance_segments_comp, layout, learn_comp, learn_evidence_comp, learn_objective_comp, learn_segments_comp,
};

/// A stage behind the drawing, in the forms that make the fitness themselves and in the one for a fitness that was made before.
pub(super) struct Behind {
    given: &'static Shader,
    silhouettes: &'static Shader,
    segments: &'static Shader,
    evidence: &'static Shader,
    /// Shared memory of a workgroup, bytes.
    shared: u32,
}

/// An iteration of a swarm: who improved, the best of all, and the move.
pub(super) const ADVANCE: Behind = Behind {
    given: &advance_comp::SHADER,
    silhouettes: &advance_objective_comp::SHADER,
    segments: &advance_segments_comp::SHADER,
    evidence: &advance_evidence_comp::SHADER,
    shared: 2 * 4 * LOOK_GROUP,
};

/// What an evolution learns from a generation: weights, mean, path, step size and matrix.
pub(super) const LEARN: Behind = Behind {
    given: &learn_comp::SHADER,
    silhouettes: &learn_objective_comp::SHADER,
    segments: &learn_segments_comp::SHADER,
    evidence: &learn_evidence_comp::SHADER,
    shared: 4 * (2 * LEARN_SAMPLES + LEARN_DOFS + SUM_LANES + 2),
};

/// Most candidates that an invocation scores: every workgroup scores all of them.
const SCORED_EACH: u32 = 4;

impl Behind {
    /// Whether a device has room for the stage behind a fitness that was made before.
    pub(super) fn fits(&self, device: &Device) -> bool {
        self.has_room(device, self.given)
    }

    fn has_room(&self, device: &Device, shader: &Shader) -> bool {
        let own = device.capabilities();
        let group: u32 = shader.workgroup_size.iter().product();
        group <= own.max_workgroup
            && self.shared <= own.shared_memory
            && shader.push_size <= own.push_constants
            && shader.bindings.len() as u32 <= own.stage_buffers
    }

    /// The form that makes this fitness of so many candidates itself, where it suits the device.
    fn scoring(&self, device: &Device, by: ScoredBy, candidates: u32) -> Option<&'static Shader> {
        let shader = match by {
            ScoredBy::Silhouettes => self.silhouettes,
            ScoredBy::Segments => self.segments,
            ScoredBy::Evidence => self.evidence,
            ScoredBy::Otherwise => return None,
        };
        let is_little = candidates <= SCORED_EACH * shader.workgroup_size[0];
        (is_little && self.has_room(device, shader)).then_some(shader)
    }
}

impl FrameRecording<'_> {
    /// Records the evaluation of candidates and such a stage behind it, in so many workgroups: the fitness in the same pass where that
    /// suits. `bindings` are those of the form for a fitness that was made before.
    pub(super) fn run_behind<P: Pod>(
        &mut self,
        behind: &Behind,
        candidates: u32,
        bindings: &[Binding<'_>],
        push: impl FnOnce(layout::Scoring) -> P,
        groups: u32,
    ) -> Result<()> {
        let Self { recorder, evaluator, objective, .. } = self;
        evaluator.record_sums(recorder, objective, candidates)?;
        let scoring = evaluator.scoring(objective, candidates)?;
        let groups = Groups::Count([groups, 1, 1]);
        let Some(shader) = behind.scoring(recorder.device(), scoring.by, candidates) else {
            let views = evaluator.views() as u32;
            let push = push(layout::Scoring { candidates, views, ..layout::Scoring::zeroed() });
            recorder.run(scoring.dispatch)?;
            let stage = ShaderStage { shader: behind.given, constants: Vec::new() };
            return recorder.run(Dispatch {
                stage,
                bindings: bindings.to_vec(),
                push: bytes_of(&push).to_vec(),
                groups,
            });
        };
        // The objective's descriptors are the first set, the search's the second.
        let own = bindings.iter().filter(|binding| binding.layout.set > 0);
        recorder.run(Dispatch {
            stage: ShaderStage { shader, constants: scoring.dispatch.stage.constants },
            bindings: scoring.dispatch.bindings.iter().chain(own).copied().collect(),
            push: bytes_of(&push(pod_read_unaligned(&scoring.dispatch.push))).to_vec(),
            groups,
        })
    }
}
