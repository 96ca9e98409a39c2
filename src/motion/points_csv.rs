//! Points as CSV: `frame,time,<name>.x,<name>.y,<name>.z,…`, mm, seconds, frames from 0, missing points empty
//! (joints.csv of FORMATS), then perhaps `<name>.sigma,…`, expected errors in mm. Tables that name their columns `<name>_x` and `time_s`, or have no time, are read as
//! well.

use std::io::Write;

use anyhow::{Context, Result, bail, ensure};

use super::number::{finite, millimetres, point, whole};
use super::points::{PointFile, PointTrajectory, meant_rate};
use super::whole_file::text;
use crate::files::shortened;

/// Files of points.
pub(super) const POINTS: PointFile = PointFile {
    read: |bytes, name| parse_points_csv(text(bytes, name)?, name),
    write: Ok(|out, points, _| write_points_csv(out, points)),
    write_metres: None,
};

/// What ends the name of a column with a point's expected error.
const SIGMA: &str = ".sigma";

/// Reads the text of a points CSV; `name` stands for the file in messages. The rate comes from the times, which must
/// follow the frames evenly; without a time column (or with a single frame at time 0) it is 0, unknown.
///
/// # Errors
/// One sentence with the file, the line, what was found and what was expected; a table of poses is recognised and said
/// to be one.
pub fn parse_points_csv(text: &str, name: &str) -> Result<PointTrajectory> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut reader =
        csv::ReaderBuilder::new().has_headers(false).flexible(true).trim(csv::Trim::All).from_reader(text.as_bytes());
    let mut records = reader.records();
    let first = records.next().transpose().with_context(|| name.to_string())?;
    let Some(first) = first else { bail!("{name} is empty, expected a table of points") };
    let columns: Vec<&str> = first.iter().collect();
    let (leading, names) = header(&columns).with_context(|| format!("{name}, line 1"))?;

    let mut trajectory = PointTrajectory { names, ..PointTrajectory::default() };
    let mut times = Vec::new();
    for record in records {
        let record = record.with_context(|| name.to_string())?;
        let place = || format!("{name}, line {}", record.position().map_or(0, csv::Position::line));
        ensure!(
            record.len() == columns.len(),
            "{}: found {} cells, expected {} as in the header",
            place(),
            record.len(),
            columns.len()
        );
        let frame = whole(&record[0]).context("column frame").with_context(place)?;
        if trajectory.frames.is_empty() {
            trajectory.first_frame = frame;
        }
        let expected = trajectory.first_frame + trajectory.frames.len();
        ensure!(frame == expected, "{}: found frame {frame}, expected frame {expected}", place());
        if leading == 2 {
            times.push(finite(&record[1]).context("column time").with_context(place)?);
        }
        let mut row = Vec::with_capacity(trajectory.names.len());
        for (index, known) in trajectory.names.iter().enumerate() {
            let column = leading + 3 * index;
            let cells = [&record[column], &record[column + 1], &record[column + 2]];
            row.push(point(cells, 1.0).with_context(|| format!("point `{}`", shortened(known))).with_context(place)?);
        }
        trajectory.frames.push(row);
    }
    trajectory.rate = rate_of(&times, trajectory.first_frame).with_context(|| name.to_string())?;
    trajectory.check().with_context(|| name.to_string())?;
    Ok(trajectory)
}

/// The number of columns before the points (`frame`, perhaps a time) and the points' names.
fn header(columns: &[&str]) -> Result<(usize, Vec<String>)> {
    let suffix = |column: &str| column.rsplit_once('.').map(|(_, axis)| axis.to_string()).unwrap_or_default();
    if columns.iter().any(|c| matches!(suffix(c).as_str(), "tx" | "ty" | "tz" | "rx" | "ry" | "rz")) {
        bail!(
            "this is a table of poses (column `{}`), expected points: `frame,time,<name>.x,…`",
            shortened(columns.iter().find(|c| suffix(c).len() == 2).copied().unwrap_or_default())
        );
    }
    ensure!(
        columns[0].eq_ignore_ascii_case("frame"),
        "found `{}` as the first column, expected `frame` and then `time,<name>.x,<name>.y,<name>.z,…`",
        shortened(columns[0])
    );
    let timed = columns.get(1).is_some_and(|c| ["time", "time_s"].iter().any(|t| c.eq_ignore_ascii_case(t)));
    let leading = if timed { 2 } else { 1 };
    let sigmas = columns.iter().position(|column| column.ends_with(SIGMA)).unwrap_or(columns.len());
    let points = columns.get(leading..sigmas).unwrap_or_default();
    ensure!(points.len() >= 3, "found {} columns after the time, expected three for each point", points.len());
    let mut names = Vec::new();
    for triple in points.chunks(3) {
        let base = triple[0].strip_suffix(".x").or_else(|| triple[0].strip_suffix("_x"));
        let Some(base) = base.filter(|base| !base.is_empty()) else {
            bail!("found column `{}`, expected `<name>.x`", shortened(triple[0]));
        };
        let separator = &triple[0][base.len()..=base.len()];
        for (axis, found) in [("y", triple.get(1)), ("z", triple.get(2))] {
            let expected = format!("{base}{separator}{axis}");
            let found = found.copied().unwrap_or_default();
            ensure!(found == expected, "found column `{}`, expected `{}`", shortened(found), shortened(&expected));
        }
        names.push(base.trim().to_string());
    }
    if let Some(stray) = columns[sigmas..]
        .iter()
        .find(|column| column.strip_suffix(SIGMA).is_none_or(|name| !names.iter().any(|known| known == name)))
    {
        bail!("found column `{}` after the points, expected `<name>.sigma` of a point before it", shortened(stray));
    }
    Ok((leading, names))
}

/// Frames a second from the times of consecutive frames.
fn rate_of(times: &[f64], first_frame: usize) -> Result<f64> {
    let (Some(first), Some(last)) = (times.first(), times.last()) else { return Ok(0.0) };
    let steps = times.len() - 1;
    if steps == 0 {
        // One row says how long a frame lasts only when it is not the first of its recording.
        let rate = first_frame as f64 / first;
        return Ok(if rate.is_finite() && rate > 0.0 { meant_rate(rate) } else { 0.0 });
    }
    let rate = steps as f64 / (last - first);
    ensure!(
        rate.is_finite() && rate > 0.0,
        "the times run from {first} s to {last} s over {} frames, expected them to increase",
        times.len()
    );
    for (row, time) in times.iter().enumerate() {
        let expected = first + row as f64 / rate;
        ensure!(
            (time - expected).abs() * rate <= 0.5,
            "frame {} is at {time} s, expected {expected:.6} s as the frames are evenly spaced",
            first_frame + row
        );
    }
    Ok(meant_rate(rate))
}

/// Writes the points as CSV, mm to a tenth of a micrometre; the time column is left out where the rate is unknown.
///
/// # Errors
/// When the trajectory breaks [`PointTrajectory::check`] or writing fails.
pub fn write_points_csv(out: &mut dyn Write, points: &PointTrajectory) -> Result<()> {
    write_with_sigmas(out, points, &[])
}

/// As [`write_points_csv`], with a column `<name>.sigma` a point after all positions: its expected error, mm; `sigmas` holds a row a frame
/// of one value a point. Of a point that is missing so is it.
///
/// # Errors
/// As there; also when there are not as many rows as frames, or values as points.
pub fn write_points_csv_with_sigmas(out: &mut dyn Write, points: &PointTrajectory, sigmas: &[Vec<f64>]) -> Result<()> {
    let is_whole = sigmas.len() == points.frames.len() && sigmas.iter().all(|row| row.len() == points.names.len());
    ensure!(
        is_whole,
        "there are {} rows of expected errors, expected {} of {} points each",
        sigmas.len(),
        points.frames.len(),
        points.names.len()
    );
    write_with_sigmas(out, points, sigmas)
}

fn write_with_sigmas(out: &mut dyn Write, points: &PointTrajectory, sigmas: &[Vec<f64>]) -> Result<()> {
    points.check()?;
    let timed = points.rate > 0.0;
    let mut writer = csv::Writer::from_writer(out);
    let mut header = vec!["frame".to_string()];
    header.extend(timed.then(|| "time".to_string()));
    header.extend(points.names.iter().flat_map(|name| ["x", "y", "z"].map(|axis| format!("{name}.{axis}"))));
    if !sigmas.is_empty() {
        header.extend(points.names.iter().map(|name| format!("{name}{SIGMA}")));
    }
    writer.write_record(&header)?;
    for (row, frame) in points.frames.iter().enumerate() {
        let mut cells = vec![(points.first_frame + row).to_string()];
        // Nine digits, so that even two frames give the rate back exactly.
        cells.extend(points.time(row).map(|time| format!("{time:.9}")));
        for point in frame {
            match point {
                Some(p) => cells.extend([p.x, p.y, p.z].map(millimetres)),
                None => cells.extend([const { String::new() }; 3]),
            }
        }
        let sigmas = sigmas.get(row).into_iter().flatten().zip(frame);
        cells.extend(sigmas.map(|(sigma, point)| point.map_or_else(String::new, |_| format!("{sigma:.2}"))));
        writer.write_record(&cells)?;
    }
    writer.flush()?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::test_points::{close, real_data, trajectories};
    use glam::DVec3;
    use proptest::prelude::*;

    const SMALL: &str = "frame,time,a.x,a.y,a.z,b.x,b.y,b.z\n7,0.7,1,2,3,,,\n8,0.8,4,5,6,7,8,9\n";

    #[test]
    fn expected_errors_follow_the_points_and_are_passed_over() {
        let points = parse_points_csv(SMALL, "joints.csv").unwrap();
        let mut bytes = Vec::new();
        write_points_csv_with_sigmas(&mut bytes, &points, &[vec![1.5, 2.0], vec![20.125, 3.0]]).unwrap();
        let text = String::from_utf8(bytes).unwrap();
        let lines: Vec<&str> = text.lines().collect();
        assert!(lines[0].ends_with("b.z,a.sigma,b.sigma"), "{text}");
        assert!(lines[1].ends_with(",,,,1.50,") && lines[2].ends_with(",20.12,3.00"), "{text}");
        assert_eq!(parse_points_csv(&text, "joints.csv").unwrap(), points);
        let error = format!("{:#}", parse_points_csv(&text.replace("b.sigma", "c.sigma"), "j").unwrap_err());
        assert!(error.contains("found column `c.sigma` after the points"), "{error}");
        assert!(write_points_csv_with_sigmas(&mut Vec::new(), &points, &[vec![1.0, 2.0]]).is_err());
    }

    #[test]
    fn both_layouts() {
        let points = parse_points_csv(SMALL, "joints.csv").unwrap();
        assert_eq!((points.rate, points.first_frame), (10.0, 7));
        assert_eq!(points.frames[0], [Some(DVec3::new(1.0, 2.0, 3.0)), None]);
        let other = SMALL.replace("a.", "a_").replace("b.", "b_").replace("time", "time_s").replace('\n', "\r\n");
        assert_eq!(parse_points_csv(&other, "joints.csv").unwrap(), points);
        let untimed = parse_points_csv("frame,a.x,a.y,a.z\n0,1,2,3\n", "joints.csv").unwrap();
        assert_eq!(untimed.rate, 0.0);
    }

    #[test]
    fn each_fault_is_one_sentence() {
        let cases = [
            (String::new(), "is empty"),
            ("frame,pelvis.tx,pelvis.ty\n0,1,2\n".into(), "a table of poses (column `pelvis.tx`)"),
            ("pose,view,area\n".into(), "found `pose` as the first column"),
            ("frame,time\n0,0\n".into(), "found 0 columns after the time"),
            ("frame,time,a.x,a.y\n".into(), "found 2 columns after the time"),
            ("frame,time,a.x,a.z,a.y\n".into(), "found column `a.z`, expected `a.y`"),
            ("frame,time,a.x,a.y,a.z,b.x\n".into(), "found column ``, expected `b.y`"),
            ("frame,time,.x,.y,.z\n".into(), "expected `<name>.x`"),
            ("frame,time,é,a.y,a.z\n".into(), "found column `é`"),
            ("frame,time,a.x,a.y,a.z\n".into(), "there are no frames"),
            (SMALL.replace("b.", "a."), "two points are named `a`"),
            (SMALL[..SMALL.len() - 3].into(), "line 3: found 7 cells, expected 8"),
            (SMALL.replace("5,6", "nan,6"), "line 3: point `a`: found `nan`, expected a finite number"),
            (SMALL.replace("5,6", "inf,6"), "found `inf`"),
            (SMALL.replace("5,6", ",6"), "line 3: point `a`: found 2 of 3 coordinates"),
            (SMALL.replace("5,6", "5e9,6"), "below 1e9 mm"),
            (SMALL.replace("\n8,", "\n9,"), "line 3: found frame 9, expected frame 8"),
            (SMALL.replace("\n8,", "\n99999999999999,"), "line 3: column frame: found `99999999999999`"),
            (SMALL.replace("0.8", "0.7"), "expected them to increase"),
            (format!("{SMALL}9,3.0,1,1,1,1,1,1\n"), "frame 8 is at 0.8 s"),
            (SMALL.replace("0.8", "late"), "line 3: column time: found `late`"),
        ];
        for (text, expected) in cases {
            let message = format!("{:#}", parse_points_csv(&text, "p.csv").unwrap_err());
            assert!(message.contains(expected) && message.contains("p.csv"), "{message}\nshould say: {expected}");
        }
    }

    #[test]
    fn the_reference_of_the_beam() {
        let Some(folder) = real_data("the_reference_of_the_beam", "beam/reference") else { return };
        let text = std::fs::read_to_string(folder.join("openpose_body25b_3d_filt6hz.csv")).unwrap();
        let points = parse_points_csv(&text, "reference.csv").unwrap();
        assert_eq!((points.names.len(), points.frames.len(), points.rate), (21, 100, 60.0));
        assert_eq!(points.names[0], "Nose");
        let shoulder = points.column("LShoulder").unwrap();
        let p = points.frames[98][shoulder].unwrap();
        assert_eq!(p, DVec3::new(-560.6, 83.2, 1444.7));
    }

    proptest! {
        #[test]
        fn written_and_read_again(points in trajectories()) {
            let mut bytes = Vec::new();
            write_points_csv(&mut bytes, &points).unwrap();
            let again = parse_points_csv(std::str::from_utf8(&bytes).unwrap(), "p.csv").unwrap();
            let mut expected = points.clone();
            if expected.frames.len() == 1 && expected.first_frame == 0 {
                expected.rate = 0.0;
            }
            prop_assert!(close(&expected, &again, 6e-5), "{expected:?}\n{again:?}");
        }
    }
}
