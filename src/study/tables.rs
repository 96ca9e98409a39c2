//! Tables of a study, as CSV for programs and as Markdown for people.

use std::io::Write;

use anyhow::Result;

use super::axes::{Axis, Value};
use super::outcome::Row;
use super::settings::{Study, TableSettings};
use super::summary::{Cell, at, places};

/// A table with its cells.
pub(super) struct Table<'a> {
    settings: &'a TableSettings,
    rows: Vec<Vec<String>>,
    columns: Vec<Vec<String>>,
    /// Row by row.
    cells: Vec<Cell>,
}

impl Table<'_> {
    pub(super) fn new<'a>(settings: &'a TableSettings, runs: &[Row]) -> Table<'a> {
        let (rows, columns) = (places(runs, &settings.rows), places(runs, &settings.columns));
        let axes: Vec<Axis> = settings.rows.iter().chain(&settings.columns).copied().collect();
        let cell = |row: &Vec<String>, column: &Vec<String>| {
            let here: Vec<String> = row.iter().chain(column).cloned().collect();
            at(runs, &axes, &here, settings.value)
        };
        let cells = rows.iter().flat_map(|row| columns.iter().map(move |column| cell(row, column))).collect();
        Table { settings, rows, columns, cells }
    }

    /// Whether no run has a value for it.
    pub(super) fn is_empty(&self) -> bool {
        self.cells.iter().all(|cell| cell.statistic.is_none())
    }

    /// One row a cell: the axes, then `runs,mean,std`.
    pub(super) fn write_csv(&self, out: &mut dyn Write) -> Result<()> {
        let mut table = csv::Writer::from_writer(out);
        let axes = self.settings.rows.iter().chain(&self.settings.columns).map(|axis| axis.name());
        table.write_record(axes.chain(["runs", "mean", "std"]))?;
        for Cell { place, statistic } in &self.cells {
            let values = match statistic {
                Some(it) => [it.count.to_string(), format!("{:.4}", it.mean), format!("{:.4}", it.std)],
                None => ["0".to_string(), String::new(), String::new()],
            };
            table.write_record(place.iter().chain(&values))?;
        }
        Ok(table.flush()?)
    }

    /// The table in Markdown under its title; a cell is `mean ± standard deviation`, the best of a column in bold where
    /// smaller or larger is better.
    pub(super) fn markdown(&self) -> String {
        let TableSettings { name, title, value, .. } = self.settings;
        let title = if title.is_empty() { name } else { title };
        format!("**{title}** ({})\n\n{}", value.heading(), self.body())
    }

    /// The same without its title.
    pub(super) fn body(&self) -> String {
        let TableSettings { value, rows, columns, .. } = self.settings;
        let head = |place: &Vec<String>| {
            let named = columns.iter().zip(place).map(|(axis, at)| match axis {
                axis if axis.is_number() => format!("{at} {}", axis.name()),
                _ => at.clone(),
            });
            named.collect::<Vec<_>>().join(", ")
        };
        let mut text = String::from("|");
        for axis in rows {
            text += &format!(" {} |", axis.name());
        }
        for place in &self.columns {
            let head = head(place);
            text += &format!(" {} |", if head.is_empty() { value.heading() } else { &head });
        }
        text += &format!("\n|{}\n", "---|".repeat(rows.len() + self.columns.len()));
        let width = self.columns.len();
        let best: Vec<Option<f64>> = (0..width).map(|column| self.best_of_column(column)).collect();
        for (row, place) in self.rows.iter().enumerate() {
            text += &format!("| {} |", place.join(" | "));
            for (column, best) in best.iter().enumerate() {
                let statistic = self.cells[row * width + column].statistic;
                let shown = statistic.map_or("–".to_string(), |it| {
                    let digits = if it.mean.abs() >= 2.0 { 1 } else { 3 };
                    let mean = format!("{:.digits$}", it.mean);
                    let mean = if *best == Some(it.mean) && self.rows.len() > 1 { format!("**{mean}**") } else { mean };
                    if it.count > 1 { format!("{mean} ± {:.digits$}", it.std) } else { mean }
                });
                text += &format!(" {shown} |");
            }
            text += "\n";
        }
        text
    }

    fn best_of_column(&self, column: usize) -> Option<f64> {
        let means = self.cells.iter().skip(column).step_by(self.columns.len());
        let means = means.filter_map(|cell| cell.statistic.map(|it| it.mean));
        match self.settings.value {
            Value::Error | Value::ErrorWithoutOffset | Value::SearchTime | Value::EvaluationTime | Value::Skipped => {
                means.min_by(f64::total_cmp)
            }
            Value::FramesPerSecond | Value::Fitness | Value::Confidence => means.max_by(f64::total_cmp),
        }
    }
}

/// The tables of a study: those it asks for, else one of the errors and one of the frame rates.
pub(super) fn settings(study: &Study) -> Vec<TableSettings> {
    if !study.tables.is_empty() {
        return study.tables.clone();
    }
    let varied: Vec<Axis> = [
        (Axis::Backend, study.backends.len()),
        (Axis::Model, study.models.len()),
        (Axis::Objective, study.objectives().len()),
        (Axis::Search, study.searches.len()),
        (Axis::Iterations, study.iterations.len()),
        (Axis::Pace, study.paces.len()),
    ]
    .into_iter()
    .filter_map(|(axis, entries)| (entries > 1).then_some(axis))
    .chain([Axis::Particles])
    .collect();
    [("error", Value::Error), ("rate", Value::FramesPerSecond)]
        .map(|(name, value)| TableSettings {
            name: name.to_string(),
            title: String::new(),
            value,
            rows: varied.clone(),
            columns: vec![Axis::Sequence],
        })
        .to_vec()
}
