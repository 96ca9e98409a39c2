//! The folder of a track.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result};

use super::journal::Journal;
use super::run::REFINED_BODY;
use super::{labels, motion_files, overlay, page, realtime, run_record, smoothed};
use crate::files::OutputFolder;

/// Everything a run writes but its overlays and labels.
const FILES: [&str; 15] = [
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
    REFINED_BODY,
    Journal::NAME,
];

/// Removes what an earlier run left in the folder, so that a new one never stands beside old results; files that no run writes stay.
pub(super) fn clear(output: &OutputFolder) -> Result<()> {
    for name in FILES.into_iter().chain(motion_files::FILES).chain([smoothed::NOTE]) {
        for path in [output.path().join(name), output.path().join(smoothed::FOLDER).join(name)] {
            if path.is_file() {
                remove(&path)?;
            }
        }
    }
    clear_drawn(&output.path().join(overlay::FOLDER), overlay::is_one)?;
    clear_drawn(&output.path().join(labels::FOLDER), labels::is_one)
}

/// Removes the pictures that a run draws into a folder of its own.
fn clear_drawn(folder: &Path, is_one: fn(&Path) -> bool) -> Result<()> {
    let cannot = || format!("cannot read the folder {}", folder.display());
    if folder.is_dir() {
        for entry in fs::read_dir(folder).with_context(cannot)? {
            let path = entry.with_context(cannot)?.path();
            if is_one(&path) {
                remove(&path)?;
            }
        }
    }
    Ok(())
}

fn remove(path: &Path) -> Result<()> {
    fs::remove_file(path).with_context(|| format!("cannot replace {}", path.display()))
}
