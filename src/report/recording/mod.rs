//! The report as a recording for the Rerun viewer (the feature `rerun`): what the page shows, on a time-line and in space.

#[cfg(feature = "rerun")]
mod contents;
#[cfg(feature = "rerun")]
mod layout;
#[cfg(feature = "rerun")]
mod markdown;
#[cfg(feature = "rerun")]
mod stream;
mod view;

use std::path::Path;

use anyhow::{Result, ensure};

use super::html::ReportData;
use crate::files::{Overwrite, write_atomically};

#[cfg(feature = "rerun")]
use contents::write;
pub use view::RecordedView;

/// Whether this build can write recordings.
///
/// # Errors
/// When it cannot: the sentence says how to build one that can.
pub fn check_recordings_are_built() -> Result<()> {
    ensure!(
        cfg!(feature = "rerun"),
        "this pantin was built without recordings: build it with `cargo build --release --features rerun`, or leave out --rerun"
    );
    Ok(())
}

/// Writes a report as a recording (.rrd) for the viewer of rerun.io.
///
/// World: metres, right-handed, z up. Time-lines: `frame`, and `time` in seconds where the rate is known; frame 0 is at 0 s.
///
/// | entity | holds |
/// |---|---|
/// | `/world/cameras/<camera>` | where it stands, its pinhole in pixels (origin in the corner of the top-left one); a lens's distortion is not part of it |
/// | `/world/cameras/<camera>/overlay` | pictures, from their frame to the next one's |
/// | `/world/<skeleton>/joints`, `/bones` | what the player plays; a joint's number is its place among the skeleton's points |
/// | `/plots/error/<curve>`, `/plots/fitness/<curve>` | curves, mm and 0 to 1 |
/// | `/plots/stages/<stage>` | ms a frame |
/// | `/report/summary`, `/report/settings` | headlines, warnings, errors and stage times; settings: Markdown |
///
/// Points that are missing or not finite are left out. A layout of the viewer's windows is part of the recording.
///
/// # Errors
/// As [`check_recordings_are_built`]; when a picture cannot be read or the file not written.
pub fn write_recording(path: &Path, data: &ReportData, views: &[RecordedView], overwrite: Overwrite) -> Result<()> {
    check_recordings_are_built()?;
    write_atomically(path, overwrite, |writer| write(writer, data, views))
}

/// Stands where nothing can be written.
#[cfg(not(feature = "rerun"))]
fn write(_: &mut dyn std::io::Write, _: &ReportData, _: &[RecordedView]) -> Result<()> {
    check_recordings_are_built()
}

#[cfg(all(test, not(feature = "rerun")))]
mod tests {
    use super::*;

    #[test]
    fn a_build_without_recordings_says_how_to_get_one() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("report.rrd");
        let error = write_recording(&path, &ReportData::default(), &[], Overwrite::Refuse).unwrap_err().to_string();
        assert!(error.contains("cargo build --release --features rerun"), "{error}");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0, "nothing is written");
    }
}
