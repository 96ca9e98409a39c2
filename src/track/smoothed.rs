//! The results of a run smoothed, beside those that were found.

use anyhow::{Result, ensure};

use super::confidence::FrameConfidence;
use super::held::Held;
use super::journal::FrameResult;
use super::results;
use crate::body::Body;
use crate::files::OutputFolder;
use crate::motion::LowPass;
use crate::sequence::Sequence;

/// Their folder in a track's folder.
pub(super) const FOLDER: &str = "smoothed";
/// What was done, in that folder.
pub(super) const NOTE: &str = "smoothing.toml";

/// The low-pass for a run of so many frames.
///
/// # Errors
/// When the cut-off suits no recording of that rate, or there are fewer frames than it takes.
pub(super) fn smoothing(cutoff: f64, fps: f64, frames: usize) -> Result<LowPass> {
    ensure!(
        frames >= LowPass::FEWEST,
        "--smooth takes {} frames or more, and {frames} are to be tracked",
        LowPass::FEWEST
    );
    LowPass::new(cutoff, fps)
}

/// Writes the files of the results once more, with every pose smoothed; frames that are gaps stay so and part those around them. Gives what
/// the user should know.
pub(super) fn write(
    output: &OutputFolder,
    sequence: &Sequence,
    body: &Body,
    frames: &[FrameResult],
    confidences: &[FrameConfidence],
    has_gaps: bool,
    cutoff: f64,
) -> Result<Vec<String>> {
    let low_pass = LowPass::new(cutoff, sequence.fps)?;
    let mut table = Held::new(frames, confidences, false).table;
    let is_gap = |row: usize| has_gaps && confidences.get(row).is_some_and(|confidence| confidence.is_lost);
    let left = match table.smooth(body, &low_pass, &is_gap) {
        Ok(left) => left,
        Err(why) => return Ok(vec![format!("nothing was smoothed: {why:#}")]),
    };
    let pose = |pose: &Vec<f64>| pose.iter().map(|value| *value as f32).collect();
    let smoothed: Vec<FrameResult> = frames
        .iter()
        .zip(&table.poses)
        .map(|(result, smooth)| FrameResult { pose: pose(smooth), ..result.clone() })
        .collect();
    let mut held = Held::new(&smoothed, confidences, has_gaps);
    held.smoothed = Some(cutoff);
    let folder = OutputFolder::open(&output.path().join(FOLDER))?;
    results::write(&folder, body, &sequence.cameras, &smoothed, confidences, &held, sequence.fps)?;
    folder.write(NOTE, |writer| {
        let told = toml::Value::String(low_pass.told());
        Ok(write!(writer, "cut_off = {cutoff:?} # Hz\nframes_per_second = {:?}\nfilter = {told}\n", sequence.fps)?)
    })?;
    let said =
        format!("{FOLDER}/ holds the results smoothed at {}; those beside it are as they were found", low_pass.told());
    Ok([said].into_iter().chain(left.told()).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_that_are_too_short_and_wrong_cut_offs_are_refused_before_the_work() {
        assert!(smoothing(6.0, 25.0, 10).is_ok());
        let error = smoothing(6.0, 25.0, 9).unwrap_err().to_string();
        assert!(error.contains("--smooth takes 10 frames or more, and 9 are to be tracked"), "{error}");
        let error = smoothing(20.0, 25.0, 50).unwrap_err().to_string();
        assert!(error.contains("the cut-off is 20 Hz"), "{error}");
    }
}
