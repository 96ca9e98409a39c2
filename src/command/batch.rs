//! `pantin batch`.

use std::path::PathBuf;

use anyhow::{Result, bail, ensure};
use serde::Serialize;

use super::interrupt::Interrupt;
use super::output::{say, tell};
use super::track::TrackOptions;
use crate::files::OutputFolder;
use crate::study::{BatchProgress, Trial, TrialRow, batch, collect_trials, numbered, track_trial, trials};

/// Tracks every sequence found under a folder: each into a folder of its name with all that `pantin track` writes, and summary.csv
/// with a row a trial. A batch that was stopped or killed goes on when the same command is given again, and any number of processes
/// may give it at once, on as many machines as share the folders.
#[derive(clap::Args, Debug)]
pub(super) struct BatchArgs {
    /// The folder with the sequences: every folder under it that holds a sequence.toml.
    #[arg(value_name = "DIR")]
    sequences: PathBuf,
    /// The folder for the results.
    #[arg(short, long, value_name = "DIR")]
    output: PathBuf,
    /// Print the trials instead of tracking them, a line of JSON each: its number, its name and its folder.
    #[arg(long, conflicts_with_all = ["run", "collect"])]
    plan: bool,
    /// Track this trial of the plan alone, without a summary.
    #[arg(long, value_name = "N", conflicts_with = "collect")]
    run: Option<usize>,
    /// Write the summary of the trials that the folder holds, and track none.
    #[arg(long)]
    collect: bool,
    #[command(flatten)]
    options: TrackOptions,
}

/// A line of a plan.
#[derive(Serialize)]
struct PlanLine<'a> {
    /// What `--run` takes.
    index: usize,
    #[serde(flatten)]
    trial: &'a Trial,
}

/// Runs the command.
///
/// # Errors
/// When there is no sequence, a setting makes no sense, a file cannot be written, some trials failed, or it was interrupted.
pub(super) fn run(args: &BatchArgs) -> Result<()> {
    let settings = args.options.settings()?;
    ensure!(settings.realtime.is_none(), "--realtime is for one sequence, expected `pantin track`");
    let trials = trials(&args.sequences, &args.output)?;
    if args.plan {
        for (index, trial) in trials.iter().enumerate() {
            say!("{}", serde_json::to_string(&PlanLine { index, trial })?);
        }
        return Ok(());
    }
    if args.collect {
        ensure!(args.output.is_dir(), "there is no folder {} to collect trials from", args.output.display());
        let rows = collect_trials(&trials, &OutputFolder::open(&args.output)?)?;
        say!("{} rows in {}", rows.len(), args.output.join("summary.csv").display());
        return Ok(());
    }
    let numbered = args.run.map(|index| numbered(&trials, index)).transpose()?;
    args.options.threads.apply()?;
    let watch = Watch { interrupt: Interrupt::listen()? };
    let output = OutputFolder::open(&args.output)?;
    if let Some(trial) = numbered {
        let Some(rows) = track_trial(trial, &settings, &output, &watch)? else {
            bail!("stopped midway: the same command goes on")
        };
        watch.tracked(trial, Ok(&rows));
        return Ok(());
    }
    let summary = batch(&trials, &settings, &output, &watch)?;
    say!(
        "{} trials in {}, start with {}",
        trials.len(),
        args.output.display(),
        args.output.join("summary.csv").display()
    );
    if summary.left > 0 {
        bail!("stopped with {} trials left: the same command goes on", summary.left);
    }
    if let Some((trial, error)) = summary.failures.first() {
        bail!("{} of {} trials failed, the first was {}: {error:#}", summary.failures.len(), trials.len(), trial.name);
    }
    Ok(())
}

struct Watch {
    interrupt: Interrupt,
}

impl BatchProgress for Watch {
    fn begin(&self, trials: usize, done: usize) {
        tell!("{trials} trials, {done} of them done");
    }

    fn tracked(&self, trial: &Trial, rows: Result<&[TrialRow], &anyhow::Error>) {
        match rows {
            Ok(rows) => {
                for row in rows {
                    let person = row.person.as_ref().map(|name| format!(", {name}")).unwrap_or_default();
                    let error = row.error.map(|error| format!(", error {error:.1} mm")).unwrap_or_default();
                    let lost = if row.lost > 0 { format!(", lost in {}", row.lost) } else { String::new() };
                    let (name, frames, confidence) = (&trial.name, row.frames, row.confidence);
                    say!("{name}{person}: {frames} frames{lost}, confidence {confidence:.2}{error}");
                }
            }
            Err(error) => tell!("{}: failed: {error:#}", trial.name),
        }
    }

    fn should_stop(&self) -> bool {
        self.interrupt.is_asked()
    }
}
