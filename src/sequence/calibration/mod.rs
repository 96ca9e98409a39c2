//! Calibration files of the formats people have, all read into [`Camera`]s in millimetres (SPEC A2, INTERFACES).

mod checks;
mod opencv;
mod opencv_storage;
mod pose2sim;
mod qualisys;
mod units;
mod writer;

use std::fs;
use std::path::Path;

use anyhow::{Context, Result, anyhow, bail, ensure};

pub use opencv::{parse_opencv_xml, parse_opencv_yaml};
pub use pose2sim::parse_cameras_toml;
pub use qualisys::parse_qualisys;
pub use writer::{cameras_toml, write_cameras_toml};

use crate::geometry::Camera;

/// Calibrations are small; anything larger is a mistake (a video handed over, say), not worth reading whole.
const LARGEST_FILE: u64 = 16 << 20;

/// Reads the cameras of a calibration file, in the file's order, lengths in mm. The format follows the name: `.toml` the
/// layout of Pose2Sim, anipose and caliscope, `.qca.txt` Qualisys, `.yml`, `.yaml` and `.xml` OpenCV.
///
/// # Errors
/// One sentence that names the file, the line or the camera and its key, what was found and what was expected: for a file
/// that is absent, not text or of another format, for a camera that lacks something or holds what no camera can have
/// (not a number, an empty picture, a rotation that is none), for two cameras of one name, no camera at all, and for
/// lengths that only make sense in another unit.
pub fn read_cameras(path: &Path) -> Result<Vec<Camera>> {
    let name = path.display().to_string();
    let lower = name.to_lowercase();
    let is = |extensions: &[&str]| extensions.iter().any(|extension| lower.ends_with(extension));
    let parse = if is(&[".toml"]) {
        parse_cameras_toml
    } else if is(&[".qca.txt", ".qca"]) {
        parse_qualisys
    } else if is(&[".yml", ".yaml"]) {
        parse_opencv_yaml
    } else if is(&[".xml"]) {
        parse_opencv_xml
    } else {
        bail!(
            "{name} is no calibration file by its name, expected one that ends in .toml, .qca.txt, .yml, .yaml or .xml"
        );
    };
    parse(&read_text(path)?, &name)
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
