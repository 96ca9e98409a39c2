//! The pipelines of a device: each compiled when it is first asked for, and kept while the device is open.

use std::sync::Mutex;

use anyhow::Result;

use super::executables::Executable;
use super::fixed_function::Drawing;
use super::lock::lock;
use super::pipeline::Pipeline;
use super::shader::ShaderStage;

/// What has been compiled.
#[derive(Default)]
pub(super) struct Compiled {
    pipelines: Mutex<Vec<(Source, Pipeline)>>,
}

/// What a pipeline is compiled from.
#[derive(PartialEq)]
pub(super) struct Source {
    pub(super) stages: Vec<ShaderStage>,
    /// None for compute.
    pub(super) drawing: Option<Drawing>,
}

impl Compiled {
    /// The pipeline of `source`. Another thread may compile another one meanwhile.
    pub(super) fn of(&self, source: Source, compile: impl FnOnce(&Source) -> Result<Pipeline>) -> Result<Pipeline> {
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

    /// What the driver made of each, of those it tells something of.
    pub(super) fn executables(&self) -> Vec<(String, Vec<Executable>)> {
        let pipelines = lock(&self.pipelines);
        let told = pipelines.iter().map(|(_, pipeline)| (pipeline.name().to_string(), pipeline.executables()));
        told.filter(|(_, executables)| !executables.is_empty()).collect()
    }
}
