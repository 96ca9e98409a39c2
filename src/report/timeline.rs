//! A time-line: what modules that work side by side did, and on which frame.

use anyhow::Result;
use plotters::element::DashedPathElement;
use plotters::prelude::*;

use super::plot::{FONT, INK, RULE, drawn};

/// Colours of frames, in turn.
const COLOURS: [RGBColor; 6] = [
    RGBColor(31, 111, 178),
    RGBColor(217, 119, 6),
    RGBColor(22, 140, 90),
    RGBColor(148, 74, 168),
    RGBColor(196, 62, 62),
    RGBColor(96, 108, 122),
];
const WIDTH: u32 = 1400;
const ROW: i32 = 34;
/// Left of the rows, for their names; above them; below them, for the axis.
const LEFT: i32 = 150;
const TOP: i32 = 12;
const BOTTOM: i32 = 52;

/// Work on a frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bar {
    /// Its row.
    pub row: usize,
    /// When it began, ms.
    pub start: f64,
    /// When it ended, ms.
    pub end: f64,
    /// The frame.
    pub frame: usize,
}

/// A moment in a row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mark {
    /// Its row.
    pub row: usize,
    /// When, ms.
    pub at: f64,
    /// The frame.
    pub frame: usize,
    /// Whether the frame was passed over there: a cross; otherwise a dot.
    pub is_dropped: bool,
}

/// What is drawn.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TimelineChart {
    /// The names of the rows, from the top down: what is captured in the first ends up in the last.
    pub rows: Vec<String>,
    /// The moments at the left and right edge, ms.
    pub from: f64,
    /// The right edge.
    pub to: f64,
    /// Work.
    pub bars: Vec<Bar>,
    /// Moments.
    pub marks: Vec<Mark>,
    /// How long after its capture a frame should be done, ms.
    pub deadline: Option<f64>,
}

/// Draws a time-line as SVG: a frame has one colour, a thin line leads from its dot in the first row to the end of its bar in
/// the last, solid where it was there by the deadline (or where there is none), broken where it was late.
///
/// # Errors
/// When the drawing library refuses, which no data is known to cause.
pub fn timeline_chart(chart: &TimelineChart) -> Result<String> {
    let height = TOP + ROW * chart.rows.len() as i32 + BOTTOM;
    let span = (chart.to - chart.from).max(1e-3);
    let room = f64::from(WIDTH as i32 - LEFT - 16);
    let x = |at: f64| LEFT + ((at - chart.from).clamp(0.0, span) / span * room).round() as i32;
    let top = |row: usize| TOP + ROW * row as i32;
    let middle = |row: usize| top(row) + ROW / 2;
    let colour = |frame: usize| COLOURS[frame % COLOURS.len()];
    let last = chart.rows.len().saturating_sub(1);
    drawn([WIDTH, height as u32], |root| {
        root.fill(&WHITE)?;
        let text = (FONT, 13, &INK).into_text_style(root);
        let small = (FONT, 10, &INK).into_text_style(root);
        for (row, name) in chart.rows.iter().enumerate() {
            root.draw(&Text::new(name.clone(), (8, middle(row) - 7), text.clone()))?;
            root.draw(&PathElement::new([(LEFT, top(row) + ROW), (WIDTH as i32 - 16, top(row) + ROW)], RULE))?;
        }
        let floor = top(chart.rows.len());
        let step = step_of(span);
        for tick in (0..).map(|tick| f64::from(tick) * step).take_while(|tick| *tick <= span) {
            let at = x(chart.from + tick);
            root.draw(&PathElement::new([(at, TOP), (at, floor + 4)], RULE))?;
            root.draw(&Text::new(format!("{tick:.0}"), (at - 8, floor + 8), small.clone()))?;
        }
        root.draw(&Text::new("ms", (LEFT - 34, floor + 8), small.clone()))?;
        let legend = "dot: captured · cross: passed over, a newer one being there · thin line: from capture to pose, broken \
                      where late · numbers: frames";
        root.draw(&Text::new(legend, (LEFT, floor + 28), small.clone()))?;
        for mark in chart.marks.iter().filter(|mark| mark.row == 0 && !mark.is_dropped) {
            let Some(done) = chart.bars.iter().rfind(|bar| bar.row == last && bar.frame == mark.frame) else {
                continue;
            };
            let ends = [(x(mark.at), middle(0)), (x(done.end), middle(last))];
            let style = colour(mark.frame).mix(0.7).stroke_width(1);
            if chart.deadline.is_some_and(|deadline| done.end - mark.at > deadline) {
                root.draw(&DashedPathElement::new(ends, 5, 4, style))?;
            } else {
                root.draw(&PathElement::new(ends, style))?;
            }
        }
        for bar in &chart.bars {
            let (left, right) = (x(bar.start), x(bar.end).max(x(bar.start) + 1));
            let corners = [(left, top(bar.row) + 6), (right, top(bar.row) + ROW - 6)];
            root.draw(&Rectangle::new(corners, colour(bar.frame).mix(0.85).filled()))?;
            if bar.row == last && right - left > 24 {
                let white = (FONT, 10, &WHITE).into_text_style(root);
                root.draw(&Text::new(bar.frame.to_string(), (left + 3, middle(bar.row) - 5), white))?;
            }
        }
        for mark in &chart.marks {
            let at = (x(mark.at), middle(mark.row));
            if mark.is_dropped {
                root.draw(&Cross::new(at, 5, colour(mark.frame).stroke_width(2)))?;
            } else {
                root.draw(&Circle::new(at, 4, colour(mark.frame).filled()))?;
            }
        }
        Ok(())
    })
}

/// A round distance between ticks, some ten of them over `span`.
fn step_of(span: f64) -> f64 {
    let rough = span / 10.0;
    let power = 10.0_f64.powf(rough.log10().floor());
    [1.0, 2.0, 5.0, 10.0].map(|factor| factor * power).into_iter().find(|step| *step >= rough).unwrap_or(rough)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn late_frames_and_drops_are_seen() {
        let mut chart = TimelineChart {
            rows: ["acquisition", "tracking"].map(str::to_string).to_vec(),
            from: 0.0,
            to: 200.0,
            bars: vec![Bar { row: 1, start: 20.0, end: 90.0, frame: 7 }],
            marks: vec![Mark { row: 0, at: 10.0, frame: 7, is_dropped: false }],
            deadline: Some(100.0),
        };
        let in_time = timeline_chart(&chart).unwrap();
        assert!(in_time.contains(">\n7\n<") && in_time.contains("acquisition"), "{in_time}");
        chart.deadline = Some(50.0);
        let late = timeline_chart(&chart).unwrap();
        assert!(late.len() > in_time.len(), "a broken line is many short ones");
        chart.marks[0].is_dropped = true;
        assert!(timeline_chart(&chart).unwrap() != late);
        for (from, to) in [(0.0, 0.0), (5.0, 1.0), (0.0, 1e9)] {
            timeline_chart(&TimelineChart { from, to, ..chart.clone() }).unwrap();
        }
        timeline_chart(&TimelineChart::default()).unwrap();
    }
}
