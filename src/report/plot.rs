//! Plots as SVG text, to stand in a page or a file of their own.

use std::ops::Range;

use anyhow::{Result, anyhow};
use plotters::prelude::*;

/// A curve over frames.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// Its name, for the legend.
    pub name: String,
    /// Red, green, blue.
    pub colour: [u8; 3],
    /// One value a frame; gaps where there is none (or it is not finite).
    pub values: Vec<Option<f64>>,
    /// Whether it bounds a band, the area from 0 up to it, and is no curve of its own.
    pub is_band: bool,
}

pub(super) const INK: RGBColor = RGBColor(70, 78, 88);
pub(super) const RULE: RGBColor = RGBColor(226, 229, 233);
pub(super) const FONT: &str = "system-ui, sans-serif";

/// Curves over the frames from `first_frame` on; the vertical axis starts at 0.
///
/// # Errors
/// When the drawing library refuses, which no data is known to cause.
pub fn line_chart(label: &str, first_frame: usize, series: &[Series], size: [u32; 2]) -> Result<String> {
    let finite = |value: &Option<f64>| value.filter(|v| v.is_finite() && v.abs() < 1e12);
    let frames = series.iter().map(|s| s.values.len()).max().unwrap_or(0).max(2);
    let top = series.iter().flat_map(|s| &s.values).filter_map(finite).fold(0.0, f64::max);
    // Several curves need room for a legend above them.
    let has_legend = series.len() > 1 || series.iter().any(|curve| curve.is_band);
    let room = if has_legend { 1.12 + 0.12 * series.len() as f64 } else { 1.08 };
    let top = if top > 0.0 { top * room } else { 1.0 };
    let x = first_frame as f64..(first_frame + frames - 1) as f64;
    drawn(size, |root| {
        let mut chart = ChartBuilder::on(root)
            .margin(8)
            .margin_right(16)
            .x_label_area_size(34)
            .y_label_area_size(54)
            .build_cartesian_2d(x.clone(), 0.0..top)?;
        chart
            .configure_mesh()
            .disable_x_mesh()
            .light_line_style(TRANSPARENT)
            .bold_line_style(RULE)
            .axis_style(RULE)
            .label_style((FONT, 12, &INK))
            .axis_desc_style((FONT, 12, &INK))
            .x_labels((size[0] as usize / 80).clamp(3, 8))
            .y_labels(5)
            .x_label_formatter(&|v| format!("{v:.0}"))
            .y_label_formatter(&|v| short(*v, top))
            .x_desc("frame")
            .y_desc(label)
            .draw()?;
        for curve in series {
            let [red, green, blue] = curve.colour;
            let style = RGBColor(red, green, blue).stroke_width(2);
            for run in runs(&curve.values.iter().map(finite).collect::<Vec<_>>()) {
                let point = |i: usize| Some(((first_frame + i) as f64, finite(&curve.values[i])?));
                if curve.is_band {
                    let colour = RGBColor(red, green, blue);
                    let [first, last] = [run.start, run.end - 1].map(|i| ((first_frame + i) as f64, 0.0));
                    let outline: Vec<_> = [first].into_iter().chain(run.filter_map(point)).chain([last]).collect();
                    chart.draw_series([Polygon::new(outline, colour.mix(0.18))])?;
                } else if run.len() == 1 {
                    let dot = run.filter_map(point).map(|p| Circle::new(p, 2, style.filled()));
                    chart.draw_series(dot)?;
                } else {
                    chart.draw_series(LineSeries::new(run.filter_map(point), style))?;
                }
            }
            if has_legend {
                chart
                    .draw_series(std::iter::empty::<Circle<(f64, f64), i32>>())?
                    .label(&curve.name)
                    .legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], style));
            }
        }
        if has_legend {
            chart
                .configure_series_labels()
                .position(SeriesLabelPosition::UpperRight)
                .label_font((FONT, 12, &INK))
                .background_style(WHITE.mix(0.7))
                .draw()?;
        }
        Ok(())
    })
}

/// Horizontal bars from the top down, each with its value behind it.
///
/// # Errors
/// As [`line_chart`].
pub fn bar_chart(bars: &[(String, f64)], unit: &str, colour: [u8; 3], width: u32) -> Result<String> {
    const ROW: u32 = 26;
    let value = |v: f64| if v.is_finite() { v.clamp(0.0, 1e12) } else { 0.0 };
    let largest = bars.iter().map(|bar| value(bar.1)).fold(0.0, f64::max).max(1e-9);
    let [red, green, blue] = colour;
    drawn([width, ROW * bars.len().max(1) as u32 + 8], |root| {
        let (left, right) = (130i32, 90i32);
        let room = f64::from((width as i32 - left - right).max(10));
        for (row, (name, amount)) in bars.iter().enumerate() {
            let y = (row as u32 * ROW) as i32 + 6;
            let length = (room * value(*amount) / largest).round() as i32;
            let text = (FONT, 13, &INK).into_text_style(root);
            root.draw(&Text::new(name.clone(), (4, y + 2), text.clone()))?;
            let bar = [(left, y), (left + length.max(1), y + ROW as i32 - 9)];
            root.draw(&Rectangle::new(bar, RGBColor(red, green, blue).filled()))?;
            let amount = format!("{} {unit}", short(value(*amount), value(*amount)));
            root.draw(&Text::new(amount, (left + length + 8, y + 2), text))?;
        }
        Ok(())
    })
}

pub(super) type SvgArea<'a> = DrawingArea<SVGBackend<'a>, plotters::coord::Shift>;

/// An SVG picture of the size, drawn by `draw`.
pub(super) fn drawn(
    size: [u32; 2],
    draw: impl FnOnce(&SvgArea) -> Result<(), DrawingAreaErrorKind<std::io::Error>>,
) -> Result<String> {
    let mut svg = String::new();
    {
        let root = SVGBackend::with_string(&mut svg, (size[0], size[1])).into_drawing_area();
        draw(&root).and_then(|()| root.present()).map_err(|error| anyhow!("cannot draw a plot: {error}"))?;
    }
    Ok(svg)
}

/// Stretches of frames that have a value.
fn runs(values: &[Option<f64>]) -> Vec<Range<usize>> {
    let mut runs: Vec<Range<usize>> = Vec::new();
    for (index, value) in values.iter().enumerate() {
        match runs.last_mut() {
            _ if value.is_none() => {}
            Some(run) if run.end == index => run.end += 1,
            _ => runs.push(index..index + 1),
        }
    }
    runs
}

/// A number with as many digits as the axis up to `top` calls for.
pub(super) fn short(value: f64, top: f64) -> String {
    match top {
        t if t >= 20.0 => format!("{value:.0}"),
        t if t >= 2.0 => format!("{value:.1}"),
        t if t >= 0.2 => format!("{value:.2}"),
        _ => format!("{value:.3}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gaps_split_a_curve() {
        assert_eq!(runs(&[None, Some(1.0), Some(2.0), None, Some(3.0)]), [1..3, 4..5]);
        let values = vec![Some(10.0), Some(20.0), None, Some(f64::NAN), Some(30.0), Some(5.0)];
        let series = Series { name: "error".into(), colour: [1, 2, 3], values, is_band: false };
        let svg = line_chart("error, mm", 7, &[series], [640, 200]).unwrap();
        assert_eq!(svg.matches("#010203").count(), 2, "{svg}");
        assert!(svg.contains("error, mm") && !svg.contains("NaN"));
    }

    #[test]
    fn odd_data_is_drawn_without_a_fuss() {
        for values in
            [vec![], vec![None], vec![Some(f64::INFINITY), Some(f64::NAN)], vec![Some(0.0)], vec![Some(1e300)]]
        {
            let series = Series { name: "<b>&".into(), colour: [0; 3], values, is_band: false };
            let svg = line_chart("x", 0, &[series.clone(), series], [300, 100]).unwrap();
            assert!(svg.starts_with("<svg") && !svg.contains("<b>"), "{svg}");
        }
        let svg = bar_chart(&[("<i>".into(), f64::NAN), ("b".into(), 2.0)], "ms", [9, 9, 9], 400).unwrap();
        assert!(svg.contains("2.0 ms") && !svg.contains("<i>"), "{svg}");
        bar_chart(&[], "ms", [9, 9, 9], 400).unwrap();
    }
}
