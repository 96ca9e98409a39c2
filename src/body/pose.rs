//! Poses: state vectors checked against their body, and the table of them that files hold (`poses.csv`, FORMATS).

use std::collections::HashMap;
use std::f64::consts::TAU;
use std::io::{BufReader, Read, Write};
use std::ops::Range;
use std::path::Path;

use anyhow::{Context, Result, anyhow, bail, ensure};

use super::{Body, DofAxis};
use crate::files::{Limit, Overwrite, expected, shortened, write_atomically};
use crate::motion::{LeftAsIs, LowPass, unwrap_angles};

/// Largest value a cell may hold, mm or degrees; single precision resolves less than a millimetre up to there.
const LARGEST: f64 = 1e7;

/// A million poses of a person take less.
const POSES: Limit = Limit { what: "a table of poses", most: 2 << 30 };

/// What a limit may be exceeded by, relative to it: single precision rounds limits too.
const LIMIT_TOLERANCE: f64 = 1e-6;

impl Body {
    /// Whether a pose (mm, radians) fits this body.
    ///
    /// # Errors
    /// When its length is not the number of degrees of freedom, or a value is not finite.
    pub fn check_pose(&self, pose: &[f64]) -> Result<()> {
        let count = self.dof_count();
        ensure!(pose.len() == count, "a pose of {} values does not fit `{}`, expected {count}", pose.len(), self.name);
        if let Some(index) = pose.iter().position(|value| !value.is_finite()) {
            bail!("{} is {}, expected a finite number", self.dof_names()[index], pose[index]);
        }
        Ok(())
    }

    /// Whether a pose keeps the limits of every joint, up to the rounding of single precision.
    ///
    /// # Errors
    /// As [`Self::check_pose`]; a limit exceeded, with the joint, the value and the limits in the units of files.
    pub fn check_limits(&self, pose: &[f64]) -> Result<()> {
        self.check_pose(pose)?;
        for ((bone, dof), &value) in self.dofs().zip(pose) {
            let [low, high] = dof.limits;
            let slack = |limit: f64| LIMIT_TOLERANCE * limit.abs().max(1.0);
            if value < low - slack(low) || value > high + slack(high) {
                let [value, low, high] = [value, low, high].map(|v| (dof.axis.to_file(v) * 1e6).round() / 1e6);
                bail!(
                    "{}.{} is {value} {}, outside its limits {low} to {high}",
                    self.bones[bone].name,
                    dof.axis.name(),
                    dof.axis.file_unit()
                );
            }
        }
        Ok(())
    }

    /// Moves every value of a pose to the nearest one within its limits.
    pub fn clamp_to_limits(&self, pose: &mut [f64]) {
        for ((_, dof), value) in self.dofs().zip(pose) {
            *value = value.clamp(dof.limits[0], dof.limits[1]);
        }
    }
}

/// Poses with the frame (or candidate) each belongs to: `poses.csv` in memory.
///
/// Files hold degrees, memory radians. A value that was single precision once, as all the tracker's are, comes back bit
/// for bit; any other angle to two units in the last place.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PoseTable {
    /// The `frame` column, counted from 0; candidates of one frame may repeat it.
    pub frames: Vec<usize>,
    /// One state vector a row: mm, radians.
    pub poses: Vec<Vec<f64>>,
}

impl PoseTable {
    /// Reads `poses.csv` for a body. Columns are found by name, in any order.
    ///
    /// # Errors
    /// One sentence with the file, the line and the column: a column missing, unknown or twice, a cell empty or not a
    /// finite number of reasonable size, a row cut short, no rows.
    pub fn read(path: &Path, body: &Body) -> Result<Self> {
        Self::parse(BufReader::new(POSES.open(path)?.take(POSES.most)), &path.display().to_string(), body)
    }

    /// [`Self::read`] from anything; `name` stands for the file in messages.
    ///
    /// # Errors
    /// As [`Self::read`].
    pub fn parse(input: impl Read, name: &str, body: &Body) -> Result<Self> {
        let mut reader = csv::ReaderBuilder::new().flexible(true).trim(csv::Trim::All).from_reader(input);
        let header = reader.headers().map_err(|error| anyhow!("{name}, line 1: {}", one_line(&error)))?.clone();
        let columns = columns(&header, body).with_context(|| format!("{name}, line 1"))?;
        let axes: Vec<DofAxis> = body.dofs().map(|(_, dof)| dof.axis).collect();
        let names = body.dof_names();

        let mut table = Self::default();
        let mut record = csv::StringRecord::new();
        loop {
            match reader.read_record(&mut record) {
                Ok(true) => {}
                Ok(false) => break,
                Err(error) => bail!("{name}: {}", one_line(&error)),
            }
            let line = record.position().map_or(0, csv::Position::line);
            let row = || format!("{name}, line {line}");
            ensure!(
                record.len() == header.len(),
                "{}: it has {} cells, expected {} as in the header",
                row(),
                record.len(),
                header.len()
            );
            let frame = &record[columns.frame];
            let frame = frame
                .parse()
                .map_err(|_| anyhow!("{}: frame is `{}`, expected a whole number from 0", row(), shortened(frame)))?;
            let mut pose = Vec::with_capacity(names.len());
            for ((&column, axis), dof) in columns.dofs.iter().zip(&axes).zip(&names) {
                let cell = &record[column];
                ensure!(!cell.is_empty(), "{}: {dof} is empty, expected a number", row());
                let value = cell.parse::<f64>().ok().filter(|value| value.abs() <= LARGEST).ok_or_else(|| {
                    let unit = axis.file_unit();
                    anyhow!("{}: {dof} is `{}`, expected a number up to {LARGEST} ({unit})", row(), shortened(cell))
                })?;
                pose.push(axis.from_file(value));
            }
            table.frames.push(frame);
            table.poses.push(pose);
        }
        ensure!(!table.poses.is_empty(), "{name} holds no poses, expected at least one row after the header");
        Ok(table)
    }

    /// Smooths the poses, each run of consecutive frames by itself, angles as the continuous motion that they are; a row for which `is_gap`
    /// says so is passed over and parts its neighbours. Angles come back within half a turn of what they were. Says what was too short.
    ///
    /// # Errors
    /// When no run is as long as smoothing takes.
    pub fn smooth(&mut self, body: &Body, low_pass: &LowPass, is_gap: &dyn Fn(usize) -> bool) -> Result<LeftAsIs> {
        let mut runs: Vec<Range<usize>> = Vec::new();
        for row in (0..self.frames.len()).filter(|&row| !is_gap(row)) {
            match runs.last_mut() {
                Some(run) if run.end == row && self.frames[row - 1].checked_add(1) == Some(self.frames[row]) => {
                    run.end = row + 1;
                }
                _ => runs.push(row..row + 1),
            }
        }
        ensure!(
            runs.iter().any(|run| run.len() >= LowPass::FEWEST),
            "there are no {} consecutive frames, which smoothing takes at least",
            LowPass::FEWEST
        );
        for (column, (_, dof)) in body.dofs().enumerate() {
            let before: Vec<f64> = self.poses.iter().map(|pose| pose[column]).collect();
            let mut samples = before.clone();
            if dof.axis.is_rotation() {
                runs.iter().for_each(|run| unwrap_angles(&mut samples[run.clone()]));
            }
            low_pass.smooth_runs(&mut samples, &runs);
            for ((pose, value), before) in self.poses.iter_mut().zip(samples).zip(before) {
                let turns = if dof.axis.is_rotation() { ((value - before) / TAU).round() } else { 0.0 };
                pose[column] = value - TAU * turns;
            }
        }
        let mut left = LeftAsIs::default();
        left.add(&runs);
        Ok(left)
    }

    /// Writes `poses.csv`, atomically.
    ///
    /// # Errors
    /// When the file exists and may not be replaced, cannot be written, or a pose does not fit the body.
    pub fn write(&self, path: &Path, overwrite: Overwrite, body: &Body) -> Result<()> {
        write_atomically(path, overwrite, |writer| {
            let mut rows = PoseWriter::new(writer, body)?;
            for (frame, pose) in self.frames.iter().zip(&self.poses) {
                rows.write(*frame, pose)?;
            }
            rows.flush()
        })
    }
}

/// Writes `poses.csv` row by row, for tracks of any length.
pub struct PoseWriter<'a, W: Write> {
    writer: csv::Writer<W>,
    body: &'a Body,
}

impl<'a, W: Write> PoseWriter<'a, W> {
    /// Starts a table with its header.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn new(writer: W, body: &'a Body) -> Result<Self> {
        let mut rows = Self::append(writer, body);
        rows.writer.write_field("frame")?;
        rows.writer.write_record(body.dof_names())?;
        Ok(rows)
    }

    /// Goes on with a table that has its header already (a resumed run).
    pub fn append(writer: W, body: &'a Body) -> Self {
        Self { writer: csv::Writer::from_writer(writer), body }
    }

    /// Writes a row; the pose is in mm and radians.
    ///
    /// # Errors
    /// When the pose does not fit the body or cannot be written.
    pub fn write(&mut self, frame: usize, pose: &[f64]) -> Result<()> {
        self.body.check_pose(pose).with_context(|| format!("the pose of frame {frame}"))?;
        self.writer.write_field(frame.to_string())?;
        for ((_, dof), value) in self.body.dofs().zip(pose) {
            // The shortest text that reads back as the same number.
            self.writer.write_field(dof.axis.to_file(*value).to_string())?;
        }
        Ok(self.writer.write_record(None::<&[u8]>)?)
    }

    /// Hands everything to the writer underneath.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn flush(&mut self) -> Result<()> {
        Ok(self.writer.flush()?)
    }
}

/// Where a table's columns are.
struct Columns {
    frame: usize,
    dofs: Vec<usize>,
}

fn columns(header: &csv::StringRecord, body: &Body) -> Result<Columns> {
    let names = body.dof_names();
    let known: Vec<&str> = ["frame"].into_iter().chain(names.iter().map(String::as_str)).collect();
    let mut places = HashMap::new();
    for (place, column) in header.iter().enumerate() {
        // Spreadsheets put a byte order mark before the first name.
        let column = column.trim_start_matches('\u{feff}');
        ensure!(known.contains(&column), "column `{}` is unknown, {}", shortened(column), expected(column, &known));
        ensure!(places.insert(column, place).is_none(), "column `{column}` is there twice, expected once");
    }
    let find = |name: &str| {
        places.get(name).copied().ok_or_else(|| anyhow!("column `{name}` is missing, expected {} columns", known.len()))
    };
    let frame = find("frame")?;
    Ok(Columns { frame, dofs: names.iter().map(|name| find(name)).collect::<Result<_>>()? })
}

fn one_line(error: &csv::Error) -> String {
    error.to_string().replace('\n', " ")
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn adult() -> Body {
        Body::adult(1750.0).unwrap()
    }

    fn to_csv(table: &PoseTable, body: &Body) -> String {
        let mut bytes = Vec::new();
        let mut rows = PoseWriter::new(&mut bytes, body).unwrap();
        for (frame, pose) in table.frames.iter().zip(&table.poses) {
            rows.write(*frame, pose).unwrap();
        }
        rows.flush().unwrap();
        drop(rows);
        String::from_utf8(bytes).unwrap()
    }

    proptest! {
        #[test]
        fn what_was_single_precision_comes_back_bit_for_bit(
            values in prop::collection::vec(-10.0_f32..10.0, 31), frame in any::<usize>()
        ) {
            let body = adult();
            let pose: Vec<f64> = values.iter().map(|value| f64::from(*value)).collect();
            let table = PoseTable { frames: vec![frame], poses: vec![pose.clone()] };
            let text = to_csv(&table, &body);
            let back = PoseTable::parse(text.as_bytes(), "poses.csv", &body).unwrap();
            prop_assert_eq!(&back.frames, &table.frames);
            for (index, (a, b)) in back.poses[0].iter().zip(&pose).enumerate() {
                prop_assert_eq!((*a as f32).to_bits(), values[index].to_bits());
                prop_assert!((a - b).abs() <= 4.0 * f64::EPSILON * b.abs());
            }
        }

        #[test]
        fn no_text_panics(text in "(frame|pelvis.tx|,|\n|\"|-|1e|[0-9]|nan|\u{feff}){0,60}") {
            let _ = PoseTable::parse(text.as_bytes(), "poses.csv", &adult());
        }

        #[test]
        fn no_bytes_panic(bytes in prop::collection::vec(any::<u8>(), 0..200)) {
            let _ = PoseTable::parse(&bytes[..], "poses.csv", &adult());
        }
    }

    #[test]
    fn columns_are_found_in_any_order() {
        let body = adult();
        let pose: Vec<f64> = (0..31).map(|i| f64::from(i as f32 * 0.125)).collect();
        let text = to_csv(&PoseTable { frames: vec![7], poses: vec![pose.clone()] }, &body);
        assert!(text.starts_with("frame,pelvis.tx,pelvis.ty,pelvis.tz,pelvis.rx,"), "{text}");
        let reversed: Vec<String> =
            text.lines().map(|line| line.split(',').rev().collect::<Vec<_>>().join(" , ")).collect();
        let table = PoseTable::parse(format!("\u{feff}{}", reversed.join("\r\n")).as_bytes(), "x", &body).unwrap();
        assert_eq!(table.frames, [7]);
        for (a, b) in table.poses[0].iter().zip(&pose) {
            assert!((a - b).abs() <= 4.0 * f64::EPSILON * b.abs(), "{a} {b}");
        }
    }

    #[test]
    fn every_bad_table_has_its_sentence() {
        let body = adult();
        let good = to_csv(&PoseTable { frames: vec![0], poses: vec![vec![0.5; 31]] }, &body);
        let (header, row) = good.trim_end().split_once('\n').unwrap();
        let cell = |text: &str| {
            let mut cells: Vec<&str> = row.split(',').collect();
            cells[2] = text;
            format!("{header}\n{row}\n{}\n", cells.join(","))
        };
        let cases = [
            (String::new(), vec!["poses.csv, line 1", "column `frame` is missing"]),
            (format!("{header}\n"), vec!["poses.csv holds no poses"]),
            (good.replace("pelvis.ty", "pelvis.ti"), vec!["line 1", "`pelvis.ti` is unknown", "nearest", "pelvis.t"]),
            (good.replace("pelvis.ty", "pelvis.tx"), vec!["line 1", "`pelvis.tx` is there twice"]),
            (header.replace(",pelvis.ty", "") + "\n", vec!["line 1", "`pelvis.ty` is missing", "32 columns"]),
            (header.replace("frame,", "") + "\n", vec!["line 1", "`frame` is missing"]),
            (cell(""), vec!["poses.csv, line 3", "pelvis.ty is empty"]),
            (cell("NaN"), vec!["line 3", "pelvis.ty is `NaN`", "expected a number"]),
            (cell("inf"), vec!["line 3", "pelvis.ty is `inf`"]),
            (cell("1e300"), vec!["line 3", "pelvis.ty is `1e300`", "mm"]),
            (cell("left"), vec!["line 3", "pelvis.ty is `left`"]),
            (format!("{header}\n-1{}\n", &row[1..]), vec!["line 2", "frame is `-1`", "whole number"]),
            (format!("{header}\n1.5{}\n", &row[1..]), vec!["line 2", "frame is `1.5`"]),
            (good[..good.len() - 40].to_string(), vec!["line 2", "cells, expected 32"]),
        ];
        for (text, sentences) in cases {
            let error = format!("{:#}", PoseTable::parse(text.as_bytes(), "poses.csv", &body).unwrap_err());
            assert!(!error.contains('\n'), "{error}");
            for sentence in sentences {
                assert!(error.contains(sentence), "`{error}` lacks `{sentence}`");
            }
        }
        let error = PoseTable::parse(&b"frame\n\xff\xfe\n"[..], "poses.csv", &body).unwrap_err();
        assert!(format!("{error:#}").contains("poses.csv"), "{error:#}");
        let error = PoseTable::read(Path::new("/nowhere/poses.csv"), &body).unwrap_err();
        assert!(format!("{error:#}").contains("cannot read /nowhere/poses.csv"), "{error:#}");
    }

    #[test]
    fn files_are_written_and_continued() {
        let body = adult();
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("poses.csv");
        let table = PoseTable { frames: vec![0, 1], poses: vec![body.standing_pose(); 2] };
        table.write(&path, Overwrite::Refuse, &body).unwrap();
        let file = std::fs::OpenOptions::new().append(true).open(&path).unwrap();
        let mut rows = PoseWriter::append(file, &body);
        rows.write(2, &body.standing_pose()).unwrap();
        rows.flush().unwrap();
        drop(rows);
        assert_eq!(PoseTable::read(&path, &body).unwrap().frames, [0, 1, 2]);
        let broken = PoseTable { frames: vec![4], poses: vec![vec![f64::NAN; 31]] };
        let error = format!("{:#}", broken.write(&path, Overwrite::Replace, &body).unwrap_err());
        assert!(error.contains("frame 4") && error.contains("pelvis.tx is NaN"), "{error}");
        assert_eq!(PoseTable::read(&path, &body).unwrap().frames.len(), 3, "the old table is whole");
    }

    #[test]
    fn limits_name_joint_value_and_limits() {
        let body = adult();
        let mut pose = body.standing_pose();
        body.check_limits(&pose).unwrap();
        let knee = body.dof_index("left_knee.ry").unwrap();
        pose[knee] = f64::from((150.0_f64).to_radians() as f32);
        body.check_limits(&pose).unwrap();
        pose[knee] = 170.0_f64.to_radians();
        let error = body.check_limits(&pose).unwrap_err().to_string();
        assert_eq!(error, "left_knee.ry is 170 degrees, outside its limits 0 to 150");
        body.clamp_to_limits(&mut pose);
        assert_eq!(pose[knee], 150.0_f64.to_radians());
        pose[1] = -1e5;
        assert!(body.check_limits(&pose).unwrap_err().to_string().contains("pelvis.ty is -100000 mm"));
    }
}
