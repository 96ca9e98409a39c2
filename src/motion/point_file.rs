//! Point files by their extension.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result, anyhow, bail};

use super::bvh::{BvhMotion, parse_bvh};
use super::c3d::{parse_c3d, write_c3d};
use super::points::PointTrajectory;
use super::points_csv::{parse_points_csv, write_points_csv};
use super::trc::{parse_trc, write_trc};
use crate::files::{Overwrite, write_atomically};

/// A recording is held in memory whole, several times its size in the file; a larger file is a mistake (a video, say).
const LARGEST_FILE: u64 = 2 << 30;

/// The formats that hold points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PointFormat {
    /// `.c3d`
    C3d,
    /// `.trc`
    Trc,
    /// `.csv`
    Csv,
    /// `.bvh`
    Bvh,
}

impl PointFormat {
    /// From a file's extension, in any case.
    ///
    /// # Errors
    /// When it is none of `.c3d .trc .csv .bvh`.
    pub fn of(path: &Path) -> Result<Self> {
        let extension = path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
        match extension.as_str() {
            "c3d" => Ok(Self::C3d),
            "trc" => Ok(Self::Trc),
            "csv" => Ok(Self::Csv),
            "bvh" => Ok(Self::Bvh),
            other => bail!("{} ends in `.{other}`, expected .c3d, .trc, .csv or .bvh", path.display()),
        }
    }
}

/// Reads points (mm) from a C3D, TRC, CSV or BVH file, known by its extension. BVH has no unit: its numbers are taken
/// as millimetres, and its joints and free ends become points ([`BvhMotion::to_points`]). Axes stay as they are in the
/// file.
///
/// # Errors
/// One sentence with the file, the line or byte, what was found and what was expected.
pub fn read_points(path: &Path) -> Result<PointTrajectory> {
    let format = PointFormat::of(path)?;
    let bytes = read_bytes(path)?;
    let name = path.display().to_string();
    match format {
        PointFormat::C3d => parse_c3d(&bytes, &name),
        PointFormat::Trc => parse_trc(text(&bytes, &name)?, &name),
        PointFormat::Csv => parse_points_csv(text(&bytes, &name)?, &name),
        PointFormat::Bvh => {
            let motion = parse_bvh(text(&bytes, &name)?, &name)?;
            motion.to_points().with_context(|| name.clone())
        }
    }
}

/// Reads a BVH file with its skeleton.
///
/// # Errors
/// As [`parse_bvh`], and when the file cannot be read.
pub fn read_bvh(path: &Path) -> Result<BvhMotion> {
    let bytes = read_bytes(path)?;
    let name = path.display().to_string();
    parse_bvh(text(&bytes, &name)?, &name)
}

/// Writes points as C3D, TRC or CSV, as the extension says, through a temporary name.
///
/// # Errors
/// When the trajectory breaks [`PointTrajectory::check`], the format needs a frame rate that is unknown, the file is
/// there and may not be replaced, writing fails, or the extension is `.bvh`, which needs a skeleton.
pub fn write_points(path: &Path, points: &PointTrajectory, overwrite: Overwrite) -> Result<()> {
    let format = PointFormat::of(path)?;
    let file_name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    if format == PointFormat::Bvh {
        bail!(
            "cannot write {}: BVH holds joint angles of a skeleton, which points alone do not give; expected .c3d, .trc or .csv",
            path.display()
        );
    }
    write_atomically(path, overwrite, |out| match format {
        PointFormat::C3d => write_c3d(out, points),
        PointFormat::Trc => write_trc(out, points, &file_name),
        _ => write_points_csv(out, points),
    })
}

pub(super) fn read_bytes(path: &Path) -> Result<Vec<u8>> {
    let cannot = || format!("cannot read {}", path.display());
    let metadata = fs::metadata(path).with_context(cannot)?;
    if metadata.len() > LARGEST_FILE {
        bail!("{} holds {} bytes, expected at most {LARGEST_FILE}", path.display(), metadata.len());
    }
    fs::read(path).with_context(cannot)
}

pub(super) fn text<'a>(bytes: &'a [u8], name: &str) -> Result<&'a str> {
    std::str::from_utf8(bytes).map_err(|error| {
        let line = bytes[..error.valid_up_to()].iter().filter(|&&byte| byte == b'\n').count() + 1;
        anyhow!("{name}, line {line}: byte {} is not UTF-8, expected a text file", error.valid_up_to())
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::test_points::{close, trajectories};
    use proptest::strategy::{Strategy, ValueTree};

    #[test]
    fn by_extension_and_never_over_a_file() {
        let folder = tempfile::tempdir().unwrap();
        let mut runner = proptest::test_runner::TestRunner::deterministic();
        let mut points = trajectories().new_tree(&mut runner).unwrap().current();
        points.rate = 50.0;
        points.first_frame = 2;
        for file in ["a.c3d", "a.TRC", "a.csv"] {
            let path = folder.path().join(file);
            write_points(&path, &points, Overwrite::Refuse).unwrap();
            assert!(close(&points, &read_points(&path).unwrap(), 1e-3), "{file}");
            let message = format!("{:#}", write_points(&path, &points, Overwrite::Refuse).unwrap_err());
            assert!(message.contains("--force"), "{message}");
        }
    }

    #[test]
    fn each_fault_is_one_sentence() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        let message = |path: &Path| format!("{:#}", read_points(path).unwrap_err());
        assert!(message(&at("walk.fbx")).contains("ends in `.fbx`, expected .c3d, .trc, .csv or .bvh"));
        assert!(message(&at("none.trc")).contains("cannot read"));
        fs::write(at("binary.trc"), b"Path\n\xff\xfe").unwrap();
        assert!(message(&at("binary.trc")).contains("line 2: byte 5 is not UTF-8"));
        fs::create_dir(at("folder.csv")).unwrap();
        assert!(message(&at("folder.csv")).contains("cannot read"));
        let mut runner = proptest::test_runner::TestRunner::deterministic();
        let mut points = trajectories().new_tree(&mut runner).unwrap().current();
        let refused = format!("{:#}", write_points(&at("a.bvh"), &points, Overwrite::Refuse).unwrap_err());
        assert!(refused.contains("a skeleton, which points alone do not give"), "{refused}");
        points.rate = 0.0;
        for file in ["a.c3d", "a.trc"] {
            let refused = format!("{:#}", write_points(&at(file), &points, Overwrite::Refuse).unwrap_err());
            assert!(refused.contains("frame rate is unknown"), "{refused}");
            assert!(!at(file).exists());
        }
    }
}
