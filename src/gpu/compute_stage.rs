//! One compute stage under the name of its passes.

use anyhow::Result;
use bytemuck::NoUninit;

use super::device::Device;
use super::pass::{Dispatch, Groups};
use super::recorder::Recorder;
use super::shader::{Binding, Shader, ShaderStage};

/// A shader and the values of its specialisation constants.
#[derive(Clone, Copy, Debug)]
pub struct Stage<'a> {
    /// The shader.
    pub shader: &'static Shader,
    /// `constant_id` and the bits of its value.
    pub constants: &'a [(u32, u32)],
}

impl From<Stage<'_>> for ShaderStage {
    fn from(stage: Stage<'_>) -> Self {
        Self { shader: stage.shader, constants: stage.constants.to_vec() }
    }
}

/// A compute stage and the name of its passes, which is their debug label and their row of timings.
#[derive(Debug)]
pub struct ComputeStage {
    name: &'static str,
    stage: ShaderStage,
}

impl ComputeStage {
    /// Compiles it.
    ///
    /// # Errors
    /// As [`Device::compute_pipeline`].
    pub fn new(device: &Device, name: &'static str, stage: Stage<'_>) -> Result<Self> {
        let stage = stage.into();
        device.compute_pipeline(&stage)?;
        Ok(Self { name, stage })
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
    pub fn dispatch<'a>(&self, bindings: &[Binding<'a>], push: &impl NoUninit, groups: Groups<'a>) -> Dispatch<'a> {
        let push = bytemuck::bytes_of(push).to_vec();
        Dispatch { stage: self.stage.clone(), bindings: bindings.to_vec(), push, groups }
    }
}
