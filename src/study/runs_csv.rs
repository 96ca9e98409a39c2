//! All runs of a study as CSV, written and read: runs.csv and stages.csv.

use std::io::Write;
use std::path::Path;

use anyhow::{Context, Result};
use serde::Deserialize;

use super::axes::Axis;
use super::outcome::{Outcome, RESULT, Row, StageShare};
use super::pace::Pace;
use super::run::{Run, USUAL};
use crate::body::Model;
use crate::evaluate::ObjectiveKind;
use crate::search::SearchKind;
use crate::track::Drawing;

/// Axes that lead a row; [`Axis::Pace`] came later and ends it.
fn leading() -> impl Iterator<Item = Axis> {
    Axis::ALL.into_iter().filter(|axis| *axis != Axis::Pace)
}

fn settings(run: &Run) -> Vec<String> {
    leading().map(|axis| axis.of(run)).chain([run.seed.to_string()]).collect()
}

fn header() -> impl Iterator<Item = &'static str> {
    leading().map(Axis::name).chain(["seed"])
}

/// Writes runs.csv: the settings, then `frames,points,error_mm,error_std_mm,error_without_offset_mm,frames_per_second,
/// fitness,confidence,evaluator,pace,skipped`; what a run has no value for is an empty cell.
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
        "pace",
        "skipped",
    ];
    table.write_record(header().chain(values))?;
    let number = |value: Option<f64>| value.map(|value| format!("{value:.4}")).unwrap_or_default();
    for Row { run, outcome } in rows {
        let mut cells = settings(run);
        cells.extend([outcome.frames.to_string(), outcome.points.to_string()]);
        cells.extend([outcome.error, outcome.error_std, outcome.error_without_offset].map(number));
        let rest = [outcome.frames_per_second, outcome.fitness, outcome.confidence];
        cells.extend(rest.map(|value| number(Some(value))));
        cells.extend([outcome.evaluator.clone(), run.pace.to_string(), number(outcome.skipped)]);
        table.write_record(&cells)?;
    }
    Ok(table.flush()?)
}

/// Writes stages.csv: the settings, then `stage,ms,pace`, one row a run and stage.
pub(super) fn write_stages(out: &mut dyn Write, rows: &[Row]) -> Result<()> {
    let mut table = csv::Writer::from_writer(out);
    table.write_record(header().chain(["stage", "ms", "pace"]))?;
    for Row { run, outcome } in rows {
        for stage in &outcome.stages {
            let mut cells = settings(run);
            cells.extend([stage.name.clone(), format!("{:.4}", stage.ms), run.pace.to_string()]);
            table.write_record(&cells)?;
        }
    }
    Ok(table.flush()?)
}

/// A row of either file, by its columns.
#[derive(Deserialize)]
struct Line {
    sequence: String,
    backend: Drawing,
    model: Model,
    objective: String,
    search: SearchKind,
    particles: usize,
    iterations: usize,
    seed: u64,
    #[serde(default)]
    pace: Pace,
    frames: Option<usize>,
    points: Option<usize>,
    error_mm: Option<f64>,
    error_std_mm: Option<f64>,
    error_without_offset_mm: Option<f64>,
    frames_per_second: Option<f64>,
    fitness: Option<f64>,
    confidence: Option<f64>,
    #[serde(default)]
    evaluator: String,
    skipped: Option<f64>,
    #[serde(default)]
    stage: String,
    ms: Option<f64>,
}

impl Line {
    /// The run, but for what no table tells: frames, spread and passes.
    fn run(&self) -> Result<Run> {
        let is_usual = self.objective == USUAL;
        Ok(Run {
            sequence: self.sequence.clone(),
            backend: self.backend,
            model: self.model,
            objective: if is_usual { None } else { Some(ObjectiveKind::from_name(&self.objective)?) },
            search: self.search,
            particles: self.particles,
            iterations: self.iterations,
            pace: self.pace,
            seed: self.seed,
            frames: String::new(),
            spread: 1.0,
            passes: None,
        })
    }
}

fn lines(path: &Path) -> Result<Vec<Line>> {
    let text = RESULT.read_text(path)?;
    let mut rows = csv::Reader::from_reader(text.as_bytes());
    rows.deserialize().collect::<Result<_, _>>().with_context(|| path.display().to_string())
}

/// The runs of runs.csv in a folder, with their times where stages.csv is there too, as [`write_runs`] and [`write_stages`] wrote them.
pub(super) fn read_rows(folder: &Path) -> Result<Vec<Row>> {
    let mut rows = Vec::new();
    for line in lines(&folder.join("runs.csv"))? {
        rows.push(Row {
            run: line.run()?,
            outcome: Outcome {
                frames: line.frames.unwrap_or_default(),
                points: line.points.unwrap_or_default(),
                error: line.error_mm,
                error_std: line.error_std_mm,
                error_without_offset: line.error_without_offset_mm,
                frames_per_second: line.frames_per_second.unwrap_or_default(),
                fitness: line.fitness.unwrap_or_default(),
                confidence: line.confidence.unwrap_or_default(),
                skipped: line.skipped,
                stages: Vec::new(),
                evaluator: line.evaluator,
            },
        });
    }
    let stages = folder.join("stages.csv");
    if !stages.exists() {
        return Ok(rows);
    }
    for line in lines(&stages)? {
        let run = line.run()?;
        if let (Some(row), Some(ms)) = (rows.iter_mut().find(|row| row.run == run), line.ms) {
            row.outcome.stages.push(StageShare { name: line.stage, ms });
        }
    }
    Ok(rows)
}
