//! Charts that compare many runs: a value against a number, and shares of a whole.

use anyhow::Result;
use plotters::prelude::*;

use super::plot::{FONT, INK, RULE, drawn, short};

/// Means against a number.
#[derive(Clone, Debug, PartialEq)]
pub struct XyLine {
    /// Its name, for the legend.
    pub name: String,
    /// Number, mean, standard deviation; in the order of the numbers.
    pub points: Vec<[f64; 3]>,
}

/// Colours that stay apart for eyes that see few, after Okabe and Ito.
const PALETTE: [RGBColor; 8] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(86, 180, 233),
    RGBColor(230, 159, 0),
    RGBColor(90, 90, 90),
    RGBColor(150, 130, 20),
];

fn colour(index: usize) -> RGBColor {
    PALETTE[index % PALETTE.len()]
}

/// Lines of means with a bar of one standard deviation to either side; the vertical axis starts at 0. What is not finite
/// is left out.
///
/// # Errors
/// When the drawing library refuses, which no data is known to cause.
pub fn xy_chart(x_label: &str, y_label: &str, lines: &[XyLine], size: [u32; 2]) -> Result<String> {
    let is_sane = |point: &&[f64; 3]| point.iter().all(|v| v.is_finite() && v.abs() < 1e12);
    let points = || lines.iter().flat_map(|line| &line.points).filter(is_sane);
    let (least, most) = points().fold((f64::MAX, f64::MIN), |(a, b), point| (a.min(point[0]), b.max(point[0])));
    let (least, most) = if least > most { (0.0, 1.0) } else { (least, most) };
    let margin = if most > least { (most - least) * 0.04 } else { 1.0 };
    let top = points().map(|point| point[1] + point[2]).fold(0.0, f64::max);
    let room = if lines.len() > 1 { 1.1 + 0.07 * lines.len() as f64 } else { 1.1 };
    let top = if top > 0.0 { top * room } else { 1.0 };
    drawn(size, |root| {
        let mut chart = ChartBuilder::on(root)
            .margin(8)
            .margin_right(16)
            .x_label_area_size(36)
            .y_label_area_size(58)
            .build_cartesian_2d(least - margin..most + margin, 0.0..top)?;
        chart
            .configure_mesh()
            .disable_x_mesh()
            .light_line_style(TRANSPARENT)
            .bold_line_style(RULE)
            .axis_style(RULE)
            .label_style((FONT, 13, &INK))
            .axis_desc_style((FONT, 13, &INK))
            .x_labels(8)
            .y_labels(6)
            .x_label_formatter(&|v| format!("{v:.0}"))
            .y_label_formatter(&|v| short(*v, top))
            .x_desc(x_label)
            .y_desc(y_label)
            .draw()?;
        let cap = margin * 0.35;
        for (index, line) in lines.iter().enumerate() {
            let style = colour(index).stroke_width(2);
            let thin = colour(index).mix(0.55).stroke_width(1);
            let points: Vec<[f64; 3]> = line.points.iter().filter(is_sane).copied().collect();
            for &[x, mean, std] in points.iter().filter(|point| point[2] > 0.0) {
                let (low, high) = ((mean - std).max(0.0), mean + std);
                let bar = [[(x, low), (x, high)], [(x - cap, low), (x + cap, low)], [(x - cap, high), (x + cap, high)]];
                chart.draw_series(bar.map(|ends| PathElement::new(ends, thin)))?;
            }
            chart.draw_series(LineSeries::new(points.iter().map(|p| (p[0], p[1])), style))?;
            let dots = points.iter().map(|p| Circle::new((p[0], p[1]), 3, colour(index).filled()));
            let series = chart.draw_series(dots)?;
            if lines.len() > 1 {
                series.label(&line.name).legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], style));
            }
        }
        if lines.len() > 1 {
            chart
                .configure_series_labels()
                .position(SeriesLabelPosition::UpperRight)
                .label_font((FONT, 13, &INK))
                .background_style(WHITE.mix(0.8))
                .draw()?;
        }
        Ok(())
    })
}

/// A whole and its parts.
#[derive(Clone, Debug, PartialEq)]
pub struct Shares {
    /// Its name, in front of its bar.
    pub name: String,
    /// Names and amounts of its parts.
    pub parts: Vec<(String, f64)>,
}

/// One bar a whole, as long as all its parts, split into them; the same part has the same colour in every bar. Parts that
/// are no positive number are left out.
///
/// # Errors
/// As [`xy_chart`].
pub fn share_chart(wholes: &[Shares], unit: &str, width: u32) -> Result<String> {
    const ROW: i32 = 30;
    let amount = |v: f64| if v.is_finite() { v.clamp(0.0, 1e12) } else { 0.0 };
    let total = |whole: &Shares| whole.parts.iter().map(|part| amount(part.1)).sum::<f64>();
    let largest = wholes.iter().map(total).fold(0.0, f64::max).max(1e-9);
    let mut names: Vec<&str> = Vec::new();
    for (name, _) in wholes.iter().flat_map(|whole| &whole.parts) {
        if !names.contains(&name.as_str()) {
            names.push(name);
        }
    }
    let (left, right) = (230_i32, 110_i32);
    let legend = 28;
    let height = legend + ROW * wholes.len().max(1) as i32 + 6;
    drawn([width, height as u32], |root| {
        let text = (FONT, 13, &INK).into_text_style(root);
        let step = ((width as i32 - 16) / names.len().max(1) as i32).min(150);
        for (index, name) in names.iter().enumerate() {
            let x = 8 + step * index as i32;
            root.draw(&Rectangle::new([(x, 7), (x + 12, 19)], colour(index).filled()))?;
            root.draw(&Text::new((*name).to_string(), (x + 17, 6), text.clone()))?;
        }
        let room = f64::from((width as i32 - left - right).max(10));
        for (row, whole) in wholes.iter().enumerate() {
            let y = legend + ROW * row as i32 + 4;
            root.draw(&Text::new(whole.name.clone(), (6, y + 5), text.clone()))?;
            let mut sum = 0.0;
            let place = |sum: f64| left + (room * sum / largest).round() as i32;
            for (name, part) in &whole.parts {
                let index = names.iter().position(|it| it == name).unwrap_or(0);
                let from = place(sum);
                sum += amount(*part);
                root.draw(&Rectangle::new([(from, y), (place(sum), y + ROW - 8)], colour(index).filled()))?;
            }
            let all = format!("{} {unit}", short(sum, sum));
            root.draw(&Text::new(all, (place(sum) + 8, y + 5), text.clone()))?;
        }
        Ok(())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn odd_data_is_drawn_without_a_fuss() {
        let line = |points: Vec<[f64; 3]>| XyLine { name: "<b>&".into(), points };
        for points in [vec![], vec![[1.0, f64::NAN, 0.0]], vec![[5.0, 0.0, 0.0]], vec![[1e300, 1e300, 1.0]]] {
            let svg = xy_chart("x", "y", &[line(points.clone()), line(points)], [320, 200]).unwrap();
            assert!(svg.starts_with("<svg") && !svg.contains("<b>") && !svg.contains("NaN"), "{svg}");
        }
        share_chart(&[], "ms", 400).unwrap();
    }

    #[test]
    fn a_part_keeps_its_colour() {
        let whole = |name: &str, parts: &[(&str, f64)]| Shares {
            name: name.into(),
            parts: parts.iter().map(|(part, amount)| ((*part).to_string(), *amount)).collect(),
        };
        let both =
            [whole("a", &[("draw", 3.0), ("compare", 1.0)]), whole("b", &[("compare", f64::NAN), ("draw", 2.0)])];
        let svg = share_chart(&both, "ms", 600).unwrap();
        // Legend, and one bar each; plotters writes colours in upper case.
        assert_eq!(svg.matches("#0072B2").count(), 3, "{svg}");
        assert!(svg.contains("4.0 ms") && svg.contains("2.0 ms"), "{svg}");
    }
}
