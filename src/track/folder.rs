//! The folder of a track.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result};

use super::journal::Journal;
use super::{labels, motion_files, overlay, page, realtime, run_record, smoothed};
use crate::files::OutputFolder;

/// Everything a run writes but its overlays and labels.
const FILES: [&str; 14] = [
    "poses.csv",
    "joints.csv",
    "joints.trc",
    "joints_opensim.trc",
    "markers.c3d",
    "confidence.csv",
    "stages.json",
    "trace.json",
    "report.html",
    page::RECORDING,
    realtime::SUMMARY,
    realtime::TIMELINE,
    run_record::NAME,
    Journal::NAME,
];

/// Whether a file of a folder is one that a run drew.
type IsOne = fn(&Path) -> bool;

/// Removes what an earlier run left in the folder, so that a new one never stands beside old results; files that no run writes stay.
pub(super) fn clear(output: &OutputFolder) -> Result<()> {
    let remove = |path: &Path| fs::remove_file(path).with_context(|| format!("cannot replace {}", path.display()));
    for name in FILES.into_iter().chain(motion_files::FILES).chain([smoothed::NOTE]) {
        for path in [output.path().join(name), output.path().join(smoothed::FOLDER).join(name)] {
            if path.is_file() {
                remove(&path)?;
            }
        }
    }
    let drawn: [(&str, IsOne); 2] = [(overlay::FOLDER, overlay::is_one), (labels::FOLDER, labels::is_one)];
    for (name, is_one) in drawn {
        let folder = output.path().join(name);
        if folder.is_dir() {
            let cannot = || format!("cannot read the folder {}", folder.display());
            for entry in fs::read_dir(&folder).with_context(cannot)? {
                let path = entry.with_context(cannot)?.path();
                if is_one(&path) {
                    remove(&path)?;
                }
            }
        }
    }
    Ok(())
}
