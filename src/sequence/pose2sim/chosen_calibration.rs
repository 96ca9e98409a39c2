//! Where the calibration of a trial lies.

use std::fs;
use std::path::PathBuf;
use std::time::SystemTime;

use anyhow::{Result, bail};

use super::listing::{entries, folders_of};

/// The calibration of a trial: in the nearest of these folders that has a folder with `calib` in its name and a file in that; the newest
/// .toml, as Pose2Sim takes it, or the newest .qca.txt where there is none. With it the others that were there to be taken.
pub(super) fn calibration(levels: &[PathBuf]) -> Result<(PathBuf, Vec<PathBuf>)> {
    for level in levels {
        let named = |folder: &PathBuf| {
            folder.file_name().is_some_and(|name| name.to_string_lossy().to_lowercase().contains("calib"))
        };
        let mut files = Vec::new();
        for folder in folders_of(level)?.into_iter().filter(named) {
            files.extend(entries(&folder)?.into_iter().filter(|file| file.is_file()));
        }
        for ending in [".toml", ".qca.txt"] {
            let fits = |file: &&PathBuf| file.to_string_lossy().to_lowercase().ends_with(ending);
            let mut fitting: Vec<PathBuf> = files.iter().filter(fits).cloned().collect();
            let age =
                |file: &PathBuf| fs::metadata(file).and_then(|data| data.modified()).unwrap_or(SystemTime::UNIX_EPOCH);
            fitting.sort_by_key(|file| (age(file), file.clone()));
            if let Some(newest) = fitting.pop() {
                return Ok((newest, fitting));
            }
        }
    }
    let places: Vec<String> = levels.iter().map(|level| level.display().to_string()).collect();
    bail!(
        "there is no calibration in {}, expected a folder like `calibration` with a .toml or .qca.txt in it",
        places.join(" or ")
    );
}
