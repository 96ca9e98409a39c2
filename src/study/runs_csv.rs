//! All runs of a study as CSV: runs.csv and stages.csv.

use std::io::Write;

use anyhow::Result;

use super::axes::Axis;
use super::outcome::Row;
use super::run::Run;

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
