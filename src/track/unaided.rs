//! A sequence that names no first pose, or no body: both are found from the silhouettes of its first second, or of the one in which somebody is
//! first seen, and kept beside the results.

use std::borrow::Cow;
use std::ops::Range;
use std::path::PathBuf;

use anyhow::{Context, Result, ensure};

use super::fit::{Fit, FitSettings, first_seen, fit_with};
use super::progress::Progress;
use super::{FrameRange, TrackSettings};
use crate::body::DofAxis;
use crate::files::{OutputFolder, Overwrite};
use crate::observe::{Advance, with_plates};
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
            format!("{name} names no start pose, and none was found in its first second, nor where somebody is first seen; give one as `start` there or as --start")
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

/// Finds the person in the first second, or where nobody can be measured there, in the one in which somebody is first seen.
fn search(sequence: &Sequence, settings: &TrackSettings, progress: &mut dyn Progress) -> Result<Fit> {
    let range = settings.frames.within(sequence.frame_count, &sequence.path.display().to_string())?;
    let mut advance = |what: &'static str, done: usize, total: usize| progress.preparing(what, done, total);
    let second_from = |frame: usize| frame..frame.saturating_add((sequence.fps.ceil() as usize).max(1)).min(range.end);
    let measured = |sequence: &Sequence, frames: Range<usize>, advance: &mut Advance<'_>| {
        let frames = FrameRange { start: Some(frames.start), end: Some(frames.end) };
        let fit = FitSettings {
            height: sequence.height,
            frames,
            samples: SAMPLES,
            keep_body: !sequence.needs_body(),
            follow: true,
            particles: settings.search.particles,
            seed: settings.search.seed,
            ..FitSettings::default()
        };
        fit_with(sequence, &fit, advance)
    };
    // Learnt once: who is not found at first is looked for with the same.
    let plated = with_plates(sequence, &mut advance)?;
    let sequence = plated.sequence.as_ref();
    let first = second_from(range.start);
    let rest = first.end..range.end;
    let mut found = match measured(sequence, first, &mut advance) {
        Ok(found) => found,
        Err(error) => match first_seen(sequence, 1, rest, &mut advance)? {
            Some(seen) => measured(sequence, second_from(seen), &mut advance)?,
            None => return Err(error),
        },
    };
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
    let frame = found.poses.frames.first().copied().unwrap_or_default();
    format!(
        "the sequence names no start: {body}a first pose{heading} with a fitness of {:.3} was found in frame {frame}, kept as {START}; `pantin fit` and --start \
         say otherwise{others}",
        found.fitness
    )
}
