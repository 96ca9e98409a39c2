//! `pantin bench`.

use std::path::PathBuf;

use anyhow::{Result, ensure};

use super::output::{put, say, tell};
use crate::bench::profile::{self, Comparison, ProfileReport, write_trace};
use crate::bench::{self, Preset};

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
