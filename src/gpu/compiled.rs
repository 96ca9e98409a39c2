//! The pipelines of a device: each compiled when it is first asked for, and kept while the device is open.

use std::sync::Mutex;

use anyhow::Result;
use rayon::prelude::*;

use super::device::{Device, lock};
use super::pipeline::{Drawing, Pipeline};
use super::shader::ShaderStage;

/// What has been compiled.
#[derive(Default)]
pub(super) struct Compiled {
    pipelines: Mutex<Vec<(Source, Pipeline)>>,
}

/// What a pipeline is compiled from.
#[derive(PartialEq)]
struct Source {
    stages: Vec<ShaderStage>,
    /// None for compute.
    drawing: Option<Drawing>,
}

impl Compiled {
    /// The pipeline of `source`. Another thread may compile another one meanwhile.
    fn of(&self, source: Source, compile: impl FnOnce(&Source) -> Result<Pipeline>) -> Result<Pipeline> {
        let known = |pipelines: &[(Source, Pipeline)]| {
            pipelines.iter().find(|(known, _)| *known == source).map(|(_, pipeline)| pipeline.clone())
        };
        if let Some(pipeline) = known(&lock(&self.pipelines)) {
            return Ok(pipeline);
        }
        let pipeline = compile(&source)?;
        lock(&self.pipelines).push((source, pipeline.clone()));
        Ok(pipeline)
    }
}

impl Device {
    /// The pipeline of a compute stage.
    ///
    /// # Errors
    /// When the stage is not one for compute, exceeds a limit of the device, or its driver refuses it.
    pub fn compute_pipeline(&self, stage: &ShaderStage) -> Result<Pipeline> {
        let source = Source { stages: vec![stage.clone()], drawing: None };
        self.compiled().of(source, |_| Pipeline::compute(&self.shared, stage))
    }

    /// The pipeline of these stages, without vertex buffers: vertex stages read storage buffers. Viewport and scissor are set a
    /// draw.
    ///
    /// # Errors
    /// When the driver refuses it.
    pub fn graphics_pipeline<S>(&self, name: &str, stages: &[S], drawing: &Drawing) -> Result<Pipeline>
    where
        S: Clone + Into<ShaderStage>,
    {
        let stages = stages.iter().cloned().map(Into::into).collect();
        let source = Source { stages, drawing: Some(*drawing) };
        self.compiled().of(source, |source| Pipeline::graphics(&self.shared, name, &source.stages, drawing))
    }

    /// Compiles compute stages side by side ahead of their first use: drivers take up to a tenth of a second for one.
    ///
    /// # Errors
    /// As [`Self::compute_pipeline`].
    pub fn compile(&self, stages: &[ShaderStage]) -> Result<()> {
        stages.par_iter().try_for_each(|stage| self.compute_pipeline(stage).map(drop))
    }
}
