//! The runs of a study, one after the other.

use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::path::Path;

use anyhow::{Context, Result, bail};

use super::outcome::{Outcome, RESULT, Row, StageShare};
use super::pace::Pace;
use super::plots;
use super::run::Run;
use super::runs_csv::{write_runs, write_stages};
use super::scenes::Prepared;
use super::settings::Study;
use super::tables::{self, Table};
use crate::files::OutputFolder;
use crate::search::SearchSettings;
use crate::track::{self, ObjectiveChoice, Passes, RealtimeSettings, TrackSettings, TrackSummary, track};

/// A finished run's file in its folder.
const ROW: &str = "row.json";
/// The journal of a run in work; a folder with one and without a row is gone on with.
pub(super) const BEGUN: &str = "run.toml";

/// What a study tells whoever waits for it.
pub trait Progress: Sync {
    /// A preset is being made: `done` of `frames`.
    fn making(&self, _name: &str, _done: usize, _frames: usize) {}

    /// The study begins: runs in all, and those an earlier call did.
    fn begin(&self, _runs: usize, _done: usize) {}

    /// A run is done and safe, or has failed.
    fn ran(&self, _run: &Run, _outcome: Result<&Outcome, &anyhow::Error>) {}

    /// Whether to stop after the frame in work.
    fn should_stop(&self) -> bool {
        false
    }
}

/// What a study yielded.
#[derive(Debug)]
pub struct StudySummary {
    /// Every run that is done, in the study's order.
    pub rows: Vec<Row>,
    /// Runs that failed, and why.
    pub failures: Vec<(Run, anyhow::Error)>,
    /// Runs that were not reached, because the study was asked to stop.
    pub left: usize,
    /// The tables in Markdown, as in tables.md.
    pub tables: String,
}

/// Makes every run of a study that `output` does not hold yet, and writes runs.csv and stages.csv (one row a run, and one a
/// run and stage), tables.md, `table-<name>.csv` and `plot-<name>.svg`. Each run has a folder `runs/<settings>` with all that
/// `track` writes. A run that fails does not end the study.
///
/// # Errors
/// When a sequence cannot be prepared, a file cannot be written, or `output` holds a run under the same name that was made
/// with other frames or another spread.
pub fn run(study: &Study, output: &OutputFolder, progress: &dyn Progress) -> Result<StudySummary> {
    study.check()?;
    let runs = study.runs()?;
    let mut rows: Vec<Option<Row>> = runs.iter().map(|run| finished(run, output)).collect::<Result<_>>()?;
    progress.begin(runs.len(), rows.iter().flatten().count());
    let mut prepared: HashMap<&str, Prepared> = HashMap::new();
    let mut failures = Vec::new();
    let mut left = 0;
    for (index, run) in runs.iter().enumerate() {
        if rows[index].is_some() {
            continue;
        }
        if progress.should_stop() {
            left += 1;
            continue;
        }
        let sequence = match prepared.entry(run.sequence.as_str()) {
            Entry::Occupied(sequence) => sequence.into_mut(),
            Entry::Vacant(empty) => empty.insert(prepare(study, run, output, progress)?),
        };
        match one(run, sequence, output, progress) {
            Ok(Some(row)) => {
                progress.ran(run, Ok(&row.outcome));
                rows[index] = Some(row);
                // After every run, so that a study can be looked at while it lasts.
                let done: Vec<Row> = rows.iter().flatten().cloned().collect();
                write(study, &done, output)?;
            }
            Ok(None) => left += 1,
            Err(error) => {
                progress.ran(run, Err(&error));
                failures.push((run.clone(), error));
            }
        }
    }
    let rows: Vec<Row> = rows.into_iter().flatten().collect();
    let tables = write(study, &rows, output)?;
    Ok(StudySummary { rows, failures, left, tables })
}

/// Makes run `index` of a study, counted from 0 in the order of [`Study::runs`], unless `output` holds it; none when it was stopped midway. Any
/// number of processes may do so in one folder: sequences are made by one of them, and whoever comes to a run in work waits for it.
///
/// # Errors
/// When the study has no such run, its sequence cannot be prepared, or the run fails.
pub fn run_one(study: &Study, output: &OutputFolder, index: usize, progress: &dyn Progress) -> Result<Option<Row>> {
    study.check()?;
    let runs = study.runs()?;
    let count = runs.len();
    let Some(run) = runs.get(index) else { bail!("there is no run {index} of {count}, expected 0 to {}", count - 1) };
    match finished(run, output)? {
        Some(row) => Ok(Some(row)),
        None => one(run, &prepare(study, run, output, progress)?, output, progress),
    }
}

/// Writes what [`run`] writes beside the runs, of those that `output` holds.
///
/// # Errors
/// When a row cannot be read, or a file cannot be written.
pub fn collect(study: &Study, output: &OutputFolder) -> Result<StudySummary> {
    study.check()?;
    let runs = study.runs()?;
    let rows = runs.iter().map(|run| finished(run, output)).collect::<Result<Vec<_>>>()?;
    let rows: Vec<Row> = rows.into_iter().flatten().collect();
    let tables = write(study, &rows, output)?;
    Ok(StudySummary { left: runs.len() - rows.len(), rows, failures: Vec::new(), tables })
}

/// Opens or makes the sequence of a run while no other process does.
fn prepare(study: &Study, run: &Run, output: &OutputFolder, progress: &dyn Progress) -> Result<Prepared> {
    let name = &run.sequence;
    let Some(sequence) = study.sequences.iter().find(|sequence| sequence.name() == *name) else {
        bail!("there is no sequence {name}")
    };
    let making = |done: usize, frames: usize| progress.making(name, done, frames);
    output.alone(&format!("sequences/{name}"), || Prepared::new(sequence, output, &making))
}

/// The row of a run that an earlier call made.
fn finished(run: &Run, output: &OutputFolder) -> Result<Option<Row>> {
    let path = output.path().join(run.place()).join(ROW);
    if !path.exists() {
        return Ok(None);
    }
    let text = RESULT.read_text(&path)?;
    let row: Row = serde_json::from_str(&text).with_context(|| format!("{} is no row of a study", path.display()))?;
    if row.run != *run {
        bail!(
            "{} was made with frames {}, spread {} and passes {}, expected {}, {} and {}: choose another folder for another study",
            path.display(),
            row.run.frames,
            row.run.spread,
            row.run.passes.map_or("unset", Passes::name),
            run.frames,
            run.spread,
            run.passes.map_or("unset", Passes::name)
        );
    }
    Ok(Some(row))
}

/// Tells the tracker when to stop.
pub(super) struct Watch<'a>(pub(super) &'a (dyn Fn() -> bool + Sync));

impl track::Progress for Watch<'_> {
    fn should_stop(&self) -> bool {
        self.0()
    }
}

/// One run, unless another process made it meanwhile; none when it was stopped midway.
fn one(run: &Run, prepared: &Prepared, output: &OutputFolder, progress: &dyn Progress) -> Result<Option<Row>> {
    output.alone(&run.place(), || match finished(run, output)? {
        Some(row) => Ok(Some(row)),
        None => make(run, prepared, output, progress),
    })
}

fn make(run: &Run, prepared: &Prepared, output: &OutputFolder, progress: &dyn Progress) -> Result<Option<Row>> {
    let folder = OutputFolder::open(&output.path().join(run.place()))?;
    let sequence = prepared.with_model(run.model, output)?;
    let mut settings = settings(run, folder.path())?;
    let should_stop = || progress.should_stop();
    let mut watch = Watch(&should_stop);
    let summary = match track(&sequence, &settings, &folder, &mut watch) {
        // What was begun with other inputs cannot be gone on with, and what has no frame left to track tells no times: the
        // run begins again.
        summary if settings.resume && !summary.as_ref().is_ok_and(|it| it.new_frames > 0) => {
            settings.resume = false;
            track(&sequence, &settings, &folder, &mut watch)?
        }
        summary => summary?,
    };
    if summary.is_cut {
        return Ok(None);
    }
    let row = Row { run: run.clone(), outcome: outcome(prepared, &folder, &summary)? };
    folder.write(ROW, |out| Ok(serde_json::to_writer_pretty(out, &row)?))?;
    Ok(Some(row))
}

/// What `track` is told for a run.
pub(super) fn settings(run: &Run, folder: &Path) -> Result<TrackSettings> {
    Ok(TrackSettings {
        drawing: run.backend,
        model: run.model,
        objective: ObjectiveChoice { kind: run.objective, ..ObjectiveChoice::default() },
        search: SearchSettings {
            kind: run.search,
            particles: run.particles,
            iterations: run.iterations,
            seed: run.seed,
            ..SearchSettings::default()
        },
        spread: run.spread,
        passes: run.passes,
        frames: run.frames.parse()?,
        overlay_every: 0,
        realtime: (run.pace == Pace::Realtime).then(RealtimeSettings::default),
        // A run in real time that was stopped has lost its time.
        resume: run.pace == Pace::Offline && folder.join(BEGUN).exists(),
        ..TrackSettings::default()
    })
}

fn outcome(prepared: &Prepared, folder: &OutputFolder, summary: &TrackSummary) -> Result<Outcome> {
    let errors = prepared.errors(folder, summary)?;
    let timings = summary.timings.iter();
    Ok(Outcome {
        frames: summary.frames.len(),
        points: errors.points,
        error: errors.mean,
        error_std: errors.std,
        error_without_offset: errors.without_offset,
        frames_per_second: summary.frames_per_second,
        fitness: summary.mean_fitness,
        skipped: summary.realtime.as_ref().map(|it| 1.0 - it.poses as f64 / it.captured.max(1) as f64),
        confidence: summary.mean_confidence,
        stages: timings.map(|it| StageShare { name: it.name.clone(), ms: it.mean() }).collect(),
        evaluator: summary.backend.join(" "),
    })
}

/// Writes everything that the rows say; gives the tables in Markdown.
fn write(study: &Study, rows: &[Row], output: &OutputFolder) -> Result<String> {
    output.write("runs.csv", |out| write_runs(out, rows))?;
    output.write("stages.csv", |out| write_stages(out, rows))?;
    write_pictures(study, rows, output, |_| true)?;
    let mut text = String::new();
    for settings in tables::settings(study) {
        let table = Table::new(&settings, rows);
        output.write(&format!("table-{}.csv", settings.name), |out| table.write_csv(out))?;
        text += &table.markdown();
        text += "\n";
    }
    output.write("tables.md", |out| Ok(out.write_all(text.as_bytes())?))?;
    Ok(text)
}

/// Writes the plots, of those that are wanted by the names of their files.
pub(super) fn write_pictures(
    study: &Study,
    rows: &[Row],
    output: &OutputFolder,
    is_wanted: impl Fn(&str) -> bool,
) -> Result<()> {
    let file = |name: &str| format!("plot-{name}.svg");
    let write = |name: &str, svg: String| output.write(&file(name), |out| Ok(out.write_all(svg.as_bytes())?));
    for settings in plots::settings(study).iter().filter(|it| is_wanted(&file(&it.name))) {
        write(&settings.name, plots::plot(settings, rows)?)?;
    }
    for settings in plots::share_settings(study).iter().filter(|it| is_wanted(&file(&it.name))) {
        write(&settings.name, plots::shares(settings, rows)?)?;
    }
    Ok(())
}
