//! MOT, the motion file of OpenSim and SIMM: a column a coordinate over time, in degrees and metres.

use std::io::Write;

use anyhow::{Result, ensure};

use super::number::fixed;

/// Decimals of a value: a hundredth of a micrometre, and as little of a degree.
const DECIMALS: usize = 8;

/// Coordinates over time.
#[derive(Clone, Debug, PartialEq)]
pub struct CoordinateTable {
    /// Their names, each once, without blanks.
    pub names: Vec<String>,
    /// Seconds, rising; rows need not be as far apart as each other.
    pub times: Vec<f64>,
    /// A row a time, degrees and metres.
    pub rows: Vec<Vec<f64>>,
}

/// Writes a motion file; `name` goes into its first line.
///
/// # Errors
/// When there are no rows, a name cannot stand in the file or stands twice, times do not rise, a row has another length or a value that
/// is not finite, or writing fails.
pub fn write_mot(out: &mut dyn Write, table: &CoordinateTable, name: &str) -> Result<()> {
    let CoordinateTable { names, times, rows } = table;
    ensure!(!rows.is_empty() && rows.len() == times.len(), "there are {} rows at {} times", rows.len(), times.len());
    for (column, coordinate) in names.iter().enumerate() {
        let is_plain = !coordinate.is_empty() && !coordinate.chars().any(|c| c.is_whitespace() || c.is_control());
        ensure!(
            is_plain && coordinate != "time",
            "a coordinate is named {coordinate:?}, expected a name without blanks"
        );
        ensure!(!names[..column].contains(coordinate), "two coordinates are named `{coordinate}`, expected each once");
    }
    let rises = times.windows(2).all(|pair| pair[0] < pair[1]) && times.iter().all(|time| time.is_finite());
    ensure!(rises, "the times of the rows do not rise");
    let name: String = name.chars().map(|c| if c.is_control() { '_' } else { c }).collect();
    writeln!(out, "{name}\nversion=1\nnRows={}\nnColumns={}\ninDegrees=yes\nendheader", rows.len(), names.len() + 1)?;
    writeln!(out, "time\t{}", names.join("\t"))?;
    for (time, row) in times.iter().zip(rows) {
        ensure!(row.len() == names.len(), "the row at {time} s has {} values, expected {}", row.len(), names.len());
        ensure!(row.iter().all(|value| value.is_finite()), "the row at {time} s has a value that is not finite");
        let values: Vec<String> = row.iter().map(|value| fixed(*value, DECIMALS)).collect();
        writeln!(out, "{}\t{}", fixed(*time, DECIMALS), values.join("\t"))?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table() -> CoordinateTable {
        CoordinateTable {
            names: vec!["knee_angle_l".into(), "pelvis_ty".into()],
            times: vec![0.04, 0.12],
            rows: vec![vec![12.5, 0.95], vec![-1e-12, 1.0]],
        }
    }

    #[test]
    fn the_header_counts_columns_and_rows() {
        let mut bytes = Vec::new();
        write_mot(&mut bytes, &table(), "walk").unwrap();
        let expected = "walk\nversion=1\nnRows=2\nnColumns=3\ninDegrees=yes\nendheader\ntime\tknee_angle_l\tpelvis_ty\n\
            0.04000000\t12.50000000\t0.95000000\n0.12000000\t0.00000000\t1.00000000\n";
        assert_eq!(String::from_utf8(bytes).unwrap(), expected);
    }

    #[test]
    fn what_cannot_be_written_is_named() {
        type Change = fn(&mut CoordinateTable);
        let broken: [(&str, Change); 6] = [
            ("two coordinates are named `pelvis_ty`", |t| t.names[0] = "pelvis_ty".into()),
            ("named \"a b\"", |t| t.names[0] = "a b".into()),
            ("times of the rows do not rise", |t| t.times[1] = 0.04),
            ("has 1 values, expected 2", |t| t.rows[1].truncate(1)),
            ("not finite", |t| t.rows[0][1] = f64::NAN),
            ("0 rows", |t| t.rows.clear()),
        ];
        for (expected, change) in broken {
            let mut table = table();
            change(&mut table);
            let error = write_mot(&mut Vec::new(), &table, "walk").unwrap_err().to_string();
            assert!(error.contains(expected), "{error} should say {expected}");
        }
    }
}
