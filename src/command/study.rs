//! `pantin study`.

use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use anyhow::{Result, bail, ensure};
use serde::Serialize;

use super::interrupt::Interrupt;
use super::output::{say, tell};
use super::progress::ProgressBar;
use super::threads_flag::ThreadsFlag;
use crate::files::{OutputFolder, Overwrite};
use crate::study::{self, Outcome, Run, Study, StudySummary};

/// Runs every combination of a study's settings over its sequences and seeds, and compares them: runs.csv has one row a run,
/// stages.csv one a run and stage, tables.md and table-*.csv means and standard deviations over seeds, plot-*.svg the same as
/// pictures. A study that was stopped or killed goes on with --resume; one that grew does only what is new. Ready study files
/// are in docs/studies.
#[derive(clap::Args, Debug)]
pub(super) struct StudyArgs {
    /// The study file.
    #[arg(value_name = "STUDY.toml")]
    study: PathBuf,
    /// The folder for rows, tables, plots and all runs.
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    #[command(flatten)]
    threads: ThreadsFlag,
    /// Make the runs that the folder does not hold yet.
    #[arg(long)]
    resume: bool,
    /// Print the runs instead of making them, a line of JSON each: its number, its folder and its settings.
    #[arg(long, conflicts_with_all = ["resume", "run", "collect"])]
    plan: bool,
    /// Make this run of the plan alone, without tables; any number of processes may do so in one folder.
    #[arg(long, value_name = "N", conflicts_with_all = ["resume", "collect"])]
    run: Option<usize>,
    /// Write rows, tables and plots of the runs that the folder holds, and make none.
    #[arg(long, conflicts_with = "resume")]
    collect: bool,
    /// Write the tables of runs.csv and stages.csv in the folder into this Markdown file, between their marks
    /// (`<!-- study: NAME TABLE -->` to `<!-- end of study -->`), plots into the folder, and make no runs.
    #[arg(long, value_name = "FILE.md", conflicts_with_all = ["resume", "run", "collect", "plan"])]
    docs: Option<PathBuf>,
}

/// A line of a plan.
#[derive(Serialize)]
struct PlanLine {
    /// What `--run` takes.
    index: usize,
    /// Its folder, within the study's.
    folder: String,
    #[serde(flatten)]
    run: Run,
}

/// Runs the command.
///
/// # Errors
/// When the study makes no sense, a sequence cannot be read, a file cannot be written, some runs failed, or it was
/// interrupted: the sentence says how to go on.
pub(super) fn run(args: &StudyArgs) -> Result<()> {
    let study = Study::load(&args.study)?;
    args.threads.apply()?;
    if args.plan {
        study.check()?;
        for (index, run) in study.runs()?.into_iter().enumerate() {
            say!("{}", serde_json::to_string(&PlanLine { index, folder: run.place(), run })?);
        }
        return Ok(());
    }
    if let Some(index) = args.run {
        return run_one(args, &study, index);
    }
    if let Some(document) = &args.docs {
        ensure!(
            args.output.is_dir(),
            "--docs takes its rows from the folder of -o, and there is none called {}",
            args.output.display()
        );
        let tables = study::write_docs(&study, &OutputFolder::open(&args.output)?, document)?;
        say!("wrote {tables} tables into {}", document.display());
        return Ok(());
    }
    if args.collect {
        ensure!(args.output.is_dir(), "there is no folder {} to collect runs from", args.output.display());
        let summary = study::collect(&study, &OutputFolder::open(&args.output)?)?;
        told(args, &summary);
        if summary.left > 0 {
            tell!("{} runs are not there yet", summary.left);
        }
        return Ok(());
    }
    if args.resume && !args.output.is_dir() {
        bail!("there is no folder {} to resume a study in: leave out --resume", args.output.display());
    }
    let output = if args.resume {
        OutputFolder::open(&args.output)?
    } else {
        // Nothing of a study is thrown away by accident: there is no --force.
        ensure!(
            !OutputFolder::holds_something(&args.output)?,
            "the folder {} is not empty: go on with the study in it by --resume, or choose another folder",
            args.output.display()
        );
        OutputFolder::create(&args.output, Overwrite::Refuse)?
    };
    let summary = study::run(&study, &output, &Watch::new()?)?;
    told(args, &summary);
    if summary.left > 0 {
        bail!("stopped with {} runs left: run the same command with --resume to go on", summary.left);
    }
    if let Some((run, error)) = summary.failures.first() {
        bail!("{} runs failed, the first was {}: {error:#}", summary.failures.len(), run.folder());
    }
    Ok(())
}

/// Makes one run.
fn run_one(args: &StudyArgs, study: &Study, index: usize) -> Result<()> {
    let output = OutputFolder::open(&args.output)?;
    let Some(row) = study::run_one(study, &output, index, &Watch::new()?)? else {
        bail!("stopped midway: the same command goes on")
    };
    say!("{}: {}", row.run.folder(), outcome_line(&row.outcome));
    Ok(())
}

fn told(args: &StudyArgs, summary: &StudySummary) {
    say!("{}", summary.tables);
    let (runs, folder) = (summary.rows.len(), &args.output);
    say!("{runs} runs in {}, start with {}", folder.display(), folder.join("tables.md").display());
}

fn outcome_line(outcome: &Outcome) -> String {
    let error = outcome.error.map_or(String::new(), |error| format!("{error:.1} mm, "));
    format!("{error}{:.1} frames/s", outcome.frames_per_second)
}

/// Runs done, for the estimate of what is left.
#[derive(Default)]
struct Runs {
    all: usize,
    before: usize,
    done: usize,
    begin: Option<Instant>,
}

struct Watch {
    interrupt: Interrupt,
    bar: Mutex<Option<ProgressBar>>,
    runs: Mutex<Runs>,
}

impl Watch {
    fn new() -> Result<Self> {
        Ok(Self { interrupt: Interrupt::listen()?, bar: Mutex::new(None), runs: Mutex::new(Runs::default()) })
    }
}

impl study::Progress for Watch {
    fn making(&self, name: &str, done: usize, frames: usize) {
        let mut bar = self.bar.lock().unwrap_or_else(PoisonError::into_inner);
        let shown = bar.get_or_insert_with(|| {
            tell!("sequence {name}");
            ProgressBar::new("making the sequence", frames)
        });
        shown.advance();
        if done == frames {
            *bar = None;
        }
    }

    fn begin(&self, runs: usize, done: usize) {
        tell!("{runs} runs, {done} of them done");
        *self.runs.lock().unwrap_or_else(PoisonError::into_inner) =
            Runs { all: runs, before: done, done, begin: Some(Instant::now()) };
    }

    fn ran(&self, run: &Run, outcome: Result<&Outcome, &anyhow::Error>) {
        let mut runs = self.runs.lock().unwrap_or_else(PoisonError::into_inner);
        runs.done += 1;
        let spent = runs.begin.map_or(0.0, |begin| begin.elapsed().as_secs_f64());
        let left = spent / (runs.done - runs.before).max(1) as f64 * (runs.all - runs.done) as f64;
        let told = match outcome {
            Ok(outcome) => outcome_line(outcome),
            Err(error) => format!("failed: {error:#}"),
        };
        tell!("{}/{}, {left:.0} s left: {} {told}", runs.done, runs.all, run.folder());
    }

    fn should_stop(&self) -> bool {
        self.interrupt.is_asked()
    }
}
