//! The driver: offline every frame of a range in order, however long it takes; in real time those that can be done in time.

use anyhow::{Result, anyhow, bail, ensure};

use super::TrackSettings;
use super::begin::{Begun, Planned};
use super::progress::Progress;
use super::summary::TrackSummary;
use super::unaided::with_start;
use crate::files::OutputFolder;
use crate::observe::{Plated, with_plates};
use crate::sequence::Sequence;

/// Tracks a sequence and fills `output` with what FORMATS calls a track's folder.
///
/// While it runs, the folder holds `run.toml` and a journal with every finished frame; the results appear when the last
/// frame is done. With [`TrackSettings::resume`] it goes on from the journal and ends with the same bytes as a run that was
/// never stopped. Without, what an earlier run left in `output` is removed.
///
/// The result files depend on the sequence, the settings and the seed alone, never on the number of threads.
///
/// In real time ([`TrackSettings::realtime`]) frames are left out and searched as time allows, so no two runs are the same.
/// poses.csv and joints.csv grow with every pose, realtime.json and timeline.svg tell of the times, and there is no page. A
/// run that is asked to stop, or whose source fails, keeps what it has: all files are written.
///
/// # Errors
/// Anything wrong with an input, named, before a file is written; a run that cannot be resumed; a picture that cannot be
/// read; a folder that cannot be written (the frames before are safe).
pub fn track(
    sequence: &Sequence,
    settings: &TrackSettings,
    output: &OutputFolder,
    progress: &mut dyn Progress,
) -> Result<TrackSummary> {
    ensure!(
        sequence.people.is_empty(),
        "{} has [[person]], and people who are tracked together are no part of this: expected `body` and `start` of one",
        sequence.path.display()
    );
    let plated = plated(sequence, settings, progress)?;
    let (sequence, found) = with_start(&plated.sequence, settings, output, progress)?;
    let warnings = sequence.remarks().into_iter().chain(plated.remarks()).chain(plated.doubt()).chain(found).collect();
    let planned = Planned::new(sequence.as_ref(), settings, output, warnings)?;
    let Begun { mut run, record, done, mut warnings } = planned.begin()?;
    progress.start(&run.start(done.len(), &warnings));
    run.take_over(done)?;
    let searched = run.search_all(progress).and_then(|()| {
        run.find_dissent(progress)?;
        warnings.extend(run.measure_again(None, progress)?);
        run.look_back(progress)
    });
    let done = run.done();
    let ends_anywhere = run.ends_anywhere();
    if !ends_anywhere || done == 0 {
        searched?;
        let summary = run.finish(&record, warnings, progress)?;
        if ends_anywhere {
            let ended = summary.realtime.and_then(|realtime| realtime.ended);
            bail!("no pose was made: {}", ended.as_deref().unwrap_or("no set of pictures of all views came"));
        }
        return Ok(summary);
    }
    // What a source delivered before it failed is as good as ever.
    let finished = run.finish(&record, warnings, progress);
    searched.map_err(|error| anyhow!("{error:#}; the {done} poses before it are in {}", output.path().display()))?;
    finished
}

/// The sequence with plates learnt where it has none. A run that keeps time has seen nothing yet, and learns as it goes.
///
/// # Errors
/// As [`with_plates`].
pub(super) fn plated<'a>(
    sequence: &'a Sequence,
    settings: &TrackSettings,
    progress: &mut dyn Progress,
) -> Result<Plated<'a>> {
    if settings.realtime.is_some() {
        return Ok(Plated::as_it_is(sequence));
    }
    with_plates(sequence, &mut |what, done, total| progress.preparing(what, done, total))
}
