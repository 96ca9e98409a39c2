//! Arrows over the area of a picture: where residuals point, and how long they are.

use anyhow::Result;
use plotters::prelude::*;

use super::plot::{FONT, INK, RULE, drawn};

/// An arrow in a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arrow {
    /// Where it begins, pixels.
    pub at: [f64; 2],
    /// Where it points, pixels before magnification.
    pub offset: [f64; 2],
    /// Red, green, blue.
    pub colour: [u8; 3],
}

/// Pixels that the shorter side of the plot's picture area has.
const SIDE: f64 = 480.0;

/// Draws the area of a picture of `size` pixels and the arrows in it, made longer by the same factor, which stands in
/// the title behind `title`. What is not finite or far outside is left out.
///
/// # Errors
/// When the drawing library refuses, which no data is known to cause.
pub fn arrow_chart(title: &str, size: [u32; 2], arrows: &[Arrow]) -> Result<String> {
    let [width, height] = size.map(|side| f64::from(side.max(1)));
    let scale = SIDE / width.min(height);
    let is_drawn = |arrow: &&Arrow| {
        let inside = |at: f64, side: f64| (-0.1 * side..1.1 * side).contains(&at);
        inside(arrow.at[0], width) && inside(arrow.at[1], height) && arrow.offset.iter().all(|o| o.abs() < 1e6)
    };
    let arrows: Vec<&Arrow> = arrows.iter().filter(is_drawn).collect();
    let magnification = magnification(&arrows, 0.05 * width.min(height));
    let [margin, head] = [36.0, 30.0];
    let room = [width, height].map(|side| (scale * side + 2.0 * margin) as u32);
    drawn([room[0], room[1] + head as u32], |root| {
        let text = (FONT, 15, &INK).into_text_style(root);
        root.draw(&Text::new(format!("{title}, arrows × {magnification}"), (margin as i32, 12), text))?;
        let place = |x: f64, y: f64| {
            // The picture's own origin is the middle of its first pixel.
            let clamp = |v: f64| v.clamp(-1e5, 1e5) as i32;
            (clamp(margin + (x + 0.5) * scale), clamp(margin + head + (y + 0.5) * scale))
        };
        let corners = [place(-0.5, -0.5), place(width - 0.5, height - 0.5)];
        root.draw(&Rectangle::new(corners, RULE.stroke_width(2)))?;
        for arrow in &arrows {
            let [red, green, blue] = arrow.colour;
            let style = RGBColor(red, green, blue).stroke_width(1);
            let ([x, y], [dx, dy]) = (arrow.at, arrow.offset.map(|o| o * magnification));
            let length = dx.hypot(dy);
            let (from, to) = (place(x, y), place(x + dx, y + dy));
            root.draw(&Circle::new(from, 2, style.filled()))?;
            root.draw(&PathElement::new([from, to], style))?;
            if length * scale > 4.0 {
                // Two barbs, 25 degrees to either side.
                let barb = |turn: f64| {
                    let (sin, cos) = turn.sin_cos();
                    let back = -7.0 / (scale * length);
                    place(x + dx + back * (cos * dx - sin * dy), y + dy + back * (sin * dx + cos * dy))
                };
                root.draw(&PathElement::new([barb(0.44), to, barb(-0.44)], style))?;
            }
        }
        Ok(())
    })
}

/// 1, 2 or 5 times a power of ten, so that the usual arrow is about `wanted` pixels long.
fn magnification(arrows: &[&Arrow], wanted: f64) -> f64 {
    let mut lengths: Vec<f64> = arrows.iter().map(|arrow| arrow.offset[0].hypot(arrow.offset[1])).collect();
    lengths.sort_by(f64::total_cmp);
    let usual = lengths.get(lengths.len() / 2).copied().unwrap_or(1.0).max(1e-9);
    let factor = (wanted / usual).clamp(1e-3, 1e6);
    let power = 10_f64.powf(factor.log10().floor());
    [5.0, 2.0, 1.0].into_iter().find(|step| step * power <= factor).unwrap_or(1.0) * power
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arrows_are_magnified_alike_and_drawn_where_they_are() {
        let arrow = |x: f64, dx: f64| Arrow { at: [x, 100.0], offset: [dx, 0.0], colour: [1, 2, 3] };
        let svg = arrow_chart("cam01", [640, 480], &[arrow(100.0, 0.3), arrow(300.0, -0.3)]).unwrap();
        assert!(svg.contains("cam01, arrows × 50"), "{svg}");
        // Two points, two shafts, two heads.
        assert_eq!(svg.matches("<circle").count(), 2, "{svg}");
        assert_eq!(svg.matches("<polyline").count(), 4, "{svg}");
        assert!(svg.contains("cx=\"136\" cy=\"166\""), "{svg}");
    }

    #[test]
    fn odd_arrows_are_left_out() {
        let arrow = |x: f64, dx: f64| Arrow { at: [x, 10.0], offset: [dx, f64::NAN], colour: [0; 3] };
        let svg = arrow_chart("<b>", [0, 48], &[arrow(f64::NAN, 1.0), arrow(1e9, 1.0), arrow(3.0, 1.0)]).unwrap();
        assert!(!svg.contains("<circle") && !svg.contains("<b>"), "{svg}");
    }
}
