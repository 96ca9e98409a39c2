//! `pantin bench`.

use anyhow::Result;

use super::output::{put, say, tell};
use crate::bench::{self, Preset};

/// Measures every backend and variant on the same built-in scene, a person among four cameras: an iteration is poses in,
/// fitness out. Rounds are interleaved and the median is told. Every evaluator's fitness is compared with the reference's
/// first. A backend that cannot run here is listed with the reason.
#[derive(clap::Args, Debug)]
pub(super) struct BenchArgs {
    /// What is measured.
    #[arg(long, value_name = "NAME", default_value_t)]
    preset: Preset,
    /// Print JSON instead of tables.
    #[arg(long)]
    json: bool,
}

/// Runs the command.
///
/// # Errors
/// When the scene cannot be made.
pub(super) fn run(args: &BenchArgs) -> Result<()> {
    let report = bench::run(args.preset, &mut |task| tell!("measuring {task}"))?;
    if args.json {
        say!("{}", serde_json::to_string_pretty(&report)?);
    } else {
        put!("{report}");
    }
    Ok(())
}
