//! Named points over time.

use std::collections::HashSet;
use std::io::Write;

use anyhow::{Result, bail, ensure};
use glam::DVec3;

use super::convention::y_up;
use crate::files::listed;

/// No recording is a thousand kilometres wide: a coordinate beyond this (mm) is damage or a wrong unit, and refusing it
/// keeps every later sum, square and 32-bit copy finite.
pub const LARGEST_COORDINATE: f64 = 1e9;

/// Named points (markers or joints) over time in the world frame, z up, mm.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PointTrajectory {
    /// Names of the points.
    pub names: Vec<String>,
    /// Frames a second; 0 where the file does not say.
    pub rate: f64,
    /// Index of the first frame, counted from 0.
    pub first_frame: usize,
    /// One row a frame, one entry a name; `None` where the point is missing.
    pub frames: Vec<Vec<Option<DVec3>>>,
    /// Cut-off, Hz, of the [`super::LowPass`] that smoothed them last; none where they are not known to be smoothed.
    pub smoothed: Option<f64>,
}

/// How files of a format of points are read and written.
pub(crate) struct PointFile {
    /// Points of a file's bytes; the name stands for the file in messages.
    pub(crate) read: fn(&[u8], &str) -> Result<PointTrajectory>,
    /// Writes points into the file of a name, or why that cannot be.
    pub(crate) write: Result<WritePoints, &'static str>,
    /// Writes them with every length in metres, and says so in the file; none where the format states no unit.
    pub(crate) write_metres: Option<WritePoints>,
}

/// Writes points; the name of their file is the last argument.
pub(crate) type WritePoints = fn(&mut dyn Write, &PointTrajectory, &str) -> Result<()>;

impl PointTrajectory {
    /// The column of a point, by its exact name.
    pub fn column(&self, name: &str) -> Option<usize> {
        self.names.iter().position(|known| known == name)
    }

    /// What a user should know of labels that stand several times in the file, whose points were named apart by [`numbered`]; none where
    /// every label stands once.
    pub fn same_labels(&self) -> Option<String> {
        let names: HashSet<&str> = self.names.iter().map(String::as_str).collect();
        let label = |name: &&String| {
            name.rsplit_once(NUMBER)
                .filter(|(label, number)| {
                    names.contains(label) && !number.is_empty() && number.bytes().all(|byte| byte.is_ascii_digit())
                })
                .is_some()
        };
        let repeated: Vec<&String> = self.names.iter().filter(label).collect();
        let points = if repeated.len() == 1 { "a point is" } else { "points are" };
        let told =
            || format!("labels that stand several times were numbered, so {points} called {}", listed(&repeated));
        (!repeated.is_empty()).then(told)
    }

    /// The time of row `row` in seconds, counted from frame 0; `None` where the rate is unknown.
    pub fn time(&self, row: usize) -> Option<f64> {
        (self.rate > 0.0).then(|| (self.first_frame + row) as f64 / self.rate)
    }

    /// Holds what every reader promises and every writer needs: at least one point and one frame, names that are
    /// unique, not empty and printable, rows as long as the names, coordinates finite and at most
    /// [`LARGEST_COORDINATE`].
    ///
    /// # Errors
    /// One sentence that names the point and the frame (counted from 0).
    pub fn check(&self) -> Result<()> {
        ensure!(!self.names.is_empty(), "there are no points, expected at least one");
        ensure!(!self.frames.is_empty(), "there are no frames, expected at least one");
        ensure!(
            self.rate.is_finite() && self.rate >= 0.0,
            "the rate is {}, expected a positive number of frames a second",
            self.rate
        );
        check_names(&self.names)?;
        for (row, points) in self.frames.iter().enumerate() {
            let frame = self.first_frame.saturating_add(row);
            ensure!(
                points.len() == self.names.len(),
                "frame {frame} holds {} points, expected {} as there are names",
                points.len(),
                self.names.len()
            );
            for (name, point) in self.names.iter().zip(points) {
                let Some(p) = point else { continue };
                ensure!(
                    p.abs().max_element() <= LARGEST_COORDINATE && p.is_finite(),
                    "point `{name}` in frame {frame} is at ({}, {}, {}) mm, expected coordinates below {LARGEST_COORDINATE:e} mm",
                    p.x,
                    p.y,
                    p.z
                );
            }
        }
        Ok(())
    }

    /// The same points with every coordinate multiplied by `factor` (files without units, BVH above all).
    pub fn scaled(mut self, factor: f64) -> Self {
        self.each(|p| p * factor);
        self
    }

    /// The same points turned from a y-up frame (z forward, x left, as BVH and OpenSim files have it) to this crate's
    /// z-up frame (x forward, y left): (x, y, z) becomes (z, x, y).
    pub fn y_up_to_z_up(mut self) -> Self {
        self.each(|p| DVec3::new(p.z, p.x, p.y));
        self
    }

    /// The same points turned from this crate's z-up frame to a y-up one (x left, z forward): what [`Self::y_up_to_z_up`] turns back.
    pub fn z_up_to_y_up(mut self) -> Self {
        self.each(y_up);
        self
    }

    fn each(&mut self, change: impl Fn(DVec3) -> DVec3) {
        for point in self.frames.iter_mut().flatten().flatten() {
            *point = change(*point);
        }
    }
}

/// Stands between a label and the number of the point that has it too.
const NUMBER: char = '#';

/// The name of the `count`th point of a label.
pub(super) fn numbered(label: &str, count: usize) -> String {
    format!("{label}{NUMBER}{count}")
}

/// Names by which points can be found again in every format.
fn check_names(names: &[String]) -> Result<()> {
    let mut seen = HashSet::new();
    for (column, name) in names.iter().enumerate() {
        if name.is_empty() || name.trim() != name || name.chars().any(char::is_control) {
            bail!("the name of point {} is {name:?}, expected printable text without blanks around it", column + 1);
        }
        ensure!(seen.insert(name.as_str()), "two points are named `{name}`, expected every name once");
    }
    Ok(())
}

/// The rate meant by a measured one: files give times with few digits, so that 120 frames a second reads as 120.00005.
/// The nearest integer is taken within one part in ten thousand (59.94 stays 59.94).
pub(super) fn meant_rate(measured: f64) -> f64 {
    let nearest = measured.round();
    if nearest > 0.0 && (measured - nearest).abs() <= 1e-4 * nearest { nearest } else { measured }
}

/// Millimetres in one unit of a file that names its unit.
pub(super) fn millimetres_in(unit: &str) -> Result<f64> {
    match unit.trim().to_ascii_lowercase().as_str() {
        "mm" | "millimeters" | "millimetres" => Ok(1.0),
        "cm" | "centimeters" | "centimetres" => Ok(10.0),
        "m" | "meters" | "metres" => Ok(1000.0),
        other => bail!("the unit is `{other}`, expected mm, cm or m"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn two() -> PointTrajectory {
        PointTrajectory {
            names: vec!["a".into(), "b".into()],
            rate: 50.0,
            first_frame: 3,
            frames: vec![vec![Some(DVec3::new(1.0, 2.0, 3.0)), None]],
            smoothed: None,
        }
    }

    #[test]
    fn what_cannot_be_written_is_named() {
        two().check().unwrap();
        type Change = fn(&mut PointTrajectory);
        let broken: [(&str, Change); 7] = [
            ("no points", |t| t.names.clear()),
            ("no frames", |t| t.frames.clear()),
            ("rate is NaN", |t| t.rate = f64::NAN),
            ("named `a`", |t| t.names[1] = "a".into()),
            ("printable", |t| t.names[1] = "a\tb".into()),
            ("frame 3 holds 1 points, expected 2", |t| t.frames[0].truncate(1)),
            ("point `b` in frame 3", |t| t.frames[0][1] = Some(DVec3::new(0.0, f64::NAN, 0.0))),
        ];
        for (expected, change) in broken {
            let mut trajectory = two();
            change(&mut trajectory);
            let message = trajectory.check().unwrap_err().to_string();
            assert!(message.contains(expected), "{message} should say {expected}");
        }
    }

    #[test]
    fn y_up_becomes_z_up_and_stays_right_handed() {
        let turned = two().y_up_to_z_up();
        assert_eq!(turned.frames[0][0], Some(DVec3::new(3.0, 1.0, 2.0)));
        let turn = |p: DVec3| DVec3::new(p.z, p.x, p.y);
        assert_eq!(turn(DVec3::X).cross(turn(DVec3::Y)), turn(DVec3::Z));
        assert_eq!(turn(DVec3::Y), DVec3::Z);
        assert_eq!(turned.z_up_to_y_up(), two());
    }

    #[test]
    fn rates_are_read_as_meant() {
        assert_eq!(meant_rate(1.0 / 0.008_333_33), 120.0);
        assert_eq!(meant_rate(59.94), 59.94);
    }
}
