//! Means and standard deviations over the runs that a table or a plot does not tell apart.

use super::axes::{Axis, Value};
use super::outcome::Row;

/// Mean and spread of several runs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Statistic {
    /// Runs that have a value.
    pub count: usize,
    /// Their mean.
    pub mean: f64,
    /// Their standard deviation (of a sample: over count - 1); 0 for a single run.
    pub std: f64,
}

impl Statistic {
    /// Of values; none of nothing.
    pub fn of(values: impl IntoIterator<Item = f64>) -> Option<Self> {
        let values: Vec<f64> = values.into_iter().collect();
        let count = values.len();
        if count == 0 {
            return None;
        }
        let mean = values.iter().sum::<f64>() / count as f64;
        let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
        let std = if count > 1 { (squares / (count - 1) as f64).sqrt() } else { 0.0 };
        Some(Self { count, mean, std })
    }
}

/// The runs that share a place on some axes, and what they say.
#[derive(Clone, Debug, PartialEq)]
pub struct Cell {
    /// Where they stand, one entry an axis.
    pub place: Vec<String>,
    /// What they say; none where no run has the value.
    pub statistic: Option<Statistic>,
}

/// The places that runs take on some axes, in the order they first appear.
pub(super) fn places(rows: &[Row], axes: &[Axis]) -> Vec<Vec<String>> {
    let mut places: Vec<Vec<String>> = Vec::new();
    for row in rows {
        let place = place(row, axes);
        if !places.contains(&place) {
            places.push(place);
        }
    }
    places
}

/// Where a run stands.
pub(super) fn place(row: &Row, axes: &[Axis]) -> Vec<String> {
    axes.iter().map(|axis| axis.of(&row.run)).collect()
}

/// What the runs at one place say.
pub(super) fn at(rows: &[Row], axes: &[Axis], here: &[String], value: Value) -> Cell {
    let values = rows.iter().filter(|row| place(row, axes) == here).filter_map(|row| value.of(&row.outcome));
    Cell { place: here.to_vec(), statistic: Statistic::of(values) }
}
