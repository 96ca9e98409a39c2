//! Plots of a study, as SVG.

use anyhow::Result;

use super::axes::Axis;
use super::outcome::Row;
use super::settings::{PlotSettings, SharesSettings, Study};
use super::summary::{Statistic, at, place, places};
use crate::report::{Shares, XyLine, share_chart, xy_chart};

const SIZE: [u32; 2] = [760, 420];
const WIDTH: u32 = 860;

/// A value against a number, one line a place on the other axes, with standard deviations.
pub(super) fn plot(settings: &PlotSettings, rows: &[Row]) -> Result<String> {
    let PlotSettings { value, x, lines, sequence, .. } = settings;
    let is_meant = |row: &&Row| sequence.as_ref().is_none_or(|name| row.run.sequence == *name);
    let rows: Vec<Row> = rows.iter().filter(is_meant).cloned().collect();
    let rows = &rows[..];
    let lines: Vec<XyLine> = places(rows, lines)
        .into_iter()
        .map(|here| {
            let on_line: Vec<Row> = rows.iter().filter(|row| place(row, lines) == here).cloned().collect();
            let mut points: Vec<[f64; 3]> = places(&on_line, &[*x])
                .iter()
                .filter_map(|at_x| {
                    let number =
                        on_line.iter().find(|row| place(row, &[*x]) == *at_x).and_then(|row| x.number(&row.run))?;
                    let statistic = at(&on_line, &[*x], at_x, *value).statistic?;
                    Some([number, statistic.mean, statistic.std])
                })
                .collect();
            points.sort_by(|a, b| a[0].total_cmp(&b[0]));
            XyLine { name: here.join(", "), points }
        })
        .collect();
    xy_chart(x.name(), value.heading(), &lines, SIZE)
}

/// The stages of a frame, in the order they run in; what runs beside the search is told too.
pub(super) fn shares(settings: &SharesSettings, rows: &[Row]) -> Result<String> {
    let wholes: Vec<Shares> = places(rows, &settings.bars)
        .into_iter()
        .map(|here| {
            let of_bar: Vec<&Row> = rows.iter().filter(|row| place(row, &settings.bars) == here).collect();
            let mut names: Vec<&str> = Vec::new();
            for stage in of_bar.iter().flat_map(|row| &row.outcome.stages) {
                if !names.contains(&stage.name.as_str()) {
                    names.push(&stage.name);
                }
            }
            let mean = |name: &str| Statistic::of(of_bar.iter().filter_map(|row| row.outcome.stage(name)));
            let parts = names.iter().filter_map(|name| Some(((*name).to_string(), mean(name)?.mean))).collect();
            let named = settings.bars.iter().zip(&here).map(|(axis, at)| match axis {
                axis if axis.is_number() => format!("{at} {}", axis.name()),
                _ => at.clone(),
            });
            Shares { name: named.collect::<Vec<_>>().join(", "), parts }
        })
        .collect();
    share_chart(&wholes, "ms a frame", WIDTH)
}

/// The plots of a study: those it asks for, else errors and frame rates against particles, a line a sequence.
pub(super) fn settings(study: &Study) -> Vec<PlotSettings> {
    use super::axes::Value;
    if !study.plots.is_empty() || !study.shares.is_empty() {
        return study.plots.clone();
    }
    let mut lines = vec![Axis::Sequence];
    lines.extend(study.searches.get(1).map(|_| Axis::Search));
    [("error", Value::Error), ("rate", Value::FramesPerSecond)]
        .map(|(name, value)| PlotSettings {
            name: name.to_string(),
            value,
            x: Axis::Particles,
            lines: lines.clone(),
            sequence: None,
        })
        .to_vec()
}

/// The pictures of shares of a study: those it asks for, else one bar a number of particles.
pub(super) fn share_settings(study: &Study) -> Vec<SharesSettings> {
    if !study.plots.is_empty() || !study.shares.is_empty() {
        return study.shares.clone();
    }
    vec![SharesSettings { name: "stages".to_string(), bars: vec![Axis::Particles] }]
}
