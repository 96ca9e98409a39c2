//! Calibration files of the formats people have, all read into [`Camera`]s in millimetres (METHOD A2, FORMATS).

mod checks;
mod opencv;
mod opencv_storage;
mod pose2sim;
mod qualisys;
mod units;
mod writer;

use std::fs;
use std::path::Path;

use anyhow::{Context, Result, anyhow, ensure};

pub use opencv::{parse_opencv_xml, parse_opencv_yaml};
pub use pose2sim::parse_cameras_toml;
pub use qualisys::parse_qualisys;
pub use writer::{cameras_toml, write_cameras_toml};

use crate::files::choices;
use crate::geometry::Camera;

/// Calibrations are small; anything larger is a mistake (a video handed over, say), not worth reading whole.
const LARGEST_FILE: u64 = 16 << 20;

choices! {
    /// The formats of calibration files, by how their names end.
    "calibration format" pub enum CalibrationFormat => parse: Parse {
        /// The layout of Pose2Sim, anipose and caliscope.
        "toml" Pose2Sim => parse_cameras_toml,
        /// Qualisys.
        "qca.txt" QualisysText => parse_qualisys,
        /// Qualisys.
        "qca" Qualisys => parse_qualisys,
        /// OpenCV.
        "yml" OpenCvYml => parse_opencv_yaml,
        /// OpenCV.
        "yaml" OpenCvYaml => parse_opencv_yaml,
        /// OpenCV.
        "xml" OpenCvXml => parse_opencv_xml,
    }
}

type Parse = fn(&str, &str) -> Result<Vec<Camera>>;

/// Reads the cameras of a calibration file, in the file's order, lengths in mm. The format follows the name.
///
/// # Errors
/// One sentence that names the file, the line or the camera and its key, what was found and what was expected: for a file
/// that is absent, not text or of another format, for a camera that lacks something or holds what no camera can have
/// (not a number, an empty picture, a rotation that is none), for two cameras of one name, no camera at all, and for
/// lengths that only make sense in another unit.
pub fn read_cameras(path: &Path) -> Result<Vec<Camera>> {
    let name = path.display().to_string();
    let lower = name.to_lowercase();
    let of_name = |format: &CalibrationFormat| lower.ends_with(&format!(".{format}"));
    let format = match CalibrationFormat::ALL.into_iter().find(of_name) {
        Some(format) => format,
        None => CalibrationFormat::from_name(path.extension().unwrap_or_default().to_string_lossy().as_ref())
            .with_context(|| name.clone())?,
    };
    (format.parse())(&read_text(path)?, &name)
}

fn read_text(path: &Path) -> Result<String> {
    let name = path.display();
    let size = fs::metadata(path).with_context(|| format!("cannot read {name}"))?.len();
    ensure!(size <= LARGEST_FILE, "{name} holds {size} bytes, expected a calibration file of at most {LARGEST_FILE}");
    let bytes = fs::read(path).with_context(|| format!("cannot read {name}"))?;
    let text = String::from_utf8(bytes)
        .map_err(|error| anyhow!("{name} is not text (byte {} is not UTF-8)", error.utf8_error().valid_up_to()))?;
    // Some editors begin a text file with a byte order mark.
    Ok(match text.strip_prefix('\u{feff}') {
        Some(rest) => rest.to_string(),
        None => text,
    })
}

#[cfg(test)]
mod tests;
