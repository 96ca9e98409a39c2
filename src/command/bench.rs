//! `pantin bench`.

use std::path::PathBuf;

use anyhow::{Result, ensure};

use super::output::{put, say, tell};
use crate::bench::profile::{self, Comparison, ProfileReport, write_trace};
use crate::bench::sweep::{self, SweepReport};
use crate::bench::{self, Preset};
use crate::files::{Overwrite, write_atomically};

/// Measures every backend and variant on the same built-in scene, a person among four cameras: an iteration is poses in,
/// fitness out. Rounds are interleaved and the median is told. Every evaluator's fitness is compared with the reference's
/// first. A backend that cannot run here is listed with the reason.
#[derive(clap::Args, Debug)]
pub(super) struct BenchArgs {
    /// What is measured.
    #[arg(long, value_name = "NAME", default_value_t)]
    preset: Preset,
    /// Measure where an iteration's time goes on the Vulkan device instead, pass by pass: time, invocations, operations and bytes,
    /// and what part of the device's measured peaks that is.
    #[arg(long, conflicts_with = "preset")]
    profile: bool,
    /// Measure how fast the stages are by the size of their workgroups and by their other constants instead, on the Vulkan device:
    /// all give the same integers.
    #[arg(long, conflicts_with_all = ["preset", "profile"])]
    sweep: bool,
    /// Take the sweep's numbers from an earlier one, the JSON of such a run.
    #[arg(long, value_name = "FILE", requires = "sweep")]
    read: Option<PathBuf>,
    /// Write the sweep's numbers as CSV too.
    #[arg(long, value_name = "FILE", requires = "sweep")]
    csv: Option<PathBuf>,
    /// Draw the sweep's times by workgroup size as SVG.
    #[arg(long, value_name = "FILE", requires = "sweep")]
    plot: Option<PathBuf>,
    /// Set the profile beside an earlier one, the JSON of such a run.
    #[arg(long, value_name = "FILE", requires = "profile", conflicts_with = "json")]
    compare: Option<PathBuf>,
    /// Write the profile's passes as a time-line for a trace viewer.
    #[arg(long, value_name = "FILE", requires = "profile")]
    trace: Option<PathBuf>,
    /// Print JSON instead of tables.
    #[arg(long)]
    json: bool,
}

/// Runs the command.
///
/// # Errors
/// When the scene cannot be made; of a profile also when there is no device, or a file cannot be read or written.
pub(super) fn run(args: &BenchArgs) -> Result<()> {
    if args.profile {
        return profile(args);
    }
    if args.sweep {
        return sweep(args);
    }
    let report = bench::run(args.preset, &mut |task| tell!("measuring {task}"))?;
    if args.json {
        say!("{}", serde_json::to_string_pretty(&report)?);
    } else {
        put!("{report}");
    }
    Ok(())
}

fn profile(args: &BenchArgs) -> Result<()> {
    // Before all else: measuring takes a while.
    let before = args.compare.as_deref().map(ProfileReport::read).transpose()?;
    if let Some(path) = &args.trace {
        ensure!(!path.exists(), "{} exists already: choose another name", path.display());
    }
    let report = profile::run(&mut |task| tell!("measuring {task}"))?;
    if let Some(path) = &args.trace {
        write_trace(&report, path)?;
    }
    match &before {
        _ if args.json => say!("{}", serde_json::to_string_pretty(&report)?),
        Some(before) => put!("{}", Comparison { before, now: &report }),
        None => put!("{report}"),
    }
    Ok(())
}

fn sweep(args: &BenchArgs) -> Result<()> {
    // Before all else: measuring takes a while.
    for path in [&args.csv, &args.plot].into_iter().flatten() {
        ensure!(!path.exists(), "{} exists already: choose another name", path.display());
    }
    let report = match &args.read {
        Some(path) => SweepReport::read(path)?,
        None => sweep::run(&mut |task| tell!("measuring {task}"))?,
    };
    let write = |path: &Option<PathBuf>, text: &dyn Fn() -> Result<String>| -> Result<()> {
        let Some(path) = path else { return Ok(()) };
        let text = text()?;
        write_atomically(path, Overwrite::Refuse, |file| Ok(file.write_all(text.as_bytes())?))
    };
    write(&args.csv, &|| Ok(report.csv()))?;
    write(&args.plot, &|| report.chart())?;
    if args.json {
        say!("{}", serde_json::to_string_pretty(&report)?);
    } else {
        put!("{report}");
    }
    Ok(())
}
