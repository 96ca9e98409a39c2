//! What a profile yields: the object of `pantin bench --profile --json` (FORMATS), and its time-line.

use std::path::Path;

use anyhow::{Context as _, Result};
use serde::{Deserialize, Serialize};
use serde_json::json;

use super::peaks::Peaks;
use crate::files::{Limit, Overwrite, write_atomically};
use crate::gpu::Work;

/// How often each stage of a pass ran.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Invocations {
    /// Compute.
    pub compute: u64,
    /// Vertices.
    pub vertices: u64,
    /// Primitives that reached the rasteriser.
    pub primitives: u64,
    /// Fragments.
    pub fragments: u64,
}

/// All passes of a name in an iteration.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Pass {
    /// Its name.
    pub name: String,
    /// How many there are.
    pub count: usize,
    /// Milliseconds of all together, the median of the rounds.
    pub ms: f64,
    /// Its part of all passes, 0 to 1.
    pub share: f64,
    /// Milliseconds between it and what ran before, in which the device waited or was given nothing.
    pub gap_ms: f64,
    /// Milliseconds after the iteration's first pass began that it began itself, in the last round.
    pub start_ms: f64,
    /// None where the device does not count them.
    pub invocations: Option<Invocations>,
    /// What its stages did; none where they cannot count, and for fills and copies.
    pub work: Option<Work>,
    /// What part of each peak that is; none without work.
    pub of_peak: Option<Peaks>,
}

/// An evaluator's iteration, poses in, fitness out.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Profile {
    /// The backend's name.
    pub backend: String,
    /// How it was done.
    pub variant: String,
    /// The body model.
    pub model: String,
    /// Candidates scored at once.
    pub particles: usize,
    /// Cameras.
    pub views: usize,
    /// Width of the pictures, pixels.
    pub width: u32,
    /// Height of the pictures, pixels.
    pub height: u32,
    /// Milliseconds of an iteration on the host's clock, without the measuring of passes.
    pub ms: f64,
    /// Milliseconds between passes, all together.
    pub gaps_ms: f64,
    /// Its passes, in order.
    pub passes: Vec<Pass>,
}

impl Profile {
    /// What was measured, as tables say it.
    pub(super) fn title(&self) -> String {
        let Self { backend, variant, model, particles, views, width, height, .. } = self;
        format!("{backend} {variant}: {model} model, {particles} particles, {views} cameras of {width}x{height}")
    }
}

/// A number that a driver tells of a stage, under its own name for it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Statistic {
    /// Such as `Register Count`, or `Spilled VGPRs`.
    pub name: String,
    /// The number.
    pub value: f64,
}

/// What a driver made of a stage.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CompiledStage {
    /// The pipeline.
    pub pipeline: String,
    /// The driver's name for the stage.
    pub stage: String,
    /// Invocations of its subgroups.
    pub subgroup_size: u32,
    /// Registers, spills, occupancy: whatever the driver tells.
    pub statistics: Vec<Statistic>,
}

/// A device's profile.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ProfileReport {
    /// Processor, its threads, operating system.
    pub machine: String,
    /// The Vulkan device and its driver.
    pub device: String,
    /// What it can do at most, a second.
    pub peaks: Peaks,
    /// What was measured.
    pub profiles: Vec<Profile>,
    /// What the driver made of the stages; empty where it does not tell.
    pub compiled: Vec<CompiledStage>,
    /// What could not be measured, and why.
    pub unavailable: Vec<String>,
}

/// A profile kept in a file.
const PROFILE: Limit = Limit { what: "a profile of pantin bench --profile --json", most: 64 << 20 };

impl ProfileReport {
    /// Reads what `pantin bench --profile --json` printed.
    ///
    /// # Errors
    /// When the file cannot be read, or holds something else: the sentence names the file, the line and what was expected.
    pub fn read(path: &Path) -> Result<Self> {
        let text = PROFILE.read_text(path)?;
        serde_json::from_str(&text).with_context(|| format!("{}: expected {}", path.display(), PROFILE.what))
    }
}

/// Writes the last round of every profile as a trace of Chrome's format: a process each, microseconds.
///
/// # Errors
/// When the file is there, or cannot be written.
pub fn write_trace(report: &ProfileReport, path: &Path) -> Result<()> {
    let mut events = Vec::new();
    for (process, profile) in (1_u32..).zip(&report.profiles) {
        let Profile { backend, variant, model, particles, views, width, height, .. } = profile;
        let name = format!("{backend} {variant}, {model}, {particles} particles, {views} x {width}x{height}");
        events.push(json!({ "name": "process_name", "ph": "M", "pid": process, "args": { "name": name } }));
        for pass in &profile.passes {
            events.push(json!({
                "name": pass.name, "ph": "X", "pid": process, "tid": 1, "ts": pass.start_ms * 1e3, "dur": pass.ms * 1e3,
                "args": { "count": pass.count, "invocations": pass.invocations, "work": pass.work, "of_peak": pass.of_peak },
            }));
        }
    }
    write_atomically(path, Overwrite::Refuse, |file| {
        serde_json::to_writer(file, &json!({ "displayTimeUnit": "ms", "traceEvents": events }))?;
        Ok(())
    })
}
