//! What one run yielded, and how it is kept.

use std::io::Write;

use anyhow::Result;
use serde::{Deserialize, Serialize};

use super::axes::Axis;
use super::plan::Run;

/// A run and what it yielded: `row.json` of its folder, a row of runs.csv.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Row {
    /// The run.
    pub run: Run,
    /// What it yielded.
    pub outcome: Outcome,
}

/// What a run yielded.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct Outcome {
    /// Frames tracked.
    pub frames: usize,
    /// Points that were compared with the truth.
    pub points: usize,
    /// Mean error over frames, then over points, mm (SPEC A10).
    pub error: Option<f64>,
    /// Standard deviation of all point-frame errors, mm.
    pub error_std: Option<f64>,
    /// The error after each point's constant mean offset is taken away, mm.
    pub error_without_offset: Option<f64>,
    /// Frames a second.
    pub frames_per_second: f64,
    /// Mean fitness.
    pub fitness: f64,
    /// Mean confidence.
    pub confidence: f64,
    /// Where the time went.
    pub stages: Vec<StageShare>,
    /// The evaluator's name and variant, as `auto` resolved it.
    pub evaluator: String,
}

/// The time of one stage of a run.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct StageShare {
    /// Its name.
    pub name: String,
    /// Of one frame, ms.
    pub ms: f64,
}

impl Outcome {
    /// The time of a stage in one frame, ms.
    pub fn stage(&self, name: &str) -> Option<f64> {
        self.stages.iter().find(|stage| stage.name == name).map(|stage| stage.ms)
    }
}

fn settings(run: &Run) -> Vec<String> {
    let seed = run.seed.to_string();
    Axis::ALL.into_iter().map(|axis| axis.of(run)).chain([seed]).collect()
}

fn header() -> impl Iterator<Item = &'static str> {
    Axis::ALL.into_iter().map(Axis::name).chain(["seed"])
}

/// Writes runs.csv: the settings, then `frames,points,error_mm,error_std_mm,error_without_offset_mm,frames_per_second,
/// fitness,confidence,evaluator`; what a run has no value for is an empty cell.
pub(super) fn write_runs(out: &mut dyn Write, rows: &[Row]) -> Result<()> {
    let mut table = csv::Writer::from_writer(out);
    let values = [
        "frames",
        "points",
        "error_mm",
        "error_std_mm",
        "error_without_offset_mm",
        "frames_per_second",
        "fitness",
        "confidence",
        "evaluator",
    ];
    table.write_record(header().chain(values))?;
    let number = |value: Option<f64>| value.map(|value| format!("{value:.4}")).unwrap_or_default();
    for Row { run, outcome } in rows {
        let mut cells = settings(run);
        cells.extend([outcome.frames.to_string(), outcome.points.to_string()]);
        cells.extend([outcome.error, outcome.error_std, outcome.error_without_offset].map(number));
        let rest = [outcome.frames_per_second, outcome.fitness, outcome.confidence];
        cells.extend(rest.map(|value| number(Some(value))));
        cells.push(outcome.evaluator.clone());
        table.write_record(&cells)?;
    }
    Ok(table.flush()?)
}

/// Writes stages.csv: the settings, then `stage,ms`, one row a run and stage.
pub(super) fn write_stages(out: &mut dyn Write, rows: &[Row]) -> Result<()> {
    let mut table = csv::Writer::from_writer(out);
    table.write_record(header().chain(["stage", "ms"]))?;
    for Row { run, outcome } in rows {
        for stage in &outcome.stages {
            let mut cells = settings(run);
            cells.extend([stage.name.clone(), format!("{:.4}", stage.ms)]);
            table.write_record(&cells)?;
        }
    }
    Ok(table.flush()?)
}
