//! Batches: every sequence under a folder tracked with the same settings, into one folder of results with one summary.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use anyhow::{Context, Result, bail, ensure};
use serde::{Deserialize, Serialize};

use super::outcome::RESULT;
use super::runner::{BEGUN, Watch};
use crate::files::OutputFolder;
use crate::sequence::Sequence;
use crate::track::{TrackSettings, TrackSummary, track_all};

/// What makes a folder a sequence.
const MANIFEST: &str = "sequence.toml";
/// A finished trial's file in its folder of results.
const DONE: &str = "trial.json";
/// While trials are tracked the summary is no older than that.
const BETWEEN_SUMMARIES: Duration = Duration::from_secs(10);
/// The summary of all.
const SUMMARY: &str = "summary.csv";

/// A sequence of a batch.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Trial {
    /// Its folder from the batch's on, and that of its results from theirs on: `anna/jump 1`.
    pub name: String,
    /// Its folder.
    pub folder: PathBuf,
}

/// A person who was tracked in a trial: a row of summary.csv.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
pub struct TrialRow {
    /// The trial.
    pub trial: String,
    /// The person, where the manifest names people.
    pub person: Option<String>,
    /// Frames tracked.
    pub frames: usize,
    /// Of them those in which the person is lost.
    pub lost: usize,
    /// Frames a second.
    pub frames_per_second: f64,
    /// Mean fitness.
    pub fitness: f64,
    /// Mean confidence.
    pub confidence: f64,
    /// Mean error against the sequence's truth and its standard deviation, mm.
    pub error: Option<f64>,
    /// See `error`.
    pub error_std: Option<f64>,
    /// Sentences that a user should read.
    pub warnings: Vec<String>,
}

/// A trial that is done, with what it was tracked with.
#[derive(Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
struct Done {
    settings: String,
    rows: Vec<TrialRow>,
}

/// What a batch tells whoever waits for it.
pub trait BatchProgress: Sync {
    /// The batch begins: trials in all, and those that earlier calls did.
    fn begin(&self, _trials: usize, _done: usize) {}

    /// A trial is done and safe, or has failed.
    fn tracked(&self, _trial: &Trial, _rows: Result<&[TrialRow], &anyhow::Error>) {}

    /// Whether to stop after the frame in work.
    fn should_stop(&self) -> bool {
        false
    }
}

/// What a batch yielded.
#[derive(Debug)]
pub struct BatchSummary {
    /// A row a person, of all trials that are done.
    pub rows: Vec<TrialRow>,
    /// Trials that failed, and why.
    pub failures: Vec<(Trial, anyhow::Error)>,
    /// Trials that were not reached, because the batch was asked to stop.
    pub left: usize,
}

/// Every sequence under a folder, itself included, in the order of their names. Inside a sequence none is looked for; links to folders
/// and `results` are passed over.
///
/// # Errors
/// When there is none, or a folder cannot be read.
pub fn trials(root: &Path, results: &Path) -> Result<Vec<Trial>> {
    let results = fs::canonicalize(results).ok();
    let mut found = Vec::new();
    let mut left = vec![root.to_path_buf()];
    while let Some(folder) = left.pop() {
        if folder.join(MANIFEST).is_file() {
            let below = folder.strip_prefix(root).unwrap_or(&folder).to_string_lossy().into_owned();
            let own = || root.file_name().map_or("sequence".into(), |name| name.to_string_lossy().into_owned());
            found.push(Trial { name: if below.is_empty() { own() } else { below }, folder });
            continue;
        }
        let cannot = || format!("cannot read the folder {}", folder.display());
        for entry in fs::read_dir(&folder).with_context(cannot)? {
            let entry = entry.with_context(cannot)?;
            let is_results = || results.is_some() && fs::canonicalize(entry.path()).ok() == results;
            if entry.file_type().with_context(cannot)?.is_dir() && !is_results() {
                left.push(entry.path());
            }
        }
    }
    ensure!(!found.is_empty(), "{} holds no {MANIFEST} anywhere, expected one a sequence", root.display());
    found.sort_by(|left, right| left.name.cmp(&right.name));
    Ok(found)
}

/// Tracks every trial that `output` does not hold yet, each into a folder of its name with all that `track` writes, and writes summary.csv. A
/// trial that fails does not end the batch. Any number of processes may do so in one folder: each takes trials that no other is at.
///
/// # Errors
/// When a file cannot be written.
pub fn batch(
    trials: &[Trial],
    settings: &TrackSettings,
    output: &OutputFolder,
    progress: &dyn BatchProgress,
) -> Result<BatchSummary> {
    let is_done = |trial: &&Trial| output.path().join(&trial.name).join(DONE).exists();
    progress.begin(trials.len(), trials.iter().filter(is_done).count());
    let mut failures = Vec::new();
    let mut busy = Vec::new();
    let mut left = 0;
    let mut told: Option<Instant> = None;
    let mut take = |trial: &Trial, waits: bool| -> Result<bool> {
        if progress.should_stop() {
            left += 1;
            return Ok(true);
        }
        let before = output.path().join(&trial.name).join(DONE).exists();
        match one(trial, settings, output, waits, progress) {
            Ok(Outcome::Busy) => return Ok(false),
            Ok(Outcome::Stopped) => left += 1,
            Ok(Outcome::Done(rows)) => {
                if !before {
                    progress.tracked(trial, Ok(&rows));
                    // Every trial's file is read for it.
                    if told.is_none_or(|told| told.elapsed() > BETWEEN_SUMMARIES) {
                        collect(trials, output)?;
                        told = Some(Instant::now());
                    }
                }
            }
            Err(error) => {
                progress.tracked(trial, Err(&error));
                failures.push((trial.clone(), error));
            }
        }
        Ok(true)
    };
    for trial in trials {
        if !take(trial, false)? {
            busy.push(trial);
        }
    }
    // What others were at is done by now, was given up by them, or is waited for.
    for trial in busy {
        take(trial, true)?;
    }
    Ok(BatchSummary { rows: collect(trials, output)?, failures, left })
}

/// Tracks one trial, unless `output` holds it; none when it was stopped midway.
///
/// # Errors
/// When it fails.
pub fn track_trial(
    trial: &Trial,
    settings: &TrackSettings,
    output: &OutputFolder,
    progress: &dyn BatchProgress,
) -> Result<Option<Vec<TrialRow>>> {
    Ok(match one(trial, settings, output, true, progress)? {
        Outcome::Done(rows) => Some(rows),
        Outcome::Stopped | Outcome::Busy => None,
    })
}

/// Writes summary.csv of the trials that `output` holds, and gives its rows.
///
/// # Errors
/// When a trial's file cannot be read, or the summary not be written.
pub fn collect(trials: &[Trial], output: &OutputFolder) -> Result<Vec<TrialRow>> {
    // One process at a time writes it, and with all that is done by then.
    output.alone("summary", || {
        let mut rows = Vec::new();
        for trial in trials {
            rows.extend(done(trial, output)?.into_iter().flat_map(|done| done.rows));
        }
        output.write(SUMMARY, |out| write_summary(out, &rows))?;
        Ok(rows)
    })
}

enum Outcome {
    Done(Vec<TrialRow>),
    Stopped,
    /// Another process is at it.
    Busy,
}

fn done(trial: &Trial, output: &OutputFolder) -> Result<Option<Done>> {
    let path = output.path().join(&trial.name).join(DONE);
    if !path.exists() {
        return Ok(None);
    }
    let text = RESULT.read_text(&path)?;
    serde_json::from_str(&text).map(Some).with_context(|| format!("{} is no trial of a batch", path.display()))
}

/// Everything that decides a trial's results, to be compared with another call's.
fn told(settings: &TrackSettings) -> String {
    format!("{:?}", TrackSettings { resume: false, ..settings.clone() })
}

fn one(
    trial: &Trial,
    settings: &TrackSettings,
    output: &OutputFolder,
    waits: bool,
    progress: &dyn BatchProgress,
) -> Result<Outcome> {
    let work = || -> Result<Outcome> {
        if let Some(done) = done(trial, output)? {
            ensure!(
                done.settings == told(settings),
                "{} was tracked with other settings: give the same, or choose another folder",
                output.path().join(&trial.name).display()
            );
            return Ok(Outcome::Done(done.rows));
        }
        make(trial, settings, output, progress)
    };
    if waits {
        return output.alone(&trial.name, work);
    }
    Ok(output.alone_at_once(&trial.name, work)?.unwrap_or(Outcome::Busy))
}

fn make(
    trial: &Trial,
    settings: &TrackSettings,
    output: &OutputFolder,
    progress: &dyn BatchProgress,
) -> Result<Outcome> {
    let sequence = Sequence::open(&trial.folder)?;
    let folder = OutputFolder::open(&output.path().join(&trial.name))?;
    let begun = |folder: &Path| folder.join(BEGUN).exists();
    let is_begun =
        begun(folder.path()) || sequence.people.iter().any(|person| begun(&folder.path().join(&person.name)));
    let settings = TrackSettings { resume: is_begun, ..settings.clone() };
    let summaries = track_all(&sequence, &settings, &folder, &mut Watch(&|| progress.should_stop()))?;
    if summaries.iter().any(|(_, summary)| summary.is_cut) {
        return Ok(Outcome::Stopped);
    }
    let rows: Vec<TrialRow> = summaries
        .iter()
        .map(|(place, summary)| {
            let person = (place != folder.path()).then(|| place.file_name()).flatten();
            row(trial, person.map(|name| name.to_string_lossy().into_owned()), summary)
        })
        .collect();
    let done = Done { settings: told(&settings), rows };
    folder.write(DONE, |out| Ok(serde_json::to_writer_pretty(out, &done)?))?;
    Ok(Outcome::Done(done.rows))
}

fn row(trial: &Trial, person: Option<String>, summary: &TrackSummary) -> TrialRow {
    TrialRow {
        trial: trial.name.clone(),
        person,
        frames: summary.frames.len(),
        lost: summary.lost,
        frames_per_second: summary.frames_per_second,
        fitness: summary.mean_fitness,
        confidence: summary.mean_confidence,
        error: summary.error.as_ref().map(|error| error.error.mean),
        error_std: summary.error.as_ref().map(|error| error.error.std),
        warnings: summary.warnings.clone(),
    }
}

fn write_summary(out: &mut dyn Write, rows: &[TrialRow]) -> Result<()> {
    let mut table = csv::Writer::from_writer(out);
    table.write_record([
        "trial",
        "person",
        "frames",
        "lost",
        "frames_per_second",
        "fitness",
        "confidence",
        "error_mm",
        "error_std_mm",
        "warnings",
    ])?;
    let number = |value: Option<f64>| value.map_or(String::new(), |value| format!("{value:.3}"));
    for row in rows {
        table.write_record([
            row.trial.as_str(),
            row.person.as_deref().unwrap_or(""),
            &row.frames.to_string(),
            &row.lost.to_string(),
            &format!("{:.1}", row.frames_per_second),
            &format!("{:.4}", row.fitness),
            &format!("{:.4}", row.confidence),
            &number(row.error),
            &number(row.error_std),
            &row.warnings.join("; "),
        ])?;
    }
    table.flush()?;
    Ok(())
}

/// The trial of that number.
///
/// # Errors
/// When there is none.
pub fn numbered(trials: &[Trial], index: usize) -> Result<&Trial> {
    let count = trials.len();
    let Some(trial) = trials.get(index) else {
        bail!("there is no trial {index} of {count}, expected 0 to {}", count - 1)
    };
    Ok(trial)
}
