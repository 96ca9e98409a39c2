//! What a sweep yields: the object of `pantin bench --sweep --json` (FORMATS), the same as CSV, and as a chart.

use std::fmt::Write as _;
use std::path::Path;

use anyhow::{Context as _, Result, ensure};
use serde::{Deserialize, Serialize};

use crate::files::Limit;
use crate::report::{XyLine, xy_chart};

/// A stage in one way.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SweepRow {
    /// Its name, as rows of passes have it.
    pub stage: String,
    /// Its constants besides the workgroup's size; empty where it has none.
    pub way: String,
    /// Invocations of a workgroup.
    pub workgroup: u32,
    /// Whether it is what is taken unasked, before anything is measured.
    pub usual: bool,
    /// Median of the stage's time in an iteration.
    pub ms: f64,
    /// The shortest.
    pub ms_min: f64,
    /// The longest.
    pub ms_max: f64,
}

impl SweepRow {
    /// The stage with its constants.
    pub(super) fn series(&self) -> String {
        if self.way.is_empty() { self.stage.clone() } else { format!("{}, {}", self.stage, self.way) }
    }
}

/// The results of a sweep.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SweepReport {
    /// Processor, its threads, operating system.
    pub machine: String,
    /// The Vulkan device and its driver.
    pub device: String,
    /// Candidates scored at once.
    pub particles: usize,
    /// Cameras.
    pub views: usize,
    /// Width of the pictures, pixels.
    pub width: u32,
    /// Height of the pictures, pixels.
    pub height: u32,
    /// What was measured, a stage after the other.
    pub rows: Vec<SweepRow>,
    /// What could not be, a sentence each.
    pub unavailable: Vec<String>,
}

/// A sweep kept in a file.
const SWEEP: Limit = Limit { what: "the JSON of pantin bench --sweep", most: 16 << 20 };

impl SweepReport {
    /// Reads what `pantin bench --sweep --json` printed.
    ///
    /// # Errors
    /// When the file cannot be read, or holds something else: the sentence names the file, the line and what was expected.
    pub fn read(path: &Path) -> Result<Self> {
        let text = SWEEP.read_text(path)?;
        serde_json::from_str(&text).with_context(|| format!("{}: expected {}", path.display(), SWEEP.what))
    }

    /// Comma-separated, a row a line.
    pub fn csv(&self) -> String {
        let mut text = "stage,way,workgroup,usual,ms,ms_min,ms_max\n".to_string();
        for row in &self.rows {
            let SweepRow { stage, way, workgroup, usual, ms, ms_min, ms_max } = row;
            let _ = writeln!(text, "{stage},{way},{workgroup},{usual},{ms},{ms_min},{ms_max}");
        }
        text
    }

    /// The time by the workgroup's size as SVG, a line a stage and way: all of the projection and of the comparison, and of what draws
    /// without a framebuffer the way that is taken unasked and the one with the shortest time.
    ///
    /// # Errors
    /// When there are no rows, or the drawing library refuses.
    pub fn chart(&self) -> Result<String> {
        let mut names: Vec<String> = Vec::new();
        for row in &self.rows {
            let drawing: Vec<&SweepRow> = self.rows.iter().filter(|other| other.stage == row.stage).collect();
            let fastest = drawing.iter().min_by(|a, b| a.ms.total_cmp(&b.ms)).map(|row| row.series());
            let is_told = !row.stage.starts_with("raster")
                || fastest.as_ref() == Some(&row.series())
                || drawing.iter().any(|other| other.usual && other.series() == row.series());
            if is_told && !names.contains(&row.series()) {
                names.push(row.series());
            }
        }
        ensure!(!names.is_empty(), "the sweep has no rows to draw");
        let lines: Vec<XyLine> = names
            .into_iter()
            .map(|name| {
                let own = self.rows.iter().filter(|row| row.series() == name);
                let mut points: Vec<[f64; 3]> = own.map(|row| [f64::from(row.workgroup), row.ms, 0.0]).collect();
                points.sort_by(|a, b| a[0].total_cmp(&b[0]));
                XyLine { name, points }
            })
            .collect();
        xy_chart("invocations of a workgroup", "ms an iteration", &lines, [760, 420])
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    pub(in crate::bench::sweep) fn report() -> SweepReport {
        let row = |stage: &str, way: &str, workgroup, usual, ms| SweepRow {
            stage: stage.into(),
            way: way.into(),
            workgroup,
            usual,
            ms,
            ms_min: ms / 2.0,
            ms_max: ms * 2.0,
        };
        SweepReport {
            machine: "a machine".into(),
            device: "a device".into(),
            particles: 512,
            views: 4,
            width: 640,
            height: 480,
            rows: vec![
                row("project", "", 64, false, 4.0),
                row("project", "", 128, true, 5.0),
                row("raster", "2 words", 32, false, 110.0),
                row("raster", "3 words", 32, true, 100.0),
                row("raster", "4 words", 64, false, 80.0),
            ],
            unavailable: vec!["compare, texels by 512: too many".into()],
        }
    }

    #[test]
    fn numbers_come_back_as_they_were_and_make_a_chart() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("sweep.json");
        let report = report();
        std::fs::write(&path, serde_json::to_string(&report).unwrap()).unwrap();
        assert_eq!(SweepReport::read(&path).unwrap(), report);
        assert_eq!(report.csv().lines().nth(4), Some("raster,3 words,32,true,100,50,200"));
        let chart = report.chart().unwrap();
        // What is usual and what is fastest, not all ways of drawing.
        assert!(["project", "raster, 3 words", "raster, 4 words"].iter().all(|name| chart.contains(name)), "{chart}");
        assert!(!chart.contains("2 words"));
        std::fs::write(&path, "{}").unwrap();
        let error = format!("{:#}", SweepReport::read(&path).unwrap_err());
        assert!(error.contains("expected the JSON of pantin bench --sweep"), "{error}");
        let error = SweepReport { rows: Vec::new(), ..report }.chart().unwrap_err().to_string();
        assert_eq!(error, "the sweep has no rows to draw");
    }
}
