//! A sequence that names no first pose, or no body: both are found from the silhouettes of its first second, and kept beside the
//! results.

use std::borrow::Cow;
use std::path::PathBuf;

use anyhow::{Context, Result, ensure};

use super::fit::{Fit, FitSettings, fit_with};
use super::progress::Progress;
use super::{FrameRange, TrackSettings};
use crate::body::DofAxis;
use crate::files::{OutputFolder, Overwrite};
use crate::sequence::Sequence;

/// What is found, beside the results.
pub(super) const BODY: &str = "found_body.toml";
const START: &str = "found_start.csv";

/// Frames of the first second that are looked at.
const SAMPLES: usize = 6;

/// The sequence with a body and a first pose, those that it names or those that were found, and a sentence about what was. A run that goes on
/// keeps what was found when it began.
///
/// # Errors
/// As [`super::fit`]; when a live source brings no first pose, or what was found cannot be written.
pub(super) fn with_start<'a>(
    sequence: &'a Sequence,
    settings: &TrackSettings,
    output: &OutputFolder,
    progress: &mut dyn Progress,
) -> Result<(Cow<'a, Sequence>, Option<String>)> {
    let names_start = settings.start.is_some() || sequence.start.is_some();
    if names_start && !sequence.needs_body() {
        return Ok((Cow::Borrowed(sequence), None));
    }
    let name = sequence.path.display();
    ensure!(
        !sequence.needs_body() || !names_start,
        "{name} names a start pose and no body that it is a pose of, expected `body` with it"
    );
    ensure!(
        !sequence.is_live(),
        "{name} names no start pose, expected a poses.csv as `start` there or as --start: a live source has no first second to find one in"
    );
    let [body, start] = [BODY, START].map(|file| output.path().join(file));
    let mut with = sequence.clone();
    let is_there = |path: &PathBuf| settings.resume && path.is_file();
    let note = if is_there(&start) && (is_there(&body) || !sequence.needs_body()) {
        None
    } else {
        let found = search(sequence, settings, progress).with_context(|| {
            format!("{name} names no start pose, and none was found in its first second; give one as `start` there or as --start")
        })?;
        if sequence.needs_body() {
            output.write(BODY, |writer| Ok(writer.write_all(found.body.to_toml().as_bytes())?))?;
        }
        found.poses.write(&start, Overwrite::Replace, &found.body)?;
        Some(told(&found))
    };
    if sequence.needs_body() {
        with.body = body;
        // It was measured in few postures of a second.
        with.measure_again.get_or_insert(true);
    }
    with.start = Some(start);
    Ok((Cow::Owned(with), note))
}

/// Finds the person in the first second.
fn search(sequence: &Sequence, settings: &TrackSettings, progress: &mut dyn Progress) -> Result<Fit> {
    let range = settings.frames.within(sequence.frame_count, &sequence.path.display().to_string())?;
    let second = range.start.saturating_add((sequence.fps.ceil() as usize).max(1));
    let mut found = fit_with(
        sequence,
        &FitSettings {
            height: sequence.height,
            frames: FrameRange { start: Some(range.start), end: Some(second.min(range.end)) },
            samples: SAMPLES,
            keep_body: !sequence.needs_body(),
            follow: true,
            particles: settings.search.particles,
            seed: settings.search.seed,
            ..FitSettings::default()
        },
        &mut |what, done, total| progress.preparing(what, done, total),
    )?;
    // The frames after the first have told which pose it is; what a run starts from is the first alone.
    found.poses.frames.truncate(1);
    found.poses.poses.truncate(1);
    Ok(found)
}

/// What was found, in a sentence.
fn told(found: &Fit) -> String {
    let heading = found.body.root_dof(DofAxis::Rz).and_then(|at| found.poses.poses.first()?.get(at));
    let heading = heading.map_or_else(String::new, |angle| format!(", facing {:.0} degrees", angle.to_degrees()));
    let body = match found.height {
        Some(height) => format!("a body of {height:.0} mm was measured, and "),
        None => String::new(),
    };
    let others = found.others.iter().map(|others| format!(". {others}")).collect::<String>();
    format!(
        "the sequence names no start: {body}a first pose{heading} with a fitness of {:.3} was found, kept as {START}; `pantin fit` and --start \
         say otherwise{others}",
        found.fitness
    )
}
