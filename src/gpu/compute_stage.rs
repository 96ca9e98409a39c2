//! One compute pipeline under the name of its passes: what most stages are.

use anyhow::Result;
use bytemuck::NoUninit;

use super::device::Device;
use super::pass::{Dispatch, Groups};
use super::pipeline::{Pipeline, Stage};
use super::recorder::Recorder;
use super::shader::Binding;

/// A compute pipeline and the name of its passes, which is their debug label and their row of timings.
#[derive(Debug)]
pub struct ComputeStage {
    name: &'static str,
    pipeline: Pipeline,
}

impl ComputeStage {
    /// Compiles it.
    ///
    /// # Errors
    /// As [`Device::compute_pipeline`].
    pub fn new(device: &Device, name: &'static str, stage: Stage<'_>) -> Result<Self> {
        Ok(Self { name, pipeline: device.compute_pipeline(stage)? })
    }

    /// The name of its passes.
    pub fn name(&self) -> &'static str {
        self.name
    }

    /// Records a pass that runs it once.
    ///
    /// # Errors
    /// As [`Recorder::compute`].
    pub fn record(
        &self,
        recorder: &mut Recorder,
        bindings: &[Binding<'_>],
        push: &impl NoUninit,
        groups: Groups<'_>,
    ) -> Result<()> {
        recorder.compute(self.name, &[self.dispatch(bindings, push, groups)])
    }

    /// One run of it, for a pass of several.
    pub fn dispatch<'a>(
        &'a self,
        bindings: &'a [Binding<'a>],
        push: &'a impl NoUninit,
        groups: Groups<'a>,
    ) -> Dispatch<'a> {
        Dispatch { pipeline: &self.pipeline, bindings, push: bytemuck::bytes_of(push), groups }
    }
}
