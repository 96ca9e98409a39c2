//! What a benchmark yields: the object of `pantin bench --json` (FORMATS).

use serde::{Serialize, Serializer};

use super::contestants::{Missing, WrongPixels};

/// One evaluator on one task.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    /// Its name as `--backend` takes it.
    pub backend: String,
    /// How it was done.
    pub variant: String,
    /// Its name: `flat`, or a rung of the ladder of frusta.
    pub model: String,
    /// Candidates scored at once.
    pub particles: usize,
    /// Cameras.
    pub views: usize,
    /// Width of the pictures, pixels.
    pub width: u32,
    /// Height of the pictures, pixels.
    pub height: u32,
    /// Width and height of the piece of a picture that is worked on at once, pixels.
    pub tile: [u32; 2],
    /// Memory written for a pixel of a candidate's picture, bytes; none where the evaluator does not tell.
    pub bytes_per_pixel: Option<f64>,
    /// Median of an iteration, poses in, fitness out.
    pub ms: f64,
    /// The shortest.
    pub ms_min: f64,
    /// The longest.
    pub ms_max: f64,
    /// Milliseconds by stage, in order, measured in rounds of their own; empty where an evaluator has none.
    #[serde(serialize_with = "as_map")]
    pub stages: Vec<(String, f64)>,
    /// Poses scored a second.
    pub poses_per_s: f64,
    /// Pictures a second: one a pose and view.
    pub images_per_s: f64,
    /// Pixels of those pictures a second, all of each, drawn or not.
    pub pixels_per_s: f64,
    /// What it draws wrong, where it is known to and measured all the same.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub wrong: Option<WrongPixels>,
}

fn as_map<S: Serializer>(stages: &[(String, f64)], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map(stages.iter().map(|(name, ms)| (name, ms)))
}

/// A benchmark's results.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BenchReport {
    /// The preset's name.
    pub preset: String,
    /// Processor, its threads, operating system.
    pub machine: String,
    /// The Vulkan device and its driver; none without one.
    pub device: Option<String>,
    /// What was measured.
    pub rows: Vec<Row>,
    /// What could not be measured here, and why.
    pub unavailable: Vec<Missing>,
}

/// The processor, its threads and the operating system in a line.
pub(super) fn machine() -> String {
    let told = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = told.lines().find_map(|line| line.strip_prefix("model name")?.split_once(':'));
    let model = model.map_or(std::env::consts::ARCH, |(_, name)| name.trim());
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    format!("{model}, {threads} threads, {}", std::env::consts::OS)
}
