//! Numbers as text files hold them.

use anyhow::{Result, bail, ensure};
use glam::DVec3;

use super::points::LARGEST_COORDINATE;
use crate::files::shortened;

/// A finite number. Rust would also read `nan` and `inf`, which no recording means.
pub(crate) fn finite(cell: &str) -> Result<f64> {
    match cell.trim().parse::<f64>() {
        Ok(number) if number.is_finite() => Ok(number),
        Ok(_) => bail!("found `{}`, expected a finite number", shortened(cell)),
        Err(_) => bail!("found `{}`, expected a number", shortened(cell)),
    }
}

/// A whole number from 0.
pub(crate) fn whole(cell: &str) -> Result<usize> {
    let cell = cell.trim();
    // Some programs write counts as 100.0.
    let digits = cell.strip_suffix(".0").unwrap_or(cell);
    match digits.parse::<usize>() {
        // Frame numbers are added to each other: leave room below the largest.
        Ok(number) if number <= u32::MAX as usize => Ok(number),
        _ => bail!("found `{}`, expected a whole number from 0 to {}", shortened(cell), u32::MAX),
    }
}

/// A point from three cells, in mm after multiplication with `factor`; all three empty where it is missing.
pub(super) fn point(cells: [&str; 3], factor: f64) -> Result<Option<DVec3>> {
    let empty = cells.iter().filter(|cell| cell.trim().is_empty()).count();
    match empty {
        3 => Ok(None),
        0 => {
            let p = DVec3::new(finite(cells[0])?, finite(cells[1])?, finite(cells[2])?) * factor;
            ensure!(
                p.abs().max_element() <= LARGEST_COORDINATE,
                "found ({}, {}, {}) mm, expected coordinates below {LARGEST_COORDINATE:e} mm",
                p.x,
                p.y,
                p.z
            );
            Ok(Some(p))
        }
        _ => bail!("found {} of 3 coordinates, expected all three, or none where the point is missing", 3 - empty),
    }
}

/// A coordinate in mm with a tenth of a micrometre, without the sign of a rounded zero.
pub(super) fn millimetres(value: f64) -> String {
    fixed(value, 4)
}

/// A number with that many decimals, without the sign of a rounded zero.
pub(crate) fn fixed(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    match text.strip_prefix('-') {
        Some(rest) if rest.bytes().all(|b| b == b'0' || b == b'.') => rest.to_string(),
        _ => text,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_finite_numbers() {
        assert_eq!(finite(" -1.5e2 ").unwrap(), -150.0);
        for (cell, expected) in
            [("nan", "finite"), ("-inf", "finite"), ("1e999", "finite"), ("1,5", "`1,5`"), ("", "``")]
        {
            let message = finite(cell).unwrap_err().to_string();
            assert!(message.contains(expected), "{cell}: {message}");
        }
    }

    #[test]
    fn whole_numbers() {
        assert_eq!(whole("100.0").unwrap(), 100);
        for cell in ["-1", "1.5", "99999999999999999999", "18446744073709551615", ""] {
            assert!(whole(cell).unwrap_err().to_string().contains("whole number"), "{cell}");
        }
    }

    #[test]
    fn a_point_is_whole_or_missing() {
        assert_eq!(point(["", " ", ""], 1.0).unwrap(), None);
        assert_eq!(point(["1", "2", "3"], 1000.0).unwrap(), Some(DVec3::new(1000.0, 2000.0, 3000.0)));
        assert!(point(["1", "", "3"], 1.0).unwrap_err().to_string().contains("2 of 3"));
        assert!(point(["1", "2", "1e8"], 1000.0).unwrap_err().to_string().contains("below 1e9"));
    }

    #[test]
    fn zero_has_no_sign() {
        assert_eq!(millimetres(-0.00001), "0.0000");
        assert_eq!(millimetres(-0.5), "-0.5000");
    }
}
