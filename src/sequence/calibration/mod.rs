//! Calibration files of the formats people have, all read into [`Camera`]s in millimetres (METHOD A2, FORMATS).

mod checks;
mod opencv;
mod opencv_storage;
mod pose2sim;
mod qualisys;
mod sizes;
mod units;
mod vicon;
mod writer;
mod xml;

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, anyhow, ensure};

pub use opencv::{parse_opencv_xml, parse_opencv_yaml};
pub use pose2sim::parse_cameras_toml;
pub use qualisys::parse_qualisys;
pub use vicon::parse_vicon;
pub use writer::{cameras_toml, write_cameras_toml};

use self::sizes::{Sizes, unsized_pictures};
use crate::files::{Limit, check_regular, choices};
use crate::geometry::Camera;

/// Calibrations are small; anything larger is a mistake (a video handed over, say), not worth reading whole.
const CALIBRATION: Limit = Limit { what: "a calibration file", most: 16 << 20 };

/// No rig has more cameras; a folder of more files was meant for something else.
const MOST_FILES: usize = 256;

choices! {
    /// The formats of calibration files, by how their names end.
    "calibration format" pub enum CalibrationFormat => parse: Parse {
        /// The layout of Pose2Sim, anipose and caliscope.
        "toml" Pose2Sim => |text, name, _| parse_cameras_toml(text, name),
        /// Qualisys.
        "qca.txt" QualisysText => |text, name, _| parse_qualisys(text, name),
        /// Qualisys.
        "qca" Qualisys => |text, name, _| parse_qualisys(text, name),
        /// Vicon.
        "xcp" Vicon => |text, name, _| parse_vicon(text, name),
        /// OpenCV, and EasyMocap's pair of intri.yml and extri.yml.
        "yml" OpenCvYml => opencv::sized_yaml,
        /// OpenCV.
        "yaml" OpenCvYaml => opencv::sized_yaml,
        /// OpenCV.
        "xml" OpenCvXml => opencv::sized_xml,
    }
}

type Parse = fn(&str, &str, Sizes) -> Result<Vec<Camera>>;

/// Reads the cameras of a calibration, in the file's order, lengths in mm. The format follows the name. A folder is read file
/// by file, in the order of their names: OpenCV's calibrations are often one file a camera.
///
/// # Errors
/// One sentence that names the file, the line or the camera and its key, what was found and what was expected: for a file
/// that is absent, not text or of another format, for a camera that lacks something or holds what no camera can have
/// (not a number, an empty picture, a rotation that is none), for two cameras of one name, no camera at all, and for
/// lengths that only make sense in another unit.
pub fn read_cameras(path: &Path) -> Result<Vec<Camera>> {
    read_cameras_sized(path, &unsized_pictures)
}

/// As [`read_cameras`], with the sizes of pictures for cameras whose file states none.
///
/// # Errors
/// As [`read_cameras`], and those of `sizes`.
pub(crate) fn read_cameras_sized(path: &Path, sizes: Sizes) -> Result<Vec<Camera>> {
    if path.is_dir() { read_folder(path, sizes) } else { read_file(path, sizes) }
}

fn read_file(path: &Path, sizes: Sizes) -> Result<Vec<Camera>> {
    let name = path.display().to_string();
    if let Some([lenses, places]) = easymocap_pair(path) {
        let [lenses_name, places_name] = [&lenses, &places].map(|file| file.display().to_string());
        let (lenses, places) = (read_text(&lenses)?, read_text(&places)?);
        return opencv::parse_easymocap((&lenses, &lenses_name), (&places, &places_name), sizes);
    }
    // A name without an ending is more often a wrong one than a file of no known format.
    if path.extension().is_none() {
        check_regular(path).map_err(|why| anyhow!(why))?;
    }
    let format = match format_of(path) {
        Some(format) => format,
        None => CalibrationFormat::from_name(path.extension().unwrap_or_default().to_string_lossy().as_ref())
            .with_context(|| name.clone())?,
    };
    (format.parse())(&read_text(path)?, &name, sizes)
}

fn format_of(path: &Path) -> Option<CalibrationFormat> {
    let lower = path.to_string_lossy().to_lowercase();
    CalibrationFormat::ALL.into_iter().find(|format| lower.ends_with(&format!(".{format}")))
}

/// The other file of EasyMocap's pair, where `path` is one of the two and both are there.
fn easymocap_pair(path: &Path) -> Option<[PathBuf; 2]> {
    let name = path.file_name()?.to_str()?;
    if !["intri.yml", "extri.yml"].contains(&name) {
        return None;
    }
    let pair = ["intri.yml", "extri.yml"].map(|file| path.with_file_name(file));
    pair.iter().all(|file| file.is_file()).then_some(pair)
}

/// A folder of calibrations: hidden files and those of other endings are passed over.
fn read_folder(folder: &Path, sizes: Sizes) -> Result<Vec<Camera>> {
    let name = folder.display();
    let entries = fs::read_dir(folder).with_context(|| format!("cannot read {name}"))?;
    let mut files = Vec::new();
    for entry in entries {
        let path = entry.with_context(|| format!("cannot read {name}"))?.path();
        // Its other half brings it along.
        let is_half = path.ends_with("extri.yml") && easymocap_pair(&path).is_some();
        let is_hidden = path.file_name().is_some_and(|file| file.to_string_lossy().starts_with('.'));
        if path.is_file() && !is_hidden && !is_half && format_of(&path).is_some() {
            files.push(path);
        }
    }
    files.sort();
    ensure!(
        !files.is_empty(),
        "{name} holds no calibration, expected files whose names end in one of {}",
        CalibrationFormat::ALL.map(|format| format!(".{format}")).join(", ")
    );
    ensure!(
        files.len() <= MOST_FILES,
        "{name} holds {} files of calibrations, expected at most {MOST_FILES}, one a camera",
        files.len()
    );
    let mut cameras = Vec::new();
    for file in &files {
        cameras.extend(read_file(file, sizes)?);
    }
    checks::names(&cameras).with_context(|| name.to_string())?;
    Ok(cameras)
}

fn read_text(path: &Path) -> Result<String> {
    CALIBRATION.read_text(path)
}

#[cfg(test)]
mod tests;
