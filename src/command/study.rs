//! `pantin study`.

use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use anyhow::{Result, bail};

use super::interrupt::Interrupt;
use super::output::{say, tell};
use super::progress::ProgressBar;
use crate::files::{OutputFolder, Overwrite};
use crate::study::{self, Outcome, Run, Study};

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
    /// Make the runs that the folder does not hold yet.
    #[arg(long)]
    resume: bool,
}

/// Runs the command.
///
/// # Errors
/// When the study makes no sense, a sequence cannot be read, a file cannot be written, some runs failed, or it was
/// interrupted: the sentence says how to go on.
pub(super) fn run(args: &StudyArgs) -> Result<()> {
    let study = Study::load(&args.study)?;
    if args.resume && !args.output.is_dir() {
        bail!("there is no folder {} to resume a study in: leave out --resume", args.output.display());
    }
    let output = if args.resume {
        OutputFolder::open(&args.output)?
    } else {
        OutputFolder::create(&args.output, Overwrite::Refuse).map_err(|error| {
            // Nothing of a study is thrown away by accident: there is no --force.
            error.context("a study is gone on with by --resume")
        })?
    };
    let watch = Watch { interrupt: Interrupt::listen()?, bar: Mutex::new(None), runs: Mutex::new(Runs::default()) };
    let summary = study::run(&study, &output, &watch)?;
    say!("{}", summary.tables);
    say!(
        "{} runs in {}, start with {}",
        summary.rows.len(),
        output.path().display(),
        output.path().join("tables.md").display()
    );
    if summary.left > 0 {
        bail!("stopped with {} runs left: run the same command with --resume to go on", summary.left);
    }
    if let Some((run, error)) = summary.failures.first() {
        bail!("{} runs failed, the first was {}: {error:#}", summary.failures.len(), run.folder());
    }
    Ok(())
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
            Ok(outcome) => {
                let error = outcome.error.map_or(String::new(), |error| format!("{error:.1} mm, "));
                format!("{error}{:.1} frames/s", outcome.frames_per_second)
            }
            Err(error) => format!("failed: {error:#}"),
        };
        tell!("{}/{}, {left:.0} s left: {} {told}", runs.done, runs.all, run.folder());
    }

    fn should_stop(&self) -> bool {
        self.interrupt.is_asked()
    }
}
