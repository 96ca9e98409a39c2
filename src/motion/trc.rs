//! TRC, the tab-separated marker format of OpenSim and Cortex. `Frame#` counts from 1, missing points are `NaN` (or empty cells),
//! the unit is in the header. Nothing in the file says which axis is up: coordinates are kept as they stand.

use std::io::Write;

use anyhow::{Context, Result, anyhow, bail, ensure};

use super::number::{finite, fixed, point, whole};
use super::points::{PointFile, PointTrajectory, millimetres_in};
use super::whole_file::text;
use crate::files::shortened;

/// Files of points.
pub(super) const POINTS: PointFile = PointFile {
    read: |bytes, name| parse_trc(text(bytes, name)?, name),
    write: Ok(write_trc),
    write_metres: Some(|out, points, file_name| write_in(out, points, file_name, OPENSIM)),
};

/// A unit that files are written in.
struct Unit {
    name: &'static str,
    millimetres: f64,
    /// Decimals that give a tenth of a micrometre.
    decimals: usize,
}

const MILLIMETRES: Unit = Unit { name: "mm", millimetres: 1.0, decimals: 4 };
const METRES: Unit = Unit { name: "m", millimetres: 1000.0, decimals: 7 };

/// In which ways files differ.
struct Layout {
    unit: Unit,
    /// `Frame#` of frame 0.
    first_number: usize,
    /// What ends the lines of names and axes.
    header_end: &'static str,
    /// What stands between the header and the data.
    after_header: &'static str,
}

/// OpenSim expects an empty line between the header and the data.
const PANTIN: Layout = Layout { unit: MILLIMETRES, first_number: 1, header_end: "", after_header: "\n" };
const OPENSIM: Layout = Layout { unit: METRES, ..PANTIN };
/// Pose2Sim counts frames from 0, and its files go without that line, which OpenSim (4.6) reads as well. Its marker augmentation finds the
/// end of the names by one tab more than others write.
const POSE2SIM: Layout = Layout { unit: METRES, first_number: 0, header_end: "\t", after_header: "" };

/// How a coordinate of a missing point is written. OpenSim (4.6) reads it, and empty cells, as missing; but it refuses a row that ends
/// in empty cells, of which it counts too few.
const MISSING: &str = "NaN";

/// Cells before the first marker: `Frame#` and `Time`.
const LEADING: usize = 2;

/// Reads the text of a TRC file; `name` stands for the file in messages. Millimetres from the unit that the header
/// names; `Frame#` 1 is frame 0, but in files whose times say that they count from 0, as Pose2Sim's.
///
/// # Errors
/// One sentence with the file, the line, what was found and what was expected.
pub fn parse_trc(text: &str, name: &str) -> Result<PointTrajectory> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut lines = text.lines().enumerate().map(|(index, line)| (index + 1, line));
    let mut next = |what: &str| lines.next().ok_or_else(|| anyhow!("{name} ends before {what}, expected a TRC file"));

    let (_, first) = next("its first line")?;
    if !first.trim_start().starts_with("PathFileType") {
        bail!("{name}, line 1: found `{}`, expected a TRC file, which starts with `PathFileType`", shortened(first));
    }
    let (_, keys) = next("the header keys")?;
    let (_, values) = next("the header values")?;
    let header = Header::parse(keys, values).with_context(|| format!("{name}, line 3"))?;
    let (_, labels) = next("the marker names")?;
    let names = marker_names(labels).with_context(|| format!("{name}, line 4"))?;
    if let Some(claimed) = header.markers {
        ensure!(
            claimed == names.len(),
            "{name}, line 4: found {} marker names, expected {claimed} as NumMarkers says",
            names.len()
        );
    }
    // The X1 Y1 Z1 line says nothing that the names do not.
    next("the line of axes")?;

    let mut trajectory =
        PointTrajectory { names, rate: header.rate, first_frame: 0, frames: Vec::new(), smoothed: None };
    let mut expected_number = None;
    for (line, row) in lines.filter(|(_, row)| !row.trim().is_empty()) {
        let (number, points) =
            data_row(row, trajectory.names.len(), header.factor).with_context(|| format!("{name}, line {line}"))?;
        match expected_number {
            None => {
                let counts_from = usize::from(!header.counts_from_0(row, number));
                trajectory.first_frame = number.saturating_sub(counts_from);
            }
            Some(expected) => {
                ensure!(number == expected, "{name}, line {line}: found frame {number}, expected frame {expected}")
            }
        }
        expected_number = Some(number + 1);
        trajectory.frames.push(points);
    }
    if let Some(claimed) = header.frames {
        ensure!(
            claimed == trajectory.frames.len(),
            "{name} holds {} frames, expected {claimed} as NumFrames says",
            trajectory.frames.len()
        );
    }
    trajectory.check().with_context(|| name.to_string())?;
    Ok(trajectory)
}

/// What lines 2 and 3 say.
struct Header {
    rate: f64,
    frames: Option<usize>,
    markers: Option<usize>,
    start: Option<usize>,
    factor: f64,
}

impl Header {
    /// Whether the first row, of that number, is one of a file whose frames count from 0, as Pose2Sim's do: so many frames lie before its
    /// time, and the header begins there too. Others have either, but not both.
    fn counts_from_0(&self, row: &str, number: usize) -> bool {
        let time = row.split('\t').nth(1).and_then(|cell| finite(cell).ok());
        self.start == Some(number) && time.is_some_and(|time| (time * self.rate - number as f64).abs() < 0.25)
    }

    fn parse(keys: &str, values: &str) -> Result<Self> {
        let keys: Vec<&str> = keys.split('\t').map(str::trim).collect();
        let values: Vec<&str> = values.split('\t').map(str::trim).collect();
        let value = |key: &str| -> Option<&str> {
            let column = keys.iter().position(|known| known.eq_ignore_ascii_case(key))?;
            values.get(column).copied().filter(|value| !value.is_empty())
        };
        let rate = value("DataRate").context("the header has no value for DataRate, expected the frames a second")?;
        let rate = finite(rate).context("DataRate")?;
        ensure!(rate > 0.0, "DataRate is {rate}, expected a positive number of frames a second");
        let count = |key: &str| value(key).map(|v| whole(v).with_context(|| key.to_string())).transpose();
        let unit = value("Units").context("the header has no value for Units, expected mm, cm or m")?;
        Ok(Self {
            rate,
            frames: count("NumFrames")?,
            markers: count("NumMarkers")?,
            start: value("OrigDataStartFrame").and_then(|cell| whole(cell).ok()),
            factor: millimetres_in(&shortened(unit)).context("Units")?,
        })
    }
}

/// The names stand over the first of each marker's three columns.
fn marker_names(line: &str) -> Result<Vec<String>> {
    let cells: Vec<&str> = line.split('\t').map(str::trim).collect();
    ensure!(
        cells.first().is_some_and(|cell| cell.eq_ignore_ascii_case("Frame#")),
        "found `{}`, expected the line `Frame#`, `Time` and the marker names",
        shortened(line)
    );
    let mut names: Vec<String> = Vec::new();
    for (column, cell) in cells.iter().enumerate().skip(LEADING) {
        let in_place = (column - LEADING).is_multiple_of(3);
        ensure!(
            in_place || cell.is_empty(),
            "found `{}` in column {}, expected a marker name every third column",
            shortened(cell),
            column + 1
        );
        if in_place {
            names.push((*cell).to_string());
        }
    }
    while names.last().is_some_and(String::is_empty) {
        names.pop();
    }
    Ok(names)
}

/// The frame's number and its points.
fn data_row(row: &str, markers: usize, factor: f64) -> Result<(usize, Vec<Option<glam::DVec3>>)> {
    let mut cells: Vec<&str> = row.split('\t').collect();
    let expected = LEADING + 3 * markers;
    // A tab at the end of the line is common.
    while cells.len() > expected && cells.last().is_some_and(|cell| cell.trim().is_empty()) {
        cells.pop();
    }
    ensure!(cells.len() == expected, "found {} cells, expected {expected} for {markers} markers", cells.len());
    let number = whole(cells[0]).context("Frame#")?;
    finite(cells[1]).context("Time")?;
    let points = cells[LEADING..]
        .chunks_exact(3)
        .enumerate()
        .map(|(marker, xyz)| {
            point([0, 1, 2].map(|axis| without_nan(xyz[axis])), factor)
                .with_context(|| format!("marker {}", marker + 1))
        })
        .collect::<Result<_>>()?;
    Ok((number, points))
}

/// The cell, empty where it says that there is no number: `nan` in any case, with or without a sign.
fn without_nan(cell: &str) -> &str {
    let bare = cell.trim();
    let is_nan = bare.strip_prefix(['-', '+']).unwrap_or(bare).eq_ignore_ascii_case("nan");
    if is_nan { "" } else { cell }
}

/// Writes the points as TRC in mm, to a tenth of a micrometre, a missing one as `NaN`; `file_name` goes into the file's first line.
///
/// # Errors
/// When the trajectory breaks [`PointTrajectory::check`], its rate is unknown, or writing fails.
pub fn write_trc(out: &mut dyn Write, points: &PointTrajectory, file_name: &str) -> Result<()> {
    write_in(out, points, file_name, PANTIN)
}

/// Writes the points (mm, z up) as Pose2Sim writes those of its pose-3d folders: metres, y up (x left, z forward), `Frame#` from 0.
///
/// # Errors
/// As [`write_trc`].
pub fn write_pose2sim_trc(out: &mut dyn Write, points: &PointTrajectory, file_name: &str) -> Result<()> {
    write_in(out, &points.clone().z_up_to_y_up(), file_name, POSE2SIM)
}

fn write_in(out: &mut dyn Write, points: &PointTrajectory, file_name: &str, layout: Layout) -> Result<()> {
    let Layout { unit, first_number, header_end, after_header } = layout;
    points.check()?;
    ensure!(points.rate > 0.0, "the frame rate is unknown, but TRC needs one: give it");
    let frames = points.frames.len();
    let file_name: String = file_name.chars().map(|c| if c.is_control() { '_' } else { c }).collect();
    writeln!(out, "PathFileType\t4\t(X/Y/Z)\t{file_name}")?;
    writeln!(
        out,
        "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\tOrigNumFrames"
    )?;
    let rate = points.rate;
    writeln!(
        out,
        "{rate}\t{rate}\t{frames}\t{}\t{}\t{rate}\t{}\t{frames}",
        points.names.len(),
        unit.name,
        points.first_frame + first_number
    )?;
    write!(out, "Frame#\tTime")?;
    for name in &points.names {
        write!(out, "\t{name}\t\t")?;
    }
    write!(out, "{header_end}\n\t")?;
    for marker in 1..=points.names.len() {
        write!(out, "\tX{marker}\tY{marker}\tZ{marker}")?;
    }
    write!(out, "{header_end}\n{after_header}")?;
    for (row, frame) in points.frames.iter().enumerate() {
        write!(out, "{}\t{:.6}", points.first_frame + row + first_number, points.time(row).unwrap_or(0.0))?;
        for point in frame {
            match point {
                Some(p) => {
                    for coordinate in p.to_array() {
                        write!(out, "\t{}", fixed(coordinate / unit.millimetres, unit.decimals))?;
                    }
                }
                None => write!(out, "\t{MISSING}\t{MISSING}\t{MISSING}")?,
            }
        }
        writeln!(out)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_of_pose2sim_count_from_0_wherever_they_start() {
        for (first_frame, rate) in [(0, 60.0), (1, 60.0), (100, 59.94), (100_000, 1000.0)] {
            let mut points = crate::motion::test_points::trajectory(rate, first_frame, 3);
            for write in [write_trc, write_pose2sim_trc] {
                let mut bytes = Vec::new();
                write(&mut bytes, &points, "p.trc").unwrap();
                let read = parse_trc(std::str::from_utf8(&bytes).unwrap(), "p.trc").unwrap();
                assert_eq!(read.first_frame, first_frame, "{rate}");
            }
            // Times that begin at 0 wherever the frames do say nothing.
            points.first_frame = 4;
            let mut bytes = Vec::new();
            write_trc(&mut bytes, &points, "p.trc").unwrap();
            let text = String::from_utf8(bytes).unwrap();
            let row = text.lines().nth(6).unwrap();
            let time = row.split('\t').nth(1).unwrap();
            let late = text.replacen(&format!("5\t{time}"), "5\t0.000000", 1);
            assert_eq!(parse_trc(&late, "p.trc").unwrap().first_frame, 4);
        }
    }
    use crate::motion::test_points::{close, real_data, trajectories};
    use proptest::prelude::*;

    #[test]
    fn pose2sim_counts_from_zero_in_metres_with_y_up() {
        let points = PointTrajectory {
            names: vec!["Hip".into(), "Nose".into()],
            rate: 60.0,
            first_frame: 30,
            frames: vec![vec![Some(glam::DVec3::new(1000.0, 2000.0, 3000.0)), None]],
            smoothed: None,
        };
        let mut out = Vec::new();
        write_pose2sim_trc(&mut out, &points, "walk_30-30.trc").unwrap();
        let text = String::from_utf8(out).unwrap();
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines[0], "PathFileType\t4\t(X/Y/Z)\twalk_30-30.trc");
        assert_eq!(lines[2], "60\t60\t1\t2\tm\t60\t30\t1");
        assert_eq!(lines[3], "Frame#\tTime\tHip\t\t\tNose\t\t\t");
        assert_eq!(lines[4], "\t\tX1\tY1\tZ1\tX2\tY2\tZ2\t");
        assert_eq!(lines[5], "30\t0.500000\t2.0000000\t3.0000000\t1.0000000\tNaN\tNaN\tNaN");
    }

    const SMALL: &str = "PathFileType\t4\t(X/Y/Z)\tsmall.trc\n\
        DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\n\
        60\t60\t2\t2\tm\n\
        Frame#\tTime\tA\t\t\tB\t\t\n\
        \t\tX1\tY1\tZ1\tX2\tY2\tZ2\n\
        5\t0.083\t1\t2\t3\t\t\t\n\
        6\t0.1\t0.5\t0\t-1e-3\t4\t5\t6\n";

    #[test]
    fn a_small_file() {
        for text in [SMALL.to_string(), SMALL.replace('\n', "\r\n"), format!("\u{feff}{}", SMALL.trim_end())] {
            let points = parse_trc(&text, "small.trc").unwrap();
            assert_eq!((points.names.join(" "), points.rate, points.first_frame), ("A B".into(), 60.0, 4));
            assert_eq!(points.frames[0], [Some(glam::DVec3::new(1000.0, 2000.0, 3000.0)), None]);
            assert_eq!(points.frames[1][0], Some(glam::DVec3::new(500.0, 0.0, -1.0)));
        }
    }

    #[test]
    fn a_gap_is_told_in_every_cell() {
        let points = parse_trc(SMALL, "small.trc").unwrap();
        for nan in ["nan", "NaN", "NAN", " -nan "] {
            let told = SMALL.replace("\t1\t2\t3\t\t\t\n", &format!("\t1\t2\t3\t{nan}\t{nan}\t{nan}\n"));
            assert_ne!(told, SMALL);
            assert_eq!(parse_trc(&told, "small.trc").unwrap(), points, "{nan}");
        }
        let mut lost = points;
        lost.frames[1].fill(None);
        let mut bytes = Vec::new();
        write_trc(&mut bytes, &lost, "lost.trc").unwrap();
        let text = String::from_utf8(bytes).unwrap();
        let rows: Vec<&str> = text.lines().skip(6).collect();
        let gap = "\tNaN".repeat(3);
        assert_eq!(
            rows,
            [format!("5\t0.066667\t1000.0000\t2000.0000\t3000.0000{gap}"), format!("6\t0.083333{gap}{gap}")]
        );
        assert_eq!(parse_trc(&text, "lost.trc").unwrap(), lost);
    }

    #[test]
    fn metres_are_said_in_the_header() {
        let points = parse_trc(SMALL, "small.trc").unwrap();
        let mut bytes = Vec::new();
        write_in(&mut bytes, &points, "m.trc", OPENSIM).unwrap();
        let text = String::from_utf8(bytes).unwrap();
        assert!(
            text.contains("\t2\t2\tm\t60\t5\t2\n") && text.contains("\t0.5000000\t0.0000000\t-0.0010000\t"),
            "{text}"
        );
        assert_eq!(parse_trc(&text, "m.trc").unwrap(), points);
    }

    #[test]
    fn each_fault_is_one_sentence() {
        let cases = [
            (String::new(), "s.trc ends before its first line"),
            ("frame,time\n".into(), "line 1: found `frame,time`, expected a TRC file"),
            (SMALL[..60].into(), "ends before the header values"),
            (SMALL[..SMALL.len() - 13].into(), "line 7: found 4 cells, expected 8 for 2 markers"),
            (SMALL.replace("\n60\t", "\n0\t"), "line 3: DataRate is 0"),
            (SMALL.replace("\n60\t", "\nfast\t"), "line 3: DataRate: found `fast`"),
            (SMALL.replace("2\tm\n", "2\tfeet\n"), "the unit is `feet`"),
            (SMALL.replace("2\tm\n", "2\n"), "no value for Units"),
            (SMALL.replace("\t2\t2\tm", "\t3\t2\tm"), "holds 2 frames, expected 3"),
            (SMALL.replace("\t2\t2\tm", "\t2\t99999999999\tm"), "NumMarkers: found `99999999999`"),
            (SMALL.replace("\t2\t2\tm", "\t2\t4000000000\tm"), "found 2 marker names, expected 4000000000"),
            (SMALL.replace("\tB\t", "\tA\t"), "two points are named `A`"),
            (SMALL.replace("\tB\t", "\t\t"), "found 1 marker names, expected 2"),
            (SMALL.replace("A\t\t\tB", "A\tB\t\t"), "every third column"),
            (SMALL.replace("\t4\t5\t6", "\t4\tnan\t6"), "line 7: marker 2: found 2 of 3 coordinates"),
            (SMALL.replace("\t4\t5\t6", "\t4\tinf\t6"), "line 7: marker 2: found `inf`, expected a finite number"),
            (SMALL.replace("\t4\t5\t6", "\t4\t\t6"), "line 7: marker 2: found 2 of 3 coordinates"),
            (SMALL.replace("\t4\t5\t6", "\t4\t1e300\t6"), "below 1e9 mm"),
            (SMALL.replace("\t4\t5\t6", "\t4\t5\t6\t7"), "found 9 cells, expected 8"),
            (SMALL.replace("\n6\t", "\n8\t"), "line 7: found frame 8, expected frame 6"),
            (SMALL.replace("\n6\t", "\n-6\t"), "line 7: Frame#: found `-6`"),
            (SMALL.replace("\t0.1\t", "\tsoon\t"), "Time: found `soon`"),
        ];
        for (text, expected) in cases {
            let message = format!("{:#}", parse_trc(&text, "s.trc").unwrap_err());
            assert!(message.contains(expected) && message.contains("s.trc"), "{message}\nshould say: {expected}");
            assert!(!message.contains('\n'), "{message}");
        }
    }

    #[test]
    fn the_authors_file() {
        let Some(folder) = real_data("the_authors_file", "beam/reference") else { return };
        let text = std::fs::read_to_string(folder.join("authors_Balancing_for_IK.trc")).unwrap();
        let points = parse_trc(&text, "authors.trc").unwrap();
        assert_eq!((points.names.len(), points.frames.len(), points.rate, points.first_frame), (21, 100, 60.0, 0));
        let hip = points.frames[0][0].unwrap();
        assert!((hip - glam::DVec3::new(-64.997_769, 901.513_220, -1_400.573_592)).length() < 1e-5, "{hip}");
    }

    proptest! {
        #[test]
        fn written_and_read_again(points in trajectories()) {
            let mut bytes = Vec::new();
            write_trc(&mut bytes, &points, "p.trc").unwrap();
            let again = parse_trc(std::str::from_utf8(&bytes).unwrap(), "p.trc").unwrap();
            prop_assert!(close(&points, &again, 6e-5), "{points:?}\n{again:?}");
        }
    }
}
