//! The points of a finished track, for comparison with a truth.

use std::path::{Path, PathBuf};

use anyhow::{Result, bail};

use crate::motion::{PointPairs, PointTrajectory, read_points};

/// The points to score and how they are paired with the truth's: those of the file itself, or of a track's folder the
/// first of markers.c3d and joints.csv that shares a name with the truth. `map` pairs (truth's name, our name).
///
/// # Errors
/// When no file can be read, or none shares a name with the truth.
pub fn tracked_points(
    track: &Path,
    truth: &PointTrajectory,
    map: &[(String, String)],
) -> Result<(PathBuf, PointTrajectory, PointPairs)> {
    let candidates = if track.is_dir() {
        vec![track.join("markers.c3d"), track.join("joints.csv")]
    } else {
        vec![track.to_path_buf()]
    };
    let mut refusals = Vec::new();
    for path in candidates {
        if track.is_dir() && !path.exists() {
            continue;
        }
        let ours = read_points(&path)?;
        match PointPairs::find(&ours, truth, map) {
            Ok(pairs) => return Ok((path, ours, pairs)),
            Err(refusal) => refusals.push(format!("{}: {refusal}", path.display())),
        }
    }
    if refusals.is_empty() {
        bail!(
            "{} holds neither markers.c3d nor joints.csv, expected a track's folder or a file of points",
            track.display()
        );
    }
    bail!("{} (pair them with --map TRUTH=OURS)", refusals.join("; "))
}
